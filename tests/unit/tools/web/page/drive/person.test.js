import assert from "node:assert/strict";
import {test} from "node:test";

import {deviceOf, KEYBOARD, kindOf, Person} from "../../../../../../tools/web/page/drive/person.js";

const ID = "Racing Wheel";
const CALIBRATION = {throttle: {axis: 0, released: 1, pressed: -1, dead: 0},
                     brake: {axis: 1, released: 1, pressed: -1, dead: 0}, take_over: 0, give_back: 1};

function pad({axes = [1, 1], down = [], timestamp = 0, id = ID, connected = true} = {}) {
  return {id, connected, mapping: "", timestamp, axes,
          buttons: [0, 1].map((i) => ({pressed: down.includes(i), value: down.includes(i) ? 1 : 0}))};
}

/** A person who is ready at the keyboard. */
function ready() {
  const person = new Person();
  person.set("seated", true);
  person.set("begun", true);
  return person;
}

/** A person who is ready at a wheel. */
function atWheel() {
  const person = ready();
  person.choose(deviceOf({id: ID}), CALIBRATION);
  person.look([null, pad()], 0);
  return person;
}

test("a person drives only after they have begun and have the seat", () => {
  const person = new Person();
  assert.equal(person.whyAway(), "not begun");
  person.set("begun", true);
  assert.equal(person.whyAway(), "no seat");
  person.set("seated", true);
  assert.equal(person.whyAway(), "");
  assert.ok(person.input(0).present);
});

test("a person who has begun is ready for a seat that another page has", () => {
  const person = new Person();
  assert.equal(person.whyNotReady(), "not begun");
  person.set("begun", true);
  assert.equal(person.whyNotReady(), "");
  assert.equal(person.input(0).present, false);
  person.set("focused", false);
  assert.equal(person.whyNotReady(), "blurred");
});

test("the arrows move the pedals, T and G press the buttons, other keys do nothing", () => {
  const person = ready();
  person.input(0);
  assert.ok(person.key("ArrowDown", true, 0));
  assert.ok(person.key("t", true, 10));
  for (let now = 0; now <= 400; now += 20) person.input(now);
  const {brake, throttle, buttons} = person.input(400);
  assert.ok(brake > 0.5 && throttle === 0);
  assert.deepEqual(buttons, ["take_over"]);
  assert.equal(person.touched_ms, 10);
  person.key("T", false, 500);
  person.key("g", true, 500);
  assert.deepEqual(person.input(500).buttons, ["give_back"]);
  assert.equal(person.key("x", true, 600), false);
  assert.equal(person.key("Enter", true, 600), false);
  assert.equal(person.touched_ms, 500);
});

test("a short press of a button lasts long enough for two messages", () => {
  const person = ready();
  person.key("t", true, 100);
  person.key("t", false, 110);
  assert.deepEqual(person.input(200).buttons, ["take_over"]);
  assert.deepEqual(person.input(230).buttons, []);
  person.press("give_back", 300);
  assert.deepEqual(person.input(400).buttons, ["give_back"]);
  assert.deepEqual(person.input(430).buttons, []);
});

test("a short press that a busy page handles late lasts as long", () => {
  const person = ready();
  person.key("t", true, 100, 400);
  person.key("t", false, 110, 400);
  assert.equal(person.touched_ms, 110);
  assert.deepEqual(person.input(500).buttons, ["take_over"]);
  person.press("give_back", 600, 900);
  assert.equal(person.touched_ms, 600);
  assert.deepEqual(person.input(1000).buttons, ["give_back"]);
});

test("a hidden page, a blurred one, a dialog and a lost seat leave the pedals at once", () => {
  for (const [name, away, why] of [["visible", false, "hidden"], ["focused", false, "blurred"],
                                   ["busy", true, "busy"], ["seated", false, "no seat"],
                                   ["begun", false, "not begun"]]) {
    const person = ready();
    person.key("ArrowUp", true, 0);
    person.key("t", true, 0);
    for (let now = 0; now <= 500; now += 20) person.input(now);
    person.set(name, away);
    assert.equal(person.whyAway(), why);
    const {present, throttle, brake, buttons} = person.input(510);
    assert.deepEqual({present, throttle, brake, buttons}, {present: false, throttle: 0, brake: 0, buttons: []});
    // When the person comes back, the pedals are still released, although no key has gone up.
    assert.equal(person.key("ArrowUp", true, 520), false);
    person.set(name, !away);
    assert.deepEqual(person.input(600).throttle, 0);
    assert.ok(person.input(600).present);
  }
});

test("a calibrated wheel moves the pedals and has its own buttons", () => {
  const person = atWheel();
  person.look([null, pad({axes: [1, -0.5], down: [1]})], 40);
  const {present, throttle, brake, axes, buttons, device} = person.input(40);
  assert.deepEqual({present, throttle, brake, axes, buttons},
                   {present: true, throttle: 0, brake: 0.75, axes: [1, -0.5], buttons: ["give_back"]});
  assert.deepEqual(device, {id: ID, kind: "wheel", name: ID});
  assert.equal(person.key("ArrowUp", true, 50), false);  // the arrows are not the pedals now
  assert.ok(person.key("t", true, 50));                   // but the buttons of the keyboard are
});

test("an axis counts as released until it has moved: a browser may report 0 before that", () => {
  const person = ready();
  person.choose(deviceOf({id: ID}), CALIBRATION);
  const at = (now_ms, axes) => {
    person.look([pad({axes})], now_ms);
    const {present, throttle, brake} = person.input(now_ms);
    return {present, throttle, brake};
  };
  assert.deepEqual(at(0, [0, 0]), {present: true, throttle: 0, brake: 0});
  assert.deepEqual(at(20, [0, 0]), {present: true, throttle: 0, brake: 0});
  assert.deepEqual(at(40, [0, -0.5]), {present: true, throttle: 0, brake: 0.75});  // the first movement acts
  assert.deepEqual(at(60, [0, 0]), {present: true, throttle: 0, brake: 0.5});      // now 0 is a position
  // The device is plugged in again, and has forgotten the positions of its axes.
  person.look([], 80);
  assert.deepEqual(at(100, [0, 0]), {present: true, throttle: 0, brake: 0});
});

for (const [what, leave, comeBack] of [
  ["a hidden page", (person) => person.set("visible", false), (person) => person.set("visible", true)],
  ["a lost connection", (person) => person.set("seated", false), (person) => person.set("seated", true)],
  ["a silent page", () => {}, () => {}],
  ["a silence that only the server has noticed", (person) => person.leavePedals(), () => {}],
]) {
  test(`after ${what} a pedal of a device acts only after it was released`, () => {
    const person = atWheel();
    const brakeAt = (now_ms, axis) => {
      person.look([pad({axes: [1, axis]})], now_ms);
      return person.input(now_ms).brake;
    };
    assert.equal(brakeAt(40, 0), 0.5);
    leave(person);
    const back_ms = what === "a silent page" ? 340 : 80;
    comeBack(person);
    assert.equal(brakeAt(back_ms, 0), 0);
    assert.equal(brakeAt(back_ms + 40, -1), 0, "a movement of a pressed pedal is no release");
    assert.ok(person.input(back_ms + 40).present);
    assert.equal(brakeAt(back_ms + 80, 0.9375), 0.03125);  // nearly released, as a worn pedal rests
    assert.equal(brakeAt(back_ms + 120, 0), 0.5);
  });
}

test("a pedal that was released and pressed again while the person was away does not act", () => {
  const person = atWheel();
  person.set("focused", false);
  person.look([pad({axes: [1, 1]})], 40);
  person.look([pad({axes: [1, 0]})], 80);
  person.set("focused", true);
  person.look([pad({axes: [1, 0]})], 120);
  assert.deepEqual([person.input(120).present, person.input(120).brake], [true, 0]);
});

test("a short pause of the page leaves the pedals pressed, a silence does not", () => {
  const person = ready();
  person.look([], 0);
  person.key("ArrowDown", true, 0);
  person.look([], 290);
  assert.ok(person.input(290).brake > 0);
  person.look([], 590);
  assert.equal(person.input(590).brake, 0);
});

test("the raw values of pedals that are buttons follow the axes", () => {
  const person = ready();
  const calibration = {...CALIBRATION, throttle: {button: 1, released: 0, pressed: 1, dead: 0}};
  person.choose(deviceOf({id: ID}), calibration);
  assert.deepEqual(person.input(0).axes, []);
  person.look([pad({axes: [0.25, 1], down: [1]})], 0);
  assert.deepEqual(person.input(0).axes, [0.25, 1, 1]);
  person.choose(deviceOf({id: ID}), null);
  assert.deepEqual(person.input(0).axes, [0.25, 1], "without a calibration no button is a pedal");
});

test("the time of an input is the device's own, and noise is no input", () => {
  const person = atWheel();
  person.look([pad({axes: [0.5, 1], timestamp: 90})], 100);
  assert.equal(person.touched_ms, 90);
  person.look([pad({axes: [0.505, 1], timestamp: 140})], 150);
  assert.equal(person.touched_ms, 90);
  person.look([pad({axes: [0, 1], timestamp: 0})], 200);
  assert.equal(person.touched_ms, 200);
});

test("an unplugged device leaves the pedals, and comes back when it is plugged in", () => {
  const person = atWheel();
  for (const pads of [[], [null], [pad({connected: false})], [pad({id: "another"})]]) {
    person.look(pads, 100);
    assert.equal(person.whyAway(), "unplugged");
    assert.equal(person.input(100).present, false);
    person.look([pad()], 200);
    assert.ok(person.input(200).present);
  }
});

test("a button that is held while the device is unplugged counts as released", () => {
  const person = atWheel();
  person.key("t", true, 0);
  person.look([], 100);
  person.key("t", false, 200);
  person.look([pad()], 300);
  assert.deepEqual(person.input(5000).buttons, []);
});

test("a device without a calibration, or with too few axes, does not drive", () => {
  const person = ready();
  person.choose(deviceOf({id: ID}), null);
  person.look([pad()], 0);
  assert.equal(person.whyAway(), "not calibrated");
  person.choose(deviceOf({id: ID}), CALIBRATION);
  assert.equal(person.whyAway(), "");
  person.look([pad({axes: [1]})], 20);
  assert.equal(person.whyAway(), "not calibrated");
  person.choose(KEYBOARD);
  assert.equal(person.whyAway(), "");
});

test("wheels are known by their names", () => {
  for (const id of ["Logitech G29 Driving Force Racing Wheel", "Thrustmaster T300", "FANATEC DD1",
                    "G920 (Vendor: 046d)"]) assert.equal(kindOf(id), "wheel", id);
  for (const id of ["Xbox 360 Controller", "DualSense Wireless Controller", ""]) {
    assert.equal(kindOf(id), "gamepad", id);
  }
});
