// The latency: the time from an input to the frame that shows it. It knows no document.
//
// A measurement begins at the time of an input: that of the event of a key (Event.timeStamp), or
// the time at which the browser got the state of a gamepad (Gamepad.timestamp). The input goes to
// the seat, which publishes it as DRIVER_INPUT and answers with its number. The measurement ends
// when the page has drawn the first frame (requestAnimationFrame) after a DRIVER_COMMAND came that
// was made from this input or from a newer one. So it contains the ways through page, seat and
// network, the wait of the driver role for its next step, and the drawing. It does not contain the
// times of keyboard and screen.

export const WARN_ABOVE_MS = 100;
export const LATE_ABOVE_MS = 40;  // the page then draws less: the goal of the 95th percentile is 50 ms
const LATE_OF = 10;               // one measurement in so many may be late
const FORGET_AFTER_MS = 2000;  // no step of the run has used the input
const KEPT = 512;              // measurements, for the percentiles
const WARN_OF = 10;            // newest measurements

export class Latency {
  constructor() {
    this.probe = null;     // {sequence, began_ms, input: number of DRIVER_INPUT or null, applied}
    this.values = [];
    this.count = 0;
    this.unjudged = [];    // measurements since takeLate() has judged
  }

  /** The newest measurement in ms; null if there is none. */
  get newest() { return this.values.at(-1) ?? null; }

  /** The longest of the last measurements in ms; -Infinity if there is none. */
  get highest() { return Math.max(...this.values.slice(-WARN_OF)); }

  /** Whether one of the last measurements was too long. */
  get isHigh() { return this.highest > WARN_ABOVE_MS; }

  /** Whether more than one measurement in LATE_OF was late. Each measurement is judged once. */
  takeLate() {
    if (this.unjudged.length < LATE_OF) return false;
    const judged = this.unjudged.splice(0);
    const late = judged.filter((value) => value > LATE_ABOVE_MS).length;
    return late > judged.length / LATE_OF;
  }

  /** The value below which a share of the kept measurements lies (nearest rank); null without any. */
  percentile(share) {
    if (this.values.length === 0) return null;
    const sorted = [...this.values].sort((a, b) => a - b);
    return sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
  }

  /** A frame with this number was sent because of an input at this time. Only one input is followed. */
  sent(sequence, began_ms, now_ms) {
    if (this.probe && now_ms - this.probe.began_ms < FORGET_AFTER_MS) return;
    this.probe = {sequence, began_ms, input: null, applied: false};
  }

  /** The seat has published the frame as DRIVER_INPUT of this number. */
  published(sequence, input) {
    if (this.probe?.sequence === sequence) this.probe.input = input;
  }

  /** A DRIVER_COMMAND was made from the DRIVER_INPUT of this number. */
  commanded(input) {
    if (this.probe && this.probe.input !== null && input >= this.probe.input) this.probe.applied = true;
  }

  /** A frame was drawn. @return the measurement that ends with it, or null */
  drawn(now_ms) {
    if (!this.probe?.applied) return null;
    const value = now_ms - this.probe.began_ms;
    this.probe = null;
    ++this.count;
    this.values.push(value);
    this.unjudged.push(value);
    if (this.values.length > KEPT) this.values.shift();
    return value;
  }

  /** The connection was lost. The input that is followed may be lost, too. */
  forget() { this.probe = null; }
}
