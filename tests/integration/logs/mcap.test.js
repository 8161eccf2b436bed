// MCAP's own library reads an exported log. Every number of every channel equals the number in the
// CSV export.
import assert from "node:assert/strict";
import {execFileSync, spawn, spawnSync} from "node:child_process";
import {createSocket} from "node:dgram";
import {once} from "node:events";
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {open} from "node:fs/promises";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import path from "node:path";
import {after, before, test} from "node:test";
import {setTimeout} from "node:timers/promises";

const require = createRequire(import.meta.url);
const {McapIndexedReader, McapStreamReader} = require("@mcap/core");
const {decompress} = require("fzstd");
const protobuf = require("protobufjs");
const {FileDescriptorSet} = require("protobufjs/ext/descriptor");

const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), "../../..");
const decompressHandlers = {zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size)))};

const STEPS = 2000;  // enough for several chunks

let folder;
let file;

const fogline = (...command) => execFileSync(process.env.FOGLINE, command, {stdio: "pipe", cwd: root});

before(() => {
  folder = mkdtempSync(path.join(tmpdir(), "fogline-mcap-"));
  const log = path.join(folder, "run.lcm");
  file = path.join(folder, "run.mcap");
  fogline("run", "scenario/dense_fog.json", "--transport", "direct", "--quiet", "--log", log,
          "--set", "/followers/count=2", "--set", `/steps=${STEPS}`);
  fogline("export", log, "--out", path.join(folder, "csv"));
  fogline("export", log, "--mcap", file);
});
after(() => rmSync(folder, {recursive: true}));

/** A file as @mcap/core reads it. */
async function readable(name) {
  const handle = await open(name);
  return {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
    close: () => handle.close(),
  };
}

async function indexed(t, name = file) {
  const source = await readable(name);
  t.after(() => source.close());
  return McapIndexedReader.Initialize({readable: source, decompressHandlers});
}

/** A decoder that is built only from a schema. */
function decoderOf(schema) {
  assert.equal(schema.encoding, "protobuf");
  const types = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data));
  types.resolveAll();
  return types.lookupType(schema.name);
}

/** The values of a message by the columns of the CSV export, such as "header.step", "state.0". */
function columnsOf(message, prefix = "") {
  const columns = {};
  for (const field of message.$type.fieldsArray) {
    const value = message[field.name];
    if (field.resolvedType && !field.repeated) {
      Object.assign(columns, columnsOf(value, `${field.name}.`));
    } else if (field.repeated) {
      value.forEach((one, i) => columns[`${prefix}${field.name}.${i}`] = one);
    } else {
      columns[prefix + field.name] = value;
    }
  }
  return columns;
}

/** Rows of a CSV file as objects of texts. */
function readCsv(name) {
  const [head, ...lines] = readFileSync(name, "utf8").trim().split("\n");
  const names = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((text, i) => [names[i], text])));
}

/**
 * Whether a value has the same bits as the number in a text. In the text a boolean is 0 or 1. A
 * 64-bit integer is a value of class Long.
 */
function isSame(value, text) {
  if (protobuf.util.Long.isLong(value)) return value.toString() === text;
  return Object.is(Number(value), Number(text));
}

/** Compares an exported log with its tables. @param count the number of tables */
async function compareWithCsv(reader, csv, count) {
  const decoders = new Map([...reader.schemasById.values()].map((schema) => [schema.id, decoderOf(schema)]));
  const rows = new Map();
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    assert.equal(channel.messageEncoding, "protobuf");
    const decoded = decoders.get(channel.schemaId).decode(message.data);
    assert.equal(message.logTime, BigInt(decoded.header.utime) * 1000n);
    assert.equal(message.publishTime, message.logTime);
    assert.equal(BigInt(message.sequence), BigInt(decoded.header.step));
    if (!rows.has(channel.topic)) rows.set(channel.topic, []);
    rows.get(channel.topic).push(columnsOf(decoded));
  }
  const tables = readdirSync(csv).filter((name) => name.endsWith(".csv"));
  assert.deepEqual([...rows.keys()].sort(), tables.map((name) => path.basename(name, ".csv")).sort());
  assert.equal(tables.length, count);
  for (const [topic, messages] of rows) {
    const expected = readCsv(path.join(csv, `${topic}.csv`));
    assert.equal(messages.length, expected.length, topic);
    expected.forEach((row, i) => {
      assert.deepEqual(Object.keys(messages[i]), Object.keys(row));
      for (const [name, text] of Object.entries(row)) {
        assert.ok(isSame(messages[i][name], text), `${topic} ${i} ${name}: ${messages[i][name]}, not ${text}`);
      }
    });
  }
}

test("every number of every channel is that of the CSV export", async (t) => {
  await compareWithCsv(await indexed(t), path.join(folder, "csv"), 9);
});

test("the wall clock of a log is a channel of the file", async (t) => {
  const [log, csv, mcap] = ["clock.lcm", "clock", "clock.mcap"].map((name) => path.join(folder, name));
  fogline("run", "scenario/paper.json", "--transport", "memq", "--quiet", "--log", log,
          "--set", "/steps=50", "--wall-clock");
  fogline("export", log, "--out", csv);
  fogline("export", log, "--mcap", mcap);
  const reader = await indexed(t, mcap);
  await compareWithCsv(reader, csv, 10);
  const [clock] = [...reader.channelsById.values()].filter(({topic}) => topic === "WALL_CLOCK");
  assert.equal(clock.metadata.get("from"), "recorder");
});

test("a log of another logger has the messages outside of steps at the simulated time", async (t) => {
  const [log, mcap] = ["recorded.lcm", "recorded.mcap"].map((name) => path.join(folder, name));
  const socket = createSocket("udp4").bind(0, "127.0.0.1");
  await once(socket, "listening");
  const url = `udpm://239.255.76.67:${socket.address().port}?ttl=0`;  // a port that is free
  socket.close();
  const record = spawn(process.env.FOGLINE, ["record", log, "--lcm-url", url]);
  t.after(() => record.kill("SIGKILL"));
  await once(record.stderr, "data");  // it says what it records when it has joined
  fogline("run", "scenario/paper.json", "--quiet", "--lcm-url", url, "--set", "/steps=50", "--log",
          path.join(folder, "own.lcm"));
  const isWhole = () => spawnSync(process.env.FOGLINE, ["digest", log]).status === 0;
  for (const end = Date.now() + 60_000; !isWhole() && Date.now() < end;) await setTimeout(50);
  record.kill("SIGINT");
  await once(record, "exit");
  fogline("export", log, "--mcap", mcap);
  const {statistics, channelsById} = await indexed(t, mcap);
  assert.ok([...channelsById.values()].some(({topic}) => topic === "STATUS"));
  assert.equal(statistics.messageStartTime, 0n);
  assert.equal(statistics.messageEndTime, 49n * 100_000_000n);
});

test("the summary counts what the file has, and finds one channel at one moment", async (t) => {
  const reader = await indexed(t);
  const {statistics} = reader;
  assert.equal(statistics.messageCount, 9n * BigInt(STEPS));
  assert.equal(statistics.chunkCount, reader.chunkIndexes.length);
  assert.ok(reader.chunkIndexes.length >= 2, "a file of one chunk would test little");
  assert.equal(statistics.messageStartTime, 0n);
  assert.equal(statistics.messageEndTime, BigInt(STEPS - 1) * 100_000_000n);
  assert.deepEqual([...statistics.channelMessageCounts.values()], Array(9).fill(BigInt(STEPS)));
  const found = [];
  const moment = {startTime: 35_000_000_000n, endTime: 35_200_000_000n};
  for await (const {sequence} of reader.readMessages({topics: ["TRUTH"], ...moment})) found.push(sequence);
  assert.deepEqual(found, [350, 351, 352]);
});

test("a reader that checks every checksum reads the file from front to back", () => {
  const reader = new McapStreamReader({decompressHandlers, validateCrcs: true});
  reader.append(readFileSync(file));
  const counts = {};
  for (let record; (record = reader.nextRecord());) counts[record.type] = (counts[record.type] ?? 0) + 1;
  assert.ok(reader.done());
  assert.equal(counts.Message, 9 * STEPS);
  assert.equal(counts.DataEnd, 1);
});

test("a changed byte of a message does not pass the checksum of its chunk", () => {
  const bytes = readFileSync(file);
  bytes[Math.floor(bytes.length / 4)] ^= 1;  // in the middle of the first of two chunks
  const reader = new McapStreamReader({decompressHandlers, validateCrcs: true});
  reader.append(bytes);
  assert.throws(() => {
    while (reader.nextRecord()) continue;
  });
});

test("the attached scenario, run again, has the digest of the metadata", async (t) => {
  const reader = await indexed(t);
  const [attachment] = await all(reader.readAttachments());
  assert.equal(attachment.name, "scenario.json");
  assert.equal(attachment.mediaType, "application/json");
  const [{name, metadata}] = await all(reader.readMetadata());
  assert.equal(name, "fogline");
  const again = path.join(folder, "again.json");
  writeFileSync(again, attachment.data);
  const run = JSON.parse(fogline("run", again, "--transport", "direct", "--json", "--quiet",
                                 "--log", path.join(folder, "again.lcm")));
  assert.equal(run.digest, metadata.get("digest"));
  assert.equal(metadata.get("steps"), String(STEPS));
  assert.equal(metadata.get("complete"), "true");
  assert.match(metadata.get("run_id"), /^[1-9][0-9]*$/);
});

/** All values of an asynchronous generator. */
async function all(generator) {
  const values = [];
  for await (const value of generator) values.push(value);
  return values;
}
