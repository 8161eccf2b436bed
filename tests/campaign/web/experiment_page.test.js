// An experiment with people in headless Chromium: after a practice run, four participants drive
// three conditions each. A script acts as the participants: it begins each run, drives at the seat,
// and answers the questions. In the middle of one trial the test kills fogline-web. Everything that
// the script has typed must be in the tables.
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
const PRACTICE = 0;  // number of the practice run
const BREAK_S = 5;   // the break after the first trial
const MARKER = "looks away, \"tired\", m\u00fcde";
const SCALES = ["mental_demand", "physical_demand", "temporal_demand", "performance", "effort", "frustration"];

/**
 * Writes the file of the experiment. Each run asks the person to take over from the first step on.
 * If a busy machine sends no input for longer than /person/deadman_s, the person counts as absent,
 * but may take over again.
 */
function writePlan(folder) {
  const file = path.join(folder, "experiment.json");
  const condition = (name, lead_s) => ({
    name, scenario: path.join(root, "scenario/drive.json"),
    set: ["/person/drives=true", "/person/when_gone=until_back", "/arbitrator/threshold=0", "/steps=500",
          `/arbitrator/take_over/lead_s=${lead_s}`]});
  writeFileSync(file, JSON.stringify({
    version: 1, title: "\u00e4".repeat(50), participants: PARTICIPANTS, seeds: "trial",  // the longest title
    conditions: Object.entries(CONDITIONS).map(([name, lead_s]) => condition(name, lead_s)),
    practice: [condition("secret-practice", 12)],
    breaks: [{after_trial: 1, at_least_s: BREAK_S}],
    questionnaires: [
      {name: "kss", kind: "kss", practice: true},
      {name: "tlx", kind: "nasa_tlx"},
      {name: "own", kind: "own", items: [
        {name: "guess", text: "How fast was the car?", min: 0, max: 200, step: 10, unit: "km/h, estimated"},
        {name: "remark", text: "What did you notice?", kind: "text"}]}]}));
  return file;
}

/** The answers after a run: for each questionnaire its items and their answers. */
function answersAfter(participant, trial) {
  const sleepiness = {"kss.sleepiness": participant + trial};
  if (trial === PRACTICE) return [sleepiness];
  return [
    sleepiness,
    Object.fromEntries(SCALES.map((name, i) => [`tlx.${name}`, 5 * (participant + trial + i)])),
    {"own.guess": 10 * (participant + trial), "own.remark": `\u201egut\u201c, "${participant}", f\u00fcr ${trial}`}];
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

/** Waits until the browser shows the participant's page again, in place of the seat's page. */
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
  await holdTakeOver(page, "^You drive");
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
 * Kills fogline-web while the person drives. Expects that the person drives again when fogline-web
 * runs again, and that both pages of the session are told of the interruption.
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
  // The page logs an error for each connection that was refused while fogline-web was away. The
  // test expects these errors.
  page.trouble = page.trouble.filter((words) => !/WebSocket|ERR_CONNECTION/.test(words));
}

/** Answers a questionnaire. @param answers by item; a number is the answer on a scale */
async function answer(page, answers) {
  const values = Object.values(answers);
  await page.waitForFunction((count) => !document.getElementById("questions").hidden
    && document.querySelectorAll("#questions fieldset").length === count, values.length);
  for (const [i, value] of values.entries()) {
    if (typeof value === "number") await page.check(`#questions input[name="item-${i}"][value="${value}"]`);
    else await page.fill(`#questions textarea[name="item-${i}"]`, value);
  }
  await page.click("#questions button");
}

/** Waits until the page shows the next run, and begins this run when the break is over. */
async function beginRun(page, trial) {
  await page.waitForFunction((words) => document.getElementById("title").textContent === words,
                             trial === PRACTICE ? "Practice run 1 of 1" : `Run ${trial} of 3`);
  assert.doesNotMatch(await page.content(), /secret|threshold|lead/i);
  if (trial === 2) {
    await page.waitForFunction(() => document.getElementById("begin").disabled
      && document.getElementById("words").textContent.startsWith("You have a break."));
  }
  await page.click("#begin");
}

/** Makes the practice run and all trials of a participant. */
async function takePart(t, started, pages, participant, onFirst) {
  const {session, participant: address} = pages;
  const page = await open(t, started, address, {size: DESKTOP, allPorts: true});
  for (let trial = PRACTICE; trial <= Object.keys(CONDITIONS).length; ++trial) {
    await beginRun(page, trial);
    await driveTrial(page, address, async () => {
      assert.doesNotMatch(await page.content(), /secret|threshold|conflict/i);
      if (participant === KILLED.participant && trial === KILLED.trial) await killDuring(t, started, page, pages);
      if (trial === 1) await onFirst?.();
    });
    for (const answers of answersAfter(participant, trial)) await answer(page, answers);
  }
  await page.waitForFunction(() => document.getElementById("title").textContent === "That was the last run");
  await session.ended;
  assert.equal(session.code, 0, session.said);
}

/** The cells of a line of a CSV file, as in RFC 4180. The first cell must not be empty. */
function cellsOf(line) {
  return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,"]*))/g)]
    .map(([, quoted, plain]) => quoted?.replaceAll('""', '"') ?? plain);
}

/** The rows of a CSV file as objects with the names of the columns. */
function rowsOf(file) {
  const [head, ...rows] = readFileSync(file, "utf8").trimEnd().split("\n").map(cellsOf);
  return rows.map((row) => {
    assert.equal(row.length, head.length, `${row}`);
    return Object.fromEntries(head.map((name, i) => [name, row[i]]));
  });
}

/** The number of a row's trial; PRACTICE for a practice run. */
const trialOf = ({practice, trial}) => (practice === "1" ? PRACTICE : Number(trial));

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
  for (const row of rows) {
    const [, ...places] = row.order.match(/^(\S+) (\S+) (\S+)$/);
    assert.equal(row.condition, places[row.trial - 1]);
  }
  for (let place = 1; place <= names.length; ++place) {
    assert.deepEqual(conditionsOf((row) => Number(row.trial) === place && Number(row.participant) <= 3), names);
  }
}

/** The decoded messages of a channel in a log. */
function messagesIn(log, wanted, type) {
  const decode = makeDecoder(describedTypes(), type);
  return readEvents(log).filter(({channel}) => channel === wanted).map(({bytes}) => decode(bytes));
}

/** The instances of the seat in a log: those that sent inputs of a present person. */
const seatsIn = (log) => new Set(messagesIn(log, "DRIVER_INPUT", "driver_input_t")
  .filter(({present}) => present).map(({instance}) => String(instance)));

/** The wall-clock time of the first fact of this kind in a log, s. */
function timeOf(log, kind) {
  const {constants} = describedTypes().trial_t;
  return Number(messagesIn(log, "TRIAL", "trial_t").find((fact) => fact.kind === constants[kind]).unix_us) / 1e6;
}

/** The measures of a log by the names of their columns, from `fogline metrics`. */
function measuresOf(log) {
  const [run] = JSON.parse(execFileSync(FOGLINE, ["metrics", log, "--json"], {encoding: "utf8"}));
  const named = (prefix, values) => Object.entries(values).map(([name, value]) => [prefix + name, value]);
  return Object.fromEntries([
    ...named("", run.metrics), ["requests", run.take_overs.length],
    ...named("first_request_", run.take_overs[0]), ...named("input_latency_", run.input_latency)]);
}

/** Checks that the row has the measures of its log, and that values.csv has the same values. */
function assertMeasures(row, log, values) {
  const measures = measuresOf(log);
  for (const [name, value] of Object.entries(measures)) {
    assert.ok(name in row, name);
    const cell = row[name];
    assert.equal(typeof value === "number" && cell !== "" ? Number(cell) : cell, value ?? "", name);
  }
  const known = Object.keys(measures).filter((name) => row[name] !== "");
  const metrics = values.filter((one) => one.kind === "metric" && one.participant === row.participant
    && one.practice === row.practice && one.trial === row.trial);
  assert.deepEqual(metrics.map(({item, value}) => [item, value]), known.map((name) => [name, row[name]]));
}

/** Checks that values.csv has each typed answer, and the marker of the experimenter. */
function assertAnswersAndMarker(values) {
  const typed = {};
  for (let participant = 1; participant <= PARTICIPANTS; ++participant) {
    for (let trial = PRACTICE; trial <= 3; ++trial) {
      for (const [item, value] of answersAfter(participant, trial).flatMap(Object.entries)) {
        typed[`${participant} ${trial} ${item}`] = String(value);
      }
    }
  }
  const answers = values.filter(({kind}) => kind === "answer");
  const told = answers.map((row) => [`${row.participant} ${trialOf(row)} ${row.item}`, row.value]);
  assert.deepEqual(Object.fromEntries(told), typed);
  assert.equal(answers.length, Object.keys(typed).length);
  for (const {item, unit} of answers) assert.equal(unit, item === "own.guess" ? "km/h, estimated" : "");
  const markers = values.filter(({kind}) => kind === "marker");
  assert.deepEqual(markers.map((row) => [row.participant, trialOf(row), row.value]), [["1", 1, MARKER]]);
  assert.ok(Number(markers[0].time_s) > 0 && Number(markers[0].time_s) < 10, markers[0].time_s);
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
        await desk.fill("#marker-text", MARKER);
        await desk.click("#marker button");
        await desk.waitForFunction((text) => document.getElementById("lines").textContent.includes(text), MARKER);
        await desk.close();
      };
    }
    await takePart(t, started, pages, participant, onFirst);
    const killed = participant === KILLED.participant;
    assert.equal(pages.session.said.includes("fogline-web was killed by signal 9"), killed, pages.session.said);
  }

  // This call fails unless all trials are done.
  execFileSync(FOGLINE, ["experiment", "status", file, "--results", results], {stdio: "pipe"});
  const tables = path.join(folder, "tables");
  execFileSync(FOGLINE, ["experiment", "export", file, "--results", results, "--out", tables], {stdio: "pipe"});
  const runs = rowsOf(path.join(tables, "trials.csv"));
  const values = rowsOf(path.join(tables, "values.csv"));
  assert.equal(runs.length, PARTICIPANTS * 4);
  const rows = runs.filter(({practice}) => practice === "0");
  assert.equal(rows.length, 12);
  assertLatinSquare(rows);
  assertAnswersAndMarker(values);
  const logOf = (row) => path.join(results, row.log);
  for (const row of runs) {
    const [participant, trial] = [Number(row.participant), trialOf(row)];
    const isFirst = participant === 1 && trial === 1;
    assert.deepEqual([row.state, row.complete, row.attempt, row.markers], ["done", "1", "1", isFirst ? "1" : "0"]);
    assert.equal(row.log, `participant-0${participant}/${trial === PRACTICE ? "practice-1" : `trial-${trial}`}`
      + `-${row.condition}.lcm`);
    if (trial !== PRACTICE) assert.equal(row.seed, String(3 * (participant - 1) + trial));
    for (const [item, value] of answersAfter(participant, trial).flatMap(Object.entries)) {
      assert.equal(row[item], String(value), item);
    }
    assertMeasures(row, logOf(row), values);
    assert.match(row.first_request_outcome, /^taken_over(_late)?$/);
    assert.ok(Number(row.first_request_take_over_time_s) > 0, row.first_request_take_over_time_s);
    execFileSync(FOGLINE, ["replay", logOf(row), "--role", "driver"], {stdio: "pipe"});
    const killed = participant === KILLED.participant && trial === KILLED.trial;
    assert.equal(seatsIn(logOf(row)).size, killed ? 2 : 1, row.log);
  }
  for (let participant = 1; participant <= PARTICIPANTS; ++participant) {
    const [first, second] = rows.filter((row) => Number(row.participant) === participant).map(logOf);
    const break_s = timeOf(second, "BEGIN") - timeOf(first, "END");
    assert.ok(break_s >= BREAK_S, `a break of ${break_s} s`);
  }
  const logs = readdirSync(results, {recursive: true}).filter((name) => name.endsWith(".lcm"));
  assert.equal(logs.length, 16, `nothing was run twice: ${logs}`);
});
