// The frames that the page sends to the seat (fogline.drive.v1 in docs/view.md), and the times at
// which they are due. It knows no document and no socket.

export const KEEP_ALIVE_MS = 50;  // a seat that hears nothing for longer knows that something is wrong
export const LEAST_GAP_MS = 4;    // at most 250 frames a second
// How often the page looks at the devices, and whether a frame is due. A browser does not tell a page
// that a pedal has moved, so half of this time is part of the latency.
export const LOOK_EVERY_MS = 8;
const MOST_NAME_BYTES = 64;
const MOST_AXES = 16;
const MOST_MS = 3_600_000;        // a longer time is sent as this one
const SAME = 1e-4;                // a smaller change of a pedal or an axis does not count

const utf8 = new TextEncoder();

/** The beginning of a text that has at most this many bytes as UTF-8. */
export function cutText(text, mostBytes = MOST_NAME_BYTES) {
  let cut = "";
  let bytes = 0;
  for (const character of text.toWellFormed?.() ?? text) {
    bytes += utf8.encode(character).length;
    if (bytes > mostBytes) break;
    cut += character;
  }
  return cut;
}

const within = (value, least, most) =>
  Number.isFinite(value) ? Math.min(most, Math.max(least, value)) : least;

/** A frame. @param age_ms time since the newest input of the device. @param latency_ms or null */
export function inputFrame(input, sequence, age_ms, latency_ms) {
  const {present, throttle, brake, axes, buttons, device} = input;
  return {
    op: "input", sequence, age_ms: within(age_ms, 0, MOST_MS), present,
    throttle: within(throttle, 0, 1), brake: within(brake, 0, 1),
    axes: axes.slice(0, MOST_AXES).map((value) => within(value, -1, 1)), buttons,
    device: {kind: device.kind, name: cutText(device.name)},
    ...(latency_ms === null ? {} : {latency_ms: within(latency_ms, 0, MOST_MS)}),
  };
}

const differs = (a, b) => Math.abs(a - b) > SAME;

/** Whether the difference of two inputs needs a frame. */
export function isChange(before, after) {
  return before === null || before.present !== after.present ||
    before.device.id !== after.device.id || differs(before.throttle, after.throttle) ||
    differs(before.brake, after.brake) || before.buttons.join() !== after.buttons.join() ||
    before.axes.length !== after.axes.length || before.axes.some((value, i) => differs(value, after.axes[i]));
}

/** Says when a frame is due, and numbers the frames. */
export class Sender {
  constructor() {
    this.sequence = 0;
    this.begin();
  }

  /** Begins with another connection. It has no earlier frame. */
  begin() {
    this.before = null;
    this.sent_ms = -Infinity;
  }

  /**
   * Whether this input is to be sent now: each change, but not more often than every LEAST_GAP_MS,
   * and without a change so often that no gap is longer than KEEP_ALIVE_MS. The first input without
   * a person is sent without delay.
   */
  isDue(input, now_ms) {
    const passed_ms = now_ms - this.sent_ms;
    if (this.before?.present && !input.present) return true;
    if (isChange(this.before, input)) return passed_ms >= LEAST_GAP_MS;
    return passed_ms + LOOK_EVERY_MS > KEEP_ALIVE_MS;
  }

  /** Whether a change waits only because the last frame was sent a moment ago. */
  isHeldBack(input) { return isChange(this.before, input); }

  /** The frame of this input. @return {sequence, ...} */
  next(input, now_ms, touched_ms, latency_ms) {
    this.before = input;
    this.sent_ms = now_ms;
    return inputFrame(input, this.sequence++, touched_ms === null ? MOST_MS : now_ms - touched_ms,
                      latency_ms);
  }
}
