// The figures of a page of studies: lines with bands over a quantity, or rows of points with
// whiskers, one row for each category. Each figure has a legend. In the legend a reader can show
// and hide series, and read the values at the cursor. The axes are in study_axes.js.

const figures = JSON.parse(document.getElementById("study-data").textContent);

const COLOURS = 8;
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];  // one pattern for each round through the colours
const MOST_IN_LEGEND = 8;  // with more series, the legend folds the series that are hidden at first

let theme = null;
let charts = [];

function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  theme = {
    palette: Array.from({length: COLOURS}, (_, i) => colour(`--p${i}`)),
    surface: colour("--surface"),
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

/** Colour and dashes of a series. Series that some figure shows at first get the first colours. */
const strokeOf = (figure, index) => theme.palette[figure.rank[index] % COLOURS];
const dashOf = (figure, index) => DASHES[Math.floor(figure.rank[index] / COLOURS) % DASHES.length];

/**
 * A line above a chart. It has a text if the value axis spans a small part of the values
 * (axisNote()), and a box that makes the axis begin at zero. Returns the line, and a function that
 * updates the line for a range.
 */
function makeAxisLine(figure, onSwitch) {
  const text = make("span");
  const box = make("input", {type: "checkbox", "aria-label": "Value axis from zero"});
  box.checked = figure.fromZero ?? false;
  box.addEventListener("change", () => {
    figure.fromZero = box.checked;
    onSwitch();
  });
  const line = make("p", {class: "span-note", id: `${figure.id}-span`, hidden: ""}, text,
                    make("label", {}, box, "from zero"));
  return [line, (range) => {
    const note = axisNote(figure, range);
    text.textContent = figure.fromZero ? "axis from zero" : note;
    line.hidden = !figure.fromZero && note === "";
  }];
}

/** Draws a band along a line. */
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

/** Draws a whisker at each point of the rows. */
function drawWhiskers(chart, xs, low, high, colour) {
  const {ctx} = chart;
  const half = 3 * devicePixelRatio;
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.25 * devicePixelRatio;
  xs.forEach((x, i) => {
    if (low[i] == null || high[i] == null) return;
    const top = chart.valToPos(x, "x", true);
    const [left, right] = [chart.valToPos(low[i], "y", true), chart.valToPos(high[i], "y", true)];
    ctx.beginPath();
    ctx.moveTo(left, top);
    ctx.lineTo(right, top);
    for (const end of [left, right]) {
      ctx.moveTo(end, top - half);
      ctx.lineTo(end, top + half);
    }
    ctx.stroke();
  });
}

/** Draws an arrow and the value at the end of the axis for each point beyond the axis. */
function drawBeyond(chart, figure, {data, values}) {
  const {ctx} = chart;
  const pixel = devicePixelRatio;
  ctx.save();
  ctx.font = `${11 * pixel}px ${theme.font}`;
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  figure.series.forEach((_, i) => {
    if (!chart.series[i + 1].show) return;
    values[i].forEach((y, k) => {
      if (!isBeyond(figure, y)) return;
      const [tip, top] = [chart.valToPos(figure.most, "y", true), chart.valToPos(data[0][k], "x", true)];
      ctx.fillStyle = strokeOf(figure, i);
      ctx.beginPath();
      ctx.moveTo(tip + 4 * pixel, top);
      ctx.lineTo(tip - 5 * pixel, top - 5 * pixel);
      ctx.lineTo(tip - 5 * pixel, top + 5 * pixel);
      ctx.fill();
      ctx.lineWidth = 4 * pixel;
      ctx.strokeStyle = theme.surface;
      ctx.strokeText(numberText(y), tip - 9 * pixel, top);
      ctx.fillText(numberText(y), tip - 9 * pixel, top);
    });
  });
  ctx.restore();
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
    draw(chart, data[0], low[i], high[i], strokeOf(figure, i));
  });
  ctx.restore();
}

/**
 * The lists of the legend. If there are many series, the first list has the series that are shown
 * at first, and a folded list has the others.
 */
function legendList(figure, items) {
  const list = (parts) => make("ul", {}, ...parts);
  if (items.length <= MOST_IN_LEGEND) return [list(items)];
  const first = items.filter((_, i) => figure.atFirst[i]);
  const others = items.filter((_, i) => !figure.atFirst[i]);
  if (others.length === 0) return [list(items)];
  const more = make("details", {class: "more-series"},
                    make("summary", {}, `${others.length} more to choose from`), list(others));
  more.open = figure.open ?? false;
  more.addEventListener("toggle", () => { figure.open = more.open; });
  return [list(first), more];
}

/**
 * Makes a legend with a button for each series. Returns a function that shows the values at a
 * position on the x axis, given its index.
 */
function makeLegend(element, figure, chart, columns) {
  const at = make("p", {class: "at"});
  const values = [];
  const items = figure.series.map((series, i) => {
    const swatch = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    for (const [name, value] of Object.entries({width: 22, height: 10, "aria-hidden": "true"})) {
      swatch.setAttribute(name, value);
    }
    const stroke = {x1: 0, y1: 5, x2: 22, y2: 5, stroke: strokeOf(figure, i), "stroke-width": 2.5,
                    "stroke-dasharray": dashOf(figure, i).join(" ")};
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
  element.replaceChildren(at, ...legendList(figure, items));
  return (place) => {
    if (place == null) return;
    const x = columns.data[0][place];
    const category = figure.categories[Math.round(x)];
    at.textContent = category ?? `${figure.xLabel}: ${numberText(xAtPlace(figure, x))}`;
    figure.series.forEach((_, i) => {
      // In a category each series has its own position on the x axis.
      const own = figure.categories.length
          ? columns.data[0].findIndex((other, k) => Math.round(other) === Math.round(x) &&
                                                    columns.values[i][k] != null)
          : place;
      const value = own < 0 ? null : columns.values[i][own];
      values[i].textContent = value == null ? "" : numberText(value);
    });
  };
}

function makeChart(figure) {
  const element = document.getElementById(figure.id);
  const panel = make("div", {class: "chart", role: "img", "aria-labelledby": `${figure.id}-title`,
                             "aria-describedby": `${figure.id}-span`});
  const [line, showNote] = makeAxisLine(figure, () => {
    const {min, max} = chart.scales.x;
    chart.setScale("x", {min, max});
  });
  element.querySelector(".panels").replaceChildren(make("div", {class: "panel"}, line, panel));
  const columns = columnsOf(figure);
  const points = figure.categories.length > 0;
  const whole = placeSpan(figure, columns.data[0]);
  let show = () => {};
  const width = panel.clientWidth;
  const chart = new uPlot({
    width,
    height: chartHeight(figure, width),
    padding: [8, 24, 0, 0],  // room for half of the last value
    legend: {show: false},
    series: [{}, ...figure.series.map((series, i) => ({
      show: series.shown,
      stroke: strokeOf(figure, i),
      dash: dashOf(figure, i),
      width: 1.75,
      spanGaps: true,
      paths: points ? () => null : undefined,
      points: points ? {show: true, size: 7, fill: strokeOf(figure, i)} : {show: false},
    }))],
    scales: {
      x: {time: false, range: (_, min, max) => min == null || max == null ? whole : [min, max],
          min: whole[0], max: whole[1], ...(points ? {ori: 1, dir: -1} : {})},
      y: {range: (chart) => {
            const range = valueRange(chart, figure, columns);
            showNote(range);
            return valueSpan(figure, range);
          }, ...(points ? {ori: 0} : {})},
    },
    axes: [xAxis(figure), yAxis(figure)],
    cursor: {drag: {x: !points, y: false}, points: {size: 6}},
    hooks: {
      drawAxes: [(chart) => drawIntervals(chart, figure, columns)],
      draw: [(chart) => drawBeyond(chart, figure, columns)],
      setCursor: [(chart) => show(chart.cursor.idx)],
    },
  }, columns.data, panel);
  chart.setScale("x", {min: whole[0], max: whole[1]});
  show = makeLegend(element.querySelector(".legend"), figure, chart, columns);
  charts.push({chart, figure, panel});
}

function build() {
  for (const {chart} of charts) chart.destroy();
  charts = [];
  readTheme();
  drawMissing();
}

/** Draws the figures that are unfolded and not drawn yet. */
function drawMissing() {
  const drawn = new Set(charts.map(({figure}) => figure));
  figures.filter((figure) => isUnfolded(figure) && !drawn.has(figure)).forEach(makeChart);
}

/** Whether a figure has a width. The content of a closed <details> element has no width. */
function isUnfolded({id}) {
  return document.getElementById(id).closest("details:not([open])") == null;
}

for (const folded of document.querySelectorAll("details.more-figures")) {
  folded.addEventListener("toggle", drawMissing);
}

new ResizeObserver(() => {
  for (const {chart, figure, panel: {clientWidth: width}} of charts) {
    if (width > 0 && width !== chart.width) {
      chart.setSize({width, height: chartHeight(figure, width)});
    }
  }
}).observe(document.body);

/**
 * Sets `rank` (order of the colours) and `atFirst` (whether a series is shown at first). Both stay
 * the same when the reader shows and hides series.
 */
function prepare(figure) {
  const names = ({series}) => series.map(({name}) => name).join();
  const alike = figures.filter((other) => names(other) === names(figure));
  const telling = figure.series.map((_, i) => alike.some(({series}) => series[i].shown));
  const order = [...telling.keys()].sort((a, b) => telling[b] - telling[a] || a - b);
  figure.rank = telling.map((_, i) => order.indexOf(i));
  figure.atFirst = figure.series.map(({shown}) => shown);
}

figures.forEach(prepare);
watchScrolls(document);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build);
build();
