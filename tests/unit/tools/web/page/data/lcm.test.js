import assert from "node:assert/strict";
import {test} from "node:test";

import {DecodeError, fieldsOf, fingerprintOf, makeDecoder, numberAt, parsePath, valueAt}
  from "../../../../../../tools/web/page/data/lcm.js";
import {describedTypes, realLog} from "../real_log.js";

const types = describedTypes();
const log = realLog("/steps=300");
const CHANNELS = {
  RUN: "run_t", TRUTH: "truth_t", HOST_EGO: "ego_t", RADAR: "radar_t", LIDAR: "lidar_t",
  TRACK: "track_t", ACC_COMMAND: "accel_command_t", DRIVER_COMMAND: "driver_command_t",
  HOST_COMMAND: "arbitration_t", FOLLOWER_COMMAND: "follower_command_t"};
const messagesOf = (channel) => log.events.filter((event) => event.channel === channel);

/** The path of a column of a CSV file: the column "state.0" has the path "state[0]". */
function pathOf(column, type) {
  const [, name, index] = column.match(/^(.*?)(?:\.(\d+))?$/);
  if (index === undefined) return column;
  const {dims} = types[type].members.find((member) => member.name === name);
  if (dims.length < 2) return `${name}[${index}]`;
  return `${name}[${Math.floor(index / dims[1])}][${index % dims[1]}]`;
}

test("every number of a real log is decoded to the last bit", () => {
  let numbers = 0;
  for (const [channel, type] of Object.entries(CHANNELS)) {
    if (channel === "RUN") continue;  // an export does not contain it
    const decode = makeDecoder(types, type);
    const rows = log.table(channel);
    const messages = messagesOf(channel).map(({bytes}) => decode(bytes));
    assert.equal(messages.length, 300);
    assert.equal(rows.length, 300);
    rows.forEach((row, i) => {
      for (const [column, text] of Object.entries(row)) {
        const value = valueAt(messages[i], parsePath(pathOf(column, type)));
        assert.equal(String(Number(value)), String(Number(text)), `${channel} ${i} ${column}`);
        ++numbers;
      }
    });
  }
  assert.ok(numbers > 20000, String(numbers));
});

test("a run's identity keeps all of its 64 bits", () => {
  const decode = makeDecoder(types, "truth_t");
  const {header: {run_id}} = decode(messagesOf("TRUTH")[0].bytes);
  assert.equal(String(run_id), log.table("TRUTH")[0]["header.run_id"]);
});

test("texts of a real log are decoded", () => {
  const decode = makeDecoder(types, "run_t");
  const parts = messagesOf("RUN").map(({bytes}) => decode(bytes));
  parts.sort((a, b) => a.header.step - b.header.step);
  assert.equal(parts.length, parts[0].num_parts);
  assert.equal(JSON.parse(parts.map(({text}) => text).join("")).steps, 300);
});

test("no cut message is decoded", () => {
  for (const [channel, type] of Object.entries(CHANNELS)) {
    const decode = makeDecoder(types, type);
    const {bytes} = messagesOf(channel)[0];
    for (let length = 0; length < bytes.length; ++length) {
      assert.throws(() => decode(bytes.subarray(0, length)), DecodeError, `${channel} ${length}`);
    }
    decode(new Uint8Array([...bytes, 1, 2, 3]));  // a signature behind the members
  }
});

test("impossible lengths are refused before any memory is taken", () => {
  const decode = makeDecoder({t: {members: [
    {name: "n", type: "int32_t", dims: []}, {name: "values", type: "double", dims: ["n"]}]}}, "t");
  const bytes = new Uint8Array(8 + 4 + 16);
  const view = new DataView(bytes.buffer);
  for (const n of [-1, 3, 0x7fffffff]) {
    view.setInt32(8, n);
    assert.throws(() => decode(bytes), DecodeError, String(n));
  }
  view.setInt32(8, 2);
  assert.deepEqual(decode(bytes).values, [0, 0]);
});

test("altered messages throw nothing but a DecodeError", () => {
  let state = 1;
  const random = () => (state = (state * 48271) % 0x7fffffff);
  for (const [channel, type] of Object.entries(CHANNELS)) {
    const decode = makeDecoder(types, type);
    for (let round = 0; round < 300; ++round) {
      const bytes = messagesOf(channel)[0].bytes.slice();
      for (let i = 0; i < 3; ++i) bytes[random() % bytes.length] = random() % 256;
      try {
        decode(bytes);
      } catch (problem) {
        assert.ok(problem instanceof DecodeError, String(problem));
      }
    }
  }
});

test("a type that contains itself, or has no description, is refused", () => {
  const circle = {t: {members: [{name: "t", type: "t", dims: []}]}};
  assert.throws(() => makeDecoder(circle, "t"), DecodeError);
  assert.throws(() => makeDecoder(circle, "toString"), DecodeError);
});

test("all messages of a type have the same fingerprint, and other types have others", () => {
  const found = new Set(Object.keys(CHANNELS).map((channel) => {
    const [first, ...others] = messagesOf(channel).map(({bytes}) => fingerprintOf(bytes));
    for (const other of others) assert.equal(other, first);
    assert.match(first, /^0x[0-9a-f]{16}$/);
    return first;
  }));
  assert.equal(found.size, Object.keys(CHANNELS).length);
});

test("each listed field is a number in a real message", () => {
  for (const [channel, type] of Object.entries(CHANNELS)) {
    const message = makeDecoder(types, type)(messagesOf(channel)[0].bytes);
    for (const {path} of fieldsOf(types, type)) {
      if (path.startsWith("holder")) continue;  // this list is empty here
      assert.equal(typeof numberAt(message, parsePath(path)), "number");
      assert.ok(!Number.isNaN(numberAt(message, parsePath(path))), `${channel}.${path}`);
    }
  }
  assert.equal(fieldsOf(types, "track_t").filter(({path}) => path.startsWith("covariance")).length, 9);
  assert.ok(Number.isNaN(numberAt({}, parsePath("state[0]"))));
});
