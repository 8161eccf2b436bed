import assert from "node:assert/strict";
import {test} from "node:test";

import {Catalogue} from "../../../../../../tools/web/page/data/catalogue.js";
import {LogStore} from "../../../../../../tools/web/page/data/log_store.js";
import {describedTypes, realLog} from "../real_log.js";

const log = realLog("/steps=700");
const truth = log.events.filter(({channel}) => channel === "TRUTH").map(({bytes}) => bytes);

/** A server that answers when the test calls answer(). */
class Wire {
  constructor() { this.asked = []; }

  ask(question) {
    return new Promise((resolve) => { this.asked.push({question, resolve}); });
  }

  async answer() {
    const {question: {op, from, to, points}, resolve} = this.asked.shift();
    if (op === "steps") {
      resolve({messages: truth.slice(from, to + 1).map((bytes, i) => ({channel: 0, step: from + i, bytes}))});
    } else {
      resolve({whole: to - from < 2 * points, times: Float64Array.of(from, to), values: Float64Array.of(1, 2)});
    }
    for (let i = 0; i < 5; ++i) await Promise.resolve();
  }
}

function opened(lastStep = 699) {
  const wire = new Wire();
  const catalogue = new Catalogue({types: describedTypes(),
                                   channels: [{id: 0, name: "TRUTH", type: "truth_t"}]});
  const store = new LogStore(catalogue, wire);
  store.setRun({run_id: "1", step_s: 0.1});
  store.setLog({first_step: 0, last_step: lastStep});
  return {wire, store};
}

test("a step is there once its part of the log has come", async () => {
  const {wire, store} = opened();
  assert.equal(store.frame(190), null);
  const {question} = wire.asked[0];
  assert.ok(question.from <= 190 && question.to >= 190 && question.to - question.from < 512);
  await wire.answer();
  assert.equal(store.frame(190).TRUTH.header.step, 190);
  assert.equal(store.frame(700), null);
});

test("of the steps that a fast reader passes only the newest is fetched", async () => {
  const {wire, store} = opened();
  for (const step of [0, 200, 300, 400, 650]) store.frame(step);
  assert.equal(wire.asked.length, 1);
  await wire.answer();
  assert.equal(wire.asked.length, 1);
  assert.ok(wire.asked[0].question.to >= 650);
});

test("a store keeps a limited number of steps", async () => {
  const {wire, store} = opened(1e6);
  for (let step = 0; step < 20000; step += 64) {
    store.frame(step);
    await wire.answer();
  }
  assert.ok(store.chunks.size <= 64, String(store.chunks.size));
});

test("a window that moves over a long log needs another part only now and then", async () => {
  const {wire, store} = opened(1e6);
  store.detail("TRUTH", "host_gap_m", 0, 60);
  assert.deepEqual([wire.asked[0].question.from, wire.asked[0].question.to], [0, 1199], "not the whole log");
  await wire.answer();
  for (let from = 0; from < 600; from += 1) store.detail("TRUTH", "host_gap_m", from, from + 60);
  assert.ok(wire.asked.length <= 25, String(wire.asked.length));
});

test("a window of as many values as a part may have gets every value", async () => {
  const wire = new Wire();
  const catalogue = new Catalogue({types: describedTypes(), channels: [{id: 0, name: "TRUTH", type: "truth_t"}]});
  const store = new LogStore(catalogue, wire);
  store.setRun({run_id: "1", step_s: 0.001});
  store.setLog({first_step: 0, last_step: 1e6});
  store.detail("TRUTH", "host_gap_m", 0, 20, 20000);
  await wire.answer();
  assert.ok(store.detail("TRUTH", "host_gap_m", 0, 20, 20000).whole);
});

test("the changes of a field are asked for once, and are exact at any time", async () => {
  const {wire, store} = opened(1e6);
  const modes = store.changes("HOST_COMMAND", "mode");
  assert.equal(store.changes("HOST_COMMAND", "mode"), modes);
  assert.equal(wire.asked.length, 1);
  assert.deepEqual(wire.asked[0].question, {op: "series", channel: "HOST_COMMAND", field: "mode", from: 0,
                                            to: 1e6, points: 20000, changes: true});
  wire.asked.shift().resolve({times: Float64Array.of(0, 77.7), values: Float64Array.of(0, 1)});
  for (let i = 0; i < 5; ++i) await Promise.resolve();
  assert.deepEqual([modes.at(77.6), modes.at(77.7), modes.at(9e4)], [0, 1, 1]);
});

test("a part that is still used is not forgotten for newer ones", async () => {
  const {wire, store} = opened(1e6);
  store.detail("TRUTH", "host_gap_m", 0, 60);
  await wire.answer();
  for (let from = 0; from < 6000; from += 60) {
    store.detail("TRUTH", "host_gap_m", 0, 60);
    store.detail("TRUTH", "host_speed_mps", from, from + 60);
  }
  assert.ok(wire.asked.length > 48);
  assert.ok(!wire.asked.some(({question: {field}}) => field === "host_gap_m"), "it was asked for once");
});

test("a short log needs no finer values", async () => {
  const {wire, store} = opened();
  store.detail("TRUTH", "host_gap_m", 0, 60);
  await wire.answer();
  store.detail("TRUTH", "host_gap_m", 10, 20);
  assert.equal(wire.asked.length, 0);
});
