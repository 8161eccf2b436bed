import assert from "node:assert/strict";
import {test} from "node:test";

import {
  ButtonLesson, calibrationOf, forgetCalibration, inverted, isComplete, isDown, keepCalibration,
  PedalLesson, pedalValue, withDeadZone,
} from "../../../../../../tools/web/page/drive/calibration.js";

const pad = (axes, buttons = []) => (
  {id: "Wheel", mapping: "", axes, buttons: buttons.map((value) => ({value, pressed: value > 0.5}))});

/** A substitute for the browser's localStorage. */
function storage() {
  const items = new Map();
  return {getItem: (name) => items.get(name) ?? null, setItem: (name, text) => items.set(name, text),
          removeItem: (name) => items.delete(name)};
}

const WHEEL = {throttle: {axis: 2, released: 1, pressed: -1, dead: 0.1},
               brake: {axis: 5, released: -0.9, pressed: 0.8, dead: 0}, take_over: 4, give_back: null};

test("a pedal is 0 when released and 1 when pressed, for both directions of its axis", () => {
  for (const {throttle} of [WHEEL, {throttle: inverted(WHEEL.throttle)}]) {
    const {released, pressed} = throttle;
    assert.equal(pedalValue(pad([0, 0, released]), throttle), 0);
    assert.equal(pedalValue(pad([0, 0, pressed]), throttle), 1);
    const half = pedalValue(pad([0, 0, (released + pressed) / 2]), throttle);
    assert.ok(Math.abs(half - 0.4 / 0.9) < 1e-9, `${half}`);  // the dead zone is 0.1
  }
  assert.equal(pedalValue(pad([0, 0, 1.5]), WHEEL.throttle), 0);
  assert.equal(pedalValue(pad([0, 0, -1.5]), WHEEL.throttle), 1);
});

test("within the dead zone a pedal is released", () => {
  assert.equal(pedalValue(pad([0, 0, 0.81]), WHEEL.throttle), 0);
  assert.ok(pedalValue(pad([0, 0, 0.79]), WHEEL.throttle) > 0);
  assert.equal(withDeadZone(WHEEL.throttle, 9).dead, 0.3);
  assert.equal(withDeadZone(WHEEL.throttle, NaN).dead, 0);
});

test("an axis that the device does not have is no pedal", () => {
  assert.equal(pedalValue(pad([0, 0]), WHEEL.throttle), null);
  assert.equal(pedalValue(pad([0, 0, NaN]), WHEEL.throttle), null);
  assert.equal(isDown(pad([], [0, 1]), 1), true);
  assert.equal(isDown(pad([], [0, 1]), 7), false);
  assert.equal(isDown(pad([], [0, 1]), null), false);
});

test("each device keeps its own calibration", () => {
  const kept = storage();
  assert.equal(calibrationOf(kept, {id: "Wheel", mapping: ""}), null);
  assert.ok(keepCalibration(kept, {id: "Wheel"}, WHEEL));
  assert.deepEqual(calibrationOf(kept, {id: "Wheel", mapping: ""}), WHEEL);
  assert.equal(calibrationOf(kept, {id: "Other", mapping: ""}), null);
  forgetCalibration(kept, {id: "Wheel"});
  assert.equal(calibrationOf(kept, {id: "Wheel", mapping: ""}), null);
});

test("a gamepad with the standard mapping needs no calibration", () => {
  const standard = calibrationOf(storage(), {id: "Pad", mapping: "standard"});
  assert.ok(isComplete(standard));
  assert.equal(pedalValue(pad([], [0, 0, 0, 0, 0, 0, 0.2, 1]), standard.throttle), 1);
});

test("what was kept is believed only if it is complete", () => {
  const kept = storage();
  const whole = JSON.stringify(WHEEL);
  for (const bad of ["", "{", "null", "[]", "7", whole.replace('"axis":2', '"axis":-1'),
                     whole.replace('"axis":2', '"axis":"2"'), whole.replace('"pressed":-1', '"pressed":1'),
                     whole.replace('"dead":0.1', '"dead":0.9'), whole.replace('"take_over":4', '"x":4')]) {
    kept.setItem("fogline.drive.calibration.Wheel", bad);
    assert.equal(calibrationOf(kept, {id: "Wheel", mapping: ""}), null, bad);
  }
  const broken = {getItem() { throw new Error("forbidden"); }, setItem() { throw new Error("full"); }};
  assert.equal(calibrationOf(broken, {id: "Wheel", mapping: ""}), null);
  assert.equal(keepCalibration(broken, {id: "Wheel"}, WHEEL), false);
});

test("a pedal is learned from one full press and release, also if it first reports 0", () => {
  const lesson = new PedalLesson();
  assert.equal(lesson.result(), null);
  for (const value of [0, 1, 0.3, -0.6, -1, 0.2, 0.98]) lesson.see(pad([0.1, -0.2, value], [0]));
  const {axis, released, pressed} = lesson.result();
  assert.deepEqual({axis, released, pressed}, {axis: 2, released: 0.98, pressed: -1});
});

test("a trigger that is a button is learned, too", () => {
  const lesson = new PedalLesson();
  for (const value of [0, 0.5, 1, 0.4, 0]) lesson.see(pad([0], [0, value]));
  assert.deepEqual([lesson.result().button, lesson.result().pressed], [1, 1]);
});

test("noise teaches nothing", () => {
  const lesson = new PedalLesson();
  for (const value of [0, 0.1, -0.1, 0.15, 0]) lesson.see(pad([value]));
  assert.equal(lesson.result(), null);
});

test("the first button that goes down is learned; one that is held already is not", () => {
  const lesson = new ButtonLesson();
  assert.equal(lesson.see(pad([], [1, 0, 0])), null);
  assert.equal(lesson.see(pad([], [1, 0, 0])), null);
  assert.equal(lesson.see(pad([], [1, 0, 1])), 2);
});
