import assert from "node:assert/strict";
import {test} from "node:test";

import {drivingSince, manoeuvreAt, modeOf, requestAt, requestSpans, sideSpans, spansOf, upTo}
  from "../../../../../../tools/web/page/data/modes.js";
import {Series} from "../../../../../../tools/web/page/data/series.js";
import {describedTypes} from "../real_log.js";

test("each mode of HOST_COMMAND has its name here", () => {
  const {constants} = describedTypes().arbitration_t;
  for (const [name, value] of Object.entries(constants)) assert.equal(modeOf(value).name, name);
  assert.equal(modeOf(Object.keys(constants).length).side, "unknown");
});

test("a collision warning leaves the side that drives", () => {
  assert.equal(modeOf(11, 0).side, "automation");
  assert.equal(modeOf(11, 1).side, "human");
  assert.equal(modeOf(11, 0.5).side, "human", "half of the authority is enough");
  assert.equal(modeOf(11, 0.49).side, "automation");
});

test("spans join equal values and end where the next begins", () => {
  assert.deepEqual(spansOf([0, 1, 2, 3], [5, 5, NaN, 7], 4),
                   [{from: 0, to: 3, value: 5}, {from: 3, to: 4, value: 7}]);
  assert.deepEqual(spansOf([], [], 4), []);
  assert.deepEqual(spansOf([0, 1, 3], [5, 6, 7], 2),
                   [{from: 0, to: 1, value: 5}, {from: 1, to: 2, value: 6}], "nothing later than the end");
});

function seriesOf(points) {
  const series = new Series();
  for (const [time, value] of points) series.push(time, value);
  return series;
}

test("the sides are the same from all values and from the changes alone", () => {
  const mode = [0, 0, 1, 11, 11, 11, 0];
  const lambda = [0, 0, 1, 1, 0, 0, 0];
  const changed = (values) => values.map((value, i) => [i, value])
    .filter(([i, value]) => i === 0 || value !== values[i - 1]);
  const expected = [{from: 0, to: 2, value: "automation"}, {from: 2, to: 4, value: "human"},
                    {from: 4, to: 7, value: "automation"}];
  for (const pick of [(values) => values.map((value, i) => [i, value]), changed]) {
    const [modes, lambdas] = [mode, lambda].map((values) => seriesOf(pick(values)));
    assert.deepEqual(sideSpans(modes, lambdas, -Infinity, Infinity, 7), expected);
    assert.deepEqual([0, 1, 2, 3, 4, 6].map((time) => drivingSince(modes, lambdas, time)),
                     [null, null, 2, 2, 4, 4]);
  }
  assert.equal(drivingSince(seriesOf([]), seriesOf([]), 3), null);
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
  assert.equal(requestAt([0, 1, 2, 3], [0, 3, 12, 3], 3.5, 10).left_s, 7.5, "emergency braking between");
  assert.equal(requestAt([0, 1, 2], [0, 3, 12], 2.5, 10).since_s, 1);
  assert.equal(requestAt([0, 1], [0, 12], 2, 10), null);
  assert.equal(requestAt([0, 1, 2], [0, 3, 11], 2.5, 10), null, "a collision warning says that it has ended");
});

test("a request lasts through all modes that ask", () => {
  const modes = seriesOf([[0, 0], [1, 3], [2, 4], [3, 5], [4, 6], [6, 3]]);
  assert.deepEqual(requestSpans(modes, -Infinity, Infinity, 8),
                   [{from: 1, to: 4, value: 1}, {from: 6, to: 8, value: 1}]);
  const braking = seriesOf([[0, 0], [1, 3], [2, 12], [3, 4], [4, 12], [5, 0]]);
  assert.deepEqual(requestSpans(braking, -Infinity, Infinity, 8), [{from: 1, to: 5, value: 1}]);
  const long = seriesOf([[0, 0], [10, 3], [12, 12], [13, 12], [15, 3], [18, 1]]);
  assert.deepEqual(requestSpans(long, 13, 20, 20), [{from: 13, to: 18, value: 1}], "of a part of the run");
  const warning = seriesOf([[0, 3], [2, 11], [3, 1]]);
  assert.deepEqual(requestSpans(warning, -Infinity, Infinity, 8), [{from: 0, to: 2, value: 1}]);
});

test("a manoeuvre is known by its first mode and the mode before it", () => {
  const names = (times, modes, time) => {
    const found = manoeuvreAt(times, modes, time);
    return found && [found.first.name, found.before?.name ?? null];
  };
  const times = [0, 1, 2, 3, 4];
  assert.deepEqual(names(times, [0, 4, 7, 8, 9], 4.5), ["MRM_COMFORT", "REQUEST_URGENT"]);
  assert.deepEqual(names(times, [0, 4, 7, 8, 9], 2), ["MRM_COMFORT", "REQUEST_URGENT"]);
  assert.deepEqual(names(times, [0, 1, 8, 6, 1], 2.5), ["MRM_EMERGENCY", "HUMAN"]);
  assert.equal(names(times, [0, 1, 8, 6, 1], 3), null);
  assert.deepEqual(names([5, 6], [7, 9], 6), ["MRM_COMFORT", null]);
  assert.deepEqual(names(times, [0, 3, 12, 8, 9], 4), ["MRM_EMERGENCY", "REQUEST"]);
  assert.deepEqual(names(times, [0, 1, 11, 12, 7], 4), ["MRM_COMFORT", "HUMAN"]);
  assert.deepEqual(names([1, 2], [12, 7], 2), ["MRM_COMFORT", null]);
  assert.deepEqual(names([1, 2, 3], [3, 11, 7], 3), ["MRM_COMFORT", null], "the request had ended");
  assert.equal(names([], [], 6), null);
});

test("the last value up to x is found", () => {
  assert.deepEqual([-1, 0, 0.5, 3, 9].map((x) => upTo([0, 1, 2, 3], x)), [-1, 0, 0, 3, 3]);
});
