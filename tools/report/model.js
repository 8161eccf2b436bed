"use strict";
// State of the page: the runs and figures that it contains, and the reader's choices.

const report = JSON.parse(document.getElementById("report-data").textContent);

const PALETTE_SIZE = 8;
const CORES = 3;  // a line is plain, or has a core in the colour of the page or of the ink

report.runs.forEach((run, index) => {
  run.index = index;
  run.style = `c${index % PALETTE_SIZE} r${Math.floor(index / PALETTE_SIZE) % CORES}`;
  for (const name in run.columns) run.columns[name] = report.columns[run.columns[name]];
});

const state = {
  runs: report.runs,  // runs that the figures show
  apart: true,        // whether each run has a panel of its own
  hidden: new Map(),  // names of the columns that a figure hides, by figure id
  time: 0,            // time of the cursor, in s
  span: [0, 1],       // range of the time axes, in s
  zoomed: false,      // whether `span` is shorter than the runs
  fromZero: new Set(),  // ids of the figures whose value axes begin at zero
  theme: null,
};

/** Colours for the canvases, from the style sheet. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  state.theme = {
    palette: Array.from({length: PALETTE_SIZE}, (_, i) => colour(`--p${i}`)),
    ink: colour("--ink"),
    surface: colour("--surface"),
    muted: colour("--muted"),
    grid: colour("--grid"),
    fog: colour("--fog"),
    human: colour("--human"),
    humanLine: colour("--human-line"),
    short: colour("--short"),
    shared: colour("--shared"),
    font: getComputedStyle(document.body).fontFamily,
  };
}

/** Index of the last value that is at most `x`; 0 if all values are larger. `values` ascend. */
function placeOf(values, x) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/**
 * Time between samples, in s, of the first shown run that has several samples; 1 without such a
 * run.
 */
function timeStep() {
  const run = state.runs.find(({columns}) => columns.time_s.length > 1);
  return run ? run.columns.time_s[1] - run.columns.time_s[0] : 1;
}

/** Index of the sample nearest to this time; -1 after the end of the run. */
function sampleAt(run, time) {
  const times = run.columns.time_s;
  const place = placeOf(times, time);
  const next = Math.min(place + 1, times.length - 1);
  const step = times.length > 1 ? times[1] - times[0] : 1;
  if (times.length === 0 || time > times[times.length - 1] + step / 2) return -1;
  return times[next] - time < time - times[place] ? next : place;
}

/** First and last time of the shown runs. */
function wholeSpan() {
  let first = Infinity;
  let last = -Infinity;
  for (const {columns: {time_s: times}} of state.runs) {
    if (times.length === 0) continue;
    first = Math.min(first, times[0]);
    last = Math.max(last, times[times.length - 1]);
  }
  return first < last ? [first, last] : [0, 1];
}

/**
 * The time in fog at which the follower's gap is furthest below its safe distance. If the gap is
 * never below the safe distance, the result is the middle of the first fog. Without fog, the result
 * is the first time.
 */
function tellingTime() {
  let worst = 0;
  let time = null;
  for (const {columns, fog} of report.runs) {
    columns.time_s.forEach((now, i) => {
      if (!fog.some(([from, to]) => from <= now && now < to)) return;
      const shortfall = columns.follower_safe_distance_m[i] - columns.follower_gap_m[i];
      if (shortfall > worst) [worst, time] = [shortfall, now];
    });
  }
  const fog = report.runs.flatMap((run) => run.fog)[0];
  return time ?? (fog ? (fog[0] + fog[1]) / 2 : wholeSpan()[0]);
}

/** Whether several runs are drawn on top of each other, in all figures without strips. */
function sharesAxes() {
  return state.runs.length > 1 && !state.apart;
}

/** Whether runs share the figure's axes. Then runs differ in colours, and curves in dashes. */
function isOverlaid(figure) {
  return sharesAxes() && !figure.strips;
}

/** Hides the details if several runs share the axes, and shows them otherwise. */
function resetHidden() {
  for (const figure of report.figures) {
    const details = figure.curves.filter((curve) => curve.detail);
    state.hidden.set(figure.id,
                     new Set(isOverlaid(figure) ? details.map((curve) => curve.column) : []));
  }
}

function visibleCurves(figure) {
  return figure.curves.filter((curve) => !state.hidden.get(figure.id).has(curve.column));
}

/** Whether the curve is the same in all these runs. */
function isShared(runs, column) {
  const [first] = runs;
  return runs.every(({columns}) => columns[column] === first.columns[column] &&
                                   columns.time_s === first.columns.time_s);
}

/** Least and greatest value that a figure shows while its time axes show [from, to]. */
function valueRange(figure, from, to) {
  let low = Infinity;
  let high = -Infinity;
  for (const {columns} of state.runs) {
    const first = placeOf(columns.time_s, from);
    const last = placeOf(columns.time_s, to);
    for (const {column} of visibleCurves(figure)) {
      const values = columns[column];
      for (let i = first; i <= last; ++i) {
        const value = values[i];
        if (value == null) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  return low > high ? [0, 1] : [low, high];
}

/** Range of a value axis that fits [low, high]. */
function fittedSpan(figure, [low, high]) {
  const half = Math.max(high - low, figure.leastSpan) * 0.56;
  const middle = (low + high) / 2;
  return [middle - half, middle + half];
}

/** Range of a figure's value axis while its time axes show [from, to]. */
function valueSpan(figure, from, to) {
  const range = valueRange(figure, from, to);
  if (!state.fromZero.has(figure.id)) return fittedSpan(figure, range);
  return [1.06 * Math.min(0, range[0]), 1.06 * Math.max(0, range[1])];
}

/**
 * "axis spans 0.3 % of the value" if a fitted axis spans less than 1 % of the figure's largest
 * value; otherwise "".
 */
function axisNote(figure, from, to) {
  const range = valueRange(figure, from, to);
  const [bottom, top] = fittedSpan(figure, range);
  const share = (top - bottom) / Math.max(...range.map(Math.abs));
  return share < 0.01 ? `axis spans ${Number((100 * share).toPrecision(2))} % of the value` : "";
}

/** A number as the tables print it. */
function decimal(value, decimals) {
  if (value == null) return "–";
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}
