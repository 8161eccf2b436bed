import assert from "node:assert/strict";
import {test} from "node:test";

import {carsOf, extinction, sightings, stands, timeGap} from "../../../../../../tools/web/page/data/cars.js";

const truth = {
  preceding_position_m: 137.5, preceding_speed_mps: 20, preceding_acceleration_mps2: -2,
  host_position_m: 100, host_speed_mps: 22, host_acceleration_mps2: -0.6, host_gap_m: 33,
  num_followers: 1, follower_position_m: [62.5], follower_speed_mps: [21],
  follower_acceleration_mps2: [0], follower_gap_m: [33]};

test("5 % of a contrast is left at the visibility", () => {
  for (const visibility_m of [20, 60, 20000]) {
    assert.ok(Math.abs(Math.exp(-extinction(visibility_m) * visibility_m) - 0.05) < 1e-12);
  }
  assert.equal(extinction(0), 0);
});

test("cars stand where they are, relative to the host", () => {
  assert.deepEqual(carsOf(truth).map(({kind, front_m}) => [kind, front_m]),
                   [["preceding", 37.5], ["host", 0], ["follower", -37.5]]);
});

test("cars move on at their speeds between two steps", () => {
  assert.deepEqual(carsOf(truth, 0.5).map(({front_m}) => front_m), [36.5, 0, -38]);
});

test("brake lamps shine when a car brakes, and not when it only rolls", () => {
  assert.deepEqual(carsOf(truth).map(({brakes}) => brakes), [true, false, false]);
});

test("a sensor without an echo sees nothing", () => {
  assert.deepEqual(sightings({RADAR: {valid: true, range_m: 33}, LIDAR: {valid: false, range_m: 0}}),
                   {radar: 33, lidar: null, fusion: null});
});

test("there is no time gap at a standstill", () => {
  assert.equal(timeGap(truth), 1.5);
  assert.equal(timeGap({...truth, host_speed_mps: 0}), null);
  assert.deepEqual([0, 0.1, 0.2].map((host_speed_mps) => stands({host_speed_mps})), [true, true, false]);
  assert.equal(stands(undefined), false);
});
