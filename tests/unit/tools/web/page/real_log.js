// A real log for the tests of the page: its messages, the description of their types, and the
// numbers that `fogline export` finds in it.

import {execFileSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import path from "node:path";

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname),
                          "../../../../..");
const EVENT = {sync: 0xeda1da01, header_bytes: 28};

/** The types of lcmtypes/*.lcm as the server describes them, without comments. */
export function describedTypes() {
  const types = {};
  for (const file of readdirSync(path.join(root, "lcmtypes"))) {
    if (!file.endsWith(".lcm")) continue;
    const text = readFileSync(path.join(root, "lcmtypes", file), "utf8").replace(/\/\/.*/g, "");
    const [, name, body] = text.match(/struct\s+(\w+)\s*\{([^]*)\}/);
    const constants = {};
    for (const [, constant, value] of body.matchAll(/const\s+\w+\s+(\w+)\s*=\s*(-?\d+);/g)) {
      constants[constant] = Number(value);
    }
    const members = [...body.replace(/const[^;]*;/g, "").matchAll(/(\w+)\s+(\w+)((?:\[\w+\])*);/g)]
      .map(([, type, member, dims]) => ({
        name: member, type,
        dims: [...dims.matchAll(/\[(\w+)\]/g)].map(([, dim]) => /^\d+$/.test(dim) ? Number(dim) : dim)}));
    types[name] = {constants, members};
  }
  return types;
}

/** The events of an event log, as [{channel, bytes}, ...]. */
export function readEvents(file) {
  const log = readFileSync(file);
  const events = [];
  for (let at = 0; at < log.length;) {
    if (log.readUInt32BE(at) !== EVENT.sync) throw new Error(`no event at ${at}`);
    const begin = at + EVENT.header_bytes;
    const end = begin + log.readInt32BE(at + 20);
    at = end + log.readInt32BE(at + 24);
    events.push({channel: log.toString("utf8", begin, end), bytes: new Uint8Array(log.subarray(end, at))});
  }
  return events;
}

/** Rows of a CSV file as objects of numbers or texts. */
function readCsv(file) {
  const [head, ...lines] = readFileSync(file, "utf8").trim().split("\n");
  const names = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((text, i) => [names[i], text])));
}

/** Runs a scenario. @return {events, table(channel)} */
export function realLog(...settings) {
  const folder = mkdtempSync(path.join(tmpdir(), "fogline-page-"));
  try {
    const file = path.join(folder, "run.lcm");
    const run = (...command) => execFileSync(process.env.FOGLINE, command, {stdio: "pipe"});
    run("run", path.join(root, "scenario/dense_fog.json"), "--transport", "direct", "--log", file,
        ...settings.flatMap((setting) => ["--set", setting]));
    run("export", file, "--out", path.join(folder, "out"));
    const tables = Object.fromEntries(readdirSync(path.join(folder, "out"))
      .filter((name) => name.endsWith(".csv"))
      .map((name) => [path.basename(name, ".csv"), readCsv(path.join(folder, "out", name))]));
    return {events: readEvents(file), table: (channel) => tables[channel]};
  } finally {
    rmSync(folder, {recursive: true});
  }
}
