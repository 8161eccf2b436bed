// Lighthouse's audit of accessibility, on a phone and on a desktop. It examines each page only as
// the page is after loading. The other tests of the pages check the rules in other states.
import assert from "node:assert/strict";
import path from "node:path";
import {test} from "node:test";

import lighthouse, {desktopConfig} from "lighthouse";

import {freshNetwork, seat} from "../seat.js";
import {background, recordedRun, root, scratch, until, view} from "../window.js";

const {CHROMIUM, FOGLINE} = process.env;
const LEAST_SCORE = 0.95;

/** Starts a browser. @return the port of its debugging protocol */
async function debuggedBrowser(t) {
  const started = background(t, CHROMIUM, [
    "--headless", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run", "--remote-debugging-port=0",
    `--user-data-dir=${scratch(t)}`, "about:blank"]);
  return Number(await until(() => started.said.match(/DevTools listening on ws:\/\/[^:]+:(\d+)/)?.[1], "the browser"));
}

/** Both addresses of a session of an experiment. */
async function experiment(t) {
  const session = background(t, FOGLINE, [
    "experiment", "run", path.join(root, "scenario/experiment/thresholds.json"), "--participant", "1",
    "--results", scratch(t), "--no-breaks"]);
  const [, participant, experimenter] = await until(
    () => session.said.match(/participant: (http:\S+)\nexperimenter: (http:\S+)\n/), "the addresses of the session");
  return {participant, experimenter};
}

const PAGES = {
  "view, a log": async (t) => `${(await view(t, [recordedRun(scratch(t))])).replace(/#.*/, "")}#step=300`,
  "view, no run yet": (t) => view(t, ["--lcm-url", freshNetwork()]),
  "drive": async (t) => (await seat(t, freshNetwork())).drive,
  "an experiment, the participant": async (t) => (await experiment(t)).participant,
  "an experiment, the experimenter": async (t) => (await experiment(t)).experimenter,
};

for (const [name, start] of Object.entries(PAGES)) {
  test(`Lighthouse gives 95 points or more for accessibility: ${name}`, async (t) => {
    const port = await debuggedBrowser(t);
    const address = await start(t);
    for (const [device, config] of [["phone", undefined], ["desktop", desktopConfig]]) {
      const {lhr} = await lighthouse(address, {port, onlyCategories: ["accessibility"], logLevel: "error"}, config);
      assert.equal(lhr.runtimeError, undefined);
      const {score} = lhr.categories.accessibility;
      t.diagnostic(`${device}: ${100 * score}`);
      const failed = Object.values(lhr.audits).filter((audit) => audit.score === 0).map(({id}) => id);
      assert.ok(score >= LEAST_SCORE, `${device}: ${100 * score}, because of ${failed.join(", ")}`);
    }
  });
}
