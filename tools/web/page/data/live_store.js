// The messages of a live run, as far back as the page stores them.

import {timeOfStep, withTimeOfHeaders} from "./clock.js";
import {headerOf} from "./catalogue.js";
import {numberAt, parsePath} from "./lcm.js";
import {upTo} from "./modes.js";
import {Series} from "./series.js";

const KEEP_S = 600;              // of simulated time
const KEEP_BYTES = 96 * 2 ** 20;         // of all channels with a message in every step
const KEEP_CONTROL_BYTES = 4 * 2 ** 20;  // of each other channel, and of each role's STATUS
const AWAY_MS = 2000;            // all processes of the run are silent if nothing has come for this long
const TIDY_AFTER = 4096;         // messages between two removals of old messages

/** Messages of one channel in the order of their steps. */
class Track {
  constructor(channel) {
    this.channel = channel;
    this.steps = [];
    this.times = [];
    this.messages = [];  // bytes of each message
    this.bytes = 0;
  }

  get lastStep() { return this.steps.at(-1) ?? -Infinity; }
  get lastTime() { return this.times.at(-1) ?? -Infinity; }

  /** Adds a copy of the bytes, because a part of a frame would keep the whole frame in memory. */
  add({step, time_s}, bytes) {
    this.steps.push(step);
    this.times.push(time_s);
    this.messages.push(bytes.slice());
    this.bytes += bytes.byteLength;
  }

  forgetBefore(time) {
    const kept = this.times.findIndex((one) => one >= time);
    this.forgetFirst(kept < 0 ? this.times.length : kept);
  }

  forgetFirst(n) {
    for (const bytes of this.messages.splice(0, n)) this.bytes -= bytes.byteLength;
    this.steps.splice(0, n);
    this.times.splice(0, n);
  }
}

export class LiveStore {
  constructor(catalogue) {
    this.catalogue = catalogue;
    this.run = null;
    this.runId = null;
    this.heard_ms = -Infinity;  // wall clock of the server at the newest message of the run
    this.clear();
  }

  /** Forgets all messages. Series that were returned before do not grow after this call. */
  clear() {
    this.generation = (this.generation ?? 0) + 1;
    this.tracks = new Map();    // by channel name
    this.wanted = new Map();    // series by field name
    this.statuses = new Map();  // the newest STATUS of each role
    this.firstStep = 0;
    this.lastStep = -1;
    this.arrived_ms = 0;        // wall clock of the server at the newest step
    this.wasSilent = false;     // whether the run was silent for AWAY_MS after the newest step
    this.taken_ms = 0;          // clock of the page at the newest step
    this.count = 0;
    this.seenStep_s = null;
  }

  setRun(run) {
    const id = BigInt.asIntN(64, BigInt(run.run_id));
    if (id !== this.runId) this.clear();
    this.run = withTimeOfHeaders(run);
    this.runId = id;
  }

  /** Length of a step in s, from the scenario; before the scenario is known, from the messages. */
  get step_s() { return this.run?.step_s ?? this.seenStep_s ?? 0.1; }
  timeOf(step) { return timeOfStep(step, this.step_s); }
  get firstTime() { return this.timeOf(this.firstStep); }
  get lastTime() { return this.timeOf(Math.max(0, this.lastStep)); }

  add({channel: id, arrived_ms, bytes}) {
    const channel = this.catalogue.channels.get(id);
    if (!channel?.hasHeader) return;
    const header = headerOf(bytes);
    if (!header) return;
    this.runId ??= header.run_id;  // the server has not yet named the run that it follows
    if (header.run_id !== this.runId) return;
    if (arrived_ms - this.heard_ms > AWAY_MS) this.wasSilent = true;
    this.heard_ms = arrived_ms;
    if (channel.name === "STATUS") this.addStatus(channel, header, bytes);
    else if (channel.isStepwise) this.keep(channel, header, arrived_ms, bytes);
    else this.keepControl(channel.name, channel, header, bytes);
  }

  addStatus(channel, header, bytes) {
    const status = this.catalogue.decode(channel, bytes);
    if (!this.catalogue.roles.includes(status?.role)) return;
    this.statuses.set(status.role, status);
    this.keepControl(`${channel.name}/${status.role}`, channel, header, bytes);
  }

  /**
   * Keeps a message that does not belong to one step. The steps and times of the stored messages
   * never decrease: a smaller step or time is replaced by that of the message before.
   */
  keepControl(source, channel, {step, time_s}, bytes) {
    const track = this.track(source, channel);
    const header = {step: Math.max(step, track.lastStep), time_s: Math.max(time_s, track.lastTime)};
    track.add(header, bytes);
    this.extend(source, channel, header, bytes);
    if (track.bytes > KEEP_CONTROL_BYTES) this.halve(source, track);
    this.countOne();
  }

  /**
   * Forgets the older half of the messages of a channel. Their times may be equal, as after the end
   * of a run, so the times cannot select the messages.
   */
  halve(source, track) {
    track.forgetFirst(Math.ceil(track.messages.length / 2));
    for (const {channel, series} of this.wanted.values()) {
      if (channel === source) series.keepLast(track.messages.length);
    }
  }

  track(source, channel) {
    if (!this.tracks.has(source)) this.tracks.set(source, new Track(channel));
    return this.tracks.get(source);
  }

  countOne() {
    if (++this.count % TIDY_AFTER === 0) this.tidy();
  }

  keep(channel, header, arrived_ms, bytes) {
    if (this.beginsAgain(channel, header)) this.clear();
    const track = this.track(channel.name, channel);
    if (header.step <= track.lastStep) return;
    track.add(header, bytes);
    if (this.lastStep < 0) this.firstStep = header.step;
    if (header.step > this.lastStep) {
      this.lastStep = header.step;
      this.arrived_ms = arrived_ms;
      this.wasSilent = false;
      this.taken_ms = performance.now();
    }
    if (header.step > 0) this.seenStep_s = header.time_s / header.step;
    this.extend(channel.name, channel, header, bytes);
    this.countOne();
  }

  /**
   * Whether a log of the same run is played again. An old TRUTH then comes after a silence of the
   * whole run. A repair also brings old messages, but the run is not silent before a repair: its
   * processes send STATUS.
   */
  beginsAgain({name}, {step}) {
    return name === "TRUTH" && step < this.lastStep && this.wasSilent;
  }

  extend(source, channel, {time_s}, bytes) {
    let message = null;
    for (const wanted of this.wanted.values()) {
      if (wanted.channel !== source) continue;
      message ??= this.catalogue.decode(channel, bytes);
      if (message) wanted.series.push(time_s, numberAt(message, wanted.parts));
    }
  }

  tidy() {
    let oldest = this.lastTime - KEEP_S;
    let bytes = 0;
    for (const track of this.tracks.values()) if (track.channel.isStepwise) bytes += track.bytes;
    if (bytes > KEEP_BYTES) oldest = Math.max(oldest, (this.firstTime + this.lastTime) / 2);
    if (oldest <= this.firstTime) return;
    for (const track of this.tracks.values()) track.forgetBefore(oldest);
    for (const {series} of this.wanted.values()) series.forgetBefore(oldest);
    const firstSteps = [...this.tracks.values()].filter(({channel}) => channel.isStepwise)
      .map(({steps}) => steps[0] ?? Infinity);
    this.firstStep = Math.min(this.lastStep, ...firstSteps);
  }

  /**
   * The messages at a step: {NAME: message}; null before the first step. The result has the
   * newest message up to this step of each channel with a message in every step.
   */
  frame(step) {
    if (this.lastStep < 0) return null;
    const frame = {};
    for (const [name, {channel, steps, messages}] of this.tracks) {
      if (!channel.isStepwise) continue;
      const place = upTo(steps, step);
      const message = place < 0 ? null : this.catalogue.decode(channel, messages[place]);
      if (message) frame[name] = message;
    }
    return frame;
  }

  /** The values of a field. The series grows with the run. */
  series(channel, path) {
    const name = `${channel}.${path}`;
    if (!this.wanted.has(name)) {
      const parts = parsePath(path);
      const series = new Series();
      const track = this.tracks.get(channel);
      track?.messages.forEach((bytes, i) => {
        const message = this.catalogue.decode(track.channel, bytes);
        if (message) series.push(track.times[i], numberAt(message, parts));
      });
      this.wanted.set(name, {channel, parts, series});
    }
    return this.wanted.get(name).series;
  }

  // A live series already has every value.
  detail(channel, path) { return this.series(channel, path); }
  changes(channel, path) { return this.series(channel, path); }
}
