import assert from "node:assert/strict";
import {test} from "node:test";

import {fragmentOf, fragmentWithoutToken, readFragment} from "../../../../../../tools/web/page/data/address.js";
import {Clock, SPEEDS, timeOfStep, withTimeOfHeaders} from "../../../../../../tools/web/page/data/clock.js";

test("a live clock shows the newest time until the reader goes elsewhere", () => {
  const clock = new Clock();
  clock.follow();
  clock.advance(0.1, 0, 12);
  assert.equal(clock.time, 12);
  clock.goTo(5);
  clock.advance(1, 0, 13);
  assert.deepEqual([clock.time, clock.state], [5, "paused"]);
});

test("playing goes on at the chosen speed, stops at the end, and begins again", () => {
  const clock = new Clock();
  clock.play(0, 10);
  clock.speed = 5;
  clock.advance(1, 0, 10);
  assert.equal(clock.time, 5);
  clock.advance(2, 0, 10);
  assert.deepEqual([clock.time, clock.state], [10, "paused"]);
  clock.play(0, 10);
  assert.equal(clock.time, 0);
});

test("the time of a live run that has ended is at rest, so it plays", () => {
  const clock = new Clock();
  clock.follow();
  clock.advance(0, 0, 10);
  clock.toggle(0, 10, false);
  assert.equal(clock.state, "paused");
  clock.toggle(0, 10, false);
  assert.deepEqual([clock.state, clock.time], ["playing", 0]);
  clock.follow();
  clock.advance(0, 0, 10);
  clock.toggle(0, 10, true);
  assert.deepEqual([clock.state, clock.time], ["playing", 0]);
});

test("each step has its own number, although 0.3 / 0.1 is less than 3", () => {
  const clock = new Clock();
  for (const of_scenario of [0.1, 0.01, 0.02, 1 / 30, 1 / 60, 0.0333333]) {
    const {step_s} = withTimeOfHeaders({step_s: of_scenario});
    for (let step = 0; step < 100000; ++step) {
      clock.time = timeOfStep(step, step_s);
      assert.equal(clock.step(step_s), step);
    }
  }
});

test("the speed stays within 0.1 and 10", () => {
  const clock = new Clock();
  for (let i = 0; i < 20; ++i) clock.changeSpeed(1);
  assert.equal(clock.speed, 10);
  for (let i = 0; i < 20; ++i) clock.changeSpeed(-1);
  assert.equal(clock.speed, 0.1);
  assert.ok(SPEEDS.includes(1));
});

test("a link reopens its step, with the key if there is one", () => {
  assert.deepEqual(readFragment(fragmentOf(190, "")), {step: 190, run: "", token: ""});
  assert.deepEqual(readFragment(fragmentOf(190, "a+b&c")), {step: 190, run: "", token: "a+b&c"});
  assert.deepEqual(readFragment(fragmentOf(7, "t", "-64")), {step: 7, run: "-64", token: "t"});
  for (const fragment of ["", "#", "#step=", "#step=-1", "#step=1.5", "#step=x", "#other=3"]) {
    assert.equal(readFragment(fragment).step, null);
  }
});

test("without its token a fragment keeps its other parts", () => {
  const back = "back=http%3A%2F%2F127.0.0.1%3A7700%2F";
  assert.equal(fragmentWithoutToken(`#token=abc&${back}`), `#${back}`);
  assert.equal(fragmentWithoutToken("#token=abc"), "");
  assert.equal(fragmentWithoutToken(""), "");
});
