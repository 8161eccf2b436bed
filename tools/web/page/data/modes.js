// The side that drives the host, by HOST_COMMAND.mode (lcmtypes/arbitration_t.lcm).

/** The sides that can drive. The page shows each side by a colour, a shape and a pattern. */
export const SIDES = {
  automation: {words: "The automation drives", short: "automation"},
  human: {words: "The human drives", short: "human"},
  risk: {words: "Minimal risk manoeuvre", short: "minimal risk"},
  unknown: {words: "It is not known who drives", short: "unknown"},
};

// Least authority with which the human counts as the driver (services/host_modes.h).
const MAIN_AUTHORITY = 0.5;

/** Whether the human has half of the authority or more. */
export const humanDrives = (lambda_human) => lambda_human >= MAIN_AUTHORITY;

const MODES = [
  {name: "AUTOMATION", side: "automation", words: "The automation drives"},
  {name: "HUMAN", side: "human", words: "The human drives"},
  {name: "MINIMAL_RISK", side: "risk", words: "Minimal risk manoeuvre: the car stops by itself"},
  {name: "REQUEST", side: "automation", asks: true,
   words: "The automation drives and asks the human to take over"},
  {name: "REQUEST_URGENT", side: "automation", asks: true, urgent: true,
   words: "The automation drives and urgently asks the human to take over"},
  {name: "HANDOVER", side: "automation", asks: true,
   words: "The automation drives; the human has answered"},
  {name: "RECOVERING", side: "human", words: "The human drives, just after taking over"},
  {name: "MRM_COMFORT", side: "risk", stops: true,
   words: "Minimal risk manoeuvre: comfortable stop"},
  {name: "MRM_EMERGENCY", side: "risk", stops: true,
   words: "Minimal risk manoeuvre: emergency stop"},
  {name: "MRM_DONE", side: "risk", stops: true,
   words: "Minimal risk manoeuvre: the car stands, locked"},
  {name: "MRM_FAILED", side: "risk", stops: true,
   words: "Minimal risk manoeuvre: the brake has no effect"},
  {name: "COLLISION_WARNING", side: null, words: "Collision warning"},
  {name: "EMERGENCY_BRAKING", side: "risk", hides: true, words: "Emergency braking"},
];

/**
 * The description {name, side, words, asks, urgent, stops, hides} of a mode. In a collision warning
 * the same side drives as before, and no request is open. `stops`: the mode is one of the stages of
 * a minimal risk manoeuvre. `hides`: the mode does not say whether there is a request.
 */
export function modeOf(mode, lambda_human = 0) {
  const known = MODES[mode];
  if (!known) return {name: "UNKNOWN", side: "unknown", words: SIDES.unknown.words};
  if (known.side) return known;
  const side = humanDrives(lambda_human) ? "human" : "automation";
  return {...known, side, words: `Collision warning. ${SIDES[side].words}`};
}

/**
 * Joins successive equal values into spans up to `end`: [{from, to, value}]. The times ascend. `to`
 * is the beginning of the next span, or `end` for the last span.
 */
export function spansOf(times, values, end) {
  const spans = [];
  for (let i = 0; i < times.length && times[i] <= end; ++i) {
    if (Number.isNaN(values[i])) continue;
    const last = spans.at(-1);
    if (last?.value === values[i]) continue;
    if (last) last.to = times[i];
    spans.push({from: times[i], to: end, value: values[i]});
  }
  return spans;
}

/**
 * Spans of the side that drives, as spansOf() gives them, within [from, to]. `modes` and `lambdas`
 * are series of HOST_COMMAND.mode and HOST_COMMAND.lambda_human; the series may contain only the
 * changes of the values.
 */
export function sideSpans(modes, lambdas, from, to, end) {
  const [mode, lambda] = [modes.within(from, to), lambdas.within(from, to)];
  const [times, sides] = [[], []];
  for (let [i, j] = [0, 0]; i < mode.times.length || j < lambda.times.length;) {
    const time = Math.min(mode.times[i] ?? Infinity, lambda.times[j] ?? Infinity);
    if (mode.times[i] === time) ++i;
    if (lambda.times[j] === time) ++j;
    if (i === 0) continue;
    times.push(time);
    sides.push(modeOf(mode.values[i - 1], lambda.values[j - 1]).side);
  }
  return spansOf(times, sides, end);
}

/**
 * The time at which the side that drives at `time` began to drive; null if this side has driven
 * since the first value. `modes` and `lambdas` as in sideSpans().
 */
export function drivingSince(modes, lambdas, time) {
  const {times: modeTimes, values: modeValues} = modes;
  const {times: lambdaTimes, values: lambdaValues} = lambdas;
  let [i, j] = [upTo(modeTimes, time), upTo(lambdaTimes, time)];
  const side = () => modeOf(modeValues[i], lambdaValues[j]).side;
  if (i < 0) return null;
  for (const now = side(); ;) {
    const since = Math.max(modeTimes[i], lambdaTimes[j] ?? -Infinity);
    if (lambdaTimes[j] === since) --j;
    if (modeTimes[i] === since) --i;
    if (i < 0) return null;
    if (side() !== now) return since;
  }
}

/**
 * The request that is open at a time: {since_s, left_s, share}; null if no request is open. `times`
 * and `modes` come from HOST_COMMAND up to this time. lead_s comes from the scenario. A request
 * begins with the first of the successive modes that ask. A mode with `hides` does not end it.
 */
export function requestAt(times, modes, time, lead_s) {
  let begin = -1;
  for (let place = upTo(times, time); place >= 0; --place) {
    const {asks, hides} = modeOf(modes[place]);
    if (asks) begin = place;
    else if (!hides) break;
  }
  if (begin < 0) return null;
  const left_s = Math.max(0, times[begin] + lead_s - time);
  return {since_s: times[begin], left_s, share: lead_s > 0 ? left_s / lead_s : 0};
}

/**
 * Spans in which a request is open, as spansOf() gives them. A mode with `hides` does not end a
 * request. @param modes series of HOST_COMMAND.mode
 */
export function requestSpans(modes, from, to, end) {
  const {times, values} = modes.within(from, to);
  // Emergency braking may have begun before `from`. Its mode does not say whether a request is
  // open. The mode before the braking says this.
  let before = times.length > 0 ? upTo(modes.times, times[0]) : -1;
  while (before >= 0 && modeOf(modes.values[before]).hides) --before;
  let open = Boolean(before >= 0 && modeOf(modes.values[before]).asks);
  const asks = values.map((mode) => {
    const {asks: isOpen = false, hides} = modeOf(mode);
    open = hides ? open : isOpen;
    return Number(open);
  });
  return spansOf(times, asks, end).filter(({value}) => value);
}

/**
 * The manoeuvre at a time: {first, before}; null if there is no manoeuvre. `first` describes the
 * first mode of the manoeuvre. `before` describes the last mode before the manoeuvre that says
 * which side drove. `before` is null if this mode is not known, or if it is a mode that asks and a
 * collision warning has followed it. `times` and `modes` as in requestAt().
 */
export function manoeuvreAt(times, modes, time) {
  let place = upTo(times, time);
  if (place < 0 || !modeOf(modes[place]).stops) return null;
  while (place > 0 && modeOf(modes[place - 1]).stops) --place;
  const first = modeOf(modes[place]);
  let warned = false;
  for (--place; place >= 0; --place) {
    const before = modeOf(modes[place]);
    if (before.name === "COLLISION_WARNING") warned = true;
    else if (!before.hides) return {first, before: warned && before.asks ? null : before};
  }
  return {first, before: null};
}

/** Index of the last value that is at most `x`; -1 if there is none. `values` ascend. */
export function upTo(values, x) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
