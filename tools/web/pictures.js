// Makes the pictures of README.md and docs/, with the browser of the campaign tests. tools/pictures
// calls this file with the names of the pictures.

import {execFileSync} from "node:child_process";
import {statSync} from "node:fs";
import path from "node:path";

import {begin, drives, startDrive} from "../../tests/campaign/web/seat.js";
import {background, browser, goTo, open, root, scratch, until, view} from "../../tests/campaign/web/window.js";

const {FOGLINE} = process.env;
const MOST_BYTES = 250000;  // limit for a picture, so that a clone of the repository stays small
const WIDTH = 1280;         // of a picture; GitHub shows it in about 850 pixels
// Number of colours of a picture. More would need three times the bytes for no visible gain.
const COLOURS = 256;
const SCHEME = {colorScheme: "light"};

/** Waits until the browser has drawn everything that the page has asked for. */
const drawn = (page) => page.evaluate(async () => {
  for (let i = 0; i < 5; ++i) await new Promise(requestAnimationFrame);
});

/** Runs fogline to its end. */
const fogline = (...args) => execFileSync(FOGLINE, args, {cwd: root, stdio: ["ignore", "ignore", "inherit"]});

/** Makes the picture of the report of tools/demo. */
async function report(t, started, file) {
  const folder = scratch(t);
  fogline("table", "scenario/paper.json", "--transport", "direct", "--logs", folder);
  const logs = ["none", "0.2", "0.5", "0.8"].map((threshold) => (
    path.join(folder, `paper-seed1-threshold-${threshold}.lcm`)));
  const out = path.join(folder, "report.html");
  fogline("report", ...logs, "--curves", "scenario/paper.json", "--output", out);
  const page = await open(t, started, `file://${out}`, {size: {width: WIDTH, height: 1000}, ...SCHEME});
  await page.waitForFunction(() => document.querySelectorAll("#curves canvas").length >= 2);
  const height = await page.evaluate(() => {
    const ends = [...document.querySelectorAll("#curves figure")].map((e) => e.getBoundingClientRect().bottom);
    return Math.ceil(Math.max(...ends)) + 16;
  });
  await page.setViewportSize({width: WIDTH, height});
  await drawn(page);
  await page.screenshot({path: file});
}

/**
 * Makes the picture of the page of `fogline view`: a run in dense fog, 0.3 s after the last
 * take-over by the human.
 */
async function window(t, started, file) {
  const log = path.join(scratch(t), "dense_fog-1.lcm");
  fogline("run", "scenario/dense_fog.json", "--transport", "direct", "--log", log);
  const page = await open(t, started, await view(t, [log]), {size: {width: WIDTH, height: 1000}, ...SCHEME});
  await page.waitForFunction(() => foglinePage.log?.events.length > 0);
  const step = await page.evaluate(() => (
    foglinePage.log.events.findLast(({text}) => text === "transfer to the human").step));
  await goTo(page, step + 3);
  await page.waitForFunction(() => foglinePage.scene.view && foglinePage.curves.charts.length > 0);
  // The time bar stays at the bottom of the window. With this height of the window, the time bar
  // begins where the section `health` begins. So it covers nothing of the sections above, and the
  // picture shows no part of `health`.
  const height = await page.evaluate(() => Math.ceil(
    document.getElementById("health").offsetTop + document.getElementById("timebar").offsetHeight));
  await page.setViewportSize({width: WIDTH, height});
  await page.waitForFunction((wanted) => document.getElementById("who").textContent === wanted, "The human drives");
  await page.waitForTimeout(1000);  // the charts pause for at most this time between two drawings
  await drawn(page);
  await page.screenshot({path: file});
}

/**
 * Makes the picture of the seat at a request to take over. With early fog the request comes early.
 */
async function drive(t, started, file) {
  const {address} = await startDrive(t, {"/fog/start_s": 3});
  const page = await open(t, started, address, {size: {width: WIDTH, height: 850}, ...SCHEME});
  await begin(page);
  await drives(page, true);
  // A busy machine may need seconds for the picture. The countdown must not go on in this time. So
  // the page takes no more messages as soon as the text of the time left begins with 9.
  await page.waitForFunction(() => {
    const isThere = document.getElementById("request-left").textContent.startsWith("9");
    if (isThere) foglineDrive.take = () => {};
    return isThere;
  });
  await page.evaluate(() => {
    document.activeElement.blur();
    // Draws all pixels. The page omits some of them if a picture takes long.
    foglineDrive.budget.level = 0;
    foglineDrive.budget.judge = () => {};
  });
  await drawn(page);
  await page.screenshot({path: file});
}

/**
 * Begins the next run at the participant's page, and waits for its questions.
 * @param during is called during the run
 */
async function makeRun(page, during = async () => {}) {
  await page.click("#begin");
  await page.waitForFunction(() => document.getElementById("words").textContent === "The run is under way.");
  await during();
  await page.waitForSelector("#questions input");
}

/**
 * Makes the picture of both pages of an experiment, side by side. The participant answers the
 * questions.
 */
async function experiment(t, started, file) {
  const session = background(t, FOGLINE, [
    "experiment", "run", "scenario/experiment/thresholds.json", "--participant", "1", "--results", scratch(t),
    "--speed", "10", "--no-breaks"]);
  const [, participant, experimenter] = await until(
    () => session.said.match(/participant: (http:\S+)\nexperimenter: (http:\S+)\n/), "the addresses of the session");
  const size = {width: WIDTH / 2 - 12, height: 800};
  const desk = await open(t, started, experimenter, {size, ...SCHEME});
  const page = await open(t, started, participant, {size, ...SCHEME});
  await makeRun(page);
  await page.check('#questions input[value="3"]');
  await page.click("#questions button");
  await page.waitForSelector("#begin:not([hidden])");
  await makeRun(page, async () => {
    await desk.fill("#marker-text", "looks away");
    await desk.click("#marker button");
    await desk.waitForFunction(() => document.getElementById("lines").textContent.includes("looks away"));
  });
  await page.check('#questions input[value="4"]');
  await page.click("#questions button");
  await page.waitForSelector('#questions input[name="item-5"]');
  for (const [item, value] of [60, 15, 55, 30].entries()) {
    await page.check(`#questions input[name="item-${item}"][value="${value}"]`);
  }
  await page.evaluate(() => document.activeElement.blur());
  size.height = await page.evaluate(() => document.documentElement.scrollHeight);
  for (const one of [page, desk]) await one.setViewportSize(size);
  const [left, right] = await Promise.all([page, desk].map(async (one) => (
    `data:image/png;base64,${(await one.screenshot()).toString("base64")}`)));
  const both = await started.newPage({viewport: {width: WIDTH, height: size.height + 44}, ...SCHEME});
  const part = (name, image) => `<div><h1>${name}</h1><img src="${image}"></div>`;
  await both.setContent(`<!DOCTYPE html><style>
    body { display: flex; gap: 24px; margin: 0; background: #c9ced2; font: 600 17px/44px system-ui, sans-serif; }
    h1 { margin: 0 0 0 16px; font: inherit; }
    img { display: block; }
    </style>${part("The participant’s page", left)}${part("The experimenter’s page", right)}`);
  await both.screenshot({path: file});
  await both.close();
}

const PICTURES = {report, view: window, drive, experiment};

/** Calls `make`, and then ends everything that `make` has started. */
async function attempt(make) {
  const ends = [];
  try {
    await make({after: (end) => ends.push(end)});
  } finally {
    for (const end of ends.reverse()) await end();
  }
}

for (const name of process.argv.slice(2)) {
  const file = path.join(root, `docs/${name}.png`);
  await attempt(async (t) => PICTURES[name](t, await browser(t), file));
  // Removes the time of writing, so that equal pictures have equal bytes.
  execFileSync("convert", [file, "-strip", "+dither", "-colors", String(COLOURS), "-define", "png:compression-level=9",
                           file]);
  const {size} = statSync(file);
  console.log(`docs/${name}.png: ${Math.round(size / 1000)} kB`);
  if (size > MOST_BYTES) throw new Error(`docs/${name}.png has more than ${MOST_BYTES / 1000} kB`);
}
