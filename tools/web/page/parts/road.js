// The road from above, to scale: cars, gaps, brake lamps, the sensors' values, and fog.

import {carsOf, extinction, sightings} from "../data/cars.js";
import {fitCanvas, hatch} from "../draw/dom.js";
import {decimal} from "../draw/format.js";
import {withAlpha} from "../draw/theme.js";

const CAR = {width_m: 1.85, corner_m: 0.5};
const LANE_M = 3.6;
const DASH = {length_m: 6, period_m: 18};  // the line between the lanes
const MARGIN_M = 10;                       // shown before the first and behind the last car
const LEAST_SPAN_M = 60;
// The scale does not change while the cars fit into the width and need at least 1/SLACK^2 of it.
const SLACK = 1.25;
const SCALE_BARS_M = [1, 2, 5, 10, 20, 50, 100, 200, 500];
const SIGHTS_HEIGHT = 52;  // height for the marks of the sensors, in pixels
const GAPS_HEIGHT = 58;   // height for the gaps, and for the scale bar below them

/** Marks of the sensors. Both colour and shape show which sensor it is. */
const SIGHTS = [
  {key: "radar", label: "radar", draw: circle},
  {key: "lidar", label: "LiDAR", draw: diamond},
  {key: "fusion", label: "fusion", draw: cross},
];

function circle(pen, x, y, r) {
  pen.arc(x, y, r, 0, 2 * Math.PI);
}

function diamond(pen, x, y, r) {
  pen.moveTo(x, y - 1.3 * r);
  for (const [dx, dy] of [[r, 0], [0, r], [-r, 0]]) pen.lineTo(x + 1.3 * dx, y + 1.3 * dy);
  pen.closePath();
}

function cross(pen, x, y, r) {
  pen.moveTo(x - r, y - r);
  pen.lineTo(x + r, y + r);
  pen.moveTo(x - r, y + r);
  pen.lineTo(x + r, y - r);
}

export class Road {
  constructor(canvas) {
    this.canvas = canvas;
    this.window = null;  // {from_m, to_m} of the shown road, relative to the host's front bumper
    this.lane = 0;       // middle of the lane, in pixels of the page from the top
  }

  /**
   * Chooses the part of the road that is shown. The part changes only if cars leave it, or fill too
   * little of it.
   */
  chooseWindow(cars, length_m) {
    const to_m = Math.max(cars[0].front_m, 0) + MARGIN_M;
    const from_m = cars.at(-1).front_m - length_m - MARGIN_M;
    const lack_m = Math.max(0, LEAST_SPAN_M - (to_m - from_m));
    const wanted = {from_m: from_m - lack_m / 2, to_m: to_m + lack_m / 2};
    const {window} = this;
    const fits = window && wanted.from_m >= window.from_m && wanted.to_m <= window.to_m &&
      (wanted.to_m - wanted.from_m) * SLACK * SLACK >= window.to_m - window.from_m;
    if (fits) return;
    const more_m = ((wanted.to_m - wanted.from_m) * (SLACK - 1)) / 2;
    this.window = {from_m: wanted.from_m - more_m, to_m: wanted.to_m + more_m};
  }

  /** @param moment {frame, ahead_s, length_m, side, theme} */
  draw({frame, ahead_s, length_m, side, theme}) {
    const {context: pen, width, height} = fitCanvas(this.canvas);
    const {TRUTH: truth} = frame;
    if (!truth || width === 0) return;
    const cars = carsOf(truth, ahead_s);
    this.chooseWindow(cars, length_m);
    const {from_m, to_m} = this.window;
    const scale = width / (to_m - from_m);
    const top = SIGHTS_HEIGHT;
    const bottom = height - GAPS_HEIGHT;
    const view = {pen, width, top, bottom, scale, theme, length_m,
                  x: (m) => (m - from_m) * scale, lane: (top + bottom) / 2 + ((bottom - top) / 4)};
    this.lane = view.lane;
    pen.font = `12px ${theme.font}`;
    pen.textBaseline = "middle";
    drawSurface(view, truth.host_position_m + ahead_s * truth.host_speed_mps);
    for (const car of cars) drawCar(view, car, side);
    drawHaze(view, truth);
    for (const car of cars) drawOutline(view, car);
    drawSights(view, frame, truth);
    drawGaps(view, cars, frame);
    drawScaleBar(view, height);
  }
}

function drawSurface({pen, width, top, bottom, scale, theme, x}, host_m) {
  pen.fillStyle = theme.verge;
  pen.fillRect(0, top, width, bottom - top);
  pen.fillStyle = theme.asphalt;
  pen.fillRect(0, top + 4, width, bottom - top - 8);
  pen.fillStyle = theme.marking;
  pen.fillRect(0, top + 8, width, 1.5);
  pen.fillRect(0, bottom - 9.5, width, 1.5);  // the edge line
  const middle = (top + bottom) / 2;
  const first = -host_m % DASH.period_m;
  const from = Math.floor((-x(first) / scale) / DASH.period_m) * DASH.period_m;
  for (let m = first + from; x(m) < width; m += DASH.period_m) {
    pen.fillRect(x(m), middle - 0.75, DASH.length_m * scale, 1.5);
  }
}

function carColour(theme, kind, side) {
  if (kind !== "host") return theme.car;
  return side === "unknown" ? theme.ink : theme[side];
}

/** Position of a car in the picture: {left, length, width}. */
function carBox({x, scale, length_m, top, bottom}, {front_m}) {
  const length = Math.max(6, length_m * scale);
  const laneHeight = (bottom - top) / 2;
  const most = 1.2 * laneHeight * (CAR.width_m / LANE_M);
  const width = Math.max(5, Math.min(CAR.width_m * scale, most));
  return {left: x(front_m) - length, length, width};
}

function tracePath({pen, lane, scale}, {left, length, width}) {
  pen.beginPath();
  pen.roundRect(left, lane - width / 2, length, width, Math.min(width / 3, CAR.corner_m * scale));
}

function drawCar(view, car, side) {
  const {pen, lane, theme} = view;
  const box = carBox(view, car);
  tracePath(view, box);
  pen.fillStyle = carColour(theme, car.kind, side);
  pen.fill();
  if (car.kind === "host" && (side === "human" || side === "risk")) {
    fillPattern(pen, hatch(pen, theme.surface, {size: 5, both: side === "risk"}));
  }
  drawScreens(pen, box, lane);
}

/** Outline and brake lamps of a car. Fog does not cover them here, so a reader finds each car. */
function drawOutline(view, car) {
  const {pen, lane, theme} = view;
  const box = carBox(view, car);
  tracePath(view, box);
  pen.strokeStyle = withAlpha(theme.ink, 0.7);
  pen.lineWidth = 1;
  pen.stroke();
  if (car.brakes) drawBrakeLamps(pen, box, lane, theme);
}

function fillPattern(pen, pattern) {
  pen.save();
  pen.globalAlpha = 0.55;
  pen.fillStyle = pattern;
  pen.fill();
  pen.restore();
}

/** Draws windscreen and rear window, which show in which direction a car drives. */
function drawScreens(pen, {left, length, width}, lane) {
  if (length < 18) return;
  pen.fillStyle = "rgba(0, 0, 0, 0.45)";
  pen.fillRect(left + 0.62 * length, lane - 0.38 * width, 0.13 * length, 0.76 * width);
  pen.fillRect(left + 0.14 * length, lane - 0.36 * width, 0.08 * length, 0.72 * width);
}

function drawBrakeLamps(pen, {left, width}, lane, theme) {
  pen.fillStyle = theme.lamp;
  for (const y of [lane - width / 2, lane + width / 2 - 0.34 * width]) {
    pen.fillRect(left - 3, y, 5, 0.34 * width);
  }
}

/**
 * Draws haze over the road. The fog between a place and the host's driver removes a share of the
 * contrast. The opacity of the haze at this place is 92 % of this share.
 */
function drawHaze({pen, width, top, bottom, theme, x, scale}, truth) {
  const sigma = extinction(truth.fog_visibility_m);
  const eye = x(-2);
  const reach = Math.max(eye, width - eye);
  for (const [side, end] of [[-1, 0], [1, width]]) {
    const gradient = pen.createLinearGradient(eye, 0, eye + side * reach, 0);
    for (let i = 0; i <= 12; ++i) {
      const lost = 1 - Math.exp((-sigma * reach * (i / 12)) / scale);
      gradient.addColorStop(i / 12, withAlpha(theme.haze, 0.92 * lost));
    }
    pen.fillStyle = gradient;
    pen.fillRect(Math.min(eye, end), top, Math.abs(end - eye), bottom - top);
  }
}

/** Draws marks above the road where each sensor sees the preceding car. */
function drawSights({pen, width, top, theme, x}, frame, truth) {
  const seen = sightings(frame);
  const colours = {radar: theme.radar, lidar: theme.lidar, fusion: theme.ink};
  const rows = {radar: 9, lidar: 24, fusion: 39};
  pen.textAlign = "left";
  pen.fillStyle = theme.muted;
  pen.lineWidth = 1;
  const rear = Math.round(x(truth.host_gap_m)) + 0.5;
  const front = x(0);
  for (const {key, label, draw} of SIGHTS) {
    const y = rows[key];
    pen.strokeStyle = theme.grid;
    line(pen, front, y, Math.min(width, Math.max(rear, front)), y);
    pen.fillStyle = theme.muted;
    pen.textAlign = "right";
    const isNear = seen[key] !== null && x(seen[key]) >= 0 && x(seen[key]) <= width;
    const words = seen[key] === null ? "no echo" : `${decimal(seen[key], 0)} m`;
    pen.fillText(isNear ? label : `${label}: ${words}`, front - 8, y);
    if (!isNear) continue;
    pen.strokeStyle = colours[key];
    pen.lineWidth = 2;
    pen.beginPath();
    draw(pen, x(seen[key]), y, 3.6);
    pen.stroke();
    pen.lineWidth = 1;
  }
  pen.strokeStyle = theme.muted;
  pen.setLineDash([3, 3]);
  line(pen, rear, 3, rear, top);
  pen.setLineDash([]);
}

function line(pen, x1, y1, x2, y2) {
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}

/** Draws dimension lines of the gaps below the road. A tick shows the safe distance. */
function drawGaps({pen, width, bottom, theme, x, length_m}, cars, frame) {
  const {ACC_COMMAND, FOLLOWER_COMMAND} = frame;
  const y = bottom + 13;
  for (let i = 1; i < cars.length; ++i) {
    const [ahead, car] = [cars[i - 1], cars[i]];
    const from = x(car.front_m);
    const gap_m = ahead.front_m - length_m - car.front_m;
    const to = x(ahead.front_m - length_m);
    const safe_m = i === 1 ? ACC_COMMAND?.safe_distance_m
                           : FOLLOWER_COMMAND?.safe_distance_m?.[i - 2];
    const short = safe_m != null && gap_m < safe_m - 0.05;
    pen.strokeStyle = pen.fillStyle = theme.ink;
    line(pen, from, y, to, y);
    for (const end of [from, to]) line(pen, end, y - 5, end, y + 5);
    if (safe_m != null && x(car.front_m + safe_m) < width) {
      pen.strokeStyle = theme.risk;
      pen.lineWidth = 2;
      line(pen, x(car.front_m + safe_m), y - 7, x(car.front_m + safe_m), y + 7);
      pen.lineWidth = 1;
    }
    pen.textAlign = "center";
    pen.fillStyle = short ? theme.risk : theme.ink;
    pen.font = `600 13px ${theme.font}`;
    const words = short ? `▼ ${decimal(gap_m, 1)} < ${decimal(safe_m, 1)} m` : `${decimal(gap_m, 1)} m`;
    pen.fillText(words, (from + to) / 2, y + 15);
    pen.font = `12px ${theme.font}`;
  }
}

function drawScaleBar({pen, width, scale, theme}, height) {
  const length_m = SCALE_BARS_M.findLast((m) => m * scale <= 90) ?? 1;
  const right = width - 8;
  const left = right - length_m * scale;
  const y = height - 6;
  pen.strokeStyle = theme.muted;
  line(pen, left, y, right, y);
  for (const end of [left, right]) line(pen, end, y - 4, end, y + 2);
  pen.fillStyle = theme.muted;
  pen.textAlign = "right";
  pen.fillText(`${length_m} m`, left - 6, y - 3);
}

/** A description of the picture in words. */
export function roadInWords(frame, length_m) {
  if (!frame.TRUTH) return "The road from above. There is no message about the cars yet.";
  const cars = carsOf(frame.TRUTH);
  const gaps = cars.slice(1).map((car, i) => {
    const gap_m = cars[i].front_m - length_m - car.front_m;
    return `${decimal(gap_m, 1)} m from the ${car.name} to the ${cars[i].name}`;
  });
  const braking = cars.filter(({brakes}) => brakes).map(({name}) => `the ${name} brakes`);
  return `The road from above: ${[...gaps, ...braking].join(", ")}.`;
}
