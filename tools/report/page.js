// The page: builds the figures for the reader's choices. All figures show the same time.

const page = {
  charts: [],   // charts of all figures
  legends: [],  // functions that show the values at a time
  panels: new Map(),  // by the chart's element: the chart, its figure and its runs
  notes: [],    // functions that show the notes on the value axes
  toolbar: document.getElementById("toolbar"),
  slider: document.getElementById("time"),
  sliderText: document.getElementById("time-text"),
  whole: document.getElementById("whole"),
};

/** Runs `work` once before the next frame, even if it is requested several times. */
function oncePerFrame(work) {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      work();
    });
  };
}

const showTime = oncePerFrame(() => {
  for (const chart of page.charts) pointAt(chart, state.time);
  for (const showValues of page.legends) showValues(state.time);
  page.slider.value = state.time;
  page.sliderText.textContent = `${decimal(state.time, 1)} s`;
});

function setTime(time) {
  const [first, last] = wholeSpan();
  state.time = Math.min(last, Math.max(first, time));
  showTime();
}

function setSpan([from, to]) {
  const [first, last] = wholeSpan();
  state.span = [Math.max(first, from), Math.min(last, to)];
  state.zoomed = state.span[0] > first || state.span[1] < last;
  page.whole.disabled = !state.zoomed;
  for (const chart of page.charts) {
    chart.batch(() => {
      chart.setSelect({left: 0, width: 0}, false);
      chart.setScale("x", {min: state.span[0], max: state.span[1]});
    });
  }
  for (const showNote of page.notes) showNote();
  showTime();
}

/**
 * Lets a figure's value axes begin at zero, or fits the axes to the figure's values again. All
 * panels of a figure have equal axes.
 */
function switchAxis(figure) {
  if (!state.fromZero.delete(figure.id)) state.fromZero.add(figure.id);
  for (const {chart, figure: other} of page.panels.values()) {
    if (other === figure) chart.setScale("x", {min: state.span[0], max: state.span[1]});
  }
  for (const showNote of page.notes) showNote();
}

/**
 * A line above a panel. It has a text if the value axis spans a small part of the values
 * (axisNote()), and a box that makes the axis begin at zero.
 */
function axisLine(figure, number, id) {
  const text = make("span");
  const box = make("input", {type: "checkbox",
                             "aria-label": `Value axes of figure ${number} from zero`});
  box.addEventListener("change", () => switchAxis(figure));
  const line = make("p", {class: "span-note", id}, text, make("label", {}, box, "from zero"));
  page.notes.push(() => {
    box.checked = state.fromZero.has(figure.id);
    const note = axisNote(figure, ...state.span);
    text.textContent = box.checked ? "axis from zero" : note;
    line.hidden = !box.checked && note === "";
  });
  return line;
}

const fitCharts = oncePerFrame(() => {
  for (const [element, {chart, figure, runs}] of page.panels) {
    const width = element.clientWidth;
    if (width > 0 && width !== chart.width) {
      chart.setSize({width, height: chartHeight(width, figure, runs)});
    }
  }
  showTime();
});

const sizes = new ResizeObserver(fitCharts);

/** One panel for all runs if they are overlaid, otherwise one panel for each run. */
function panelsOf(figure) {
  return isOverlaid(figure) ? [state.runs] : state.runs.map((run) => [run]);
}

/** Name of a panel's run, with a badge if its log is not complete. */
function panelTitle(run) {
  const title = make("h4", {}, make("i", {class: `dot ${run.style}`}), run.name);
  if (run.badge) title.append(" ", make("span", {class: "badge"}, run.badge));
  return title;
}

function buildFigure(figure, number) {
  const element = document.getElementById(figure.id);
  const place = element.querySelector(".panels");
  const panels = panelsOf(figure);
  place.classList.toggle("strips", isStrip(figure));
  place.classList.toggle("overlaid", isOverlaid(figure));
  place.replaceChildren();
  panels.forEach((runs, index) => {
    const names = runs.map((run) => run.name).join(", ");
    const noteId = `${figure.id}-span-${index}`;
    const chartElement = make("div", {
      class: "chart", role: "img", "aria-label": `Figure ${number}, ${figure.title}: ${names}`,
      "aria-describedby": noteId});
    const panel = make("div", {class: "panel"});
    if (!isOverlaid(figure)) panel.append(panelTitle(runs[0]));
    panel.append(axisLine(figure, number, noteId), chartElement);
    place.append(panel);
    const chart = makeChart(chartElement, figure, runs, {onTime: setTime, onSpan: setSpan});
    page.charts.push(chart);
    page.panels.set(chartElement, {chart, figure, runs});
    sizes.observe(chartElement);
  });
  page.legends.push(makeLegend(element.querySelector(".legend"), figure, (curve) => {
    const hidden = state.hidden.get(figure.id);
    if (!hidden.delete(curve.column)) hidden.add(curve.column);
    const label = curve.label;
    build();
    for (const button of element.querySelectorAll(".legend button")) {
      if (button.textContent === label) button.focus();
    }
  }));
}

function build() {
  sizes.disconnect();
  for (const chart of page.charts) chart.destroy();
  page.charts = [];
  page.legends = [];
  page.notes = [];
  page.panels.clear();
  document.querySelector("#figures .figures").classList.toggle("apart", !sharesAxes());
  readTheme();
  report.figures.forEach((figure, index) => buildFigure(figure, index + 1));
  for (const showNote of page.notes) showNote();
  showTime();
}

/** Draws all figures again, for example in other colours. */
function draw() {
  build();
  buildCurves();
}

/** Calls `change`, which changes the shown runs or their view. Then draws the figures again. */
function compare(change) {
  const shared = sharesAxes();
  change();
  if (sharesAxes() !== shared) resetHidden();
  const whole = wholeSpan();
  if (!state.zoomed) state.span = whole;
  Object.assign(page.slider, {min: whole[0], max: whole[1], step: timeStep()});
  build();
  setTime(state.time);
}

function listen() {
  const runs = document.getElementById("runs");
  runs.addEventListener("change", () => {
    const chosen = new Set([...runs.querySelectorAll(":checked")].map((box) => Number(box.value)));
    compare(() => { state.runs = report.runs.filter((run) => chosen.has(run.index)); });
  });
  document.getElementById("views").addEventListener("change", ({target}) => {
    compare(() => { state.apart = target.value === "apart"; });
  });
  page.slider.addEventListener("input", () => setTime(Number(page.slider.value)));
  page.whole.addEventListener("click", () => setSpan(wholeSpan()));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  const paper = (on) => () => {
    document.documentElement.classList.toggle("paper", on);
    draw();
  };
  addEventListener("beforeprint", paper(true));
  addEventListener("afterprint", paper(false));
}

function start() {
  const several = report.runs.length > 1;
  watchScrolls(document);
  document.getElementById("runs").classList.toggle("single", !several);
  document.getElementById("views").hidden = !several;
  page.toolbar.hidden = report.runs.length === 0;
  state.time = tellingTime();
  resetHidden();
  listen();
  compare(() => {});
  startCurves();
}

start();
