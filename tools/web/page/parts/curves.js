// Curves of the fields that the reader has chosen. Fields with the same unit share a chart.

import {Combobox} from "./combobox.js";
import {drawNow, extremes, fillSpan, joined, makeChart, widened} from "../draw/chart.js";
import {DASHES, placesOf} from "../draw/curve_styles.js";
import {byId, make, say, setAttribute} from "../draw/dom.js";
import {searchFields} from "../data/catalogue.js";
import {digits, seconds, withUnit} from "../draw/format.js";
import {EARLY} from "../data/clock.js";
import {numberAt, parsePath} from "../data/lcm.js";
import {modeOf, spansOf} from "../data/modes.js";
import {whereValid} from "../data/series.js";

const FIRST_FIELDS = ["TRUTH.host_gap_m", "RADAR.range_m", "LIDAR.range_m", "TRUTH.host_speed_mps"];
const MOST_FIELDS = 8;         // number of colours
const MOST_SUGGESTIONS = 40;
const MINUTE_S = 60;
// Pause between drawings: `factor` times as long as the last drawing took, but at most `most_ms`.
const REST = {most_ms: 1000, factor: 5};
const LEAST_SPAN = 1e-3;  // least range of a value axis, as a share of the largest absolute value
// The value at a time comes from a short series: from NEAR_S before the time to NEAR_S after it. A
// longer series may have only the extremes of each span.
const NEAR_S = 10;
const KEEP = "fogline.fields";
const valueId = (index) => `value-of-field-${index}`;
const NAMES = {"HOST_COMMAND.mode": (mode) => modeOf(mode).name};  // names of values, by field

/** The reader's last choice if the browser has stored it; otherwise FIRST_FIELDS. */
function keptFields() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEEP));
    return Array.isArray(kept) ? kept.filter((name) => typeof name === "string") : FIRST_FIELDS;
  } catch {
    return FIRST_FIELDS;
  }
}

function keepFields(fields) {
  try {
    localStorage.setItem(KEEP, JSON.stringify(fields.map(({name}) => name)));
  } catch { /* the browser stores nothing */ }
}

/** A short piece of a curve, for the legend. */
function lineKey(colour, dash) {
  const draw = (kind, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", kind);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const svg = draw("svg", {class: "line-key", width: 26, height: 8, "aria-hidden": "true"});
  svg.append(draw("line", {x1: 0, x2: 26, y1: 4, y2: 4, stroke: colour, "stroke-width": 2.5,
                           "stroke-dasharray": dash.join(" ")}));
  return svg;
}

export class Curves {
  /**
   * @param onPick(time) is called for a click on a chart; onFull(words) is called if the reader
   * chooses more than MOST_FIELDS fields
   */
  constructor({onPick, onFull}) {
    this.onPick = onPick;
    this.onFull = onFull;
    this.place = byId("charts");
    this.chips = byId("chosen");
    this.charts = [];
    this.known = [];  // fields of the run; empty before there is a connection
    this.fields = [];
    this.span = "minute";  // "minute", "all", or [from, to] after a zoom
    this.hover = null;
    this.drawnAt = 0;
    this.cost_ms = 0;
    this.isCurrent = false;  // whether the charts show all values that have come
    this.box = new Combobox(byId("field-search"), byId("field-list"), {
      suggest: (typed) => this.suggestions(typed),
      onChoose: (name) => this.toggle(name),
    });
    for (const button of document.querySelectorAll("[data-span]")) {
      button.addEventListener("click", () => this.setSpan(button.dataset.span));
    }
    byId("curves").addEventListener("pointerleave", () => { this.hover = null; });
  }

  suggestions(typed) {
    const exact = /\[\d+\]/.test(typed) ? this.fieldNamed(typed.trim()) : null;
    const found = searchFields(this.known, typed, MOST_SUGGESTIONS);
    if (exact && !found.some(({name}) => name === exact.name)) found.unshift(exact);
    return found.map((field) => {
      const chosen = this.fields.some(({name}) => name === field.name);
      const comment = chosen ? "chosen; choose it again to remove it" : field.comment;
      return {key: field.name, chosen, parts: [
        make("span", {class: "field-name"}, field.name),
        make("span", {class: "field-unit"}, field.unit),
        make("span", {class: "field-comment"}, comment)]};
    });
  }

  /** Begins with another store, new channels, or other colours. */
  build(store, catalogue, theme) {
    this.store = store;
    this.theme = theme;
    this.known = catalogue.fields();
    const wanted = this.fields.length ? this.fields.map(({name}) => name) : keptFields();
    this.fields = wanted.map((name) => this.fieldNamed(name)).filter(Boolean).slice(0, MOST_FIELDS);
    this.rebuild();
  }

  /** The field with this name: a known field or another element of a known list; null if none. */
  fieldNamed(name) {
    const known = this.known.find((field) => field.name === name);
    if (known) return known;
    const pattern = name.replace(/\[\d+\]/g, "[0]");
    const first = this.known.find((field) => field.name === pattern);
    return first ? {...first, name, path: name.slice(first.channel.length + 1)} : null;
  }

  toggle(name) {
    const place = this.fields.findIndex((field) => field.name === name);
    if (place < 0 && this.fields.length === MOST_FIELDS) {
      this.onFull(`At most ${MOST_FIELDS} curves are shown. Remove one before you add ${name}.`);
      return;
    }
    if (place >= 0) this.fields.splice(place, 1);
    else this.fields.push(this.fieldNamed(name));
    keepFields(this.fields);
    this.rebuild();
  }

  styleOf(index) {
    const place = this.places[index];
    return {stroke: this.theme.palette[place], dash: DASHES[place]};
  }

  rebuild() {
    for (const {chart} of this.charts) chart.destroy();
    this.place.replaceChildren();
    this.places = placesOf(this.fields);
    const units = [...new Set(this.fields.map(({unit}) => unit))];
    const n = units.length;
    this.charts = units.map((unit, i) => this.makePanel(unit, i === n - 1, n));
    this.makeChips();
    byId("no-fields").hidden = this.fields.length > 0;
    this.drawn = "";
    this.drawnAt = 0;
  }

  makePanel(unit, isLast, panels) {
    const fields = this.fields.filter((field) => field.unit === unit);
    const names = fields.map(({name}) => name).join(", ");
    const label = `Curves over time: ${names}`;
    const values = fields.map((field) => valueId(this.fields.indexOf(field))).join(" ");
    const element = make("div", {class: "chart", role: "img", "aria-label": label, "aria-describedby": values});
    this.place.append(make("p", {class: "axis-name"}, unit || "no unit"), element);
    const panel = {fields, element, range: [0, 1]};
    panel.chart = makeChart(element, {
      theme: this.theme,
      height: (panels > 1 ? 170 : 280) + (isLast ? 28 : 0),
      timeAxis: isLast,
      lines: fields.map((field) => this.styleOf(this.fields.indexOf(field))),
      valueRange: () => panel.range,
      below: (chart) => this.drawFog(chart),
      above: (chart) => drawNow(chart, this.moment?.time ?? 0, this.theme.muted),
      onPick: this.onPick,
      onSpan: (from, to) => this.setSpan([from, to]),
      onWhole: () => this.setSpan("all"),
      onCursor: (chart) => {
        if (chart.cursor.left >= 0 && chart.cursor.event) {
          this.hover = chart.posToVal(chart.cursor.left, "x");
        }
      },
    });
    return panel;
  }

  makeChips() {
    this.values = this.fields.map((_, i) => make("span", {class: "value", id: valueId(i)}));
    this.chips.replaceChildren(...this.fields.map((field, i) => {
      const {stroke, dash} = this.styleOf(i);
      const remove = make("button", {
        type: "button", class: "remove", "aria-label": `Remove ${field.name}`}, "×");
      remove.addEventListener("click", () => {
        this.toggle(field.name);
        byId("field-search").focus();
        this.box.close();
      });
      return make("li", {title: field.comment}, lineKey(stroke, dash),
                  make("span", {class: "field-name"}, field.name), this.values[i], remove);
    }));
  }

  setSpan(span) {
    this.span = span;
    for (const button of document.querySelectorAll("[data-span]")) {
      setAttribute(button, "aria-pressed", String(button.dataset.span === span));
    }
    this.drawn = "";
    this.drawnAt = 0;
  }

  /** First and last time that the charts show. */
  range(time) {
    if (Array.isArray(this.span)) return this.span;
    const {firstTime, lastTime} = this.store;
    if (this.span === "all") return [firstTime, Math.max(lastTime, firstTime + 1)];
    const end = Math.max(time, firstTime + MINUTE_S);
    return [end - MINUTE_S, end];
  }

  seriesOf({channel, path}, from, to) {
    return this.store.detail(channel, path, from, to);
  }

  /**
   * The changes of the channel's field `valid`, which says whether the sensor has a value; null for
   * a field that always has a value.
   */
  validOf({channel, path}) {
    const depends = path !== "valid" && !path.startsWith("header.") && this.fieldNamed(`${channel}.valid`);
    return depends ? this.store.changes(channel, "valid") : null;
  }

  /** The values of a field in this time, with a gap where a sensor has no value. */
  columnsOf(field, from, to) {
    const columns = this.seriesOf(field, from, to).within(from, to);
    const valid = this.validOf(field);
    return valid?.length ? whereValid(columns, valid) : columns;
  }

  drawFog(chart) {
    const {min, max} = chart.scales.x;
    if (min == null) return;
    const {times, values} = this.store.changes("TRUTH", "fog_present").within(min, max);
    for (const span of spansOf(times, values, Math.min(max, this.store.lastTime))) {
      if (span.value) fillSpan(chart, span.from, span.to, this.theme.fog);
    }
  }

  /** All series of the charts, at a moment. A log store fetches the series that it lacks. */
  fetch({time}) {
    const [from, to] = this.range(time);
    return this.fields.flatMap((field) => [this.seriesOf(field, from, to), this.validOf(field)]);
  }

  /** Draws the moment. There are at least `least_ms` between two drawings. */
  draw(moment, least_ms) {
    this.moment = moment;
    this.sayValues(moment);
    const now = performance.now();
    const rest_ms = Math.min(REST.most_ms, Math.max(least_ms, REST.factor * this.cost_ms));
    this.isCurrent = now - this.drawnAt >= rest_ms;
    if (!this.isCurrent) return;
    const [from, to] = this.range(moment.time);
    const series = this.fetch(moment);
    const drawn = `${from} ${to} ${moment.time} ${series.map((one) => one?.version)}`;
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    for (const panel of this.charts) this.drawPanel(panel, from, to);
    this.drawnAt = performance.now();
    this.cost_ms = this.drawnAt - now;
  }

  drawPanel({chart, fields, range}, from, to) {
    const columns = fields.map((field) => this.columnsOf(field, from, to));
    const [low, high] = extremes(columns, from, to);
    const size = Math.max(1e-6, Math.abs(low) || 0, Math.abs(high) || 0);
    [range[0], range[1]] = widened(low, high, LEAST_SPAN * size);
    chart.setData(joined(columns), false);
    chart.setScale("x", {min: from, max: to});
  }

  /** The last value of a field at or before a time; NaN until the data have come. */
  valueAt({channel, path, isStepwise}, time) {
    const series = this.seriesOf({channel, path}, ...this.range(this.moment.time));
    if (series.whole) return series.at(time);
    // The series of a long time has only the extremes of each span. So the value comes from the
    // series of a short time around `time`, or from the messages of the step.
    if (!isStepwise) {
      const near = this.seriesOf({channel, path}, time - NEAR_S, time + NEAR_S);
      return near.whole ? near.at(time) : NaN;
    }
    const frame = this.store.frame(Math.floor(time / this.store.run.step_s + EARLY));
    return numberAt(frame?.[channel], parsePath(path));
  }

  /**
   * Shows values with about four digits: the values at the cursor or, without a cursor, the values
   * of the shown moment.
   */
  sayValues({frame, time, run}) {
    const hover = this.hover;
    this.fields.forEach((field, i) => {
      const {channel, path, unit, isStepwise} = field;
      const isThere = this.validOf(field)?.at(hover ?? time) !== 0;  // a sensor may have no value
      const value = !isThere ? NaN
        : hover === null && isStepwise ? numberAt(frame?.[channel], parsePath(path))
        : this.valueAt(field, hover ?? time);
      say(this.values[i], withUnit(digits(value), Number.isNaN(value) ? unit : NAMES[field.name]?.(value) ?? unit));
      setAttribute(this.values[i], "data-value", String(value));
    });
    const [from, to] = Array.isArray(this.span) ? this.span : [-Infinity, Infinity];  // of a zoom
    const outside = time < from || time > to ? ", which is outside of the charts" : "";
    const {firstStep, firstTime} = this.store;
    const begin = firstStep > 0 ? `. The data begin at ${seconds(firstTime, run.step_s)}` : "";
    const place = hover === null ? `Values at ${seconds(time, run.step_s)}${outside}`
                                 : `Values at the cursor, ${seconds(hover, run.step_s)}`;
    say(byId("curves-at"), place + begin);
  }

  resize() {
    for (const {chart, element} of this.charts) {
      const width = element.clientWidth;
      if (width > 0 && width !== chart.width) chart.setSize({width, height: chart.height});
    }
  }
}
