import assert from "node:assert/strict";
import {test} from "node:test";

import {DASHES, placesOf} from "../../../../../../tools/web/page/draw/curve_styles.js";

const places = (...channels) => placesOf(channels.map((channel) => ({channel})));

test("radar and LiDAR keep their colours, whatever else is chosen", () => {
  assert.deepEqual(places("TRUTH", "RADAR", "LIDAR", "TRUTH"), [6, 2, 3, 5]);
  assert.deepEqual(places("LIDAR", "RADAR"), [3, 2]);
  assert.deepEqual(places("TRUTH", "TRUTH", "TRACK", "LIDAR"), [6, 5, 7, 3]);
});

test("no two curves look alike", () => {
  for (const channels of [Array(8).fill("TRUTH"), Array(8).fill("RADAR"),
                          ["LIDAR", "LIDAR", "RADAR", "RADAR", "TRUTH", "TRUTH", "TRACK", "TRACK"]]) {
    assert.deepEqual(places(...channels).sort(), DASHES.map((_, i) => i));
  }
});
