// The client library of Foxglove and Lichtblick reads a live run.
import assert from "node:assert/strict";
import {createRequire} from "node:module";
import path from "node:path";
import {test} from "node:test";

import {background, scratch, until, view} from "./window.js";

const require = createRequire(import.meta.url);
const {FoxgloveClient} = require("@foxglove/ws-protocol");
const WebSocket = require("ws");

const {FOGLINE} = process.env;

for (const name of ["foxglove.websocket.v1", "foxglove.sdk.v1"]) {
  test(`${name}: a client subscribes to a channel and gets its messages`, async (t) => {
    const network = `udpm://239.255.76.67:${20000 + Math.floor(Math.random() * 20000)}?ttl=0`;
    const address = new URL(await view(t, ["--lcm-url", network]));
    const socket = new WebSocket(`ws://${address.host}/ws`, [name]);
    t.after(() => socket.terminate());
    const client = new FoxgloveClient({ws: socket});
    const channels = [];
    const messages = [];
    const problems = [];
    client.on("error", (problem) => problems.push(String(problem)));
    client.on("advertise", (advertised) => channels.push(...advertised));
    client.on("message", ({data}) => messages.push(JSON.parse(new TextDecoder().decode(data))));
    const truth = await until(() => channels.find(({topic}) => topic === "TRUTH"), "the channel TRUTH");
    assert.equal(truth.encoding, "json");
    assert.equal(JSON.parse(truth.schema).type, "object");
    client.subscribe(truth.id);
    background(t, FOGLINE, ["run", "scenario/dense_fog.json", "--lcm-url", network, "--quiet",
                            "--pace", "2", "--log", path.join(scratch(t), "run.lcm")]);
    await until(() => messages.length >= 20, "20 messages");
    assert.ok(messages.every(({host_gap_m: gap_m}) => gap_m > 30 && gap_m < 36));
    assert.deepEqual(problems, []);
  });
}
