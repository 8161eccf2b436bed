import assert from "node:assert/strict";
import {test} from "node:test";

import {KEYBOARD} from "../../../../../../tools/web/page/drive/person.js";
import {cutText, inputFrame, LOOK_EVERY_MS, Sender} from "../../../../../../tools/web/page/drive/sender.js";

const input = (more = {}) => (
  {present: true, throttle: 0, brake: 0, axes: [], buttons: [], device: KEYBOARD, ...more});

test("a frame has the members of the protocol, within their bounds", () => {
  assert.deepEqual(inputFrame(input({brake: 0.25, buttons: ["take_over"]}), 7, 12.5, 17), {
    op: "input", sequence: 7, age_ms: 12.5, present: true, throttle: 0, brake: 0.25, axes: [],
    buttons: ["take_over"], device: {kind: "keyboard", name: "Keyboard"}, latency_ms: 17});
  const wild = inputFrame(input({throttle: 7, brake: NaN, axes: [...Array(20)].map((_, i) => i - 3)}),
                          0, -4, null);
  assert.deepEqual([wild.throttle, wild.brake, wild.age_ms], [1, 0, 0]);
  assert.equal(wild.axes.length, 16);
  assert.ok(wild.axes.every((value) => Math.abs(value) <= 1));
  assert.ok(!("latency_ms" in wild));
});

test("the name of a device is cut at a whole character", () => {
  assert.equal(cutText("a".repeat(70)), "a".repeat(64));
  assert.equal(cutText("ä".repeat(40)), "ä".repeat(32));
  assert.equal(cutText(`${"a".repeat(63)}ä`), "a".repeat(63));
  assert.equal(cutText("wheel"), "wheel");
});

test("each change is due, but at most every 4 ms", () => {
  const sender = new Sender();
  assert.ok(sender.isDue(input(), 0));
  sender.next(input(), 0, null, null);
  for (const change of [{throttle: 0.5}, {brake: 0.01}, {axes: [0]}, {buttons: ["give_back"]},
                        {device: {...KEYBOARD, id: "Pad"}}]) {
    assert.equal(sender.isDue(input(change), 3), false);
    assert.ok(sender.isDue(input(change), 4));
  }
  assert.equal(sender.isDue(input({throttle: 1e-6}), 4), false);
});

test("the first input without a person is due at once", () => {
  const sender = new Sender();
  sender.next(input(), 100, null, null);
  assert.ok(sender.isDue(input({present: false}), 100));
  sender.next(input({present: false}), 100, null, null);
  assert.equal(sender.isDue(input(), 101), false);
});

test("without a change no gap is longer than 50 ms", () => {
  const sender = new Sender();
  let last = 0;
  let widest = 0;
  for (let now = 0; now < 2000; now += LOOK_EVERY_MS) {
    if (!sender.isDue(input(), now)) continue;
    widest = Math.max(widest, now - last);
    last = now;
    sender.next(input(), now, 0, null);
  }
  assert.ok(widest > 0 && widest <= 50, `${widest}`);
});

test("a pedal that moves all the time makes at most 250 frames a second", () => {
  const sender = new Sender();
  let frames = 0;
  for (let now = 0; now < 1000; ++now) {
    const moving = input({throttle: now / 1000});
    if (!sender.isDue(moving, now)) continue;
    assert.equal(sender.next(moving, now, now, null).sequence, frames);
    ++frames;
  }
  assert.equal(frames, 250);
});

test("a new connection learns the state at once", () => {
  const sender = new Sender();
  sender.next(input(), 0, null, null);
  assert.equal(sender.isDue(input(), 1), false);
  sender.begin();
  assert.ok(sender.isDue(input(), 1));
  assert.equal(sender.next(input(), 1, null, null).sequence, 1);
});
