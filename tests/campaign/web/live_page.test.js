// The page of a run that is on the network.
import assert from "node:assert/strict";
import path from "node:path";
import {test} from "node:test";

import {background, browser, open, scratch, serve, until, view} from "./window.js";

const {FOGLINE} = process.env;
const FOGLINE_RELAY = path.join(path.dirname(FOGLINE), "fogline-relay");
const SCENARIO = "scenario/dense_fog.json";

/** The URL of a multicast network of this test alone. */
const url = () => `udpm://239.255.76.67:${20000 + Math.floor(Math.random() * 20000)}?ttl=0`;

function run(t, network, ...args) {
  return background(t, FOGLINE, ["run", SCENARIO, "--lcm-url", network, "--quiet",
                                 "--log", path.join(scratch(t), "live.lcm"), ...args]);
}

test("a live run is shown as it goes: the newest step, all roles, no loss", async (t) => {
  const network = url();
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]));
  run(t, network, "--pace", "1");
  await page.waitForFunction(() => Number(document.body.dataset.step) >= 20);
  assert.equal(await page.locator("#origin-words").innerText(), "Live");
  assert.equal(await page.locator("#title").innerText(),
               "A dense fog bank: the LiDAR loses the preceding car");
  assert.equal(await page.locator("#who").innerText(), "The automation drives");
  await page.waitForFunction(() => document.querySelectorAll("#roles tbody tr").length === 9);
  await page.waitForFunction(() => document.querySelectorAll("#senders tbody tr").length >= 9);
  await page.waitForFunction(() => /^All 9 roles answer\. No packet to this viewer was lost/.test(
    document.getElementById("health-summary").textContent));
  const steps = await page.evaluate(async () => {
    const before = Number(document.body.dataset.step);
    await new Promise((resolve) => { setTimeout(resolve, 2000); });
    return Number(document.body.dataset.step) - before;
  });
  assert.ok(steps > 10 && steps < 30, `about 20 steps in 2 s: ${steps}`);

  // The reader stops, looks back, and follows the run again.
  const says = (words) => page.waitForFunction(
    (wanted) => document.getElementById("origin-words").textContent === wanted, words);
  await page.keyboard.press("Space");
  await says("Paused; the run goes on");
  await page.keyboard.press("Home");
  await page.waitForFunction(() => document.body.dataset.step === "0");
  await page.keyboard.press("Space");
  await says("Behind the run");
  await page.keyboard.press("l");
  await says("Live");
  await page.waitForFunction(() => Number(document.body.dataset.step) > 40);
});

test("a page that opens late has the history of the run", async (t) => {
  const network = url();
  const address = await view(t, ["--lcm-url", network]);
  const started = await browser(t);
  const early = await open(t, started, address);
  run(t, network, "--pace", "1");
  await early.waitForFunction(() => Number(document.body.dataset.step) >= 30);
  const late = await open(t, started, address);
  await late.waitForFunction(() => foglinePage.store?.lastStep >= 30);
  assert.equal(await late.evaluate(() => foglinePage.store.firstStep), 0);
  assert.ok(await late.evaluate(() => foglinePage.curves.charts[0].chart.data[0].length) > 20);
});

test("a link to a moment of a live run opens this moment", async (t) => {
  const network = url();
  const address = await view(t, ["--lcm-url", network]);
  const started = await browser(t);
  const first = await open(t, started, address);
  run(t, network, "--pace", "1");
  await first.waitForFunction(() => Number(document.body.dataset.step) >= 20);
  const run_id = await first.evaluate(() => foglinePage.run.run_id);
  const at = (fragment) => open(t, started, address.replace(/(#.*)?$/, fragment));
  const second = await at(`#run=${run_id}&step=12`);
  await second.waitForFunction(() => document.body.dataset.step === "12");
  assert.equal(await second.locator("#origin-words").innerText(), "Paused; the run goes on");
  for (const [fragment, words] of [["#run=5&step=12", /of another run/], [`#run=${run_id}&step=600`, /to step 600/]]) {
    const other = await at(fragment);
    await other.waitForFunction((wanted) => new RegExp(wanted).test(document.getElementById("note").textContent),
                                words.source);
    // The note may come before the first step.
    await other.waitForFunction(() => document.getElementById("origin-words").textContent === "Live");
  }
});

test("an event that comes takes the focus from no event of the list", async (t) => {
  const network = url();
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]));
  run(t, network, "--pace", "3");
  const buttons = page.locator("#events button");
  await buttons.first().focus();
  const first = await buttons.first().innerText();
  const before = await buttons.count();
  await page.waitForFunction((count) => document.querySelectorAll("#events button").length > count, before);
  assert.equal(await page.evaluate(() => document.activeElement.innerText), first);
});

test("at 100 Hz each frame shows the newest step that has come", async (t) => {
  const network = url();
  const started = await browser(t);
  const address = await view(t, ["--lcm-url", network]);
  run(t, network, "--realtime", "--set", "/step_s=0.01", "--set", "/steps=6000");
  const page = await open(t, started, address);
  await page.waitForFunction(() => Number(document.body.dataset.step) >= 300);
  const behind = await page.evaluate(async () => {
    const found = [];
    for (const began = performance.now(); performance.now() - began < 5000;) {
      await new Promise(requestAnimationFrame);
      found.push(foglinePage.store.lastStep - Number(document.body.dataset.step));
    }
    return found;
  });
  assert.ok(behind.length > 5, "frames go on");
  assert.deepEqual(new Set(behind), new Set([0]));
});

test("over tcpq the page does not say that nothing was lost", async (t) => {
  const relay = background(t, FOGLINE_RELAY, ["--listen", "127.0.0.1:0"]);
  const network = await until(() => relay.said.match(/tcpq:\/\/\S+/)?.[0], "the address of the relay");
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]));
  run(t, network, "--pace", "1");
  await page.waitForFunction(() => /^All 9 roles answer\. Lost packets: not known over tcpq\.$/.test(
    document.getElementById("health-summary").textContent));
});

test("a page that has forgotten the begin of a long run says where its data begin", async (t) => {
  const network = url();
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]));
  await page.waitForFunction(() => foglinePage.hello);
  run(t, network, "--pace", "100", "--set", "/step_s=0.5", "--set", "/steps=1900");  // 950 s; the page keeps 600 s
  await page.waitForFunction(() => document.body.dataset.step === "1899");
  await page.waitForFunction(() => /The data begin at \d+\.\d/.test(document.getElementById("curves-at").textContent));
  await page.locator("#events button").first().click();  // the page has forgotten this event
  await page.waitForFunction(() => /^The data begin at step \d+\.$/.test(document.getElementById("note").textContent));
});

test("the page says when the run has ended, and when the program has", async (t) => {
  const network = url();
  const {server, address} = await serve(t, ["--lcm-url", network]);
  const page = await open(t, await browser(t), address);
  await page.waitForFunction(() => foglinePage.hello);
  await page.waitForFunction(() => document.getElementById("origin-words").textContent === "Connected");
  assert.notEqual(await page.locator("#origin").getAttribute("data-state"), "live");  // there is no run yet
  run(t, network, "--pace", "10");
  const says = (words) => page.waitForFunction(
    (wanted) => document.getElementById("origin-words").textContent === wanted, words);
  await says("The run has ended");
  const who = (words) => page.waitForFunction((wanted) => document.getElementById("who").textContent === wanted, words);
  await who("The run has ended");
  assert.match(await page.locator("#reason").innerText(), /^In its last step: “The automation drives”\. The Degree of Conflict/);
  assert.equal(await page.locator("#now").getAttribute("data-side"), "ended");
  assert.ok(await page.locator("#live").isHidden());
  assert.equal(await page.locator("#play").getAttribute("aria-label"), "Play");
  await page.click("#play");  // shows the run again from its first step
  await page.waitForFunction(() => Number(document.body.dataset.step) < 100);
  await who("The automation drives");  // at the shown moment
  await says("The run has ended");
  server.kill("SIGTERM");
  await says("The program has ended");
  page.trouble = page.trouble.filter((words) => !words.includes("WebSocket"));  // no server answers
});

test("a run that is interrupted has ended, too", async (t) => {
  const network = url();
  const page = await open(t, await browser(t), await view(t, ["--lcm-url", network]));
  await page.waitForFunction(() => foglinePage.hello);
  const interrupted = run(t, network, "--pace", "1");
  await page.waitForFunction(() => Number(document.body.dataset.step) > 5);
  interrupted.kill("SIGINT");
  await page.waitForFunction(() => document.getElementById("who").textContent === "The run has ended");
});

test("the page finds the server again after it was away", async (t) => {
  const network = url();
  const address = await view(t, ["--lcm-url", network]);
  const page = await open(t, await browser(t), address);
  await page.waitForFunction(() => foglinePage.hello);
  await page.evaluate(() => foglinePage.wire.socket.close());
  await page.waitForFunction(() => document.getElementById("origin").dataset.state === "lost");
  await page.waitForFunction(() => document.getElementById("origin-words").textContent === "Connected");
});
