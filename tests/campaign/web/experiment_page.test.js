// An experiment with people in headless Chromium: four participants drive three conditions each. A
// script acts as the participants: it begins each run, drives at the seat, and answers the
// questions. In the middle of one trial the test kills fogline-web.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readdirSync, readFileSync, writeFileSync} from "node:fs";
import path from "node:path";
import {test} from "node:test";

import WebSocket from "ws";

import {makeDecoder} from "../../../tools/web/page/data/lcm.js";
import {describedTypes, readEvents} from "../../unit/tools/web/page/real_log.js";
import {begin, drives, holdTakeOver, socketOf} from "./seat.js";
import {background, browser, DESKTOP, open, root, scratch, until} from "./window.js";

const {FOGLINE} = process.env;
const PARTICIPANTS = 4;
const CONDITIONS = {"secret-short": 10, "secret-middle": 14, "secret-long": 18};  // lead_s
const KILLED = {participant: 2, trial: 2};

/** Writes the file of the experiment. In each run the person is asked from the first step on. */
function writePlan(folder) {
  const file = path.join(folder, "experiment.json");
  const conditions = Object.entries(CONDITIONS).map(([name, lead_s]) => ({
    name, scenario: path.join(root, "scenario/drive.json"),
    set: ["/person/drives=true", "/arbitrator/threshold=0", "/steps=500", `/arbitrator/take_over/lead_s=${lead_s}`]}));
  writeFileSync(file, JSON.stringify({
    version: 1, title: "Test", participants: PARTICIPANTS, seeds: "trial", conditions,
    questionnaires: [{name: "kss", kind: "kss"}]}));
  return file;
}

/** Starts a session. @return {session, participant, experimenter}: its process and both addresses */
async function startSession(t, file, results, participant) {
  const session = background(t, FOGLINE, ["experiment", "run", file, "--results", results,
                                          "--participant", String(participant)]);
  session.on("exit", (code) => { session.code = code; });
  const [, forParticipant, forExperimenter] = await until(() => {
    assert.equal(session.code, undefined, session.said);
    return session.said.match(/participant: (http:\S+)\nexperimenter: (http:\S+)\n/);
  }, "the addresses of the session");
  return {session, participant: forParticipant, experimenter: forExperimenter};
}

/** Kills the fogline-web of a session, as kill -9 does. */
function killWeb({pid}) {
  const children = readFileSync(`/proc/${pid}/task/${pid}/children`, "utf8").trim().split(" ");
  const web = children.filter((child) => readFileSync(`/proc/${child}/comm`, "utf8") === "fogline-web\n");
  assert.equal(web.length, 1);
  process.kill(Number(web[0]), "SIGKILL");
}

/** Waits until the page has left the seat for the participant's page. */
const comesBack = (page, address) => page.waitForURL(({origin}) => origin === new URL(address).origin);

/**
 * The person drives at the seat until the run is over. @param during is called while the person
 * drives
 */
async function driveTrial(page, address, during) {
  await page.waitForURL(({pathname}) => pathname === "/drive");
  assert.ok(!page.url().includes("token"), page.url());
  await begin(page);
  await drives(page, true);
  await page.waitForFunction(() => !document.getElementById("request").hidden);
  // A busy machine may send no input for so long that the deadman stops the car. This test also
  // accepts such a stop.
  await holdTakeOver(page, "^(You drive|The car)");
  await page.keyboard.down("ArrowDown");
  await page.waitForFunction(() => document.getElementById("brake").value > 0.2);
  await page.keyboard.up("ArrowDown");
  await during();
  await comesBack(page, address);
}

/**
 * The states that the session sends to the participant's page from this time on, the newest last.
 */
function statesOf(t, address) {
  const states = [];
  const socket = new WebSocket(socketOf(address));
  socket.on("message", (data) => states.push(JSON.parse(data)));
  t.after(() => socket.close());
  return states;
}

/**
 * Kills fogline-web while the person drives. The person drives on when fogline-web runs again, and
 * both pages of the session show this.
 */
async function killDuring(t, started, page, {session, participant, experimenter}) {
  const states = statesOf(t, participant);
  await until(() => states.at(-1)?.seat, "the seat in the participant's state");
  const {seat} = states.at(-1);
  killWeb(session);
  await page.waitForFunction(() => !foglineDrive.wire.isOpen);
  await until(() => states.at(-1).seat === "", "the participant's state without a seat");
  await until(() => states.at(-1).seat, "the seat to be back in the participant's state");
  assert.equal(states.at(-1).seat, seat);
  await page.waitForFunction(() => foglineDrive.wire.isOpen && foglineDrive.state === "yours");
  const desk = await open(t, started, experimenter, {size: DESKTOP});
  await desk.waitForFunction(() => document.getElementById("lines").textContent.includes("fogline-web runs again"));
  await desk.close();
  await drives(page, true);
  // The connections that were refused at that time are not errors of the page.
  page.trouble = page.trouble.filter((words) => !/WebSocket|ERR_CONNECTION/.test(words));
}

async function answer(page, value) {
  await page.check(`#questions input[value="${value}"]`);
  await page.click("#questions button");
}

/** Makes all trials of a participant. */
async function takePart(t, started, pages, participant, onFirst) {
  const {session, participant: address} = pages;
  const page = await open(t, started, address, {size: DESKTOP, allPorts: true});
  for (let trial = 1; trial <= Object.keys(CONDITIONS).length; ++trial) {
    await page.waitForFunction((words) => document.getElementById("title").textContent === words,
                               `Run ${trial} of 3`);
    assert.doesNotMatch(await page.content(), /secret|threshold|lead/i);
    await page.click("#begin");
    await driveTrial(page, address, async () => {
      assert.doesNotMatch(await page.content(), /secret|threshold|conflict/i);
      if (participant === KILLED.participant && trial === KILLED.trial) await killDuring(t, started, page, pages);
      if (trial === 1) await onFirst?.();
    });
    await page.waitForSelector("#questions input");
    await answer(page, participant + trial);
  }
  await page.waitForFunction(() => document.getElementById("title").textContent === "That was the last run");
  await session.ended;
  assert.equal(session.code, 0, session.said);
}

/** The rows of a CSV file without quotes, as objects with the names of the columns. */
function rowsOf(file) {
  const [head, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => {
    assert.equal(row.length, head.length);
    return Object.fromEntries(head.map((name, i) => [name, row[i]]));
  });
}

/**
 * Each participant drives each condition once. In the trials of the first three participants, each
 * place of the order has each condition once.
 */
function assertLatinSquare(rows) {
  const names = Object.keys(CONDITIONS).sort();
  const conditionsOf = (wanted) => rows.filter(wanted).map(({condition}) => condition).sort();
  for (let participant = 1; participant <= PARTICIPANTS; ++participant) {
    assert.deepEqual(conditionsOf((row) => Number(row.participant) === participant), names);
  }
  for (let place = 1; place <= names.length; ++place) {
    assert.deepEqual(conditionsOf((row) => Number(row.trial) === place && Number(row.participant) <= 3), names);
  }
}

/** The instances of the seat in a log, if its person was present. */
function seatsIn(log) {
  const decode = makeDecoder(describedTypes(), "driver_input_t");
  const inputs = readEvents(log).filter(({channel}) => channel === "DRIVER_INPUT").map(({bytes}) => decode(bytes));
  return new Set(inputs.filter(({present}) => present).map(({instance}) => String(instance)));
}

test("four participants drive three conditions; a kill of fogline-web loses nothing", async (t) => {
  const folder = scratch(t);
  const file = writePlan(folder);
  const results = path.join(folder, "results");
  const started = await browser(t);
  for (let participant = 1; participant <= PARTICIPANTS; ++participant) {
    const pages = await startSession(t, file, results, participant);
    let onFirst = null;
    if (participant === 1) {
      const desk = await open(t, started, pages.experimenter, {size: DESKTOP});
      onFirst = async () => {
        assert.match(await desk.locator("#words").innerText(), /secret-\w+, seed \d+/);
        assert.match(await desk.locator("#view").getAttribute("href"), /^http:\/\/127\.0\.0\.1:\d+\/#token=\w+$/);
        await desk.fill("#marker-text", "looks away");
        await desk.click("#marker button");
        await desk.waitForFunction(() => document.getElementById("lines").textContent.includes("looks away"));
        await desk.close();
      };
    }
    await takePart(t, started, pages, participant, onFirst);
    const killed = participant === KILLED.participant;
    assert.equal(pages.session.said.includes("fogline-web was killed by signal 9"), killed, pages.session.said);
  }

  execFileSync(FOGLINE, ["experiment", "status", file, "--results", results], {stdio: "pipe"});  // all are done
  const tables = path.join(folder, "tables");
  execFileSync(FOGLINE, ["experiment", "export", file, "--results", results, "--out", tables], {stdio: "pipe"});
  const rows = rowsOf(path.join(tables, "trials.csv"));
  assert.equal(rows.length, 12);
  assertLatinSquare(rows);
  for (const row of rows) {
    const [participant, trial] = [Number(row.participant), Number(row.trial)];
    assert.deepEqual([row.state, row.attempt, row["kss.sleepiness"], row.markers],
                     ["done", "1", String(participant + trial), participant === 1 && trial === 1 ? "1" : "0"]);
    const log = path.join(results, `participant-0${participant}`,
                          `trial-${trial}-${row.condition}.lcm`);
    execFileSync(FOGLINE, ["replay", log, "--role", "driver"], {stdio: "pipe"});
    const killed = participant === KILLED.participant && trial === KILLED.trial;
    assert.equal(seatsIn(log).size, killed ? 2 : 1, log);
  }
  const logs = readdirSync(results, {recursive: true}).filter((name) => name.endsWith(".lcm"));
  assert.equal(logs.length, 12, `nothing was run twice: ${logs}`);
});
