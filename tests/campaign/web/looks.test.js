// The looks of every page in its states. The tests find what a reader cannot see, read or reach, in
// each window and in both colour schemes.
import assert from "node:assert/strict";
import {existsSync, renameSync} from "node:fs";
import path from "node:path";
import {test} from "node:test";

import {looksWell, prepareLooks} from "./looks.js";
import {begin, drives, freshNetwork, setPad, startDrive, withFakePads} from "./seat.js";
import {background, browser, goTo, open, PHONE, recordedRun, root, scratch, view} from "./window.js";

const {FOGLINE} = process.env;

test("the view of a log looks well", async (t) => {
  const folder = scratch(t);
  const log = path.join(folder, "paper-seed1-threshold-0.5.lcm");  // a name as in tools/demo
  renameSync(recordedRun(folder, ["/arbitrator/take_over/mode=requested",
                                  "/arbitrator/take_over/absent_probability=1"], "paper"), log);
  const page = await open(t, await browser(t), await view(t, [log]), {prepare: prepareLooks});
  await goTo(page, 0);
  await looksWell(page, "the automation drives");
  for (const kind of ["request", "manoeuvre"]) {
    await goTo(page, await page.evaluate((wanted) => foglinePage.log.events.find((one) => one.kind === wanted).step + 1,
                                         kind));
    await looksWell(page, kind);
  }
  await page.keyboard.press("?");
  await looksWell(page, "the keys");
  await page.keyboard.press("Escape");
  await page.keyboard.press("/");
  await page.keyboard.type("gap");
  await looksWell(page, "the list of fields", {keys: false});
});

test("the view without its key looks well", async (t) => {
  const address = await view(t, [recordedRun(scratch(t)), "--listen", "127.0.0.1"]);
  const page = await open(t, await browser(t), address.replace(/#.*/, ""), {prepare: prepareLooks});
  await page.waitForFunction(() => !document.getElementById("problem").hidden);
  await looksWell(page, "no key");
  // The page reports errors about the refused connection. The test ignores these errors.
  page.trouble = page.trouble.filter((words) => !words.includes("WebSocket"));
});

test("the view of a live run looks well", async (t) => {
  const network = freshNetwork();
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]), {prepare: prepareLooks});
  await page.waitForFunction(() => foglinePage.hello);
  await looksWell(page, "no run yet");
  background(t, FOGLINE, ["run", "scenario/dense_fog.json", "--lcm-url", network, "--quiet", "--pace", "3",
                          "--log", path.join(scratch(t), "live.lcm")]);
  await page.waitForFunction(() => {
    const isThere = document.getElementById("who").textContent === "The human drives" &&
      ["roles", "senders"].every((table) => document.querySelectorAll(`#${table} tbody tr`).length >= 9);
    if (isThere) foglinePage.take = foglinePage.receive = () => {};  // the page stays in this state
    return isThere;
  });
  await looksWell(page, "a run");
});

test("the page of a drive looks well", async (t) => {
  const {run, address} = await startDrive(t, {"/arbitrator/threshold": 0, "/steps": 30000});
  const page = await open(t, await browser(t), address, {prepare: async (context) => {
    await prepareLooks(context);
    await withFakePads(context);
  }});
  await page.waitForFunction(() => foglineDrive.state === "yours");
  await looksWell(page, "before the drive");
  await begin(page);
  await drives(page, true);
  await page.waitForFunction(() => {
    const asks = !document.getElementById("request").hidden;
    if (asks) foglineDrive.take = () => {};  // the page stays in this state
    return asks;
  });
  await looksWell(page, "the request to take over");
  await page.evaluate(() => {
    foglineDrive.latency.values.push(250);
    foglineDrive.latency.recent.push({value: 250, at_ms: performance.now() + 60000});  // does not age
    dispatchEvent(new Event("blur"));
    foglineDrive.set = () => {};  // the person stays away
  });
  await page.waitForFunction(() => ["away", "latency-warning"].every((id) => !document.getElementById(id).hidden));
  await looksWell(page, "a person who has left, and a delay");
  await page.evaluate(() => { delete foglineDrive.set; });
  await page.click("#setup-open");
  await setPad(page);
  await page.selectOption("#device", "Test Wheel");
  await looksWell(page, "the device");
  await page.click("#setup-close");
  run.kill("SIGINT");
  await page.waitForFunction(() => document.getElementById("origin-words").textContent === "The program has ended");
  assert.match(await page.locator("#who").innerText(), /^The (program|drive) has ended/);
  assert.equal(await page.locator("#speed").innerText(), "–");
  for (const button of ["#begin", "#take-over", "#give-back"]) assert.ok(await page.locator(button).isDisabled());
  await looksWell(page, "the end of the program");
  // The page reports errors after the end of the program. The test ignores these errors.
  page.trouble = page.trouble.filter((words) => !/WebSocket|ERR_CONNECTION/.test(words));
});

// ---- both pages of an experiment. The test itself sends the states of a session to the pages, so
// it need not wait until a session reaches a state.

const ADDRESS = "http://127.0.0.1:7681/";  // there is no server at this address; the test answers
const TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css"};

const scale = (text, min, max, step, low, high) => ({text, kind: "scale", min, max, step, low, high});
const ITEMS = [
  scale("Mental demand: how much you had to think and watch", 0, 100, 5, "very low", "very high"),
  scale("How sleepy you are now", 1, 9, 1, "fully awake", "very sleepy, fighting sleep"),
  scale("A scale with more marks than a row has room for", 0, 100, 1, "low", "high"),
  {text: "Is there anything that you noticed?", kind: "text"},
];
const BOTH = {state: 1, practice: false, run: 2, of: 3, wait_s: 0, drives: true};
const DESK = {...BOTH, participant: 1, condition: "late, seed 102", questionnaire: "", view: "", lines: [
  "the run begins", `marker: ${"a long text without a break ".repeat(4)}`, "the run has ended",
].map((text, i) => ({at_ms: Date.UTC(2026, 0, 1) + 60_000 * i, text}))};
const ASKING = {...BOTH, stage: "asking", items: ITEMS};
const STATES = {
  "index.html": [
    {...BOTH, stage: "waiting"},
    {...BOTH, stage: "waiting", wait_s: 950},
    {...ASKING, refused: "the session does not wait for this now"},
    {...BOTH, stage: "finished"}],
  "experimenter.html": [
    {...DESK, stage: "waiting"},
    {...DESK, stage: "driving", view: `${ADDRESS}#token=0`, refused: "no run is under way"},
    {...DESK, stage: "asking", questionnaire: "workload"}],
};

/**
 * Opens a page of an experiment. @return {page, show, sent}: the page, a function that makes the
 * page show a state, and the objects that the page has sent
 */
async function experiment(t, main, options = {}) {
  let state = STATES[main][0];
  const sent = [];
  const page = await open(t, await browser(t), ADDRESS, {...options, prepare: async (context) => {
    await prepareLooks(context);
    await context.route(`${ADDRESS}**`, (route) => {
      const {pathname} = new URL(route.request().url());
      const file = path.join(root, "tools/trials/desk/page", pathname === "/" ? main : pathname);
      return existsSync(file) ? route.fulfill({path: file, contentType: TYPES[path.extname(file)]})
                              : route.fulfill({status: 404});
    });
    await context.routeWebSocket(/\/ws/, (socket) => {
      socket.onMessage((frame) => sent.push(JSON.parse(frame)));
      socket.send(JSON.stringify(state));
    });
  }});
  const show = async (wanted) => {
    state = wanted;
    await page.reload();
    await page.waitForFunction(() => document.getElementById("title").textContent !== "Connecting");
  };
  return {page, show, sent};
}

for (const [main, who] of [["index.html", "participant"], ["experimenter.html", "experimenter"]]) {
  test(`the ${who}'s page of an experiment looks well`, async (t) => {
    const {page, show} = await experiment(t, main);
    for (const state of STATES[main]) {
      await show(state);
      await looksWell(page, `${state.stage}, ${state.refused ?? "not refused"}`);
    }
  });
}

test("a scale without an answer is named below the scale, and nothing is sent", async (t) => {
  const {page, show, sent} = await experiment(t, "index.html");
  await show(ASKING);
  const marked = () => page.evaluate(() => [...document.querySelectorAll("[role=radiogroup]")].map((scale) => (
    scale.getAttribute("aria-invalid") === "true" && scale.querySelector(".missing").offsetHeight > 0)));
  const described = () => page.evaluate(() => [...document.querySelectorAll("[role=radiogroup]")].map((scale) => (
    scale.getAttribute("aria-describedby").split(" ").map((id) => document.getElementById(id))
      .filter((words) => words.matches(".missing")).map((words) => words.textContent).join())));
  const focused = () => page.evaluate(() => document.activeElement.name);
  await page.check('input[name="item-0"][value="50"]');
  await page.click("#questions button");
  assert.deepEqual(await marked(), [false, true, true]);
  assert.deepEqual(await described(), ["", "Please choose an answer.", "Please choose an answer."]);
  assert.equal(await focused(), "item-1");
  await looksWell(page, "missing answers");
  await page.check('input[name="item-1"][value="3"]');
  assert.deepEqual(await marked(), [false, false, true]);
  assert.deepEqual(await described(), ["", "", "Please choose an answer."]);
  await page.click("#questions button");
  assert.equal(await focused(), "item-2");
  assert.deepEqual(sent, []);
  await page.check('input[name="item-2"][value="7"]');
  await page.click("#questions button");
  assert.deepEqual(sent, [{op: "answers", state: 1, values: ["50", "3", "7", ""]}]);
});

test("a scale with few marks is one row; a finger can choose each mark of a scale with many", async (t) => {
  const {page, show} = await experiment(t, "index.html", {size: PHONE});
  await show(ASKING);
  const rows = await page.evaluate(() => [...document.querySelectorAll(".scale")].map((row) => (
    new Set([...row.children].map((mark) => mark.getBoundingClientRect().top)).size)));
  assert.equal(rows[1], 1);
  assert.ok(rows[0] > 1 && rows[2] > rows[0]);
  const narrowest = await page.evaluate(() => Math.min(
    ...[...document.querySelectorAll(".scale label")].map((mark) => mark.getBoundingClientRect().width)));
  assert.ok(narrowest >= 24, `${narrowest} px`);  // WCAG 2.2, 2.5.8
});
