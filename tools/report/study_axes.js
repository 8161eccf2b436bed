// The axes of a figure of studies: positions of values, ranges, ticks, and the rows of categories.
// study.js follows in the same script, and defines the variable `theme`.

const SPREAD = 0.6;  // share of a category's row in which its series lie
const ROW = {point: 11, line: 14, gap: 10, names: 0.44};  // in pixels; names: share of the width

/** A number for a reader, with four significant digits and a true minus sign. */
function numberText(value) {
  if (value == null) return "–";
  const text = String(Number(Math.abs(value).toPrecision(4)));
  return value < 0 ? `−${text}` : text;
}

/**
 * placeOfX(), placeOfY(): position of a value on the axis. xAtPlace(), yAtPlace(): value at a
 * position. On a logarithmic axis, the position is the decimal logarithm of the value.
 */
const placeOfX = (figure, x) => figure.logX ? Math.log10(x) : x;
const xAtPlace = (figure, place) => figure.logX ? 10 ** place : place;
const placeOfY = (figure, y) => !figure.logY || y == null ? y : y > 0 ? Math.log10(y) : null;
const yAtPlace = (figure, place) => figure.logY ? 10 ** place : place;
const isBeyond = (figure, y) => figure.most != null && y > figure.most;

/**
 * Columns for uPlot, and in the same order the unchanged values and the ends of the intervals:
 * {data, values, low, high}.
 */
function columnsOf(figure) {
  const count = figure.series.length;
  const tables = figure.series.map(({x, y, low, high}, i) => {
    const shift = figure.categories.length ? SPREAD * ((i + 0.5) / count - 0.5) : 0;
    const none = y.map(() => null);
    return [x.map((value) => placeOfX(figure, value) + shift), y, low.length ? low : none, high.length ? high : none];
  });
  const [xs, ...columns] = uPlot.join(tables);
  const every = (first) => figure.series.map((_, i) => columns[3 * i + first]);
  const values = every(0);
  // A value beyond the axis has a special mark and no interval.
  const placed = (column, i) => column.map((y, k) => {
    if (isBeyond(figure, values[i][k])) return null;
    return placeOfY(figure, isBeyond(figure, y) ? figure.most : y);
  });
  return {data: [xs, ...values.map(placed)], values,
          low: every(1).map(placed), high: every(2).map(placed)};
}

/** Least and greatest of the shown values and intervals. */
function valueRange(chart, figure, {data, values, low, high}) {
  let least = Infinity;
  let most = -Infinity;
  data.slice(1).forEach((places, i) => {
    if (!chart.series[i + 1].show) return;
    if (values[i].some((y) => isBeyond(figure, y))) most = figure.most;
    for (const column of [places, low[i], high[i]]) {
      for (const value of column) {
        if (value == null) continue;
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
  });
  return least > most ? [0, 1] : [least, most];
}

/** A value axis that fits the range, with a margin. */
function fittedSpan([least, most]) {
  const margin = 0.05 * (most - least) || Math.abs(most) * 0.05 || 1;
  return [least - margin, most + margin];
}

function valueSpan(figure, range) {
  if (!figure.fromZero) return fittedSpan(range);
  return [1.05 * Math.min(0, range[0]), 1.05 * Math.max(0, range[1])];
}

/**
 * "axis spans 0.3 % of the value" if a fitted axis spans less than 1 % of the largest value;
 * otherwise "". A logarithmic axis has no zero.
 */
function axisNote(figure, range) {
  if (figure.logY) return "";
  const [bottom, top] = fittedSpan(range);
  const share = (top - bottom) / Math.max(...range.map(Math.abs));
  return share < 0.01 ? `axis spans ${Number((100 * share).toPrecision(2))} % of the value` : "";
}

/** The range of the whole x axis. */
function placeSpan(figure, xs) {
  if (figure.categories.length) return [-0.6, figure.categories.length - 0.4];
  if (xs.length === 0) return [0, 1];
  const [first, last] = [xs[0], xs[xs.length - 1]];
  const margin = 0.02 * (last - first) || 1;
  return [first - margin, last + margin];
}

/** Width of a text of an axis, in pixels. */
function textWidth(text) {
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = `12px ${theme.font}`;
  return pen.measureText(text).width;
}

/** The name of a category in lines of at most `room` pixels. A single word may be wider. */
function linesOf(name, room) {
  const lines = [];
  for (const word of name.replace(/(\d) (?=\D)/g, "$1\u00a0").split(" ")) {
    const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
    if (lines.length && textWidth(longer) <= room) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return {lines, width: Math.max(...lines.map(textWidth))};
}

/** Names of the rows, the room for them, and the height of a row, in a chart of this width. */
function rowsOf(figure, width) {
  const names = figure.categories.map((name) => linesOf(name, ROW.names * width));
  const lines = Math.max(...names.map((name) => name.lines.length));
  return {
    names: names.map((name) => name.lines.join("\n")),
    room: Math.ceil(Math.max(...names.map((name) => name.width))) + 14,
    height: ROW.gap + Math.max(ROW.line * lines, ROW.point * figure.series.length),
  };
}

function chartHeight(figure, width) {
  if (figure.categories.length) {
    return rowsOf(figure, width).height * figure.categories.length + 44;
  }
  return Math.round(Math.min(380, Math.max(240, width * 0.52)));
}

function axis(more) {
  const lines = {stroke: theme.grid, width: 1};
  return {stroke: theme.muted, font: `12px ${theme.font}`, grid: lines,
          ticks: {...lines, size: 4}, gap: 5, ...more};
}

/** Ticks at the existing values of x, except values whose texts would overlap. */
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
  return axis({
    side: 3,
    lineGap: ROW.line / 12,
    size: (chart) => rowsOf(figure, chart.width).room,
    splits: () => figure.categories.map((_, i) => i),
    values: (chart) => rowsOf(figure, chart.width).names,
  });
}

/** Ticks 1, 2, 5, 10 ... of a logarithmic axis, or 1, 10, 100 ... of a long logarithmic axis. */
function logTicks(least, most) {
  const decades = Array.from({length: Math.ceil(most) - Math.floor(least) + 1},
                             (_, i) => Math.floor(least) + i);
  const steps = most - least > 2 ? [1] : [1, 2, 5];
  return decades.flatMap((decade) => steps.map((step) => decade + Math.log10(step)))
      .filter((place) => place >= least && place <= most);
}

function yAxis(figure) {
  // The room has space for a tick, a gap and the longest value.
  const room = (_, texts) => Math.max(56, 14 + Math.ceil(Math.max(...(texts ?? [""]).map(textWidth))));
  const place = figure.categories.length ? {side: 2, size: 28, space: 56} : {size: room};
  const splits = figure.logY ? (chart, index, least, most) => logTicks(least, most) : undefined;
  return axis({...place, splits,
               values: (_, places) => places.map((y) => numberText(yAtPlace(figure, y)))});
}
