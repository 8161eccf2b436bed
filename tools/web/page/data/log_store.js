// The messages of a recorded run. The page fetches them from the server when it needs them.

import {timeOfStep, withTimeOfHeaders} from "./clock.js";
import {Series} from "./series.js";

const CHUNK = 64;          // number of steps that are fetched together
const KEEP_CHUNKS = 64;
export const MOST_POINTS = 20000;  // of a series; the server sends up to twice as many values
const DETAIL_POINTS = 4000;  // of a curve over a part of the log
const KEEP_DETAILS = 48;     // number of stored parts; the charts show 16 at a time

export class LogStore {
  constructor(catalogue, wire) {
    this.catalogue = catalogue;
    this.wire = wire;
    this.run = null;
    this.chunks = new Map();   // by number; the last used chunk is last
    this.wanted = new Map();   // series by field name
    this.details = new Map();
    this.fetching = null;      // number of the chunk that was requested
    this.next = null;          // number of the chunk to request next
    this.firstStep = 0;
    this.lastStep = -1;
    this.arrived_ms = 0;
  }

  setRun(run) { this.run = withTimeOfHeaders(run); }

  setLog({first_step, last_step}) {
    this.firstStep = first_step;
    this.lastStep = last_step;
  }

  timeOf(step) { return timeOfStep(step, this.run?.step_s ?? 0.1); }
  get firstTime() { return this.timeOf(this.firstStep); }
  get lastTime() { return this.timeOf(Math.max(0, this.lastStep)); }

  /** The messages of a step: {NAME: message}; null until they have come. */
  frame(step) {
    if (step < this.firstStep || step > this.lastStep) return null;
    const number = Math.floor(step / CHUNK);
    const chunk = this.chunks.get(number);
    if (!chunk) {
      this.want(number);
      return null;
    }
    this.chunks.delete(number);
    this.chunks.set(number, chunk);
    if (step % CHUNK >= CHUNK / 2 && !this.chunks.has(number + 1) &&
        (number + 1) * CHUNK <= this.lastStep) {
      this.want(number + 1);
    }
    return this.decoded(chunk, step);
  }

  decoded(chunk, step) {
    if (chunk.step === step) return chunk.frame;
    const frame = {};
    for (const {channel: id, bytes} of chunk.messages.get(step) ?? []) {
      const channel = this.catalogue.channels.get(id);
      const message = this.catalogue.decode(channel, bytes);
      if (message) frame[channel.name] = message;
    }
    chunk.step = step;
    chunk.frame = frame;
    return frame;
  }

  /**
   * Fetches a chunk. One chunk is fetched at a time. If several chunks wait, only the chunk that
   * was requested last is fetched.
   */
  want(number) {
    if (this.fetching === number) return;
    if (this.fetching !== null) {
      this.next = number;
      return;
    }
    this.fetching = number;
    const from = Math.max(this.firstStep, number * CHUNK);
    const to = Math.min(this.lastStep, number * CHUNK + CHUNK - 1);
    this.wire.ask({op: "steps", from, to})
      .then(({messages}) => this.keep(number, messages), () => {})
      .finally(() => {
        this.fetching = null;
        const {next} = this;
        this.next = null;
        if (next !== null && !this.chunks.has(next)) this.want(next);
      });
  }

  keep(number, messages) {
    const chunk = {messages: new Map(), step: null, frame: null};
    for (const message of messages) {
      if (!chunk.messages.has(message.step)) chunk.messages.set(message.step, []);
      chunk.messages.get(message.step).push(message);
    }
    this.chunks.set(number, chunk);
    for (const oldest of this.chunks.keys()) {
      if (this.chunks.size <= KEEP_CHUNKS) break;
      this.chunks.delete(oldest);
    }
  }

  fetchSeries(series, question) {
    this.wire.ask({op: "series", ...question}).then((answer) => {
      series.whole = answer.whole;
      series.replace(answer);
    }, () => {});
  }

  /** Fetches a field over the whole log. @param more further members of the request */
  fetchWhole(channel, path, more = {}) {
    const name = JSON.stringify([channel, path, more]);
    if (!this.wanted.has(name)) {
      const series = new Series();
      this.wanted.set(name, series);
      const {firstStep: from, lastStep: to} = this;
      this.fetchSeries(series, {channel, field: path, from, to, points: MOST_POINTS, ...more});
    }
    return this.wanted.get(name);
  }

  /**
   * The values of a field over the whole log; of a long log only the extremes of each span. The
   * series is empty until the values have come.
   */
  series(channel, path) { return this.fetchWhole(channel, path); }

  /**
   * The values of a field that seldom changes, over the whole log: the first value, and each value
   * that differs from the value before. So at() gives the exact value, however long the log is.
   */
  changes(channel, path) { return this.fetchWhole(channel, path, {changes: true}); }

  /**
   * The values of a field in the window between two times. A fetched part is twice as long as the
   * window, and begins at a multiple of the window's length. So a moving window seldom needs
   * another part. The next part is fetched early.
   * @param points if the part has more than twice this number of values, the series has only
   * extremes
   */
  detail(channel, path, from_s, to_s, points = DETAIL_POINTS) {
    if (this.lastStep - this.firstStep < 2 * MOST_POINTS) {
      const whole = this.series(channel, path);
      if (whole.whole) return whole;
    }
    const {step_s} = this.run;
    const length = Math.max(1, Math.ceil((to_s - from_s) / step_s));
    const place = from_s / step_s / length;  // beginning of the window, in lengths of the window
    const part = (begin) => this.part(channel, path, begin * length, (begin + 2) * length, points);
    if (place - Math.floor(place) > 0.5) part(Math.floor(place) + 1);
    return part(Math.floor(place));
  }

  part(channel, path, begin, end, points) {
    const from = Math.min(Math.max(this.firstStep, begin), this.lastStep);
    const to = Math.max(from, Math.min(this.lastStep, end - 1));
    const name = JSON.stringify([channel, path, from, to, points]);
    if (!this.details.has(name)) {
      for (const oldest of this.details.keys()) {
        if (this.details.size < KEEP_DETAILS) break;
        this.details.delete(oldest);
      }
      const series = new Series();
      this.details.set(name, series);
      this.fetchSeries(series, {channel, field: path, from, to, points});
    }
    const detail = this.details.get(name);
    this.details.delete(name);
    this.details.set(name, detail);  // the last used part is last
    return detail;
  }
}
