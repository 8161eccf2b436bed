import assert from "node:assert/strict";
import {test} from "node:test";

import {modeOf, requestAt, spansOf, upTo} from "../../../../../../tools/web/page/data/modes.js";
import {describedTypes} from "../real_log.js";

test("each mode of HOST_COMMAND has its name here", () => {
  const {constants} = describedTypes().arbitration_t;
  for (const [name, value] of Object.entries(constants)) assert.equal(modeOf(value).name, name);
  assert.equal(modeOf(Object.keys(constants).length).side, "unknown");
});

test("a collision warning leaves the side that drives", () => {
  assert.equal(modeOf(11, 0).side, "automation");
  assert.equal(modeOf(11, 1).side, "human");
});

test("spans join equal values and end where the next begins", () => {
  assert.deepEqual(spansOf([0, 1, 2, 3], [5, 5, NaN, 7], 4),
                   [{from: 0, to: 3, value: 5}, {from: 3, to: 4, value: 7}]);
  assert.deepEqual(spansOf([], [], 4), []);
});

test("a request counts down from its first step, through all modes that ask", () => {
  const times = [0, 1, 2, 3, 4, 5];
  const modes = [0, 3, 3, 4, 5, 6];
  assert.equal(requestAt(times, modes, 0, 10), null);
  assert.deepEqual(requestAt(times, modes, 1, 10), {since_s: 1, left_s: 10, share: 1});
  assert.equal(requestAt(times, modes, 4.5, 10).left_s, 6.5);
  assert.equal(requestAt(times, modes, 4, 2).left_s, 0);
  assert.equal(requestAt(times, modes, 5, 10), null);
  assert.equal(requestAt([], [], 5, 10), null);
});

test("the last value up to x is found", () => {
  assert.deepEqual([-1, 0, 0.5, 3, 9].map((x) => upTo([0, 1, 2, 3], x)), [-1, 0, 0, 3, 3]);
});
