import assert from "node:assert/strict";
import {test} from "node:test";

import {FIRST_S, Ramps, ratesOf} from "../../../../../../tools/web/page/drive/ramps.js";

const RATES = {press_ps: 1, release_ps: 3};

/** Advances the ramps every 20 ms, as the page does. */
function advance(ramps, from_ms, to_ms) {
  for (let now = from_ms; now <= to_ms; now += 20) ramps.advance(now);
  return ramps.advance(to_ms);
}

test("a pedal follows its key by its ramp, and comes back when the key is released", () => {
  const ramps = new Ramps(RATES);
  ramps.hold("throttle", true, 1000);
  assert.ok(Math.abs(advance(ramps, 1000, 1500).throttle - (0.5 + FIRST_S) * RATES.press_ps) < 1e-9);
  assert.equal(advance(ramps, 1500, 9000).throttle, 1);
  ramps.hold("throttle", false, 9000);
  assert.ok(Math.abs(advance(ramps, 9000, 9100).throttle - (1 - (0.1 + FIRST_S) * RATES.release_ps)) < 1e-9);
  assert.deepEqual(advance(ramps, 9100, 10000), {throttle: 0, brake: 0});
});

test("a key moves its pedal at once, so that the event of the key can be sent", () => {
  const ramps = new Ramps(RATES);
  ramps.hold("brake", true, 1000);
  assert.ok(Math.abs(ramps.advance(1000).brake - FIRST_S * RATES.press_ps) < 1e-12);
  advance(ramps, 1000, 3000);
  ramps.hold("brake", false, 3000);
  assert.ok(Math.abs(ramps.advance(3000).brake - (1 - FIRST_S * RATES.release_ps)) < 1e-12);
});

test("the ramp does not depend on how often it is looked at", () => {
  const often = new Ramps(RATES);
  const seldom = new Ramps(RATES);
  for (const ramps of [often, seldom]) ramps.hold("brake", true, 0);
  for (let now = 0; now < 200; now += 4) often.advance(now);
  for (let now = 0; now < 200; now += 50) seldom.advance(now);
  assert.ok(Math.abs(often.advance(200).brake - seldom.advance(200).brake) < 1e-9);
});

test("the brake wins while both keys are down", () => {
  const ramps = new Ramps(RATES);
  ramps.hold("throttle", true, 0);
  advance(ramps, 0, 2000);
  ramps.hold("brake", true, 2000);
  assert.deepEqual(advance(ramps, 2000, 3000), {throttle: 0, brake: 1});
});

test("a pause of the page is no time in which a key was held", () => {
  const ramps = new Ramps(RATES);
  ramps.hold("throttle", true, 0);
  assert.ok(ramps.advance(60000).throttle <= (0.1 + FIRST_S) * RATES.press_ps + 1e-9);
});

test("who leaves leaves both pedals at once", () => {
  const ramps = new Ramps(RATES);
  ramps.hold("brake", true, 0);
  advance(ramps, 0, 1000);
  ramps.drop();
  assert.deepEqual(ramps.advance(1000), {throttle: 0, brake: 0});
  assert.deepEqual(advance(ramps, 1000, 2000), {throttle: 0, brake: 0});
});

test("the rates are those of the scenario", () => {
  assert.deepEqual(ratesOf({person: {key_press_ps: 2, key_release_ps: 6}}), {press_ps: 2, release_ps: 6});
  for (const scenario of [undefined, {}, {person: {}}, {person: {key_press_ps: 0, key_release_ps: 1}}]) {
    assert.deepEqual(ratesOf(scenario), {press_ps: 1.5, release_ps: 4});
  }
});
