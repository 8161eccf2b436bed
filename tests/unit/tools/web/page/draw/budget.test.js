import assert from "node:assert/strict";
import {test} from "node:test";

import {Budget} from "../../../../../../tools/web/page/draw/budget.js";

/** Passes frames of this length to the budget for a time. @return the time after these frames */
function run(budget, frame_ms, time_ms, from = 0) {
  let now = from;
  for (; now < from + time_ms; now += frame_ms) budget.frame(now);
  return now;
}

test("a slow machine draws less, a fast one again more", () => {
  const budget = new Budget();
  const whole = budget.now;
  const now = run(budget, 60, 5000);
  assert.ok(budget.now.rest_ms > whole.rest_ms && budget.now.ratio < whole.ratio);
  run(budget, 16, 60000, now);
  assert.deepEqual(budget.now, whole);
});

test("a level that was too slow is tried again, but later and later", () => {
  const budget = new Budget();
  let now = run(budget, 60, 1100);
  const tries = [];
  for (let i = 0; i < 4; ++i) {
    const {level} = budget;
    const begin = now;
    while (budget.level >= level) now = run(budget, 16, 500, now);
    tries.push(now - begin);
    while (budget.level < level) now = run(budget, 60, 500, now);
  }
  tries.forEach((time_ms, i) => assert.ok(i === 0 || time_ms > 1.5 * tries[i - 1], `${tries}`));
});

test("a page draws less while something else is late, though its frames are fast", () => {
  let late = true;
  const budget = new Budget({isLate: () => late});
  const whole = budget.now;
  const now = run(budget, 16, 5000);
  assert.ok(budget.now.ratio < 0.5 * whole.ratio, `${budget.now.ratio}`);
  late = false;
  run(budget, 16, 120000, now);
  assert.deepEqual(budget.now, whole);
});

test("frames within the budget change nothing", () => {
  const budget = new Budget();
  const {level} = budget;
  run(budget, 25, 20000);
  assert.equal(budget.level, level);
});

test("a page that was hidden is not slow", () => {
  const budget = new Budget();
  for (let i = 0; i < 20; ++i) budget.frame(i * 2000);
  assert.equal(budget.level, 0);
});
