// Numbers and times as text. A missing value is a dash.

const DASH = "–";
const MINUS = "−";
const SPACE = "\u00a0";  // between a number and its unit, which stay on one line

export function decimal(value, decimals) {
  if (value == null || !Number.isFinite(value)) return DASH;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", MINUS);
}

/** A value with about four digits. */
export function digits(value) {
  if (value == null || !Number.isFinite(value)) return DASH;
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value).replace("-", MINUS);
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3).replaceAll("-", MINUS);
  return decimal(value, Math.max(0, 3 - Math.floor(Math.log10(size))));
}

export function withUnit(text, unit) {
  return unit ? `${text}${SPACE}${unit}` : text;
}

/** Simulated time, such as "19.0 s"; with as many decimals as the step needs. */
export function seconds(time, step_s = 0.1) {
  return `${decimal(time, timeDecimals(step_s))}${SPACE}s`;
}

export function timeDecimals(step_s) {
  return Math.min(4, Math.max(1, Math.ceil(-Math.log10(step_s) - 1e-9)));
}

/**
 * A label of a time axis whose labels are increment_s apart: "30 s", "5 min", "2 h".
 * @param decimals number of decimals of a label in seconds
 */
export function timeTick(time_s, increment_s, decimals) {
  if (increment_s < 60) return `${decimal(time_s, decimals)}${SPACE}s`;
  const [size_s, unit] = increment_s < 3600 ? [60, "min"] : [3600, "h"];
  return `${decimal(time_s / size_s, 0)}${SPACE}${unit}`;
}

/** Simulated time in whole minutes and seconds, such as "16:40 min", or "1:31:05 h". */
export function clockTime(time_s) {
  const whole_s = Math.floor(time_s);
  const [h, min, s] = [Math.floor(whole_s / 3600), Math.floor(whole_s / 60) % 60, whole_s % 60];
  const two = (value) => String(value).padStart(2, "0");
  return h > 0 ? `${h}:${two(min)}:${two(s)}${SPACE}h` : `${min}:${two(s)}${SPACE}min`;
}

export function count(value) {
  return value == null ? DASH : value.toLocaleString("en-GB").replaceAll(",", SPACE);
}

export function share(part, whole) {
  return whole > 0 ? `${decimal((100 * part) / whole, 2)}${SPACE}%` : DASH;
}

const KMH_PER_MPS = 3.6;
export const kmh = (speed_mps) => decimal(speed_mps * KMH_PER_MPS, 0);

/** The text for a visibility in m. */
export function visibility(value) {
  if (value == null || !Number.isFinite(value)) return DASH;
  return value >= 1000 ? `${decimal(value / 1000, 1)}${SPACE}km` : `${decimal(value, 0)}${SPACE}m`;
}
