import assert from "node:assert/strict";
import {test} from "node:test";

import {Answer, countdown, told, whyAwayInWords} from "../../../../../../tools/web/page/drive/told.js";
import {describedTypes} from "../real_log.js";

test("each mode of HOST_COMMAND has words that say nothing of conflict or threshold", () => {
  const {constants} = describedTypes().arbitration_t;
  for (const [name, mode] of Object.entries(constants)) {
    const {words, side} = told({mode, lambda_human: 0});
    assert.notEqual(side, "unknown", name);
    assert.doesNotMatch(words, /conflict|threshold|sensor|lidar|radar|undefined|not known/i, name);
  }
  assert.equal(told(null).words, "The drive has not begun");
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

test("a request counts down from its begin, also if the page sees only its end", () => {
  const request = {op: "request", since_s: 2, begin_known: true};
  assert.deepEqual(countdown(request, 2, 10), {left_s: 10, share: 1, atMost: false});
  assert.deepEqual(countdown(request, 7, 10), {left_s: 5, share: 0.5, atMost: false});
  assert.equal(countdown(request, 10, 10).left_s, 2, "a page that was loaded 8 s after the request");
  assert.equal(countdown(request, 30, 10).left_s, 0);
  // The page may still have the frame of the step before the request began.
  assert.equal(countdown({...request, since_s: 32}, 31.98, 10).left_s, 10);
});

test("if the begin of a request is not known, the page says at most how much time is left", () => {
  assert.deepEqual(countdown({op: "request", since_s: 8, begin_known: false}, 10, 10),
                   {left_s: 8, share: 0.8, atMost: true});
  assert.deepEqual(countdown(null, 10, 10), {left_s: 10, share: 1, atMost: true});
});

test("the end of a drive is told, and a collision", () => {
  const {COLLISION_NONE, COLLISION_HOST, COLLISION_FOLLOWER} = describedTypes().truth_t.constants;
  const at = (truth) => told({mode: 1, lambda_human: 1}, truth).words;
  assert.equal(at({last: 0, collision: COLLISION_NONE}), "You drive");
  assert.equal(at({last: 1, collision: COLLISION_NONE}), "The drive has ended");
  assert.match(at({last: 1, collision: COLLISION_HOST}), /ended: your car has hit the car ahead/);
  assert.match(at({last: 1, collision: COLLISION_FOLLOWER}), /ended: the car behind has hit yours/);
});

test("without a connection the page does not say that somebody drives", () => {
  const {HUMAN, REQUEST} = describedTypes().arbitration_t.constants;
  const at = (connection, truth = null, mode = HUMAN) => told({mode, lambda_human: 1}, truth, connection);
  assert.equal(at("open").words, "You drive");
  assert.equal(at("ended").words, "The program has ended");
  for (const state of ["lost", "refused"]) assert.match(at(state).words, /No connection/);
  for (const state of ["ended", "lost", "refused"]) assert.equal(at(state).side, "unknown");
  assert.equal(at("lost", null, REQUEST).asks, false);
  assert.match(at("ended", {last: 1, collision: 0}).words, /^The drive has ended/, "the result stays");
});

test("in a stop that lasts until the end of the run the page gives no advice", () => {
  const {MINIMAL_RISK, MRM_COMFORT, MRM_DONE, MRM_FAILED, EMERGENCY_BRAKING} =
    describedTypes().arbitration_t.constants;
  const at = (mode) => told({mode, lambda_human: 0});
  for (const mode of [MINIMAL_RISK, MRM_DONE]) {
    assert.ok(at(mode).isFinal);
    for (const why of ["", "not begun", "no seat", "not calibrated"]) {
      assert.match(whyAwayInWords(why, at(mode)), /Nobody drives any more in this run/);
    }
  }
  assert.match(whyAwayInWords("not begun", {...at(MINIMAL_RISK), hasLeft: true}), /You have left the seat\. Nobody/);
  for (const mode of [MRM_COMFORT, MRM_FAILED]) {
    assert.equal(at(mode).isFinal, false);
    assert.match(whyAwayInWords("", at(mode)), /You can still take over/);
    assert.match(whyAwayInWords("hidden", at(mode)), /hidden/);
  }
  assert.equal(whyAwayInWords("", at(EMERGENCY_BRAKING)), "");
});

test("emergency braking does not take the authority from the human", () => {
  const {AUTOMATION, HUMAN, EMERGENCY_BRAKING} = describedTypes().arbitration_t.constants;
  const has = (mode, lambda_human) => told({mode, lambda_human}).hasAuthority;
  assert.deepEqual([has(EMERGENCY_BRAKING, 1), has(HUMAN, 1)], [true, true]);
  assert.deepEqual([has(EMERGENCY_BRAKING, 0.5), has(EMERGENCY_BRAKING, 0.49)], [true, false], "half is enough");
  assert.deepEqual([has(EMERGENCY_BRAKING, 0), has(AUTOMATION, 0), told(null).hasAuthority], [false, false, false]);
});

test("a car that stands does not stop", () => {
  const {MINIMAL_RISK} = describedTypes().arbitration_t.constants;
  const at = (host_speed_mps) => told({mode: MINIMAL_RISK, lambda_human: 0}, {last: 0, host_speed_mps}).words;
  assert.deepEqual([at(5), at(0)], ["The car stops by itself", "The car stands"]);
});

test("a car that stops by itself answers the button, if it has not taken the answer", () => {
  const {HUMAN, MRM_COMFORT, MRM_EMERGENCY, MRM_FAILED, EMERGENCY_BRAKING} =
    describedTypes().arbitration_t.constants;
  const answer = new Answer();
  const at = (mode) => told({mode, lambda_human: 0});
  for (const mode of [MRM_COMFORT, MRM_EMERGENCY, MRM_FAILED]) {
    answer.press("take_over", at(mode), 0);
    assert.match(answer.words(at(mode), 1500), /has not taken your answer/);
    assert.equal(answer.words(told({mode: HUMAN, lambda_human: 1}), 1500), "", "the person drives");
    answer.press("give_back", at(mode), 0);
    assert.equal(answer.words(at(mode), 1500), "");
  }
  // When the stop is final, the page says so, and gives no answer to the button.
  const {MRM_DONE} = describedTypes().arbitration_t.constants;
  answer.press("take_over", at(MRM_COMFORT), 0);
  assert.equal(answer.words(at(MRM_DONE), 1500), "");
  // A transfer continues during emergency braking, so the car may have taken the answer. The page
  // must not say that the car has not taken it.
  answer.press("take_over", at(EMERGENCY_BRAKING), 0);
  assert.equal(answer.words(at(EMERGENCY_BRAKING), 1500), "");
});

test("a button without effect gets an answer, one with an effect gets none", () => {
  const {AUTOMATION, HUMAN, REQUEST, HANDOVER} = describedTypes().arbitration_t.constants;
  const state = (mode, lambda_human = 0) => told({mode, lambda_human});
  const answer = new Answer();
  answer.press("take_over", state(AUTOMATION), 0);
  assert.equal(answer.words(state(AUTOMATION), 500), "", "the run may still react");
  assert.match(answer.words(state(AUTOMATION), 1500), /has not asked you/);
  assert.equal(answer.words(state(AUTOMATION), 7000), "");
  answer.press("take_over", state(AUTOMATION), 0);
  assert.equal(answer.words(state(HUMAN, 1), 1500), "", "the person drives now");
  answer.press("take_over", state(AUTOMATION), 0);
  assert.equal(answer.words(state(REQUEST), 1500), "", "the automation asks now");
  for (const mode of [REQUEST, HANDOVER]) {
    answer.press("take_over", state(mode), 0);
    assert.equal(answer.words(state(mode), 1500), "", "the person has answered");
  }
  answer.press("give_back", state(HUMAN, 1), 0);
  assert.match(answer.words(state(HUMAN, 1), 1500), /Press again later/);
  answer.press("give_back", state(HUMAN, 1), 0);
  assert.equal(answer.words(state(AUTOMATION), 1500), "");
});

test("why a person does not drive is said in words", () => {
  for (const why of ["not begun", "no seat", "refused", "hidden", "blurred", "busy", "unplugged", "not calibrated"]) {
    assert.ok(whyAwayInWords(why).length > 10, why);
  }
  assert.equal(whyAwayInWords(""), "");
  assert.match(whyAwayInWords("not begun", {hasLeft: true}), /left the seat/);
  assert.match(whyAwayInWords("hidden", {side: "human"}), /No person presses the pedals/);
  assert.doesNotMatch(whyAwayInWords("hidden", {side: "automation"}), /No person/);
  assert.equal(whyAwayInWords("", {side: "human"}), "");
});
