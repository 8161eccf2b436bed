// The latency: the time from an input to the frame that shows it. This file does not use the
// document.
//
// A measurement begins at the time of an input. For a key this is the time of its event
// (Event.timeStamp). For a gamepad it is the time at which the browser got the state
// (Gamepad.timestamp). The page sends the input to the seat. The seat publishes it as DRIVER_INPUT,
// and answers with the number of this message. Then a DRIVER_COMMAND comes, which the driver role
// has made from this input or from a newer one. The measurement ends when the page has drawn the
// next frame (requestAnimationFrame). So it contains the time in page, seat and network, the wait
// of the driver role for its next step, and the drawing. It does not contain the delays of the
// keyboard and of the screen.

export const WARN_ABOVE_MS = 100;
export const LATE_ABOVE_MS = 40;  // the page then draws less; goal for the 95th percentile: 50 ms
const LATE_OF = 10;               // one of this many measurements may be late
// After this time, a new measurement may replace a measurement that has not ended.
const FORGET_AFTER_MS = 2000;
const KEPT = 512;              // number of measurements for the percentiles
const WARN_OF = 10;            // number of the newest measurements for the warning
const WARN_FOR_MS = 10000;     // the page warns of a long measurement for this time

export class Latency {
  constructor() {
    this.probe = null;     // {sequence, began_ms, input: number of DRIVER_INPUT or null, applied}
    this.values = [];
    this.recent = [];      // {value, at_ms} of the newest WARN_OF measurements
    this.count = 0;
    this.unsent = null;    // the newest measurement, until a frame reports it
    this.unjudged = [];    // measurements since takeLate() last judged
  }

  /** The newest measurement in ms; null if there is none. */
  get newest() { return this.values.at(-1) ?? null; }

  /**
   * The longest of the last WARN_OF measurements in ms; -Infinity without a measurement. A
   * measurement counts for WARN_FOR_MS.
   */
  highest(now_ms) {
    return Math.max(...this.recent.filter(({at_ms}) => now_ms - at_ms < WARN_FOR_MS).map(({value}) => value));
  }

  /** Whether the page warns that one of the last measurements was too long. */
  isHigh(now_ms) { return this.highest(now_ms) > WARN_ABOVE_MS; }

  /** The newest measurement in ms for the next frame; null if an earlier frame has reported it. */
  takeUnsent() {
    const value = this.unsent;
    this.unsent = null;
    return value;
  }

  /** Whether more than one measurement in LATE_OF was late. Each measurement is judged once. */
  takeLate() {
    if (this.unjudged.length < LATE_OF) return false;
    const judged = this.unjudged.splice(0);
    const late = judged.filter((value) => value > LATE_ABOVE_MS).length;
    return late > judged.length / LATE_OF;
  }

  /**
   * The value below which a share of the stored measurements lies (nearest rank); null without a
   * measurement.
   */
  percentile(share) {
    if (this.values.length === 0) return null;
    const sorted = [...this.values].sort((a, b) => a - b);
    return sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
  }

  /**
   * Call this when a frame with this number was sent for an input at this time. Begins a
   * measurement if no other one is in progress.
   */
  sent(sequence, began_ms, now_ms) {
    if (this.probe && now_ms - this.probe.began_ms < FORGET_AFTER_MS) return;
    this.probe = {sequence, began_ms, input: null, applied: false};
  }

  /** Call this when the seat has published the frame as DRIVER_INPUT of this number. */
  published(sequence, input) {
    if (this.probe?.sequence === sequence) this.probe.input = input;
  }

  /** Call this when a DRIVER_COMMAND was made from the DRIVER_INPUT of this number. */
  commanded(input) {
    if (this.probe && this.probe.input !== null && input >= this.probe.input) this.probe.applied = true;
  }

  /**
   * Call this when a frame was drawn.
   * @return the measurement that ends with this frame, or null
   */
  drawn(now_ms) {
    if (!this.probe?.applied) return null;
    const value = now_ms - this.probe.began_ms;
    this.probe = null;
    this.recent = [...this.recent, {value, at_ms: now_ms}].slice(-WARN_OF);
    ++this.count;
    this.values.push(value);
    this.unsent = value;
    this.unjudged.push(value);
    if (this.values.length > KEPT) this.values.shift();
    return value;
  }

  /** Drops the current measurement, because its input may be lost with the connection. */
  forget() { this.probe = null; }
}
