import assert from "node:assert/strict";
import {test} from "node:test";

import {readFrame, socketUrl} from "../../../../../../tools/web/page/data/wire.js";

/** A frame of numbers: [["u8", 1], ["f64", 2.5], ["bytes", [1, 2]], ...]. */
function frame(...parts) {
  const sizes = {u8: 1, u16: 2, u32: 4, i64: 8, f64: 8};
  const view = new DataView(new ArrayBuffer(
    parts.reduce((sum, [kind, value]) => sum + (sizes[kind] ?? value.length), 0)));
  let at = 0;
  const put = {
    u8: (value) => view.setUint8(at, value), u16: (value) => view.setUint16(at, value, true),
    u32: (value) => view.setUint32(at, value, true), f64: (value) => view.setFloat64(at, value, true),
    i64: (value) => view.setBigInt64(at, BigInt(value), true),
    bytes: (value) => new Uint8Array(view.buffer).set(value, at)};
  for (const [kind, value] of parts) {
    put[kind](value);
    at += sizes[kind] ?? value.length;
  }
  return view.buffer;
}

test("a frame has all messages that have come since the last one", () => {
  const {kind, messages} = readFrame(frame(
    ["u8", 1], ["u16", 3], ["f64", 1e12], ["u32", 2], ["bytes", [7, 8]],
    ["u16", 300], ["f64", 1e12 + 1], ["u32", 0]));
  assert.equal(kind, "messages");
  assert.deepEqual(messages.map(({channel, arrived_ms, bytes}) => [channel, arrived_ms, [...bytes]]),
                   [[3, 1e12, [7, 8]], [300, 1e12 + 1, []]]);
});

test("an answer has the messages of its steps", () => {
  const {id, messages} = readFrame(frame(
    ["u8", 2], ["u32", 9], ["u16", 1], ["i64", 190], ["u32", 1], ["bytes", [5]]));
  assert.deepEqual([id, messages[0].channel, messages[0].step, [...messages[0].bytes]], [9, 1, 190, [5]]);
  assert.deepEqual(readFrame(frame(["u8", 2], ["u32", 9])).messages, []);
});

test("a series has its times, then its values", () => {
  const {id, whole, times, values} = readFrame(frame(
    ["u8", 3], ["u32", 4], ["u8", 1], ["u32", 2], ["f64", 0], ["f64", 0.1], ["f64", NaN], ["f64", 7]));
  assert.deepEqual([id, whole, [...times], [...values]], [4, true, [0, 0.1], [NaN, 7]]);
  assert.equal(readFrame(frame(["u8", 3], ["u32", 4], ["u8", 0], ["u32", 0])).whole, false);
});

test("a frame whose lengths do not fit is no frame", () => {
  for (const bad of [frame(["u8", 1], ["u16", 3]), frame(["u8", 3], ["u32", 4], ["u8", 1], ["u32", 2]),
                     frame(["u8", 2], ["u32", 9], ["u16", 1], ["i64", 1], ["u32", 99]), frame()]) {
    assert.throws(() => readFrame(bad), RangeError);
  }
  assert.equal(readFrame(frame(["u8", 9])).kind, "unknown");
});

test("the socket is at the page's own host, with the key", () => {
  const location = {protocol: "http:", host: "127.0.0.1:8080"};
  assert.equal(socketUrl(location, ""), "ws://127.0.0.1:8080/ws");
  assert.equal(socketUrl({...location, protocol: "https:"}, "a&b"), "wss://127.0.0.1:8080/ws?token=a%26b");
});
