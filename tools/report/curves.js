// Figure A: safety improvement and redundant human engagement as functions of the threshold. Each
// curve has a band for the confidence interval of the mean, and a band for the percentiles of the
// seeds. This file also has the state that figures A and B share: the threshold at the reader's
// cursor.

const {curves} = report;

const MEASURES = [
  {key: "si", label: "SI", colour: 0, dash: []},
  {key: "rhe", label: "RHE", colour: 1, dash: [7, 4]},
];
const BANDS = [
  {alpha: 0.2, ends: ({p5, p95}, i) => [p5[i], p95[i]]},
  {alpha: 0.45, ends: ({mean, ci95}, i) => around(mean[i], ci95[i])},
];

const curveState = {
  row: 0,             // index of the threshold at the reader's cursor
  hidden: new Set(),  // keys of the measures that figure A hides
};

const curvePage = {
  charts: [],  // [{chart, element, wholeX, wholeY}], with the initial ranges of the axes
  show: [],    // functions that show a threshold, given its index
  tools: document.getElementById("curve-tools"),
  slider: document.getElementById("threshold"),
  text: document.getElementById("threshold-text"),
  whole: document.getElementById("whole-curves"),
};

/** [middle - half, middle + half]; nulls if a value is missing. */
function around(middle, half) {
  return middle == null || half == null ? [null, null] : [middle - half, middle + half];
}

/**
 * Smallest and largest of the values, with a margin. The margin is 5 % of the range of the values,
 * or of `least` if `least` is larger. [0, 1] without values.
 */
function widened(values, least) {
  const numbers = values.filter((value) => value != null);
  if (numbers.length === 0) return [0, 1];
  const low = numbers.reduce((a, b) => Math.min(a, b));
  const high = numbers.reduce((a, b) => Math.max(a, b));
  const margin = 0.05 * Math.max(high - low, least);
  return [low - margin, high + margin];
}

function curveHeight(width) {
  return Math.round(Math.min(340, Math.max(240, width * 0.5)));
}

/** The point of figure B whose thresholds include the threshold of this row, if there is one. */
function pointOf(row) {
  return curves.points.find(({rows}) => rows.includes(row));
}

const showRow = oncePerFrame(() => {
  for (const show of curvePage.show) show(curveState.row);
  const threshold = String(curves.thresholds[curveState.row]);
  curvePage.slider.value = curveState.row;
  curvePage.slider.setAttribute("aria-valuetext", threshold);
  curvePage.text.textContent = threshold;
});

function setRow(row) {
  curveState.row = row;
  showRow();
}

function showWholeCurves() {
  for (const {chart, wholeX, wholeY} of curvePage.charts) {
    chart.setScale("x", {min: wholeX[0], max: wholeX[1]});
    chart.setScale("y", {min: wholeY[0], max: wholeY[1]});
  }
  curvePage.whole.disabled = true;
  showRow();
}

/**
 * Calls `draw(ctx)`, and clips everything that `draw` paints to the plot. Units are canvas pixels.
 */
function withinPlot({ctx, bbox}, draw) {
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw(ctx);
  ctx.restore();
}

/** Draws a published value as a hollow diamond. */
function drawDiamond(chart, x, y, colour) {
  const {ctx} = chart;
  const [left, top] = [chart.valToPos(x, "x", true), chart.valToPos(y, "y", true)];
  const r = 6 * devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(left, top - r);
  for (const [dx, dy] of [[r, 0], [0, r], [-r, 0]]) ctx.lineTo(left + dx, top + dy);
  ctx.closePath();
  ctx.fillStyle = withAlpha(state.theme.surface, 0.7);
  ctx.fill();
  ctx.setLineDash([]);
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.75 * devicePixelRatio;
  ctx.stroke();
}

/**
 * Makes a chart in a figure's element. It calls `onPoint(chart)` when the reader points at the
 * chart. A drag zooms in both directions.
 */
function makeCurveChart(figure, {data, series, bands, wholeX, wholeY, xLabel, cursor, draw,
                                 onPoint}) {
  const element = make("div", {
    class: "chart", role: "img", "aria-labelledby": `${figure.id}-title`});
  figure.querySelector(".panels").replaceChildren(make("div", {class: "panel"}, element));
  const {font} = state.theme;
  const width = element.clientWidth;
  const range = (_, min, max) => [min, max];
  const scale = ([low, high]) => ({auto: false, min: low, max: high, range});
  const options = {
    width,
    height: curveHeight(width),
    padding: [TOP, 12, 0, 0],
    legend: {show: false},
    series,
    bands,
    scales: {x: {...scale(wholeX), time: false}, y: scale(wholeY)},
    axes: [
      axisOptions(TICK_SPACE.time, tickTexts(""), {
        size: 28, label: xLabel, labelSize: 20, labelGap: 0, labelFont: `12px ${font}`}),
      axisOptions(TICK_SPACE.value, tickTexts(""), {size: VALUE_AXIS_WIDTH}),
    ],
    cursor: {
      ...cursor,
      drag: {x: true, y: true, uni: 24, dist: 6, setScale: true},
      bind: {mouseleave: () => null, dblclick: () => showWholeCurves},
    },
    hooks: {
      draw: [(chart) => withinPlot(chart, () => draw(chart))],
      setCursor: [(chart) => { if (chart.cursor.event) onPoint(chart); }],
      setSelect: [(chart) => { if (chart.select.width > 0) curvePage.whole.disabled = false; }],
      setScale: [() => showRow()],
    },
  };
  const chart = new uPlot(options, data, element);
  chart.over.addEventListener("touchmove", ({touches: [touch]}) => {
    const {left, top} = chart.over.getBoundingClientRect();
    chart.setCursor({left: touch.clientX - left, top: touch.clientY - top}, false);
    onPoint(chart);
  }, {passive: true});
  curvePage.charts.push({chart, element, wholeX, wholeY});
  return chart;
}

function shownMeasures() {
  return MEASURES.filter(({key}) => !curveState.hidden.has(key));
}

/** Columns, series and bands of figure A: all bands, then all means on top of them. */
function curveSeries() {
  const data = [curves.thresholds];
  const series = [{}];
  const bands = [];
  for (const {key, colour} of shownMeasures()) {
    for (const {alpha, ends} of BANDS) {
      const pairs = curves.thresholds.map((_, i) => ends(curves[key], i));
      for (const end of [0, 1]) {
        data.push(pairs.map((pair) => pair[end]));
        series.push({isEdge: true, stroke: "transparent", width: 0, points: {show: false}});
      }
      const fill = withAlpha(state.theme.palette[colour], alpha);
      bands.push({series: [series.length - 1, series.length - 2], fill});
    }
  }
  for (const {key, colour, dash} of shownMeasures()) {
    data.push(curves[key].mean);
    series.push({stroke: state.theme.palette[colour], width: 2, dash, points: {show: false}});
  }
  return {data, series, bands};
}

function buildThresholds(figure) {
  const parts = curveSeries();
  const {thresholds, published} = curves;
  const drawPublished = (chart) => {
    for (const row of published) {
      for (const {key, colour} of shownMeasures()) {
        drawDiamond(chart, row.threshold, row[key], state.theme.palette[colour]);
      }
    }
  };
  const chart = makeCurveChart(figure, {
    ...parts,
    wholeX: widened([...thresholds, ...published.map(({threshold}) => threshold)], 0.01),
    wholeY: widened([...parts.data.slice(1).flat(),
                     ...published.flatMap(({si, rhe}) => [si, rhe])], 1),
    xLabel: "DoC threshold",
    cursor: {y: false, points: {size: (_, i) => parts.series[i].isEdge ? 0 : 7}},
    draw: drawPublished,
    onPoint: ({cursor}) => { if (cursor.idx != null) setRow(cursor.idx); },
  });
  const showValues = makeCurveLegend(figure);
  curvePage.show.push((row) => {
    pointAt(chart, thresholds[row]);
    showValues(row);
  });
}

/** Makes one row for each measure. Returns a function that shows the values at a threshold. */
function makeCurveLegend(figure) {
  const clock = make("span");
  const head = make("tr", {}, make("th", {scope: "col"}, clock));
  for (const name of ["mean", "std. dev.", "95 % CI of mean", "5th to 95th pct."]) {
    head.append(make("th", {scope: "col"}, name));
  }
  const rows = MEASURES.map((measure, place) => {
    const shown = !curveState.hidden.has(measure.key);
    const button = make("button", {type: "button", "aria-pressed": shown},
                        lineSwatch(state.theme.palette[measure.colour], measure.dash, 2.5),
                        measure.label);
    button.addEventListener("click", () => {
      if (!curveState.hidden.delete(measure.key)) curveState.hidden.add(measure.key);
      buildCurves();
      figure.querySelectorAll(".legend button")[place].focus();
    });
    const cells = Array.from({length: 4}, () => make("td"));
    return {measure, cells, element: make("tr", {}, make("th", {scope: "row"}, button), ...cells)};
  });
  const keys = [["interval", "95 % CI of the mean"],
                ["percentiles", "5th to 95th percentile of seeds"]];
  if (curves.published.length) keys.push(["diamond", "published"]);
  const label = "Values of figure A at the threshold";
  figure.querySelector(".legend").replaceChildren(
      make("div", {class: "scroll", role: "region", tabindex: 0, "aria-label": label},
           make("table", {}, make("thead", {}, head),
                make("tbody", {}, ...rows.map(({element}) => element)))),
      makeKeys(keys));
  watchScrolls(figure);
  return (row) => {
    clock.textContent = `at ${curves.thresholds[row]} in %`;
    for (const {measure, cells} of rows) {
      const {mean, deviation, ci95, p5, p95} = curves[measure.key];
      const range = ([low, high]) =>
          low == null ? "–" : `${decimal(low, 2)} to ${decimal(high, 2)}`;
      cells[0].textContent = decimal(mean[row], 2);
      cells[1].textContent = decimal(deviation[row], 2);
      cells[2].textContent = range(around(mean[row], ci95[row]));
      cells[3].textContent = range([p5[row], p95[row]]);
    }
  };
}
