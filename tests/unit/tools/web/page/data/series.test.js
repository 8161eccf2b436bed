import assert from "node:assert/strict";
import {test} from "node:test";

import {Series, whereValid} from "../../../../../../tools/web/page/data/series.js";

function counted(n) {
  const series = new Series();
  for (let i = 0; i < n; ++i) series.push(i, 10 * i);
  return series;
}

test("a series keeps every value while it grows", () => {
  const series = counted(10000);
  assert.equal(series.length, 10000);
  assert.deepEqual([series.times[9999], series.values[9999]], [9999, 99990]);
});

test("a series that forgets needs no more room", () => {
  const series = new Series();
  for (let i = 0; i < 100000; ++i) {
    series.push(i, i);
    series.forgetBefore(i - 100);
  }
  assert.equal(series.length, 101);
  assert.equal(series.times[0], 99899);
  assert.ok(series.allTimes.length <= 512, String(series.allTimes.length));
});

test("no two states of any series have the same version", () => {
  const [first, second] = [new Series(), new Series()];
  const seen = new Set([first.version, second.version]);
  first.push(1, 2);
  seen.add(first.version);
  second.replace({times: Float64Array.of(1), values: Float64Array.of(2)});
  seen.add(second.version);
  assert.equal(seen.size, 4);
});

test("a part of a series has one value before and one after", () => {
  const {times, values} = counted(100).within(10.5, 20.5);
  assert.deepEqual([times[0], times.at(-1), values[0]], [10, 21, 100]);
  assert.equal(counted(0).within(0, 1).times.length, 0);
});

test("a column has a gap where a sensor has no value", () => {
  const valid = new Series();
  for (const [time, value] of [[0, 1], [2, 0], [4, 1]]) valid.push(time, value);
  const {times, values} = whereValid(counted(6), valid);
  assert.deepEqual([...times], [0, 1, 2, 3, 4, 5]);
  assert.deepEqual([...values], [0, 10, NaN, NaN, 40, 50]);
});

test("the value at a time is the last one up to it", () => {
  assert.deepEqual([counted(5).at(2.9), counted(5).at(9)], [20, 40]);
  assert.ok(Number.isNaN(counted(5).at(-1)));
});
