// A person drives with `fogline drive` and its page in headless Chromium, from the request to take
// over until the automation drives again. A script acts as the person, with the keys or with a
// wheel.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {test} from "node:test";

import {makeDecoder} from "../../../tools/web/page/data/lcm.js";
import {describedTypes, readEvents} from "../../unit/tools/web/page/real_log.js";
import {begin, drives, holdTakeOver, setPad, startDrive, withFakePads} from "./seat.js";
import {browser, DESKTOP, open, PHONE, root, until} from "./window.js";

const {FOGLINE} = process.env;
const WHEEL = {throttle: {axis: 0, released: 1, pressed: -1, dead: 0.02},
               brake: {axis: 1, released: 1, pressed: -1, dead: 0.02}, take_over: 0, give_back: 1};

// The defaults of /person/deadman_s and /person/coasting_mps2, and the step of scenario/drive.json.
const DEADMAN_S = 0.3;
const RELEASED_MPS2 = -0.5;
const PERIOD_S = 0.02;
const TAKE_OVER_PEDAL = "0.1";  // the default of /person/take_over_pedal
// Scheduling allowance: the time for which the machine may delay the messages of page and driver.
const ALLOWANCE_S = 0.25;

// The events of scenario/drive.json, shortened to 30 s. The fog lasts from 3 s to 18 s, and the car
// ahead brakes at 12 s.
const STORY = {
  "/steps": 1500, "/fog/start_s": 3, "/fog/duration_s": 15,
  "/lead/breakpoints": [{duration_s: 12, speed_mps: 20}, {duration_s: 3, speed_mps: 12},
                        {duration_s: 3, speed_mps: 12}, {duration_s: 6, speed_mps: 20}],
};

/** Starts `fogline drive`, and opens its page. @return {page, log, run} */
async function drive(t, settings = {}, options = {}) {
  const {run, log, address} = await startDrive(t, {...STORY, ...settings});
  return {page: await open(t, await browser(t), address, {size: DESKTOP, ...options}), log, run};
}

/**
 * Fails if the run has ended, or if `holds` is false. Without this check the test would then wait
 * without an end.
 */
function assertGoesOn(run, holds, what) {
  assert.equal(run.code, undefined, `the run has ended: ${run.said}`);
  assert.ok(holds, `${what}; the run says: ${run.said}`);
}

/** Waits until the page says with these words who drives. */
const says = (page, words) => page.waitForFunction(
  (wanted) => document.getElementById("who").textContent.startsWith(wanted), words);

/**
 * Follows the car ahead with a time gap while the human drives. The script acts every 40 ms. It
 * takes its values from the newest messages of the page. The page shows the same messages to a
 * person.
 */
async function follow(page, run, pedals, until_s) {
  for (;;) {
    const seen = await page.evaluate(() => {
      const {TRUTH: truth, HOST_COMMAND: command} = foglineDrive.newest.frame;
      const gap_m = truth.preceding_position_m - foglineDrive.length_m - truth.host_position_m;
      return {time_s: truth.header.utime / 1e6, gap_m, speed_mps: truth.host_speed_mps,
              lead_mps: truth.preceding_speed_mps, lambda_human: command.lambda_human};
    });
    assertGoesOn(run, seen.lambda_human > 0.5, `the person does not drive at ${seen.time_s} s`);
    if (seen.time_s >= until_s) return;
    const wanted = 0.25 * (seen.gap_m - 5 - 1.4 * seen.speed_mps) + 0.9 * (seen.lead_mps - seen.speed_mps);
    await pedals(wanted);
    await page.waitForTimeout(40);  // the reaction time of this person
  }
}

/** Pedals by keys. A key is either pressed or not. */
function keys(page) {
  const down = {ArrowUp: false, ArrowDown: false};
  const hold = async (key, wanted) => {
    if (down[key] === wanted) return;
    down[key] = wanted;
    await (wanted ? page.keyboard.down(key) : page.keyboard.up(key));
  };
  return async (wanted) => {
    await hold("ArrowDown", wanted < -0.8);
    await hold("ArrowUp", wanted > 0.3);
  };
}

/** Pedals of a wheel. */
const wheel = (page) => (wanted) => setPad(page, {
  axes: [1 - 2 * Math.min(1, Math.max(0, (wanted + 0.5) / 3)), 1 - 2 * Math.min(1, Math.max(0, -wanted / 8))]});

/** Plugs a calibrated wheel in. */
async function plugIn(page) {
  await page.evaluate((calibration) => {
    localStorage.setItem("fogline.drive.calibration.Test Wheel", JSON.stringify(calibration));
    localStorage.setItem("fogline.drive.device", "Test Wheel");
  }, WHEEL);
  await setPad(page);
  await page.waitForFunction(() => foglineDrive.person.device.id === "Test Wheel");
}

/** The person answers a request to take over. */
async function takeOver(page, isWheel) {
  if (!isWheel) return holdTakeOver(page, "^You drive");
  await setPad(page, {down: [0]});
  return says(page, "You drive");
}

/** The decoded messages of a channel in a log. */
function messagesOf(log, channel, type) {
  const decode = makeDecoder(describedTypes(), type);
  return readEvents(log).filter((event) => event.channel === channel).map(({bytes}) => decode(bytes));
}

/** The delays in a log, in us. Equal values that follow each other count once. */
function latenciesOf(inputs) {
  const values = inputs.map(({latency_us}) => Number(latency_us)).filter((value) => value >= 0);
  return values.filter((value, i) => value !== values[i - 1]);
}

/**
 * Checks that `fogline metrics` has the measures that take_over_measures.py works out from the raw
 * messages of the log, and that `fogline events` names the person's answer.
 * @param sent number of latencies in the log
 */
function assertMeasures(log, sent) {
  const run = (command, ...args) => execFileSync(command, args, {cwd: root, encoding: "utf8"});
  const expected = JSON.parse(run("python3", "tests/integration/drive/take_over_measures.py", log, TAKE_OVER_PEDAL));
  const [measured] = JSON.parse(run(FOGLINE, "metrics", log, "--json"));
  assert.ok(expected.length > 0, "a request");
  assert.equal(measured.take_overs.length, expected.length);
  expected.forEach((request, i) => {
    for (const [name, value] of Object.entries(request)) {
      const found = measured.take_overs[i][name];
      const isEqual = value === null ? found === null : Math.abs(found - value) <= 1e-9;
      assert.ok(isEqual, `request ${i}, ${name}: ${found} in place of ${value}`);
    }
  });
  assert.equal(measured.take_overs[0].outcome, "taken_over");
  assert.equal(measured.input_latency.inputs, sent);
  const [{events}] = JSON.parse(run(FOGLINE, "events", log, "--json"));
  const texts = events.map(({event}) => event);
  for (const text of ["request to take over", "acknowledgement by the person", "transfer to the human",
                      "transfer to the automation"]) {
    assert.ok(texts.includes(text), `${text} is not one of: ${texts.join(", ")}`);
  }
}

for (const [device, make] of [["the keys", keys], ["a wheel", wheel]]) {
  test(`a person takes over on request, brakes behind the leader, and gives back (${device})`, async (t) => {
    const isWheel = make === wheel;
    const {page, log, run} = await drive(t, {}, {prepare: isWheel ? withFakePads : null});
    if (isWheel) await plugIn(page);
    await begin(page);
    await drives(page, true);
    await says(page, "The automation drives");
    await says(page, "Take over");
    await page.waitForFunction(() => !document.getElementById("request").hidden);
    assert.ok(await page.evaluate(() => foglineDrive.alarm.played > 0), "the request is heard");
    const left = await page.locator("#request-left").innerText();
    assert.match(left, /^(10|9|8|7)\s/);
    await takeOver(page, isWheel);
    assert.ok(await page.locator("#request").isHidden());
    const pedals = make(page);
    await follow(page, run, pedals, 22);
    await pedals(0);
    // The fog has gone. The automation takes over only after some time, so the person gives back
    // repeatedly.
    await until(async () => {
      if (isWheel) await setPad(page, {down: [1]});
      else await page.keyboard.press("g");
      await page.waitForTimeout(100);  // the person's wait before the next try
      if (isWheel) await setPad(page);
      const who = await page.locator("#who").innerText();
      assertGoesOn(run, !who.startsWith("The car"), who);
      return who === "The automation drives";
    }, "the automation to drive again");
    await run.ended;
    assert.equal(run.code, 0, run.said);
    const {measured, count} = await page.evaluate(() => ({
      measured: foglineDrive.latency.values.map((ms) => Math.trunc(1000 * ms)), count: foglineDrive.latency.count}));
    // The page's errors after the end of the run are expected.
    page.trouble = page.trouble.filter((words) => !words.includes("WebSocket"));

    const truth = messagesOf(log, "TRUTH", "truth_t");
    assert.ok(Math.min(...truth.map(({host_gap_m}) => host_gap_m)) > 2, "no collision");
    const human = messagesOf(log, "HOST_COMMAND", "arbitration_t").filter(({lambda_human}) => lambda_human > 0.5);
    assert.ok(human.length > 200, `the person has driven for ${human.length} steps`);
    const inputs = messagesOf(log, "DRIVER_INPUT", "driver_input_t");
    assert.ok(inputs.some(({brake}) => brake > 0.1), "the person has braked");
    assert.equal(new Set(inputs.map(({instance}) => String(instance))).size, 1);
    // This test sets no limit for the delay, because other processes may cause a long delay.
    // speed.test.js tests the limit, and measures how busy other processes are.
    const latencies = latenciesOf(inputs);
    const median = [...latencies].sort((a, b) => a - b)[Math.floor(latencies.length / 2)];
    t.diagnostic(`${device}: ${latencies.length} delays, median ${median / 1000} ms`);
    assert.ok(latencies.length >= 10, `${latencies.length} delays`);
    assert.deepEqual(latencies.filter((one) => !measured.includes(one)), []);
    const sent = inputs.filter(({latency_us}) => latency_us >= 0).length;
    assert.ok(sent <= count, `${count} measurements are ${sent} times in the log`);
    assertMeasures(log, sent);
    // A replay of the inputs in the log gives the same commands.
    execFileSync(FOGLINE, ["replay", log, "--role", "driver"], {stdio: "pipe"});
  });
}

/** Presses the throttle of a person who drives, until the car accelerates. */
async function pressThrottle(page, isWheel) {
  const speed = () => page.evaluate(() => foglineDrive.newest.frame.TRUTH.host_speed_mps);
  const before = await speed();
  if (isWheel) await setPad(page, {axes: [0, 1]});
  else await page.keyboard.down("ArrowUp");
  await until(async () => await speed() > before + 0.1, "the car to accelerate");
}

/**
 * Checks in the log that the driver's readiness becomes 0 soon enough after the last input of the
 * person, and that the pedals are released from then on.
 * @param from the step in which the person has begun to drive
 */
function assertReleased(log, from) {
  const timeOf = ({header}) => Number(header.utime) / 1e6;
  const commands = messagesOf(log, "DRIVER_COMMAND", "driver_command_t").filter(({header}) => header.step >= from);
  const away = commands.findIndex(({readiness}) => readiness === 0);
  assert.ok(away > 0, "the driver becomes not ready");
  assert.ok(commands[away - 1].acceleration_mps2 > 0, "the person has pressed the throttle until then");
  assert.equal(commands[away].input_sequence, -1);
  const last = messagesOf(log, "DRIVER_INPUT", "driver_input_t")
    .filter((input) => input.present && timeOf(input) <= timeOf(commands[away])).at(-1);
  const after_s = timeOf(commands[away]) - timeOf(last);
  assert.ok(after_s <= DEADMAN_S + 2 * PERIOD_S + ALLOWANCE_S, `${after_s} s after the last input`);
  const pressed = commands.slice(away).filter(({acceleration_mps2}) => acceleration_mps2 !== RELEASED_MPS2);
  assert.deepEqual(pressed.map(({header}) => header.step), []);
}

/**
 * The person drives. Then `happens` is called, and the run must notice that no person is present.
 * `then` is called while the car stops, and checks the page.
 */
async function leavesTheCar(t, happens, {isWheel = false, then = null} = {}) {
  const {page, log, run} = await drive(t, {"/arbitrator/threshold": 0, "/steps": 600},
                                       {prepare: isWheel ? withFakePads : null});
  if (isWheel) await plugIn(page);
  await begin(page);
  await drives(page, true);  // before that, the page ignores keys
  await says(page, "Take over");
  await takeOver(page, isWheel);
  await pressThrottle(page, isWheel);
  await happens(page);
  await then?.(page);
  await run.ended;
  const commands = messagesOf(log, "HOST_COMMAND", "arbitration_t");
  const drove = commands.findIndex(({lambda_human}) => lambda_human > 0.5);
  assert.ok(drove > 0);
  assert.ok(commands.slice(drove).some(({mode}) => mode === 2 || (mode >= 7 && mode <= 10)),
            "the car stops by itself");
  assertReleased(log, commands[drove].header.step);
}

test("when the tab is hidden, the fallbacks stop the car", async (t) => {
  await leavesTheCar(t, (page) => page.evaluate(() => {
    Object.defineProperty(document, "hidden", {value: true, configurable: true});
    document.dispatchEvent(new Event("visibilitychange"));
  }));
});

test("when the person leaves the seat by a second press, the fallbacks stop the car", async (t) => {
  await leavesTheCar(t, async (page) => {
    const button = page.locator("#begin");
    await button.click();
    await until(async () => await button.innerText() === "Press again to leave", "the words for the second press");
    assert.match(await page.locator("#answer").innerText(), /The car may stop for the rest of the run/);
    await drives(page, true);
    await button.click();
    await drives(page, false);
  });
});

test("the view of a drive says how the drive begins", async (t) => {
  const {view} = await startDrive(t);
  const page = await open(t, await browser(t), view);
  await page.waitForFunction(() => /presses “Begin” at the seat/.test(document.getElementById("reason").textContent));
});

test("when the page is closed, the fallbacks stop the car", async (t) => {
  await leavesTheCar(t, (page) => page.close());
});

test("when the wheel is unplugged, the fallbacks stop the car", async (t) => {
  await leavesTheCar(t, (page) => setPad(page, {connected: false}), {isWheel: true, then: async (page) => {
    await says(page, "The car stops by itself");
    assert.equal(await page.locator("#away").innerText(), "Nobody drives any more in this run.");
    assert.ok(await page.locator("#take-over").isDisabled());
  }});
});

test("when the page is silent for 300 ms, the fallbacks stop the car", async (t) => {
  await leavesTheCar(t, (page) => page.evaluate(() => {
    const end = performance.now() + 1500;
    while (performance.now() < end) continue;
  }));
});

test("the first brake lights of the car ahead need no new shader, for which the page would stand still", async (t) => {
  const {page} = await drive(t, {"/steps": 1000, "/lead/breakpoints": [
    {duration_s: 2, speed_mps: 20}, {duration_s: 3, speed_mps: 12}, {duration_s: 15, speed_mps: 12}]}, {
    prepare: (context) => context.addInitScript(() => {
      window.shaders = 0;
      const {linkProgram} = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.linkProgram = function (program) {
        window.shaders += 1;
        linkProgram.call(this, program);
      };
    })});
  await page.waitForFunction(() => foglineDrive.view);
  const before = await page.evaluate(() => window.shaders);
  assert.ok(before > 0);
  await begin(page);
  await page.waitForFunction(() => foglineDrive.newest?.frame.TRUTH?.preceding_acceleration_mps2 < -1);
  const after = await page.evaluate(async () => {
    // On a slow machine the page draws the view in only one of four frames. In ten frames it draws
    // the view at least twice.
    for (let i = 0; i < 10; ++i) await new Promise(requestAnimationFrame);
    return window.shaders;
  });
  assert.equal(after, before);
});

/**
 * Delays all messages of the server to the page by `window.late_ms`. There is no picture of the
 * road, because a busy machine would draw it late, too.
 */
async function withLateMessages(context) {
  await context.route("**/driver_view.js", (route) => route.abort());
  await context.addInitScript(() => {
    window.late_ms = 0;
    window.WebSocket = class extends WebSocket {
      set onmessage(take) {
        super.onmessage = take && ((event) => {
          if (window.late_ms > 0) setTimeout(() => take(event), window.late_ms);
          else take(event);
        });
      }
    };
  });
}

test("the page warns while the picture follows the inputs too late, and not longer", async (t) => {
  const late_ms = 300;
  const {page} = await drive(t, {"/steps": 15000}, {size: PHONE, prepare: withLateMessages});
  await begin(page);
  await drives(page, true);
  const warning = page.locator("#latency-warning");
  /**
   * Presses a key again and again until two conditions hold: fits() is true for the delay that the
   * page shows, and the page shows the warning if and only if `warned` is true.
   */
  const shows = (fits, warned) => until(async () => {
    await page.keyboard.press("ArrowUp");
    const delay_ms = parseInt(await page.locator("#latency").textContent(), 10);  // NaN before the first measurement
    return fits(delay_ms) && await warning.isVisible() === warned;
  }, `a delay ${warned ? "with the" : "without a"} warning`);
  await shows((delay_ms) => delay_ms <= 100, false);
  await page.evaluate((late) => { window.late_ms = late; }, late_ms);
  await shows((delay_ms) => delay_ms >= late_ms, true);
  assert.match(await warning.innerText(), /more than 100 ms/);
  await page.evaluate(() => { window.late_ms = 0; });
  await shows((delay_ms) => delay_ms <= 100, false);
  // The page's error about the picture, which was not loaded, is expected.
  page.trouble = page.trouble.filter((words) => !words.includes("ERR_FAILED"));
});
