// `fogline view` and its page in headless Chromium, for tests.

import assert from "node:assert/strict";
import {execFileSync, spawn} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import path from "node:path";
import {fileURLToPath} from "node:url";

import {chromium} from "playwright-core";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
const {FOGLINE, CHROMIUM} = process.env;
const PATIENCE_MS = 60000;  // for a busy machine

export const DESKTOP = {width: 1600, height: 1000};
export const PHONE = {width: 390, height: 844};

const endings = new WeakMap();

/**
 * Adds an action for the end of the test. The action that was added last is done first. If an
 * action fails, the other actions are done nevertheless, so no process is left.
 */
function atEnd(t, end) {
  if (!endings.has(t)) {
    const ends = [];
    endings.set(t, ends);
    t.after(async () => {
      const failures = [];
      for (; ends.length; ends.pop()) await Promise.resolve().then(ends.at(-1)).catch((why) => failures.push(why));
      if (failures.length) throw failures[0];
    });
  }
  endings.get(t).push(end);
}

/** A folder that is removed at the end of the test. */
export function scratch(t) {
  const folder = mkdtempSync(path.join(tmpdir(), "fogline-window-"));
  atEnd(t, () => rmSync(folder, {recursive: true, force: true}));
  return folder;
}

/** Runs a scenario without a network. @return the log's path */
export function recordedRun(folder, settings = [], scenario = "dense_fog") {
  const log = path.join(folder, `run-${settings.length}.lcm`);
  execFileSync(FOGLINE, ["run", path.join(root, `scenario/${scenario}.json`), "--transport", "direct",
                         "--log", log, ...settings.flatMap((setting) => ["--set", setting])],
               {stdio: "pipe"});
  return log;
}

/**
 * Reads the numbers of a log. @return a function of channel and step that gives an object of
 * numbers
 */
export function numbersOf(folder, log) {
  const out = path.join(folder, "numbers");
  execFileSync(FOGLINE, ["export", log, "--out", out], {stdio: "pipe"});
  return (channel, step) => {
    const [head, ...rows] = readFileSync(path.join(out, `${channel}.csv`), "utf8").trim().split("\n");
    const values = rows[step].split(",");
    return Object.fromEntries(head.split(",").map((name, i) => [name, Number(values[i])]));
  };
}

/** Runs a program until the test ends. @return the process */
export function background(t, command, args) {
  const process = spawn(command, args, {cwd: root, stdio: ["ignore", "pipe", "pipe"]});
  process.said = "";
  for (const stream of [process.stdout, process.stderr]) {
    stream.on("data", (data) => { process.said += data; });
  }
  const ended = new Promise((resolve) => { process.on("exit", resolve); });
  atEnd(t, async () => {
    process.kill("SIGINT");
    await ended;
  });
  process.ended = ended;
  return process;
}

/** Waits until `look()` returns a true value. @return this value */
export async function until(look, what) {
  const end = Date.now() + PATIENCE_MS;
  for (;;) {
    const found = await look();
    if (found) return found;
    assert.ok(Date.now() < end, `waited in vain for: ${what}`);
    await new Promise((resolve) => { setTimeout(resolve, 20); });
  }
}

/** Starts `fogline view`. @return the address that it prints */
export async function view(t, args) {
  return (await serve(t, args)).address;
}

/** Starts `fogline view`. @return {server, address}: its process, and the address that it prints */
export async function serve(t, args) {
  const place = args.includes("--listen") ? [] : ["--port", "0"];
  const server = background(t, FOGLINE, ["view", "--no-browser", ...place, ...args]);
  server.on("exit", (code) => { server.code = code; });
  const address = await until(() => {
    assert.equal(server.code, undefined, server.said);
    return server.said.match(/http:\/\/\S+/)?.[0];
  }, "the address of fogline view");
  return {server, address};
}

/** Starts a browser for the test. */
export async function browser(t) {
  const started = await chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking",
           "--disable-component-update", "--disable-sync", "--no-first-run"]});
  atEnd(t, () => started.close());
  return started;
}

/**
 * Opens an address. `page.trouble` has the page's errors, its violations of the content security
 * policy, and its requests to other hosts. This list must be empty at the end of the test.
 * `prepare` gets the page's context before the page is loaded. With `allPorts`, other ports of the
 * same machine do not count as other hosts.
 */
export async function open(t, started, address,
                           {size = DESKTOP, prepare = null, allPorts = false, ...options} = {}) {
  const context = await started.newContext({viewport: size, ...options});
  if (prepare) await prepare(context);
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  page.trouble = [];
  const {host, hostname} = new URL(address);
  const isOwn = (url) => (allPorts ? url.hostname === hostname : url.host === host);
  page.on("console", (message) => {
    if (message.type() === "error") page.trouble.push(message.text());
  });
  page.on("pageerror", (problem) => page.trouble.push(problem.stack));
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (!isOwn(url) && url.protocol !== "data:") page.trouble.push(`request to ${url.host}`);
  });
  await page.addInitScript(() => {
    addEventListener("securitypolicyviolation", ({violatedDirective, blockedURI}) => {
      console.error(`policy: ${violatedDirective} ${blockedURI}`);
    });
  });
  await page.goto(address);
  atEnd(t, () => assert.deepEqual(page.trouble, []));
  return page;
}

/** Waits until the page shows a step. */
export async function shows(page, step) {
  await page.waitForFunction((wanted) => document.body.dataset.step === String(wanted), step);
}

/** Moves the slider to a step. */
export async function goTo(page, step) {
  await page.waitForFunction(() => document.body.dataset.step);
  await page.evaluate((wanted) => {
    const slider = document.getElementById("time");
    slider.value = String(wanted);
    slider.dispatchEvent(new Event("input"));
  }, step);
  await shows(page, step);
}

/** The violations of axe's rules of accessibility. Lighthouse uses the same rules. */
export async function breaches(page) {
  if (!await page.evaluate(() => "axe" in window)) {
    await page.evaluate(readFileSync(path.join(root, "node_modules/axe-core/axe.min.js"), "utf8"));
  }
  return page.evaluate(async () => {
    const {violations} = await axe.run(document, {resultTypes: ["violations"]});
    return violations.map(({id, nodes}) => `${id}: ${nodes.map(({html}) => html).join(" ")}`);
  });
}
