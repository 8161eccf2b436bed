// `fogline view --seat`, its participant's page in headless Chromium, and the messages that the
// page sends to the run.

import assert from "node:assert/strict";
import path from "node:path";

import WebSocket from "ws";

import {Catalogue} from "../../../tools/web/page/data/catalogue.js";
import {readFrame} from "../../../tools/web/page/data/wire.js";
import {background, scratch, until} from "./window.js";

const {FOGLINE} = process.env;
const HELD_MS = 1000;  // a key that has no effect is pressed again after this time

/** The URL of a multicast network of this test alone. */
export const freshNetwork = () =>
  `udpm://239.255.76.67:${20000 + Math.floor(Math.random() * 20000)}?ttl=0`;

/** Starts a program with a seat. @return {server, drive, view}: the process and both addresses */
export async function seat(t, network, args = []) {
  const place = args.includes("--listen") ? [] : ["--port", "0"];
  const server = background(t, FOGLINE, ["view", "--seat", "--no-browser", "--lcm-url", network,
                                         ...place, ...args]);
  server.on("exit", (code) => { server.code = code; });
  const [drive, view] = await until(() => {
    assert.equal(server.code, undefined, server.said);
    const found = server.said.match(/http:\/\/\S+(?=\n)/g) ?? [];
    return found.length >= 2 && found;
  }, "both addresses");
  return {server, drive, view};
}

/**
 * Starts a drive. @param settings fields of the scenario and their values
 * @return {run, log, address, view}: its process, its log, and the addresses of both pages
 */
export async function startDrive(t, settings = {}) {
  const log = path.join(scratch(t), "drive.lcm");
  const set = Object.entries(settings).flatMap(([field, value]) => ["--set", `${field}=${JSON.stringify(value)}`]);
  const run = background(t, FOGLINE, ["drive", "scenario/drive.json", "--no-browser", "--lcm-url", freshNetwork(),
                                      "--log", log, "--json", ...set]);
  run.on("exit", (code) => { run.code = code; });
  const [, address, view] = await until(() => {
    assert.equal(run.code, undefined, run.said);
    return run.said.match(/drive: (http:\S+)\s+view: +(http:\S+)/);
  }, "the addresses of the pages");
  return {run, log, address, view};
}

/** The address of the WebSocket of a page, with the token of the page's address. */
export function socketOf(address) {
  const {host, hash} = new URL(address);
  const token = new URLSearchParams(hash.slice(1)).get("token");
  return `ws://${host}/ws${token ? `?token=${token}` : ""}`;
}

/**
 * Receives the messages on the network of a seat as a viewer. `heard` has all messages of the
 * wanted channels in the order of their arrival: {name, message, at_ms}.
 */
export async function listener(t, address, names = ["DRIVER_INPUT"]) {
  const socket = new WebSocket(socketOf(address), ["fogline.view.v1"]);
  socket.binaryType = "arraybuffer";
  const heard = [];
  let catalogue = null;
  socket.on("message", (data, isBinary) => {
    if (!isBinary) {
      const object = JSON.parse(data);
      if (object.op === "hello") catalogue = new Catalogue(object);
      return;
    }
    const frame = readFrame(data);
    for (const {channel: id, bytes} of frame.messages ?? []) {
      const channel = catalogue.channels.get(id);
      if (!names.includes(channel?.name)) continue;
      const message = catalogue.decode(channel, bytes);
      assert.ok(message, `${channel.name} can be decoded`);
      heard.push({name: channel.name, message, at_ms: performance.now()});
    }
  });
  t.after(() => socket.close());
  await until(() => catalogue, "the hello of the view");
  return {
    heard,
    newest: (name = "DRIVER_INPUT") => heard.findLast((one) => one.name === name)?.message,
    /** Waits for the first new message for which fits() is true. @return this message */
    async next(fits, what, name = "DRIVER_INPUT") {
      const from = heard.length;
      return until(() => heard.slice(from).find((one) => one.name === name && fits(one.message)), what);
    },
  };
}

/** Prepares the context of a page. The page gets the gamepads that `window.fakePads` lists. */
export async function withFakePads(context) {
  await context.addInitScript(() => {
    window.fakePads = [];
    navigator.getGamepads = () => window.fakePads;
  });
}

/** Sets the state of a faked gamepad: its axes, and the buttons that are down. */
export async function setPad(page, {id = "Test Wheel", axes = [1, 1], down = [], connected = true,
                                    mapping = ""} = {}) {
  await page.evaluate((state) => {
    const before = window.fakePads.find((pad) => pad.id === state.id);
    const pad = {...state, index: 0, timestamp: performance.now(),
                 buttons: [0, 1, 2, 3].map((i) => (
                   {pressed: state.down.includes(i), touched: false, value: state.down.includes(i) ? 1 : 0}))};
    window.fakePads = state.connected ? [pad] : [];
    if (!before && state.connected) dispatchEvent(new Event("gamepadconnected"));
    if (before && !state.connected) dispatchEvent(new Event("gamepaddisconnected"));
  }, {id, axes, down, connected, mapping});
}

/** Waits until the page drives; with `whether` false, until it does not drive. */
export async function drives(page, whether) {
  await page.waitForFunction((wanted) => document.body.dataset.present === wanted, String(whether));
}

/** Presses the button with which the person says that they are ready. */
export async function begin(page) {
  await page.waitForFunction(() => foglineDrive.state !== "");
  await page.click("#begin");
}

/**
 * Holds the key to take over until the page says who drives, in words that match `pattern`. A short
 * press could have no effect while a busy machine sends nothing. If the page is silent for longer
 * than /person/deadman_s, the held key has no effect any more. Then the person presses the key
 * again.
 */
export async function holdTakeOver(page, pattern) {
  await until(async () => {
    await page.keyboard.down("t");
    const told = page.waitForFunction(
      (wanted) => new RegExp(wanted).test(document.getElementById("who").textContent), pattern, {timeout: HELD_MS});
    const isTold = await told.then(() => true, () => false);
    await page.keyboard.up("t");
    return isTold;
  }, `the page to say ${pattern}`);
}
