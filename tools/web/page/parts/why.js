// Shows why this side drives, over the last 20 s: conflict and threshold, authorities, and the
// error of each sensor.

import {drawNow, extremes, fillSpan, joined, makeChart, stepped, TOP, widened}
  from "../draw/chart.js";
import {byId, hatch, say} from "../draw/dom.js";
import {decimal, withUnit} from "../draw/format.js";
import {MOST_POINTS} from "../data/log_store.js";
import {requestSpans, sideSpans, spansOf, upTo} from "../data/modes.js";
import {Series, whereValid} from "../data/series.js";
import {withAlpha} from "../draw/theme.js";

export const WINDOW_S = 20;
// The band for the side that drives, above the curves of the conflict, in pixels.
const BAND = {height: 12, gap: 5};
const LEAST_ERROR_SPAN_M = 0.5;
const MANY_M = 100;

/** The values whose errors are drawn: {key, channel, path, label}. */
const SOURCES = [
  {key: "radar", channel: "RADAR", path: "range_m", label: "radar"},
  {key: "lidar", channel: "LIDAR", path: "range_m", label: "LiDAR"},
  {key: "fusion", channel: "TRACK", path: "state[0]", label: "fusion"},
];

/** Draws the side that drives as a band: a colour and a pattern for each side. */
export function drawBand(chart, spans, theme, top, height) {
  const {ctx} = chart;
  for (const {from, to, value: side} of spans) {
    if (side === "unknown") continue;
    fillSpan(chart, from, to, theme[side], top, height);
    if (side === "automation") continue;
    const lines = hatch(ctx, theme.surface, {both: side === "risk", size: 5});
    lines.setTransform(new DOMMatrix());
    fillSpan(chart, from, to, lines, top, height);
  }
}

/**
 * The values of a source minus the truth; NaN where the source has no value. Both series must have
 * every value of the shown time, because the extremes of two series come from different steps.
 */
function errorColumns({times, values}, valid, truth) {
  const seen = whereValid({times, values}, valid);
  return {times, values: seen.values.map((one, i) => one - truth.at(times[i]))};
}

/** The columns up to a time. */
function upToTime({times, values}, time) {
  const n = upTo(times, time) + 1;
  return {times: times.subarray(0, n), values: values.subarray(0, n)};
}

/** An error in m, as text. A large error has no decimals, because they have no meaning. */
function errorInWords(error_m) {
  if (Number.isNaN(error_m)) return "no value";
  return withUnit(decimal(error_m, Math.abs(error_m) < MANY_M ? 2 : 0), "m");
}

const NOTHING = new Series();

export class Why {
  constructor(onPick) {
    this.onPick = onPick;
    this.charts = [];
  }

  /** Begins with another store, or with other colours. */
  build(store, theme) {
    for (const chart of this.charts) chart.destroy();
    this.store = store;
    this.theme = theme;
    this.moment = {time: 0};
    this.modes = store.changes("HOST_COMMAND", "mode");
    this.lambdas = store.changes("HOST_COMMAND", "lambda_human");
    this.fog = store.changes("TRUTH", "fog_present");
    this.valid = SOURCES.map(({channel}) => store.changes(channel, "valid"));
    this.charts = [this.makeConflict(), this.makeAuthority(), this.makeErrors()];
    this.drawn = "";
    this.drawnAt = 0;
  }

  chart(id, options) {
    return makeChart(byId(id), {
      theme: this.theme, onPick: this.onPick, below: (chart) => this.drawFog(chart),
      above: (chart) => drawNow(chart, this.moment.time, this.theme.muted), ...options});
  }

  makeConflict() {
    const {ink, risk} = this.theme;
    return this.chart("why-doc", {
      height: 168, top: TOP + BAND.height + BAND.gap, timeAxis: false,
      lines: [{stroke: ink, width: 2}, {stroke: risk, dash: [6, 4], width: 1.75, paths: stepped}],
      valueRange: () => [-0.04, 1.04],
      valueAxis: {splits: () => [0, 0.25, 0.5, 0.75, 1]},
      below: (chart) => {
        this.drawFog(chart);
        const height = BAND.height * devicePixelRatio;
        const top = TOP * devicePixelRatio;
        drawBand(chart, this.sideSpans(), this.theme, top, height);
        const requests = requestSpans(this.modes, this.range[0], this.shownEnd, this.shownEnd);
        for (const {from, to} of requests) fillSpan(chart, from, to, this.theme.risk, top, height / 3);
      }});
  }

  makeAuthority() {
    const {automation, human} = this.theme;
    return this.chart("why-authority", {
      height: 74, timeAxis: false,
      lines: [{stroke: automation, width: 2, paths: stepped},
              {stroke: human, dash: [2, 3], width: 2.25, paths: stepped}],
      valueRange: () => [-0.12, 1.12],
      valueAxis: {splits: () => [0, 1]}});
  }

  makeErrors() {
    const {radar, lidar, ink} = this.theme;
    return this.chart("why-errors", {
      height: 178,
      lines: [{stroke: radar, dash: [2, 3], width: 2},
              {stroke: lidar, dash: [8, 3, 2, 3], width: 2}, {stroke: ink, width: 1.75}],
      valueRange: () => this.errorRange ?? [-1, 1],
      below: (chart) => {
        this.drawFog(chart);
        const {ctx, bbox} = chart;
        ctx.fillStyle = withAlpha(this.theme.muted, 0.6);
        ctx.fillRect(bbox.left, chart.valToPos(0, "y", true), bbox.width, devicePixelRatio);
      }});
  }

  drawFog(chart) {
    for (const {from, to} of this.fogSpans()) fillSpan(chart, from, to, this.theme.fog);
  }

  fogSpans() {
    const {times, values} = this.fog.within(this.range[0], this.shownEnd);
    return spansOf(times, values, this.shownEnd).filter(({value}) => value);
  }

  sideSpans() {
    return sideSpans(this.modes, this.lambdas, this.range[0], this.shownEnd, this.shownEnd);
  }

  /** Every value of a field in the shown time. The series is empty until the values have come. */
  shown(channel, path) {
    const series = this.store.detail(channel, path, ...this.range, MOST_POINTS);
    return series.whole ? series : NOTHING;
  }

  /** The shown moment, or the last known time if this is earlier. Nothing later is shown. */
  get shownEnd() {
    return Math.min(this.moment.time, this.store.lastTime);
  }

  /** First and last time of the charts. In the first 20 s the last time is after the moment. */
  get range() {
    const end = Math.max(this.moment.time, this.store.firstTime + WINDOW_S);
    return [end - WINDOW_S, end];
  }

  /** All series of the charts, at a moment. A log store fetches the series that it lacks. */
  fetch(moment) {
    this.moment = moment;
    const command = (path) => this.shown("HOST_COMMAND", path);
    return {
      commands: ["doc", "threshold", "lambda_automation", "lambda_human"].map(command),
      truth: this.shown("TRUTH", "host_gap_m"),
      sources: SOURCES.map(({channel, path}) => this.shown(channel, path)),
    };
  }

  /** Draws the moment. While time goes on, there are at least `rest_ms` between two drawings. */
  draw(moment, rest_ms) {
    const {commands, truth, sources} = this.fetch(moment);
    const [doc, threshold, automation, human] = commands;
    const all = [...commands, truth, ...sources, ...this.valid, this.modes, this.lambdas, this.fog];
    const drawn = `${moment.time} ${all.map(({version}) => version)}`;
    if (drawn === this.drawn && moment.frame === this.frame) return;
    const now = performance.now();
    if (moment.moves && now - this.drawnAt < rest_ms) return;
    this.drawnAt = now;
    this.drawn = drawn;
    this.frame = moment.frame;
    const [from, to] = this.range;
    const part = (series) => upToTime(series.within(from, moment.time), moment.time);
    const errors = sources.map((values, i) => {
      const isThere = truth.length > 0 && this.valid[i].length > 0;
      return errorColumns(part(isThere ? values : NOTHING), this.valid[i], truth);
    });
    this.errorRange = widened(...extremes(errors, from, to), LEAST_ERROR_SPAN_M);
    const columns = [[part(doc), part(threshold)], [part(automation), part(human)], errors];
    this.charts.forEach((chart, i) => {
      chart.setData(joined(columns[i]), false);
      chart.setScale("x", {min: from, max: to});
    });
    this.sayValues(moment, errors);
  }

  /** Shows the numbers of the shown moment, beside the names of the curves. */
  sayValues({frame, time}, errors) {
    const {HOST_COMMAND: command} = frame ?? {};
    say(byId("value-doc"), decimal(command?.doc, 2));
    say(byId("value-threshold"), decimal(command?.threshold, 2));
    say(byId("value-automation"), decimal(command?.lambda_automation, 2));
    say(byId("value-human"), decimal(command?.lambda_human, 2));
    SOURCES.forEach(({key}, i) => {
      const {times, values} = errors[i];
      const place = upTo(times, time);
      say(byId(`value-${key}`), place < 0 ? "" : errorInWords(values[place]));
    });
  }

  resize() {
    const ids = ["why-doc", "why-authority", "why-errors"];
    this.charts.forEach((chart, i) => {
      const width = byId(ids[i]).clientWidth;
      if (width > 0 && width !== chart.width) chart.setSize({width, height: chart.height});
    });
  }
}
