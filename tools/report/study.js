"use strict";
// The figures of a page of studies: lines with bands over a quantity, or points with whiskers over
// categories. Each has a legend that shows, hides, and gives the values at the cursor.

const figures = JSON.parse(document.getElementById("study-data").textContent);

const COLOURS = 8;
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];  // one for each round of the colours
const SPREAD = 0.6;  // share of a category's place over which its series stand side by side

let theme = null;
let charts = [];

function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  theme = {
    palette: Array.from({length: COLOURS}, (_, i) => colour(`--p${i}`)),
    muted: colour("--muted"),
    grid: colour("--grid"),
    font: getComputedStyle(document.body).fontFamily,
  };
}

function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** A number for a reader: four significant digits, a true minus sign. */
function numberText(value) {
  if (value == null) return "–";
  const text = String(Number(Math.abs(value).toPrecision(4)));
  return value < 0 ? `−${text}` : text;
}

const strokeOf = (index) => theme.palette[index % COLOURS];
/** Where a value of x lies on the axis, and what lies there. */
const placeOfX = (figure, x) => figure.logX ? Math.log10(x) : x;
const xAtPlace = (figure, place) => figure.logX ? 10 ** place : place;
const dashOf = (index) => DASHES[Math.floor(index / COLOURS) % DASHES.length];

/** Columns for uPlot, and the intervals in the same order: {data, low, high}. */
function columnsOf(figure) {
  const count = figure.series.length;
  const tables = figure.series.map(({x, y, low, high}, i) => {
    const shift = figure.categories.length ? SPREAD * ((i + 0.5) / count - 0.5) : 0;
    const none = y.map(() => null);
    return [x.map((value) => placeOfX(figure, value) + shift), y, low.length ? low : none, high.length ? high : none];
  });
  const [xs, ...columns] = uPlot.join(tables);
  const every = (first) => figure.series.map((_, i) => columns[3 * i + first]);
  return {data: [xs, ...every(0)], low: every(1), high: every(2)};
}

/** Least and greatest of the shown values and intervals, with a margin. */
function valueSpan(chart, {data, low, high}) {
  let least = Infinity;
  let most = -Infinity;
  data.slice(1).forEach((values, i) => {
    if (!chart.series[i + 1].show) return;
    for (const column of [values, low[i], high[i]]) {
      for (const value of column) {
        if (value == null) continue;
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
  });
  if (least > most) return [0, 1];
  const margin = 0.05 * (most - least) || Math.abs(most) * 0.05 || 1;
  return [least - margin, most + margin];
}

/** The whole x axis. */
function placeSpan(figure, xs) {
  if (figure.categories.length) return [-0.6, figure.categories.length - 0.4];
  if (xs.length === 0) return [0, 1];
  const [first, last] = [xs[0], xs[xs.length - 1]];
  const margin = 0.02 * (last - first) || 1;
  return [first - margin, last + margin];
}

/** A band along a line. */
function drawBand(chart, xs, low, high, colour) {
  const {ctx} = chart;
  const places = xs.map((_, i) => i).filter((i) => low[i] != null && high[i] != null);
  if (places.length === 0) return;
  ctx.globalAlpha = 0.18;
  ctx.fillStyle = colour;
  ctx.beginPath();
  const at = (i, value) => [chart.valToPos(xs[i], "x", true), chart.valToPos(value, "y", true)];
  for (const i of places) ctx.lineTo(...at(i, low[i]));
  for (const i of places.reverse()) ctx.lineTo(...at(i, high[i]));
  ctx.closePath();
  ctx.fill();
}

/** A whisker at each point. */
function drawWhiskers(chart, xs, low, high, colour) {
  const {ctx} = chart;
  const half = 3 * devicePixelRatio;
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.25 * devicePixelRatio;
  xs.forEach((x, i) => {
    if (low[i] == null || high[i] == null) return;
    const left = chart.valToPos(x, "x", true);
    const [bottom, top] = [chart.valToPos(low[i], "y", true), chart.valToPos(high[i], "y", true)];
    ctx.beginPath();
    ctx.moveTo(left, bottom);
    ctx.lineTo(left, top);
    for (const end of [bottom, top]) {
      ctx.moveTo(left - half, end);
      ctx.lineTo(left + half, end);
    }
    ctx.stroke();
  });
}

function drawIntervals(chart, figure, {data, low, high}) {
  const {ctx, bbox} = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  figure.series.forEach((_, i) => {
    if (!chart.series[i + 1].show) return;
    const draw = figure.categories.length ? drawWhiskers : drawBand;
    draw(chart, data[0], low[i], high[i], strokeOf(i));
  });
  ctx.restore();
}

/** The legend: a button for each series. Returns what shows the values at a place. */
function makeLegend(element, figure, chart, columns) {
  const at = make("p", {class: "at"});
  const values = [];
  const items = figure.series.map((series, i) => {
    const swatch = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    for (const [name, value] of Object.entries({width: 22, height: 10, "aria-hidden": "true"})) {
      swatch.setAttribute(name, value);
    }
    const stroke = {x1: 0, y1: 5, x2: 22, y2: 5, stroke: strokeOf(i), "stroke-width": 2.5,
                    "stroke-dasharray": dashOf(i).join(" ")};
    for (const [name, value] of Object.entries(stroke)) line.setAttribute(name, value);
    swatch.append(line);
    const value = make("span", {class: "value"});
    values.push(value);
    const button = make("button", {type: "button", "aria-pressed": chart.series[i + 1].show},
                        swatch, series.name, value);
    button.addEventListener("click", () => {
      series.shown = !chart.series[i + 1].show;
      chart.setSeries(i + 1, {show: series.shown});
      button.setAttribute("aria-pressed", series.shown);
    });
    return make("li", {}, button);
  });
  element.replaceChildren(at, make("ul", {}, ...items));
  return (place) => {
    if (place == null) return;
    const x = columns.data[0][place];
    const category = figure.categories[Math.round(x)];
    at.textContent = category ?? `${figure.xLabel}: ${numberText(xAtPlace(figure, x))}`;
    figure.series.forEach((_, i) => {
      // In a category the series stand side by side: each has its own place.
      const own = figure.categories.length
          ? columns.data[0].findIndex((other, k) => Math.round(other) === Math.round(x) &&
                                                    columns.data[i + 1][k] != null)
          : place;
      const value = own < 0 ? null : columns.data[i + 1][own];
      values[i].textContent = value == null ? "" : numberText(value);
    });
  };
}

function chartHeight(width) {
  return Math.round(Math.min(380, Math.max(240, width * 0.52)));
}

function axis(more) {
  const lines = {stroke: theme.grid, width: 1};
  return {stroke: theme.muted, font: `12px ${theme.font}`, grid: lines,
          ticks: {...lines, size: 4}, gap: 5, ...more};
}

/** The values of x that there are, as long as their texts do not touch. */
function loggedTicks(figure, chart) {
  const room = 34;  // pixels
  let last = -Infinity;
  return chart.data[0].filter((place) => {
    const left = chart.valToPos(place, "x");
    if (left - last < room) return false;
    last = left;
    return true;
  });
}

function xAxis(figure) {
  const label = {label: figure.xLabel, labelSize: 20, labelGap: 0, labelFont: `12px ${theme.font}`};
  if (figure.logX) {
    return axis({size: 28, ...label, splits: (chart) => loggedTicks(figure, chart),
                 values: (_, places) => places.map((x) => numberText(xAtPlace(figure, x)))});
  }
  if (!figure.categories.length) return axis({size: 28, ...label});
  const longest = Math.max(...figure.categories.map((name) => name.length));
  return axis({
    ...label,
    size: Math.min(120, 16 + 5 * longest),
    rotate: -35,
    splits: () => figure.categories.map((_, i) => i),
    values: () => figure.categories,
  });
}

function makeChart(figure) {
  const element = document.getElementById(figure.id);
  const panel = make("div", {class: "chart", role: "img", "aria-labelledby": `${figure.id}-title`});
  element.querySelector(".panels").replaceChildren(make("div", {class: "panel"}, panel));
  const columns = columnsOf(figure);
  const points = figure.categories.length > 0;
  const whole = placeSpan(figure, columns.data[0]);
  let show = () => {};
  const width = panel.clientWidth;
  const chart = new uPlot({
    width,
    height: chartHeight(width),
    padding: [8, points ? 48 : 12, 0, 0],  // room for the last category's slanted name
    legend: {show: false},
    series: [{}, ...figure.series.map((series, i) => ({
      show: series.shown,
      stroke: strokeOf(i),
      dash: dashOf(i),
      width: 1.75,
      spanGaps: true,
      paths: points ? () => null : undefined,
      points: points ? {show: true, size: 7, fill: strokeOf(i)} : {show: false},
    }))],
    scales: {
      x: {time: false, range: (_, min, max) => min == null || max == null ? whole : [min, max],
          min: whole[0], max: whole[1]},
      y: {range: (chart) => valueSpan(chart, columns)},
    },
    axes: [xAxis(figure), axis({size: 56})],
    cursor: {drag: {x: !points, y: false}, points: {size: 6}},
    hooks: {
      drawAxes: [(chart) => drawIntervals(chart, figure, columns)],
      setCursor: [(chart) => show(chart.cursor.idx)],
    },
  }, columns.data, panel);
  chart.setScale("x", {min: whole[0], max: whole[1]});
  show = makeLegend(element.querySelector(".legend"), figure, chart, columns);
  charts.push({chart, panel});
}

function build() {
  for (const {chart} of charts) chart.destroy();
  charts = [];
  readTheme();
  figures.forEach(makeChart);
}

new ResizeObserver(() => {
  for (const {chart, panel: {clientWidth: width}} of charts) {
    if (width > 0 && width !== chart.width) chart.setSize({width, height: chartHeight(width)});
  }
}).observe(document.body);
watchScrolls(document);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build);
build();
