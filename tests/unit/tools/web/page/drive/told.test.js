import assert from "node:assert/strict";
import {test} from "node:test";

import {Countdown, told, whyAwayInWords} from "../../../../../../tools/web/page/drive/told.js";
import {describedTypes} from "../real_log.js";

test("each mode of HOST_COMMAND has words that say nothing of conflict or threshold", () => {
  const {constants} = describedTypes().arbitration_t;
  for (const [name, mode] of Object.entries(constants)) {
    const {words, side} = told({mode, lambda_human: 0});
    assert.notEqual(side, "unknown", name);
    assert.doesNotMatch(words, /conflict|threshold|sensor|lidar|radar|undefined|not known/i, name);
  }
  assert.equal(told(null).words, "The drive has not begun");
  assert.equal(told({mode: 0, lambda_human: 1}, true).words, "The drive has ended");
  assert.equal(told({mode: 99, lambda_human: 0}).words, "It is not known who drives");
});

test("who drives and who is asked is told by mode", () => {
  const {AUTOMATION, HUMAN, REQUEST, REQUEST_URGENT, HANDOVER, COLLISION_WARNING} =
    describedTypes().arbitration_t.constants;
  const at = (mode, lambda_human = 0) => told({mode, lambda_human});
  assert.deepEqual([at(AUTOMATION).asks, at(HUMAN).asks], [false, false]);
  assert.deepEqual([at(REQUEST).asks, at(REQUEST).urgent], [true, false]);
  assert.deepEqual([at(REQUEST_URGENT).asks, at(REQUEST_URGENT).urgent], [true, true]);
  assert.equal(at(HANDOVER).asks, false);
  assert.match(at(COLLISION_WARNING, 1).words, /You drive/);
  assert.match(at(COLLISION_WARNING, 0).words, /The automation drives/);
});

test("a request counts down from its first step, and a new one begins again", () => {
  const countdown = new Countdown();
  assert.equal(countdown.see(false, 1, 10), null);
  assert.deepEqual(countdown.see(true, 2, 10), {left_s: 10, share: 1});
  assert.deepEqual(countdown.see(true, 7, 10), {left_s: 5, share: 0.5});
  assert.equal(countdown.see(true, 30, 10).left_s, 0);
  assert.equal(countdown.see(false, 31, 10), null);
  assert.equal(countdown.see(true, 32, 10).left_s, 10);
  assert.equal(countdown.see(true, 1, 10).left_s, 10);  // another run
});

test("why a person does not drive is said in words", () => {
  for (const why of ["not begun", "no seat", "refused", "hidden", "blurred", "busy", "unplugged", "not calibrated"]) {
    assert.ok(whyAwayInWords(why).length > 10, why);
  }
  assert.equal(whyAwayInWords(""), "");
});
