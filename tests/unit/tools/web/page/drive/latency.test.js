import assert from "node:assert/strict";
import {test} from "node:test";

import {LATE_ABOVE_MS, Latency} from "../../../../../../tools/web/page/drive/latency.js";
import {KEYBOARD} from "../../../../../../tools/web/page/drive/person.js";
import {Sender} from "../../../../../../tools/web/page/drive/sender.js";

/** Makes one measurement of `value_ms`. */
function measure(latency, began_ms, value_ms) {
  latency.sent(latency.count, began_ms, began_ms);
  latency.published(latency.count, latency.count);
  latency.commanded(latency.count);
  return latency.drawn(began_ms + value_ms);
}

test("it lasts from the input to the first frame after a command that was made from it", () => {
  const latency = new Latency();
  latency.sent(5, 1000, 1001);
  assert.equal(latency.drawn(1010), null);
  latency.commanded(40);         // the number of input 5 is not known yet
  assert.equal(latency.drawn(1015), null);
  latency.published(5, 41);
  latency.commanded(40);         // this command was made from an older input
  assert.equal(latency.drawn(1020), null);
  latency.commanded(42);         // this command was made from a newer input
  assert.equal(latency.drawn(1033), 33);
  assert.equal(latency.newest, 33);
  assert.equal(latency.drawn(1050), null);
});

test("one input is followed at a time, and forgotten if no step uses it", () => {
  const latency = new Latency();
  latency.sent(1, 0, 0);
  latency.sent(2, 100, 100);
  latency.published(2, 9);
  latency.commanded(9);
  assert.equal(latency.drawn(150), null);
  latency.sent(3, 3000, 3000);
  latency.published(3, 10);
  latency.commanded(10);
  assert.equal(latency.drawn(3020), 20);
  latency.sent(4, 4000, 4000);
  latency.forget();
  latency.published(4, 11);
  latency.commanded(11);
  assert.equal(latency.drawn(4020), null);
});

test("each measurement is in one frame, although the page repeats an input in many frames", () => {
  const latency = new Latency();
  const sender = new Sender();
  const input = {present: true, throttle: 0, brake: 0, axes: [], buttons: [], device: KEYBOARD};
  const sent = [];
  let now = 0;
  for (let i = 0; i < 200; ++i) {
    const began_ms = now;
    for (let frame = 0; frame < 1 + (7 * i) % 5; ++frame) {
      now += 40 + (13 * i + 5 * frame) % 11;  // the times of the frames jitter
      sent.push(sender.next(input, now, began_ms, latency.takeUnsent()).latency_ms);
    }
    measure(latency, now, 10 + i % 3);
  }
  sent.push(sender.next(input, now, now, latency.takeUnsent()).latency_ms);
  assert.ok(sent.length > 500);
  assert.deepEqual(sent.filter((value) => value !== undefined), latency.values);
});

test("the percentile is the nearest rank of what was measured", () => {
  const latency = new Latency();
  assert.equal(latency.percentile(0.95), null);
  for (let i = 1; i <= 100; ++i) measure(latency, 10000 * i, i);
  assert.equal(latency.percentile(0.95), 95);
  assert.equal(latency.percentile(0.5), 50);
  assert.equal(latency.percentile(1), 100);
});

test("a measurement above 100 ms warns until ten good ones have come", () => {
  const latency = new Latency();
  measure(latency, 0, 100);
  assert.equal(latency.isHigh(100), false);
  measure(latency, 1000, 101);
  assert.equal(latency.isHigh(1101), true);
  assert.equal(latency.highest(1101), 101);
  for (let i = 1; i <= 9; ++i) measure(latency, 2000 + 300 * i, 20);
  assert.equal(latency.isHigh(4720), true);
  measure(latency, 5000, 20);
  assert.equal(latency.isHigh(5020), false);
});

test("a measurement that is over 10 s old does not warn", () => {
  const latency = new Latency();
  measure(latency, 0, 300);
  assert.deepEqual([300, 10000, 11000].map((now_ms) => latency.isHigh(now_ms)), [true, true, false]);
  measure(latency, 12000, 20);
  assert.equal(latency.isHigh(12020), false, "a good one does not bring an old one back");
});

test("it is late if more than one measurement in ten is, and judges each once", () => {
  const latency = new Latency();
  const measureAll = (values) => values.forEach((value) => measure(latency, 1000 * latency.count, value));
  const late = LATE_ABOVE_MS + 1;
  measureAll(Array(9).fill(late));
  assert.equal(latency.takeLate(), false, "nine are too few");
  measureAll([LATE_ABOVE_MS]);
  assert.equal(latency.takeLate(), true);
  assert.equal(latency.takeLate(), false);
  measureAll([late, ...Array(9).fill(LATE_ABOVE_MS)]);
  assert.equal(latency.takeLate(), false);
  measureAll([late, late, ...Array(8).fill(20)]);
  assert.equal(latency.takeLate(), true);
});
