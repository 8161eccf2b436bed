// The frames that the page sends to the seat (fogline.drive.v1 in docs/view.md), and the times at
// which they are due. This file does not use the document, and has no socket.

export const KEEP_ALIVE_MS = 50;  // longest time between frames; see Seat::kSilent
export const LEAST_GAP_MS = 4;    // at most 250 frames a second
// Interval at which the page reads the devices, and checks whether a frame is due. A browser sends
// no event when a pedal moves. So on average the latency contains half of this time.
export const LOOK_EVERY_MS = 8;
const MOST_NAME_BYTES = 64;
const MOST_AXES = 16;
const MOST_MS = 3_600_000;        // a longer time is sent as this time
const SAME = 1e-4;                // a smaller change of a pedal or an axis causes no frame

const utf8 = new TextEncoder();

/** The beginning of a text: whole characters, together at most this many bytes of UTF-8. */
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

/**
 * The frame for an input.
 * @param age_ms time since the newest input of the device
 * @param latency_ms a measurement that no earlier frame has reported; null if there is none
 */
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

/** Whether two inputs differ so much that a frame is needed. */
export function isChange(before, after) {
  return before === null || before.present !== after.present ||
    before.device.id !== after.device.id || differs(before.throttle, after.throttle) ||
    differs(before.brake, after.brake) || before.buttons.join() !== after.buttons.join() ||
    before.axes.length !== after.axes.length || before.axes.some((value, i) => differs(value, after.axes[i]));
}

/** Decides when a frame is due, and numbers the frames. */
export class Sender {
  constructor() {
    this.sequence = 0;
    this.begin();
  }

  /** Begins with a new connection, on which no frame was sent. */
  begin() {
    this.before = null;
    this.sent_ms = -Infinity;
  }

  /**
   * Whether this input must be sent at this time. A change is sent, but not sooner than
   * LEAST_GAP_MS after the last frame. Without a change, a frame is sent before KEEP_ALIVE_MS have
   * passed. The first input without a person is sent without delay.
   */
  isDue(input, now_ms) {
    const passed_ms = now_ms - this.sent_ms;
    if (this.before?.present && !input.present) return true;
    if (isChange(this.before, input)) return passed_ms >= LEAST_GAP_MS;
    return passed_ms + LOOK_EVERY_MS > KEEP_ALIVE_MS;
  }

  /** Whether an input that is not due is a change that waits for LEAST_GAP_MS. */
  isHeldBack(input) { return isChange(this.before, input); }

  /** Makes the frame of this input. @return {sequence, ...} */
  next(input, now_ms, touched_ms, latency_ms) {
    this.before = input;
    this.sent_ms = now_ms;
    return inputFrame(input, this.sequence++, touched_ms === null ? MOST_MS : now_ms - touched_ms,
                      latency_ms);
  }
}
