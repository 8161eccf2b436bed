// tools/web/page/drive/leaving.js: a person who drives leaves the seat with a second press.
import assert from "node:assert/strict";
import {test} from "node:test";

import {Leaving} from "../../../../../../tools/web/page/drive/leaving.js";

test("a person who does not drive leaves with one press", () => {
  const leaving = new Leaving();
  assert.equal(leaving.press(false, 0), true);
  assert.equal(leaving.asks(0), false);
});

test("a person who drives leaves with the second press", () => {
  const leaving = new Leaving();
  assert.equal(leaving.press(true, 1000), false);
  assert.equal(leaving.asks(1000), true);
  assert.equal(leaving.press(true, 4999), true);
  assert.equal(leaving.asks(4999), false);
});

test("after four seconds a press is the first one again", () => {
  const leaving = new Leaving();
  leaving.press(true, 1000);
  assert.equal(leaving.asks(5000), false);
  assert.equal(leaving.press(true, 5000), false);
  assert.equal(leaving.press(true, 8999), true);
});

test("after the person has come back, one press does not leave", () => {
  const leaving = new Leaving();
  leaving.press(true, 0);
  leaving.press(true, 1);
  assert.equal(leaving.press(true, 2), false);
});
