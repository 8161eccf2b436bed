// The looks of both pages of an experiment: accessibility, and the room that they need. The test
// itself sends the states of a session, so each state is there at once.
import assert from "node:assert/strict";
import {existsSync} from "node:fs";
import path from "node:path";
import {test} from "node:test";

import {breaches, browser, DESKTOP, open, PHONE, root} from "./window.js";

const ADDRESS = "http://127.0.0.1:7681/";  // no program listens there: the test answers
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
  "the run begins", `marker: ${"a long text without a break ".repeat(4)}`, "the run has ended"]};
const STATES = [
  ["index.html", {...BOTH, stage: "waiting"}],
  ["index.html", {...BOTH, stage: "waiting", wait_s: 95}],
  ["index.html", {...BOTH, stage: "asking", items: ITEMS}],
  ["index.html", {...BOTH, stage: "finished"}],
  ["experimenter.html", {...DESK, stage: "waiting"}],
  ["experimenter.html", {...DESK, stage: "driving", view: `${ADDRESS}#token=0`, refused: "it does not fit the state"}],
  ["experimenter.html", {...DESK, stage: "asking", questionnaire: "workload"}],
];

/** Opens a page of an experiment that is in this state. */
async function shown(t, started, [main, state], options) {
  const page = await open(t, started, ADDRESS, {...options, prepare: async (context) => {
    await context.route(`${ADDRESS}**`, (route) => {
      const {pathname} = new URL(route.request().url());
      const file = path.join(root, "tools/trials/desk/page", pathname === "/" ? main : pathname);
      return existsSync(file) ? route.fulfill({path: file, contentType: TYPES[path.extname(file)]})
                              : route.fulfill({status: 404});
    });
    await context.routeWebSocket(/\/ws/, (socket) => socket.send(JSON.stringify(state)));
  }});
  await page.waitForFunction(() => document.getElementById("title").textContent !== "Connecting");
  return page;
}

for (const [name, options] of [["desktop", {size: DESKTOP}], ["phone", {size: PHONE}],
                               ["dark phone", {size: PHONE, colorScheme: "dark"}]]) {
  test(`the pages of an experiment break no rule of accessibility and fit their window (${name})`, async (t) => {
    const started = await browser(t);
    for (const one of STATES) {
      const page = await shown(t, started, one, options);
      const what = `${one[0]}, ${one[1].stage}`;
      assert.deepEqual(await breaches(page), [], what);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `${what}: ${wide} px too wide`);
      const out = await page.evaluate(() => {
        const column = document.querySelector("main");
        const end = column.getBoundingClientRect().right - parseFloat(getComputedStyle(column).paddingRight);
        return [...document.querySelectorAll("button, input, textarea, .ends")]
          .filter((element) => element.getBoundingClientRect().right > end + 1).length;
      });
      assert.equal(out, 0, `${what}: parts that stand out of the column`);
      await page.close();
    }
  });
}

test("a scale with few marks is one row, and its ends are named below them", async (t) => {
  const started = await browser(t);
  const page = await shown(t, started, STATES[2], {size: PHONE});
  const rows = await page.evaluate(() => [...document.querySelectorAll(".scale")].map((row) => (
    new Set([...row.children].map((mark) => mark.getBoundingClientRect().top)).size)));
  assert.deepEqual(rows.slice(0, 2), [1, 1]);
  assert.ok(rows[2] > 1);
});
