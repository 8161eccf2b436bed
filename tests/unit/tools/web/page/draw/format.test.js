import assert from "node:assert/strict";
import {test} from "node:test";

import {clockTime, digits, seconds, timeTick} from "../../../../../../tools/web/page/draw/format.js";

const plain = (text) => text.replaceAll("\u00a0", " ").replaceAll("−", "-");

test("labels of a time axis are in seconds, then in whole minutes and hours", () => {
  assert.equal(plain(timeTick(12.5, 0.5, 1)), "12.5 s");
  assert.equal(plain(timeTick(6030, 30, 0)), "6030 s");
  assert.equal(plain(timeTick(6000, 60, 0)), "100 min");
  assert.equal(plain(timeTick(99000, 1800, 0)), "1650 min");
  assert.equal(plain(timeTick(18000, 3600, 0)), "5 h");
});

test("a number has about four digits, and a missing one is a dash", () => {
  assert.deepEqual([12, 1.23456, 0.0123456, -3.5, 1e6 + 0.5].map((value) => plain(digits(value))),
                   ["12", "1.235", "0.01235", "-3.500", "1.000e+6"]);
  assert.deepEqual([null, NaN, Infinity].map(digits), ["–", "–", "–"]);
});

test("a time has the decimals of the step", () => {
  assert.equal(plain(seconds(1.25, 0.1)), "1.3 s");
  assert.equal(plain(seconds(1.25, 0.01)), "1.25 s");
});

test("a time in minutes has whole seconds, and hours only if there are some", () => {
  assert.equal(plain(clockTime(0)), "0:00 min");
  assert.equal(plain(clockTime(65.99)), "1:05 min");
  assert.equal(plain(clockTime(3599.9)), "59:59 min");
  assert.equal(plain(clockTime(3600)), "1:00:00 h");
  assert.equal(plain(clockTime(5465)), "1:31:05 h");
});
