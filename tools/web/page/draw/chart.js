// A uPlot chart over simulated time, in the style of the report's charts (tools/report/chart.js).

import uPlot from "uplot";

import {decimal, timeTick} from "./format.js";
import {upTo} from "../data/modes.js";

const VALUE_AXIS_WIDTH = 52;  // equal in all charts, so that their time axes line up
export const TOP = 8;         // space above the plot, in pixels
const RIGHT = 28;             // space right of the plot, for half of the longest time label
const SYNC = "time";          // all charts share the reader's cursor

export const stepped = uPlot.paths.stepped({align: 1});

function decimalsOf(increment) {
  let decimals = 0;
  while (decimals < 6 && Math.abs(Number(increment.toFixed(decimals)) / increment - 1) > 1e-6) {
    ++decimals;
  }
  return decimals;
}

const valueTicks = (chart, ticks, axis, space, increment) =>
  ticks.map((tick) => decimal(tick, decimalsOf(increment)));
const timeTicks = (chart, ticks, axis, space, increment) =>
  ticks.map((tick) => timeTick(tick, increment, decimalsOf(increment)));

// Distances between the ticks of a time axis, in s. Below 10 s they are 1, 2 or 5 times a power of
// ten. Then come 10, 20 and 30 s, whole minutes, and whole hours.
const TIME_INCREMENTS = [
  ...[-4, -3, -2, -1, 0].flatMap((power) => [1, 2, 5].map((digit) => Number(`${digit}e${power}`))),
  10, 20, 30, ...[1, 2, 5, 10, 20, 30].map((minutes) => 60 * minutes),
  ...[1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].map((hours) => 3600 * hours)];

function axisOptions(theme, more) {
  const lines = {stroke: theme.grid, width: 1};
  return {stroke: theme.muted, font: `12px ${theme.font}`, grid: lines, ticks: {...lines, size: 4},
          gap: 5, ...more};
}

/** The range [low, high], widened by a margin. Its length is at least `least`. */
export function widened(low, high, least) {
  if (!(low <= high)) return [0, Math.max(1, least)];
  const margin = 0.06 * Math.max(high - low, least);
  const lack = Math.max(0, least - (high - low)) / 2;
  return [low - margin - lack, high + margin + lack];
}

/**
 * Makes a chart in `element`.
 * @param options {theme, height, lines: [{stroke, dash, width, paths}], valueRange(chart, low,
 * high), timeAxis, top, below(chart), above(chart), onPick(time), onSpan(from, to), onWhole()}
 */
export function makeChart(element, options) {
  const {theme, lines} = options;
  const withTimeAxis = options.timeAxis ?? true;
  const chart = new uPlot({
    width: Math.max(120, element.clientWidth),
    height: options.height,
    padding: [options.top ?? TOP, RIGHT, withTimeAxis ? 0 : 4, 0],
    legend: {show: false},
    series: [{}, ...lines.map(({stroke, dash, width, paths}) => (
      {stroke, dash, width: width ?? 1.75, paths, points: {show: false}, spanGaps: false}))],
    scales: {
      x: {time: false, auto: false, range: (_, min, max) => [min, max]},
      y: {range: options.valueRange},
    },
    axes: [
      axisOptions(theme, withTimeAxis ? {space: 64, size: 28, incrs: TIME_INCREMENTS, values: timeTicks}
                                      : {space: 64, size: 0, incrs: TIME_INCREMENTS,
                                         values: () => [], ticks: {show: false}}),
      axisOptions(theme, {space: 30, size: VALUE_AXIS_WIDTH, values: valueTicks,
                          ...options.valueAxis}),
    ],
    cursor: {
      y: false,
      points: {size: 6},
      sync: {key: SYNC, scales: ["x", null]},
      drag: {x: Boolean(options.onSpan), y: false, dist: 6, setScale: false},
      bind: {dblclick: () => () => options.onWhole?.()},
    },
    hooks: {
      drawClear: [(made) => clipped(made, () => options.below?.(made))],
      draw: [(made) => clipped(made, () => options.above?.(made))],
      setSelect: [(made) => {
        const {left, width} = made.select;
        if (width <= 0) return;
        options.onSpan?.(made.posToVal(left, "x"), made.posToVal(left + width, "x"));
        made.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
      }],
      setCursor: [(made) => options.onCursor?.(made)],
    },
  }, [[], ...lines.map(() => [])], element);
  if (options.onPick) listenForPick(chart, options.onPick);
  return chart;
}

/** Calls onPick with the time of a click. A drag is not a click. */
function listenForPick(chart, onPick) {
  let pressedAt = null;
  chart.over.addEventListener("pointerdown", ({clientX}) => { pressedAt = clientX; });
  chart.over.addEventListener("click", ({clientX, detail}) => {
    if (detail !== 1 || pressedAt === null || Math.abs(clientX - pressedAt) > 5) return;
    onPick(chart.posToVal(clientX - chart.over.getBoundingClientRect().left, "x"));
  });
}

/** Draws within the plot and the space above it. */
function clipped(chart, draw) {
  const {ctx, bbox} = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, 0, bbox.width, bbox.top + bbox.height);
  ctx.clip();
  draw();
  ctx.restore();
}

/** Fills a time span over the height of the plot, or over `height` canvas pixels from `top` on. */
export function fillSpan(chart, from, to, fill, top = chart.bbox.top, height = chart.bbox.height) {
  const left = chart.valToPos(from, "x", true);
  chart.ctx.fillStyle = fill;
  chart.ctx.fillRect(left, top, Math.max(1, chart.valToPos(to, "x", true) - left), height);
}

/** Draws the vertical line of the shown moment. */
export function drawNow(chart, time, colour) {
  const {ctx, bbox} = chart;
  const x = Math.round(chart.valToPos(time, "x", true)) + 0.5;
  ctx.strokeStyle = colour;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
}

/** Replaces NaN by null, because uPlot leaves a gap where a value is null. */
function withGaps(values) {
  return values.some(Number.isNaN) ? Array.from(values, (v) => Number.isNaN(v) ? null : v) : values;
}

/** Columns of several series on one time axis. */
export function joined(columns) {
  const [{times: first}] = columns;
  const isFirst = (times) => times === first ||
    (times.length === first.length && times.every((time, i) => time === first[i]));
  if (columns.every(({times}) => isFirst(times))) {
    return [first, ...columns.map(({values}) => withGaps(values))];
  }
  return uPlot.join(columns.map(({times, values}) => [times, withGaps(values)]));
}

/** Smallest and largest value of columns within [from, to]. */
export function extremes(columns, from, to) {
  let [low, high] = [Infinity, -Infinity];
  for (const {times, values} of columns) {
    const end = upTo(times, to);
    for (let i = Math.max(0, upTo(times, from)); i <= end; ++i) {
      if (values[i] < low) low = values[i];
      if (values[i] > high) high = values[i];
    }
  }
  return [low, high];
}
