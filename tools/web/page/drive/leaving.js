// Asks for a second press of “Leave the seat” while the run needs the person. Otherwise one press
// by mistake would end the drive.

const WITHIN_MS = 4000;  // the time for the second press

export class Leaving {
  constructor() {
    this.until_ms = -Infinity;
  }

  /**
   * @param isMissed whether the run needs the person now
   * @return whether this press leaves the seat
   */
  press(isMissed, now_ms) {
    const leaves = !isMissed || this.asks(now_ms);
    this.until_ms = leaves ? -Infinity : now_ms + WITHIN_MS;
    return leaves;
  }

  /** Whether a second press would leave the seat now. */
  asks(now_ms) {
    return now_ms < this.until_ms;
  }
}
