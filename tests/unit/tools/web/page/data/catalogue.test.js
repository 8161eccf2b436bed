import assert from "node:assert/strict";
import {test} from "node:test";

import {Catalogue, headerOf, searchFields} from "../../../../../../tools/web/page/data/catalogue.js";
import {fingerprintOf} from "../../../../../../tools/web/page/data/lcm.js";
import {LiveStore} from "../../../../../../tools/web/page/data/live_store.js";
import {describedTypes, realLog} from "../real_log.js";

const log = realLog("/steps=300");
const CHANNELS = [
  {id: 0, name: "TRUTH", type: "truth_t"}, {id: 1, name: "HOST_COMMAND", type: "arbitration_t"},
  {id: 2, name: "CAMERA", type: null}, {id: 3, name: "STATUS", type: "status_t"},
  {id: 4, name: "RUN", type: "run_t"}];
const ROLES = ["world", "fusion"];
const bytesOf = (channel) => log.events.filter((event) => event.channel === channel).map(({bytes}) => bytes);
const truth = bytesOf("TRUTH");

function catalogue() {
  return new Catalogue({types: describedTypes(), channels: CHANNELS, roles: ROLES,
                        fingerprints: {truth_t: fingerprintOf(truth[0])}});
}

test("a message of another type on a channel is counted and not decoded", () => {
  const known = catalogue();
  assert.equal(known.decode(known.named("TRUTH"), bytesOf("HOST_COMMAND")[0]), null);
  assert.equal(known.decode(known.named("TRUTH"), truth[0].subarray(0, 40)), null);
  assert.equal(known.undecodable, 2);
  assert.equal(known.decode(known.named("CAMERA"), truth[0]), null);
  assert.equal(known.undecodable, 2);
});

test("the header is read without the message", () => {
  const {run_id, step, time_s} = headerOf(truth[190]);
  assert.deepEqual([String(run_id), step, time_s], [log.table("TRUTH")[190]["header.run_id"], 190, 19]);
  assert.equal(headerOf(truth[0].subarray(0, 31)), null);
});

test("fields are found by parts of their names, comments and units", () => {
  const fields = catalogue().fields();
  const names = (typed) => searchFields(fields, typed, 100).map(({name}) => name);
  assert.equal(names("doc")[0], "HOST_COMMAND.doc");
  assert.equal(names("gap HOST")[0], "TRUTH.host_gap_m");
  assert.deepEqual(names("no such field"), []);
  assert.equal(searchFields(fields, "", 5).length, 5);
  assert.ok(!names("").slice(0, 10).some((name) => name.includes(".header.")));
});

function filledStore() {
  const store = new LiveStore(catalogue());
  store.setRun({run_id: log.table("TRUTH")[0]["header.run_id"], step_s: 0.1});
  truth.forEach((bytes, i) => store.add({channel: 0, arrived_ms: i, bytes}));
  return store;
}

test("a live store gives each step's newest messages, and the values of a field", () => {
  const store = filledStore();
  assert.deepEqual([store.firstStep, store.lastStep, store.arrived_ms], [0, 299, 299]);
  assert.equal(store.frame(190).TRUTH.header.step, 190);
  const {times, values} = store.series("TRUTH", "host_gap_m");
  assert.equal(times.length, 300);
  assert.equal(String(values[270]), log.table("TRUTH")[270].host_gap_m);
});

test("a live store tells a repair from a log that is played again", () => {
  const store = filledStore();
  const [run] = bytesOf("RUN");
  for (let ms = 300; ms < 4000; ms += 200) store.add({channel: 4, arrived_ms: ms, bytes: run});
  truth.slice(0, 100).forEach((bytes) => store.add({channel: 0, arrived_ms: 4000, bytes}));
  assert.equal(store.lastStep, 299, "the other processes were alive: a repair");
  assert.equal(store.series("TRUTH", "host_gap_m").times.length, 300);
  truth.slice(0, 100).forEach((bytes, i) => store.add({channel: 0, arrived_ms: 7000 + i, bytes}));
  assert.equal(store.lastStep, 99, "after a silence of the whole run: played again");
});

test("a live store keeps no more than its messages of a frame", () => {
  const frame = new Uint8Array(1e6);
  const store = new LiveStore(catalogue());
  frame.set(truth[0], 500);
  store.add({channel: 0, arrived_ms: 0, bytes: frame.subarray(500, 500 + truth[0].length)});
  const [kept] = store.tracks.get("TRUTH").messages;
  assert.equal(kept.buffer.byteLength, truth[0].length);
  assert.deepEqual(kept, truth[0]);
});

test("messages that belong to no step have curves, too, and STATUS one for each role", () => {
  const fields = catalogue().fields();
  const found = (name) => fields.find((field) => field.name === name);
  assert.deepEqual([found("STATUS/fusion.cpu_ms").channel, found("STATUS/fusion.cpu_ms").isStepwise],
                   ["STATUS/fusion", false]);
  assert.equal(found("STATUS.cpu_ms"), undefined);
  assert.equal(found("TRUTH.host_gap_m").isStepwise, true);
  const store = new LiveStore(catalogue());
  const before = store.series("RUN", "header.step");
  const runs = bytesOf("RUN");
  for (const bytes of [...runs, ...runs]) store.add({channel: 4, arrived_ms: 0, bytes});
  const after = store.series("RUN", "header.run_id");
  assert.deepEqual([before.length, after.length], [2 * runs.length, 2 * runs.length]);
  assert.equal(store.lastStep, -1);
  assert.equal(store.frame(0), null);
});

test("messages whose time stands still do not fill the memory, and cost no step", () => {
  const store = filledStore();
  const [bytes] = bytesOf("RUN");
  const series = store.series("RUN", "header.step");
  for (let i = 0; i < 6 * 2 ** 20 / bytes.length; ++i) store.add({channel: 4, arrived_ms: 0, bytes});
  const {bytes: kept, messages} = store.tracks.get("RUN");
  assert.ok(kept <= 4 * 2 ** 20 && kept > 2 ** 20, String(kept));
  assert.ok(series.length >= messages.length && series.length < 4 * 2 ** 20 / bytes.length + 1, String(series.length));
  assert.deepEqual([store.firstStep, store.lastStep], [0, 299]);
});

test("a live store takes no message twice, of another run, or of an unknown type", () => {
  const store = filledStore();
  const series = store.series("TRUTH", "host_gap_m");
  store.add({channel: 0, arrived_ms: 0, bytes: truth[5]});
  store.add({channel: 0, arrived_ms: 0, bytes: truth[299]});
  store.add({channel: 2, arrived_ms: 0, bytes: truth[299]});
  store.add({channel: 7, arrived_ms: 0, bytes: truth[299]});
  store.add({channel: 0, arrived_ms: 0, bytes: new Uint8Array(4)});
  const other = truth[299].slice();
  other[8] ^= 1;
  store.add({channel: 0, arrived_ms: 0, bytes: other});
  assert.equal(series.length, 300);
});

test("messages that come before the server names the run belong to it", () => {
  const store = new LiveStore(catalogue());
  truth.forEach((bytes, i) => store.add({channel: 0, arrived_ms: i, bytes}));
  assert.equal(store.lastStep, 299);
  store.setRun({run_id: log.table("TRUTH")[0]["header.run_id"], step_s: 0.1});
  assert.equal(store.lastStep, 299);
});

test("a log that is played once more begins with an empty store, and a repair changes nothing", () => {
  const store = filledStore();
  store.add({channel: 0, arrived_ms: 1000, bytes: truth[0]});
  assert.deepEqual([store.firstStep, store.lastStep], [0, 299]);
  store.add({channel: 0, arrived_ms: 10000, bytes: truth[0]});
  assert.deepEqual([store.firstStep, store.lastStep], [0, 0]);
});

test("another run begins with an empty store", () => {
  const store = filledStore();
  store.setRun({run_id: "5", step_s: 0.1});
  assert.equal(store.frame(0), null);
  assert.equal(store.series("TRUTH", "host_gap_m").length, 0);
});
