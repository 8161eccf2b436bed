import assert from "node:assert/strict";
import {test} from "node:test";

import {Catalogue} from "../../../../../../tools/web/page/data/catalogue.js";
import {backOf, Newest} from "../../../../../../tools/web/page/drive/newest.js";
import {describedTypes, realLog} from "../real_log.js";

const CHANNELS = [["TRUTH", "truth_t"], ["HOST_COMMAND", "arbitration_t"], ["DRIVER_COMMAND", "driver_command_t"],
                  ["RADAR", "radar_t"], ["RUN", "run_t"]].map(([name, type], id) => ({id, name, type}));
const idOf = (name) => CHANNELS.find((channel) => channel.name === name)?.id;

/** The messages of a run, in the order in which they come. */
const log = realLog("/steps=20");
const messages = log.events.filter(({channel}) => idOf(channel) !== undefined)
  .map(({channel, bytes}) => ({channel: idOf(channel), name: channel, bytes}));

const fresh = () => new Newest(new Catalogue({types: describedTypes(), channels: CHANNELS}));

test("it keeps the newest message of each channel that the page needs", () => {
  const newest = fresh();
  const taken = messages.map((message, i) => newest.add(message, i)).filter(Boolean);
  assert.deepEqual(Object.keys(newest.frame).sort(), ["DRIVER_COMMAND", "HOST_COMMAND", "TRUTH"]);
  assert.equal(taken.length, 60);
  assert.equal(newest.step, 19);
  assert.equal(newest.frame.TRUTH.host_speed_mps, Number(log.table("TRUTH")[19].host_speed_mps));
});

test("an older message and one of another run change nothing", () => {
  const newest = fresh();
  const truths = messages.filter(({name}) => name === "TRUTH");
  newest.add(truths[5], 100);
  assert.equal(newest.add(truths[4], 200), null);
  assert.equal(newest.taken_ms, 100);
  const other = new Uint8Array(truths[6].bytes);
  other[15] ^= 1;  // the last byte of the run's number
  assert.equal(newest.add({...truths[6], bytes: other}, 300), null);
  assert.equal(newest.step, 5);
});

test("another run begins without the old messages", () => {
  const newest = fresh();
  newest.add(messages.find(({name}) => name === "TRUTH"), 0);
  newest.setRun({run_id: "5"});
  assert.equal(newest.step, -1);
  assert.deepEqual(newest.frame, {});
});

test("the page goes back only to a page of this machine", () => {
  const back = (url) => backOf(`#token=1&back=${encodeURIComponent(url)}`, "192.168.1.5");
  assert.equal(back("http://127.0.0.1:7700/questions"), "http://127.0.0.1:7700/questions");
  assert.equal(back("http://localhost:1/"), "http://localhost:1/");
  assert.equal(back("http://192.168.1.5:7700/a#b"), "http://192.168.1.5:7700/a#b");
  for (const bad of ["", "x", "http://evil.example/", "https://127.0.0.1/", "javascript:alert(1)",
                     "//127.0.0.1/", "http://127.0.0.1.evil.example/"]) assert.equal(back(bad), "", bad);
  assert.equal(backOf("", "127.0.0.1"), "");
});
