// The legend of a figure: one row for each curve, one column for each run, with the values at the
// cursor's time. The legend also has the keys of the shades.

function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** Makes a short piece of a line. */
function lineSwatch(stroke, dash, width) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
  const attributes = {x1: 0, y1: 5, x2: 28, y2: 5, stroke,
                      "stroke-width": width, "stroke-dasharray": dash.join(" ")};
  for (const [name, value] of Object.entries(attributes)) line.setAttribute(name, value);
  for (const [name, value] of Object.entries({width: 28, height: 10, "aria-hidden": "true"})) {
    svg.setAttribute(name, value);
  }
  svg.append(line);
  return svg;
}

/** Makes a short piece of the curve in the style of the figure. */
function swatch(curve, overlaid, shared) {
  const {palette, ink, shared: sharedColour} = state.theme;
  const stroke = !overlaid ? palette[curve.colour] : shared ? sharedColour : ink;
  return lineSwatch(stroke, overlaid || curve.limit ? curve.dash : [], curve.limit ? 2 : 2.5);
}

/** Makes a list that explains marks and shades. `keys` is [[class of the mark, text], ...]. */
function makeKeys(keys) {
  return make("ul", {class: "keys"}, ...keys.map(([name, text]) =>
      make("li", {}, make("span", {class: `key ${name}`}), text)));
}

function shadeKeys(figure) {
  const overlaid = isOverlaid(figure);
  const keys = [];
  if (state.runs.some((run) => run.fog.length)) keys.push(["fog", "fog"]);
  if (state.runs.some((run) => run.human.length)) {
    keys.push(overlaid ? ["bars", "bar: the human drives, in the run of that colour"]
                       : ["human", "the human drives"]);
  }
  const {shade} = figure;
  const hidden = state.hidden.get(figure.id);
  if (shade && !hidden.has(shade.below) && !hidden.has(shade.limit)) {
    keys.push([overlaid ? "short neutral" : "short", shade.meaning]);
  }
  return makeKeys(keys);
}

/**
 * Fills `element` with the legend. It calls `onToggle(curve)` when the reader shows or hides a
 * curve. Returns a function that shows the values at a time.
 */
function makeLegend(element, figure, onToggle) {
  const overlaid = isOverlaid(figure);
  const clock = make("span");
  const head = make("tr", {}, make("th", {scope: "col"}, clock));
  for (const run of state.runs) {
    head.append(make("th", {scope: "col", class: run.style}, run.name));
  }
  const cells = [];
  const rows = figure.curves.map((curve) => {
    const shared = overlaid && isShared(state.runs, curve.column);
    const shown = !state.hidden.get(figure.id).has(curve.column);
    const button = make("button", {type: "button", "aria-pressed": shown},
                        swatch(curve, overlaid, shared), curve.label);
    button.addEventListener("click", () => onToggle(curve));
    const row = make("tr", {}, make("th", {scope: "row"}, button));
    for (const run of state.runs) {
      const cell = make("td");
      cells.push({cell, run, values: run.columns[curve.column]});
      row.append(cell);
    }
    return row;
  });
  const label = `Values of figure ${report.figures.indexOf(figure) + 1} at the cursor`;
  element.replaceChildren(
      make("div", {class: "scroll", role: "region", tabindex: 0, "aria-label": label},
           make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows))),
      shadeKeys(figure));
  watchScrolls(element);
  return (time) => {
    const unit = figure.unit ? ` in ${figure.unit}` : "";
    clock.textContent = `at ${decimal(time, 1)} s${unit}`;
    const places = new Map(state.runs.map((run) => [run, sampleAt(run, time)]));
    for (const {cell, run, values} of cells) {
      cell.textContent = decimal(values[places.get(run)], figure.decimals);
    }
  };
}
