// The participant's page: the inputs of a person, and the empty seat when no person is present. The
// tests act as the person, and read DRIVER_INPUT from the network.
import assert from "node:assert/strict";
import {test} from "node:test";

import {begin, drives, freshNetwork, listener, seat, setPad, startDrive, withFakePads} from "./seat.js";
import {browser, DESKTOP, open, PHONE, until} from "./window.js";

/** Opens a page that drives. @return the page, and the messages that the run gets from it */
async function seated(t, {pads = false, ...options} = {}) {
  const network = freshNetwork();
  const {server, drive, view} = await seat(t, network);
  const run = await listener(t, view);
  const started = await browser(t);
  const page = await open(t, started, drive, {prepare: pads ? withFakePads : null, ...options});
  return {server, drive, view, run, page, started};
}

const close = (a, b) => Math.abs(a - b) < 1e-6;

test("the arrows are the pedals, T and G the buttons", async (t) => {
  const {run, page} = await seated(t);
  assert.equal(run.newest()?.present ?? false, false);
  await begin(page);
  await drives(page, true);
  await page.keyboard.down("ArrowDown");
  const braking = await run.next(({brake}) => brake === 1, "the whole brake");
  assert.equal(braking.message.throttle, 0);
  assert.equal(braking.message.present, true);
  assert.equal(braking.message.device, "Keyboard");
  const ramp = run.heard.map(({message}) => message.brake).filter((brake) => brake > 0 && brake < 1);
  assert.ok(ramp.length > 5, `the key is a ramp: ${ramp}`);
  await page.keyboard.up("ArrowDown");
  await run.next(({brake}) => brake === 0, "the released brake");
  await page.keyboard.down("ArrowUp");
  await run.next(({throttle}) => throttle > 0.5, "the throttle");
  await page.keyboard.up("ArrowUp");
  await page.keyboard.press("t");
  await run.next(({buttons}) => buttons === 1, "the button to take over");
  await page.keyboard.press("g");
  await run.next(({buttons}) => buttons === 2, "the button to give back");
  await run.next(({buttons}) => buttons === 0, "released buttons");
  // The page has sent many inputs, and none of them is missing.
  assert.ok(run.heard.length > 20);
  const numbers = run.heard.map(({message}) => message.sequence);
  assert.deepEqual(numbers, numbers.map((_, i) => numbers[0] + i));
});

test("a view counts the page of the seat, and names a command that starts a run on its network", async (t) => {
  const {view, started} = await seated(t);  // the listener in seated() is a viewer, too
  const page = await open(t, started, view);
  await page.waitForFunction(() =>
    document.getElementById("network").textContent.includes("2 viewers · 1 page of the seat"));
  assert.match(await page.locator("#reason").innerText(), /fogline run \S+ --pace 1 --lcm-url 'udpm:/);
});

test("a wheel is calibrated in the page, drives, and is known again", async (t) => {
  const {run, page} = await seated(t, {pads: true});
  await setPad(page, {axes: [0, 0]});  // a browser reports 0 before an axis has moved
  await page.click("#setup-open");
  await page.selectOption("#device", "Test Wheel");
  for (const [name, axis] of [["throttle", 0], ["brake", 1]]) {
    await page.click(`#learn-${name}`);
    for (const value of [1, 0, -1, 0, 1]) {
      const axes = [1, 1];
      axes[axis] = value;
      await setPad(page, {axes});
      await page.waitForFunction(([place, wanted]) => foglineDrive.person.pad.axes[place] === wanted,
                                 [axis, value]);
    }
    await page.click(`#learn-${name}`);
    await page.waitForFunction(([id, wanted]) => document.getElementById(id).textContent === wanted,
                               [`place-${name}`, `axis ${axis}`]);
  }
  for (const [name, button] of [["take_over", 2], ["give_back", 3]]) {
    await page.click(`#learn-${name}`);
    await page.waitForFunction(() => foglineDrive.setup.lesson?.teacher.before);
    await setPad(page, {down: [button]});
    await page.waitForFunction(([id, wanted]) => document.getElementById(id).textContent === wanted,
                               [`place-${name}`, `button ${button}`]);
    await setPad(page);
  }
  await page.fill("#dead-brake", "20");
  await page.click("#setup-close");
  await begin(page);
  await drives(page, true);
  await setPad(page, {axes: [1, 0], down: [2]});
  const half = (await run.next(({brake}) => brake > 0, "the brake of the wheel")).message;
  assert.ok(close(half.brake, 0.375), `half of the way with a dead zone of 0.2: ${half.brake}`);
  assert.deepEqual([half.buttons, half.device, half.axes], [1, "Test Wheel", [1, 0]]);
  assert.equal(half.device_kind, 2);
  // The throttle is inverted, and stays inverted after a reload.
  await page.click("#setup-open");
  await page.click("#invert-throttle");
  await page.click("#setup-close");
  await page.reload();
  await setPad(page, {axes: [0, 0]});  // the axes have not moved since the page was loaded
  await page.waitForFunction(() => foglineDrive.person.device.id === "Test Wheel");
  await begin(page);
  await drives(page, true);
  const untouched = (await run.next(({present}) => present, "that a person is there")).message;
  assert.deepEqual([untouched.throttle, untouched.brake], [0, 0]);
  await setPad(page, {axes: [1, 1]});
  await run.next(({throttle, present}) => present && throttle === 1, "the inverted throttle");
});

test("a gamepad with the standard mapping drives at once; unplugged, no person drives", async (t) => {
  const {run, page} = await seated(t, {pads: true});
  const pad = {id: "Test Pad", mapping: "standard", axes: [0, 0, 0, 0]};
  await page.evaluate(() => localStorage.setItem("fogline.drive.device", "Test Pad"));
  await page.evaluate((state) => {
    window.fakePads = [{...state, connected: true, index: 0, timestamp: 0,
                        buttons: Array.from({length: 17}, () => ({pressed: false, value: 0}))}];
  }, pad);
  await page.waitForFunction(() => foglineDrive.person.device.id === "Test Pad");
  await begin(page);
  await drives(page, true);
  await page.evaluate(() => {
    const [pad] = window.fakePads;
    pad.buttons = pad.buttons.map((button, i) => (i === 6 ? {pressed: true, value: 1} : button));
    window.fakePads = [{...pad}];
  });
  const pressed = (await run.next(({brake}) => brake === 1, "the left trigger")).message;
  assert.deepEqual(pressed.axes, [0, 0, 0, 0, 0, 1], "the raw values of both triggers follow the axes");
  await page.evaluate(() => {
    window.fakePads = [null];
    dispatchEvent(new Event("gamepaddisconnected"));
  });
  const away = (await run.next(({present}) => !present, "an unplugged device")).message;
  assert.deepEqual([away.brake, away.throttle, away.buttons], [0, 0, 0]);
  assert.match(await page.locator("#away").innerText(), /unplugged/);
});

/** A person brakes with a key. Then `happens` is called, and then no person may drive. */
async function leaves(t, happens, why) {
  const all = await seated(t);
  const {run, page} = all;
  await begin(page);
  await drives(page, true);
  await page.keyboard.down("ArrowDown");
  await run.next(({brake}) => brake === 1, "the brake");
  const away = run.next(({present}) => !present, "that no person drives");
  await happens(all);
  const {message} = await away;
  assert.deepEqual([message.brake, message.throttle, message.buttons], [0, 0, 0]);
  if (why) await page.waitForFunction((words) => document.getElementById("away").textContent.includes(words), why);
  return all;
}

test("a hidden tab does not drive", async (t) => {
  await leaves(t, async ({page}) => {
    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", {value: true, configurable: true});
      document.dispatchEvent(new Event("visibilitychange"));
    });
  }, "hidden");
});

test("a window without the keyboard does not drive, and comes back with released pedals", async (t) => {
  const {page, run} = await leaves(t, ({page: one}) => one.evaluate(() => { dispatchEvent(new Event("blur")); }),
                                   "Another window");
  // A person presses “Go on”. First the window gets the keyboard, and then another button is at the
  // place of “Go on”. So the press hits this other button.
  const pressed = await page.evaluate(() => {
    const {left, top, width, height} = document.getElementById("go-on").getBoundingClientRect();
    dispatchEvent(new Event("focus"));
    const button = document.elementFromPoint(left + width / 2, top + height / 2);
    button.dispatchEvent(new PointerEvent("pointerdown", {bubbles: true}));
    button.dispatchEvent(new PointerEvent("click", {bubbles: true, detail: 1}));
    return button.id;
  });
  assert.equal(pressed, "begin");
  assert.equal(await page.locator("#begin").innerText(), "Leave the seat");  // nothing happened
  const back = await run.next(({present}) => present, "that the person is back");
  assert.equal(back.message.brake, 0);
  const from_ms = await page.evaluate(() => performance.now());
  await page.waitForFunction((from) => performance.now() > from + 600, from_ms);
  await page.click("#begin");  // a separate click
  await page.waitForFunction(() => document.getElementById("begin").innerText !== "Leave the seat");
});

test("an open dialog does not drive", async (t) => {
  await leaves(t, ({page}) => page.click("#setup-open"), "dialog");
});

test("a page that is busy for 300 ms does not drive, and is told", async (t) => {
  const {page, server, run} = await leaves(t, ({page: one}) => one.evaluate(() => {
    const end = performance.now() + 900;
    while (performance.now() < end) continue;
  }));
  await until(() => server.said.includes("its page is silent"), "the notice of the silence");
  // The page's next input takes the seat again, with released pedals although the key is still
  // down.
  await drives(page, true);
  const back = await run.next(({present}) => present, "that the person is back");
  assert.equal(back.message.brake, 0);
});

test("a page that is closed, or has lost its socket, does not drive", async (t) => {
  await leaves(t, ({page}) => page.evaluate(() => foglineDrive.wire.socket.close()));
  await leaves(t, ({page}) => page.close());
});

test("the second driver is told that the seat is taken, and may ask again", async (t) => {
  const {page, drive, started, run} = await seated(t);
  await begin(page);
  await drives(page, true);
  const second = await open(t, started, drive);
  await second.waitForFunction(() => foglineDrive.state === "taken");
  await begin(second);
  await second.waitForFunction(() => document.getElementById("away").textContent.includes("Another person"));
  await second.keyboard.down("ArrowDown");
  await drives(second, false);
  assert.equal(run.heard.some(({message}) => message.brake > 0), false);
  await second.keyboard.up("ArrowDown");
  await page.close();
  // The seat becomes free only when the server has noticed the end of the first page. So the
  // second page tries again and again.
  await until(() => second.evaluate(() => {
    if (!foglineDrive.person.begun) document.getElementById("begin").click();
    return document.body.dataset.present === "true";
  }), "the seat");
});

test("a page that is only open gives the seat to the person at another one", async (t) => {
  const {page, drive, started, run} = await seated(t);
  await page.waitForFunction(() => foglineDrive.state === "yours");
  const second = await open(t, started, drive);
  await begin(second);
  await drives(second, true);
  await second.keyboard.down("ArrowDown");
  await run.next(({brake, present}) => present && brake > 0.5, "the brake of the second page");
  await second.keyboard.up("ArrowDown");
  await page.waitForFunction(() => foglineDrive.state === "taken");
  await begin(page);
  await page.waitForFunction(() => document.getElementById("away").textContent.includes("Another person"));
  await drives(page, false);
  await drives(second, true);
});

test("with --listen only the driver's token gives the seat", async (t) => {
  const {drive, view} = await seat(t, freshNetwork(), ["--listen", "127.0.0.1:0"]);
  const started = await browser(t);
  const page = await open(t, started, drive);
  await page.waitForFunction(() => foglineDrive.state === "yours");
  assert.ok(!page.url().includes("token"), page.url());
  const wrong = await open(t, started, drive.replace(/#.*/, new URL(view).hash));
  await wrong.waitForFunction(() => document.getElementById("problem").textContent.includes("contains a token"));
  await wrong.close();  // otherwise the page would try to connect again
  // The page's errors about the refused connection are expected.
  wrong.trouble = wrong.trouble.filter((words) => !words.includes("WebSocket"));
});

for (const [name, size] of [["desktop", DESKTOP], ["phone", PHONE], ["low", {width: 1000, height: 760}]]) {
  test(`the request to take over does not cover the car ahead (${name})`, async (t) => {
    const {page} = await seated(t, {size});
    await page.waitForFunction(() => foglineDrive.state === "yours");
    await page.evaluate(() => {
      document.getElementById("request").hidden = false;
      foglineDrive.drawState = () => {};
    });
    // The camera looks down by 0.07 rad. So the horizon, where the car ahead is, lies at a third of
    // the picture's height.
    const covered = await page.evaluate(() => {
      const [sign, picture] = ["request", "driver-view"].map((id) => document.getElementById(id).getBoundingClientRect());
      return (sign.bottom - picture.top) / picture.height;
    });
    assert.ok(covered < 0.335, `the request covers the car ahead: ${covered} of the picture`);
  });
}

test("a finger holds the pedals of the page", async (t) => {
  const {run, page} = await seated(t, {size: PHONE, hasTouch: true, isMobile: true});
  await begin(page);
  await drives(page, true);
  const finger = (id, type) => page.locator(id).dispatchEvent(type, {pointerId: 1, pointerType: "touch"});
  // No real pointer belongs to these events, so the page cannot capture a pointer. The test
  // replaces setPointerCapture() by a function that does nothing.
  await page.evaluate(() => { Element.prototype.setPointerCapture = () => {}; });
  assert.ok(await page.locator("#touch-brake").isVisible());
  await finger("#touch-brake", "pointerdown");
  await run.next(({brake}) => brake === 1, "the brake");
  await finger("#touch-brake", "pointerup");
  await run.next(({brake}) => brake === 0, "the released brake");
  await finger("#touch-throttle", "pointerdown");
  await run.next(({throttle}) => throttle > 0.5, "the throttle");
  await finger("#touch-throttle", "pointercancel");
  await run.next(({throttle}) => throttle === 0, "the released throttle");
});

test("with a mouse the page has no pedals to hold", async (t) => {
  const {page} = await seated(t);
  assert.equal(await page.locator("#touch-brake").isVisible(), false);
});

test("everything works with the keyboard alone", async (t) => {
  const {page} = await seated(t);
  await page.waitForFunction(() => foglineDrive.state === "yours");
  const reached = [];
  for (let i = 0; i < 4; ++i) {
    await page.keyboard.press("Tab");
    reached.push(await page.evaluate(() => document.activeElement.id));
    if (reached.at(-1) === "begin") break;
  }
  assert.deepEqual(reached, ["setup-open", "begin"]);
  await page.keyboard.press("Enter");
  await drives(page, true);
});

test("when Tab comes back to the page, it reaches the button to take over before the next frame", async (t) => {
  const {address} = await startDrive(t, {"/steps": 30000});
  const page = await open(t, await browser(t), address);
  await begin(page);
  await page.waitForFunction(() => !document.getElementById("take-over").disabled);
  await until(async () => {
    await page.keyboard.press("Tab");
    return !await page.evaluate(() => document.hasFocus());
  }, "Tab to leave the page after its last button");
  await page.waitForFunction(() => document.getElementById("take-over").disabled);
  await page.evaluate(() => { foglineDrive.loop = () => {}; });  // no frame is drawn any more
  const reached = [];
  for (let i = 0; i < 3; ++i) {
    await page.keyboard.press("Tab");
    reached.push(await page.evaluate(() => document.activeElement.id));
  }
  assert.deepEqual(reached, ["setup-open", "begin", "take-over"]);
});

test("a changed condition of driving shows who drives now, also between two frames", async (t) => {
  const {address} = await startDrive(t, {"/steps": 30000});
  const page = await open(t, await browser(t), address);
  await begin(page);
  await page.waitForFunction(() => !document.getElementById("take-over").disabled);
  // The test changes the newest HOST_COMMAND: the human drives. No frame is drawn and no message
  // comes during this call. So only set() can change the buttons.
  const areDisabled = await page.evaluate(() => {
    const HUMAN = 1;  // host_command_t
    Object.assign(foglineDrive.newest.frame.HOST_COMMAND, {mode: HUMAN, lambda_human: 1});
    const buttons = ["take-over", "give-back"].map((id) => document.getElementById(id));
    const before = buttons.map(({disabled}) => disabled);
    foglineDrive.set("focused", true);
    return [before, buttons.map(({disabled}) => disabled)];
  });
  assert.deepEqual(areDisabled, [[false, true], [true, false]]);
});

test("the page says nothing of conflict, threshold or condition", async (t) => {
  const {page} = await seated(t);
  const words = await page.evaluate(() => document.documentElement.textContent);
  assert.doesNotMatch(words, /conflict|threshold|condition|lidar|radar|gap/i);
});
