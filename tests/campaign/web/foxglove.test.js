// The client library of Foxglove and Lichtblick reads a live run at 100 Hz.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {once} from "node:events";
import {createRequire} from "node:module";
import path from "node:path";
import {test} from "node:test";

import {makeDecoder} from "../../../tools/web/page/data/lcm.js";
import {describedTypes, readEvents} from "../../unit/tools/web/page/real_log.js";
import {freshNetwork} from "./seat.js";
import {background, scratch, until, view} from "./window.js";

const require = createRequire(import.meta.url);
const {FoxgloveClient} = require("@foxglove/ws-protocol");
const WebSocket = require("ws");

const {FOGLINE} = process.env;
const STEPS = 1000;

/**
 * Opens a client with this subprotocol. @return {client, channels, problems}; `channels` and
 * `problems` grow while the client receives frames
 */
function connect(t, address, name) {
  const socket = new WebSocket(`ws://${new URL(address).host}/ws`, [name]);
  t.after(() => socket.terminate());
  const client = new FoxgloveClient({ws: socket});
  const channels = [];
  const problems = [];
  client.on("error", (problem) => problems.push(String(problem)));
  client.on("status", ({message}) => problems.push(message));
  client.on("advertise", (advertised) => channels.push(...advertised));
  return {client, channels, problems};
}

/**
 * A message in the form of the protocol's JSON: long integers are texts, and numbers that are not
 * finite are null.
 */
const asJson = (message) => JSON.stringify(message, (key, value) => (
  typeof value === "bigint" ? String(value) : value));

for (const name of ["foxglove.websocket.v1", "foxglove.sdk.v1"]) {
  test(`${name}: a client lists all channels, and gets every message of a run at 100 Hz`, async (t) => {
    const network = freshNetwork();
    const {client, channels, problems} = connect(t, await view(t, ["--lcm-url", network]), name);
    const graph = JSON.parse(execFileSync(FOGLINE, ["graph", "--json"], {encoding: "utf8"}));
    await until(() => channels.length >= graph.channels.length, "the channels");
    assert.deepEqual(channels.map(({topic}) => topic), graph.channels.map((channel) => channel.name));
    const got = new Map(channels.map(({topic}) => [topic, new Set()]));
    const topics = new Map();  // by the id of the subscription
    for (const {id, topic, encoding, schema} of channels) {
      assert.equal(encoding, "json");
      assert.equal(JSON.parse(schema).type, "object");
      topics.set(client.subscribe(id), topic);
    }
    client.on("message", ({subscriptionId, data}) => {
      got.get(topics.get(subscriptionId)).add(asJson(JSON.parse(new TextDecoder().decode(data))));
    });
    const log = path.join(scratch(t), "run.lcm");
    const run = background(t, FOGLINE, ["run", "scenario/dense_fog.json", "--lcm-url", network, "--quiet", "--json",
                                        "--realtime", "--set", "/step_s=0.01", "--set", `/steps=${STEPS}`,
                                        "--log", log]);
    const [code] = await once(run, "close");  // all output of the run has come
    assert.equal(code, 0, run.said);
    const {steps, realtime} = JSON.parse(run.said);
    // The log has every message that was published in time. A role may have skipped steps. Then the
    // log lacks the messages of these steps (missed_messages).
    assert.deepEqual([steps, realtime.unlogged_messages], [STEPS, 0]);
    const types = describedTypes();
    const decoders = new Map(graph.channels.filter((channel) => channel.per_step)
      .map((channel) => [channel.name, makeDecoder(types, channel.type)]));
    const logged = readEvents(log).filter(({channel}) => decoders.has(channel));
    assert.deepEqual(new Set(logged.map(({channel}) => channel)), new Set(decoders.keys()));
    assert.equal(logged.length, decoders.size * STEPS - realtime.missed_messages);
    for (const {channel, bytes} of logged) {
      const message = asJson(decoders.get(channel)(bytes));
      await until(() => got.get(channel).has(message), `a message of ${channel}: ${message}`);
    }
    for (const channel of ["RUN", "STATUS"]) assert.ok(got.get(channel).size > 0, channel);
    t.diagnostic(`${logged.length} messages, and the client has each; the log lacks ${realtime.missed_messages}`);
    assert.deepEqual(problems, []);
  });
}
