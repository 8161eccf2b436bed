// The reader's time: the time of the run that the page shows. It follows the live run, plays, or is
// paused. This file does not use the document.

// Tolerance for rounding, in steps: with steps of 0.1 s, the time 0.3 s is step 3, but the computed
// quotient 0.3 / 0.1 is less than 3.
export const EARLY = 1e-6;

/**
 * The description of a run, with `step_s` as the time between the headers of two successive steps.
 * This time is a whole number of microseconds. The scenario may have another time, such as 1/30 s.
 */
export const withTimeOfHeaders = (run) => ({...run, step_s: timeOfStep(1, run.step_s)});

/** The simulated time of a step, in s: exactly the time in the header of its messages. */
export const timeOfStep = (step, step_s) => (step * Math.round(step_s * 1e6)) / 1e6;

export const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10];

export class Clock {
  constructor() {
    this.state = "paused";  // "live", "playing" or "paused"
    this.time = 0;          // s
    this.speed = 1;
  }

  /** The simulated step that is shown. */
  step(step_s) {
    return Math.floor(this.time / step_s + EARLY);
  }

  /**
   * Advances the reader's time, after `seconds` of real time. The reader's time stays between
   * `first` and `last`.
   */
  advance(seconds, first, last) {
    if (this.state === "live") this.time = last;
    if (this.state === "playing") {
      this.time += seconds * this.speed;
      if (this.time >= last) {
        this.time = last;
        this.state = "paused";
      }
    }
    this.time = Math.min(Math.max(this.time, first), Math.max(first, last));
  }

  goTo(time) {
    this.time = time;
    if (this.state === "live") this.state = "paused";
  }

  follow() { this.state = "live"; }
  pause() { this.state = "paused"; }

  /** Plays on, or plays from the beginning if the time is at the end. */
  play(first, last) {
    if (this.time >= last) this.time = first;
    this.state = "playing";
  }

  /**
   * Pauses, or plays if the time is paused or follows a live run that has ended.
   * @param isOver whether a live run has ended
   */
  toggle(first, last, isOver) {
    if (this.state === "paused" || (this.state === "live" && isOver)) this.play(first, last);
    else this.pause();
  }

  /** Chooses the next higher (+1) or lower (-1) speed. */
  changeSpeed(direction) {
    const place = SPEEDS.indexOf(this.speed) + direction;
    this.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, place))];
  }
}
