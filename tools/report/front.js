// Figure B: safety improvement, and its cost in human engagement. The figure has the points of the
// thresholds, the Pareto front, and the published points.

/** Index of the point nearest to the cursor. */
function nearestPoint(chart) {
  const {left, top} = chart.cursor;
  const distance = ({rhe, si}) =>
      Math.hypot(chart.valToPos(rhe, "x") - left, chart.valToPos(si, "y") - top);
  let best = 0;
  curves.points.forEach((point, i) => {
    if (distance(point) < distance(curves.points[best])) best = i;
  });
  return best;
}

/** Writes thresholds below or beside their points where there is room, the most important first. */
function drawLabels(chart) {
  const {ctx, bbox} = chart;
  const pixel = devicePixelRatio;
  const taken = [];
  ctx.font = `${11 * pixel}px ${state.theme.font}`;
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  ctx.fillStyle = state.theme.muted;
  for (const place of curves.labels) {
    const {rhe, si, thresholds, beside} = curves.points[place];
    const width = ctx.measureText(thresholds).width;
    const x = chart.valToPos(rhe, "x", true);
    const isBeyond = x + width + 10 * pixel > bbox.left + bbox.width;
    const y = chart.valToPos(si, "y", true) + (beside && !isBeyond ? 0 : 10 * pixel);
    const left = isBeyond ? x - 6 * pixel - width : x + 8 * pixel;
    const box = {left: left - 4 * pixel, right: left + width + 4 * pixel,
                 top: y - 7 * pixel, bottom: y + 7 * pixel};
    const clashes = taken.some((other) => box.left < other.right && other.left < box.right &&
                                          box.top < other.bottom && other.top < box.bottom);
    if (clashes) continue;
    taken.push(box);
    ctx.fillText(thresholds, left, y);
  }
}

/**
 * Makes a ring with a text beside it. Returns a function that moves the ring to a point, and shows
 * the thresholds of this point.
 */
function makeSpot(chart) {
  const text = make("span");
  const spot = make("div", {class: "spot", "aria-hidden": "true"}, text);
  chart.over.append(spot);
  return ({rhe, si, thresholds}) => {
    const [left, top] = [chart.valToPos(rhe, "x"), chart.valToPos(si, "y")];
    const {width, height} = chart.over.getBoundingClientRect();
    spot.hidden = !(left >= -1 && left <= width + 1 && top >= -1 && top <= height + 1);
    spot.style.left = `${left}px`;
    spot.style.top = `${top}px`;
    spot.classList.toggle("left", left > width / 2);
    text.textContent = thresholds;
  };
}

function makeFrontLegend(figure) {
  const text = make("p", {class: "reading"});
  const keys = [["front", "on the front"], ["dominated", "another threshold is better"]];
  if (curves.published.length) keys.push(["diamond ink", "published"]);
  figure.querySelector(".legend").replaceChildren(text, makeKeys(keys));
  return (row) => {
    const point = pointOf(row);
    text.textContent = `Threshold ${point ? point.thresholds : curves.thresholds[row]}: ` +
        `SI ${decimal(curves.si.mean[row], 2)} %, RHE ${decimal(curves.rhe.mean[row], 2)} %` +
        (point ? `, ${point.front ? "on the front" : "not on the front"}` : "");
  };
}

function buildFront(figure) {
  const {points, published} = curves;
  const {palette, shared, surface, ink} = state.theme;
  const column = (front) => points.map((point) => point.front === front ? point.si : null);
  const dots = (stroke, fill, size) => ({show: true, size, width: 1.25, stroke, fill});
  const chart = makeCurveChart(figure, {
    data: [points.map(({rhe}) => rhe), column(false), column(true)],
    series: [
      {},
      {paths: () => null, stroke: shared, points: dots(shared, surface, 6)},
      {stroke: palette[0], width: 1.75, spanGaps: true, points: dots(palette[0], palette[0], 7)},
    ],
    wholeX: widened([...points.map(({rhe}) => rhe), ...published.map(({rhe}) => rhe)], 1),
    wholeY: widened([...points.map(({si}) => si), ...published.map(({si}) => si)], 1),
    xLabel: "Redundant human engagement (RHE, %)",
    cursor: {x: false, y: false, points: {show: false}},
    draw: (of) => {
      drawLabels(of);
      for (const {rhe, si} of published) drawDiamond(of, rhe, si, ink);
    },
    onPoint: (of) => { if (points.length) setRow(points[nearestPoint(of)].rows[0]); },
  });
  const showSpot = makeSpot(chart);
  const showText = makeFrontLegend(figure);
  curvePage.show.push((row) => {
    const point = pointOf(row);
    if (point) showSpot(point);
    showText(row);
  });
}

const fitCurves = new ResizeObserver(oncePerFrame(() => {
  for (const {chart, element: {clientWidth: width}} of curvePage.charts) {
    if (width > 0 && width !== chart.width) chart.setSize({width, height: curveHeight(width)});
  }
  showRow();
}));

function buildCurves() {
  if (!curves) return;
  fitCurves.disconnect();
  for (const {chart} of curvePage.charts) chart.destroy();
  curvePage.charts = [];
  curvePage.show = [];
  readTheme();
  buildThresholds(document.getElementById("thresholds"));
  buildFront(document.getElementById("front"));
  for (const {element} of curvePage.charts) fitCurves.observe(element);
  curvePage.whole.disabled = true;
  showRow();
}

function startCurves() {
  if (!curves) return;
  const {thresholds, published} = curves;
  const middle = published.length ? published[published.length >> 1].threshold
                                  : thresholds[thresholds.length >> 1];
  curveState.row = placeOf(thresholds, middle);
  curvePage.slider.addEventListener("input", () => setRow(Number(curvePage.slider.value)));
  curvePage.whole.addEventListener("click", showWholeCurves);
  curvePage.tools.hidden = false;
  buildCurves();
}
