// One panel of a figure: a uPlot chart of one or more runs over time. If there are more runs than
// colours, some lines have a core: a second colour along the middle of the line.

const TICK_SPACE = {time: 56, value: 34, stripValue: 18};  // smallest distance of ticks, in pixels
const VALUE_AXIS_WIDTH = 50;               // the same in all charts, so that time axes are aligned
const TOP = 8;                             // above the plot, in pixels
const STRIP_HEIGHT = 96;
const LANE = {height: 4, gap: 2};          // bars above the plot for the time in which the human drives

/** The lines of a panel, in drawing order: [{run, curve, stroke, dash, width, isCore}]. */
function panelCurves(figure, runs) {
  const {palette, shared} = state.theme;
  return visibleCurves(figure).flatMap((curve) => {
    const width = curve.limit ? 1.5 : curve.detail ? 1.25 : 1.75;
    if (!isOverlaid(figure)) {
      const dash = curve.limit ? curve.dash : [];
      return [{run: runs[0], curve, stroke: palette[curve.colour], dash, width}];
    }
    if (isShared(runs, curve.column)) {
      return [{run: runs[0], curve, stroke: shared, dash: curve.dash, width}];
    }
    return runs.flatMap((run) => runLines(run, curve, width));
  });
}

function runColour(run) {
  return state.theme.palette[run.index % PALETTE_SIZE];
}

/** Colour of the core of a run's lines; null if they have no core. */
function runCore(run) {
  const {surface, ink} = state.theme;
  return [null, surface, ink][Math.floor(run.index / PALETTE_SIZE) % CORES];
}

/** Lines of a run on shared axes: one in the run's colour, and the run's core (if any) on top. */
function runLines(run, curve, width) {
  const line = {run, curve, stroke: runColour(run), dash: curve.dash, width};
  const core = runCore(run);
  if (!core) return [line];
  return [{...line, width: 2 * width}, {...line, stroke: core, width: 0.8 * width, isCore: true}];
}

/** Columns for uPlot: one time axis for all runs, even if their lengths and steps differ. */
function panelData(curves) {
  if (curves.length === 0) return [state.span.slice()];
  return uPlot.join(curves.map(({run, curve}) => [run.columns.time_s, run.columns[curve.column]]));
}

function withAlpha(colour, alpha) {
  return colour + Math.round(alpha * 255).toString(16).padStart(2, "0");
}

/** Diagonal lines, so that shades are distinguishable without colour. */
function hatch(context, colour) {
  const size = Math.round(7 * devicePixelRatio);
  const tile = document.createElement("canvas");
  tile.width = tile.height = size;
  const pen = tile.getContext("2d");
  pen.strokeStyle = colour;
  pen.lineWidth = Math.max(1, devicePixelRatio * 0.8);
  for (const shift of [-size, 0, size]) {
    pen.moveTo(shift - 1, size + 1);
    pen.lineTo(shift + size + 1, -1);
  }
  pen.stroke();
  return context.createPattern(tile, "repeat");
}

/** Fills the times [from, to] (s) over the full height, or over `height` pixels from `top` on. */
function fillSpan(chart, [from, to], fill, top = chart.bbox.top, height = chart.bbox.height) {
  const left = chart.valToPos(from, "x", true);
  chart.ctx.fillStyle = fill;
  chart.ctx.fillRect(left, top, chart.valToPos(to, "x", true) - left, height);
}

function drawFog(chart, runs) {
  const spans = new Map(runs.flatMap((run) => run.fog).map((span) => [span.join(), span]));
  for (const span of spans.values()) fillSpan(chart, span, state.theme.fog);
}

/** Hatches the time in which the human drives. */
function drawHuman(chart, run) {
  const lines = hatch(chart.ctx, state.theme.humanLine);
  for (const span of run.human) {
    fillSpan(chart, span, state.theme.human);
    fillSpan(chart, span, lines);
  }
}

/** Shows when the human drives in each of several runs: one bar for each run, above the plot. */
function drawLanes(chart, runs) {
  const lanes = runs.filter((run) => run.human.length);
  lanes.forEach((run, lane) => {
    const top = chart.bbox.top - (lanes.length - lane) * (LANE.height + LANE.gap) * devicePixelRatio;
    const height = LANE.height * devicePixelRatio;
    for (const span of run.human) {
      fillSpan(chart, span, runColour(run), top, height);
      if (runCore(run)) fillSpan(chart, span, runCore(run), top + height / 3, height / 3);
    }
  });
}

function laneSpace(figure, runs) {
  if (!isOverlaid(figure)) return 0;
  return runs.filter((run) => run.human.length).length * (LANE.height + LANE.gap);
}

/** Shades areas in which one curve is below another curve. */
function drawShortfall(chart, {below, limit}, runs) {
  for (const run of runs) {
    const {time_s: times, [below]: gaps, [limit]: limits} = run.columns;
    const at = (i, value) => [chart.valToPos(times[i], "x", true), chart.valToPos(value, "y", true)];
    const upper = (i) => at(i, Math.max(gaps[i], limits[i]));
    const {ctx} = chart;
    ctx.fillStyle = runs.length === 1 ? state.theme.short : withAlpha(runColour(run), 0.22);
    ctx.beginPath();
    for (let i = 0; i < gaps.length;) {
      const begin = i;
      while (i < gaps.length && gaps[i] !== null && limits[i] !== null) ++i;
      for (let k = begin; k < i; ++k) {
        if (k === begin) ctx.moveTo(...at(k, gaps[k]));
        else ctx.lineTo(...at(k, gaps[k]));
      }
      for (let k = i - 1; k >= begin; --k) ctx.lineTo(...upper(k));
      if (i === begin) ++i;
    }
    ctx.fill();
  }
}

/** Draws everything that is under the curves. */
function drawShades(chart, figure, runs) {
  const {ctx, bbox} = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, 0, bbox.width, bbox.top + bbox.height);
  ctx.clip();
  drawFog(chart, runs);
  if (isOverlaid(figure)) drawLanes(chart, runs);
  else drawHuman(chart, runs[0]);
  const visible = new Set(visibleCurves(figure).map((curve) => curve.column));
  const {shade} = figure;
  if (shade && visible.has(shade.below) && visible.has(shade.limit)) {
    drawShortfall(chart, shade, runs);
  }
  ctx.restore();
}

const holdPaths = {
  linear: undefined,
  since: uPlot.paths.stepped({align: -1}),
  until: uPlot.paths.stepped({align: 1}),
};

function seriesOptions({curve, stroke, dash, width, isCore}) {
  return {stroke, dash, width, isCore, paths: holdPaths[curve.hold], points: {show: false}};
}

function axisOptions(space, values, more) {
  const {muted, grid, font} = state.theme;
  const lines = {stroke: grid, width: 1};
  return {stroke: muted, font: `12px ${font}`, grid: lines, ticks: {...lines, size: 4}, gap: 5,
          space, values, ...more};
}

/** Number of decimals that a multiple of `increment` needs. */
function decimalsOf(increment) {
  let decimals = 0;
  while (decimals < 6 && Math.abs(Number(increment.toFixed(decimals)) / increment - 1) > 1e-6) {
    ++decimals;
  }
  return decimals;
}

function tickTexts(suffix) {
  return (chart, ticks, axis, space, increment) => {
    const decimals = decimalsOf(increment);
    return ticks.map((tick) => decimal(tick, decimals) + suffix);
  };
}

/** Whether the figure shows several runs as strips: low panels, one below the other. */
function isStrip(figure) {
  return sharesAxes() && figure.strips;
}

function chartHeight(width, figure, runs) {
  if (isStrip(figure)) return STRIP_HEIGHT;
  return Math.round(Math.min(300, Math.max(200, width * 0.42))) + laneSpace(figure, runs);
}

/**
 * Makes a chart of `runs` in `element`. It calls `onTime(time)` when the reader points at a time,
 * and `onSpan(span)` when the reader chooses a time span.
 */
function makeChart(element, figure, runs, {onTime, onSpan}) {
  const curves = panelCurves(figure, runs);
  const data = panelData(curves);
  const width = element.clientWidth;
  const options = {
    width,
    height: chartHeight(width, figure, runs),
    padding: [TOP + laneSpace(figure, runs), 10, 0, 0],
    legend: {show: false},
    series: [{}, ...curves.map(seriesOptions)],
    scales: {
      x: {time: false, min: state.span[0], max: state.span[1], range: (chart, min, max) => [min, max]},
      y: {range: () => valueSpan(figure, ...state.span)},
    },
    axes: [
      axisOptions(TICK_SPACE.time, tickTexts(" s"), {size: isStrip(figure) ? 22 : 30}),
      axisOptions(isStrip(figure) ? TICK_SPACE.stripValue : TICK_SPACE.value, tickTexts(""),
                  {size: VALUE_AXIS_WIDTH}),
    ],
    cursor: {
      y: false,
      points: {size: (chart, place) => chart.series[place].isCore ? 0 : 6},
      drag: {x: true, y: false, dist: 6, setScale: false},  // onSpan sets the scale of every chart
      bind: {mouseleave: () => null, dblclick: () => () => onSpan(wholeSpan())},
    },
    hooks: {
      drawClear: [(chart) => drawShades(chart, figure, runs)],
      setCursor: [(chart) => {
        if (chart.cursor.left >= 0) onTime(chart.posToVal(chart.cursor.left, "x"));
      }],
      setSelect: [(chart) => {
        const {left, width: chosen} = chart.select;
        if (chosen > 0) onSpan([chart.posToVal(left, "x"), chart.posToVal(left + chosen, "x")]);
      }],
    },
  };
  const chart = new uPlot(options, data, element);
  chart.over.addEventListener("touchmove", ({touches: [touch]}) => {
    onTime(chart.posToVal(touch.clientX - chart.over.getBoundingClientRect().left, "x"));
  }, {passive: true});
  return chart;
}

/** Puts the chart's cursor at a time, or hides it if the time is not shown. */
function pointAt(chart, time) {
  const {min, max} = chart.scales.x;
  const seen = time >= min && time <= max;
  chart.setCursor({left: seen ? chart.valToPos(time, "x") : -10, top: seen ? 1 : -10}, false);
}
