// Limits how much the page draws, so that slow machines also show at least 30 frames a second. It
// measures the time between frames, because this time contains the work of the graphics processor.
// The page may also report that something else is late. After a level was too slow, the page waits
// longer before it tries this level again.

const SLOW_MS = 30;         // mean time between frames
const FAST_MS = 20;
const LOOK_EVERY_MS = 500;
// The page draws more after this number of successive checks in which the frames were fast. If
// drawing more is then too slow, this number is doubled, up to MOST_PATIENCE.
const CALM_LOOKS = 10;
const MOST_PATIENCE = 320;
const HIDDEN_MS = 1000;     // a longer time between frames means that the page was hidden

/**
 * The levels. rest_ms is the pause between two drawings of a chart. The driver's view is drawn with
 * the share `ratio` of its full resolution, and only in one of `every` frames.
 */
const LEVELS = [
  {rest_ms: 40, ratio: 1, every: 1},
  {rest_ms: 80, ratio: 0.75, every: 1},
  {rest_ms: 120, ratio: 0.6, every: 1},
  {rest_ms: 200, ratio: 0.5, every: 2},
  {rest_ms: 330, ratio: 0.4, every: 3},
  {rest_ms: 500, ratio: 0.25, every: 4},
];

export class Budget {
  /**
   * @param slow_ms if the mean time between frames is longer, the page draws less
   * @param isLate returns whether something else is late because the page draws too much; called
   * every LOOK_EVERY_MS
   */
  constructor({slow_ms = SLOW_MS, isLate = () => false} = {}) {
    this.slow_ms = slow_ms;
    this.isLate = isLate;
    this.patience = CALM_LOOKS;
    this.level = 0;
    this.began = null;
    this.frames = 0;
    this.calm = 0;
    this.raised = false;  // whether the last change of the level was to draw more
    this.last = null;
  }

  get now() { return LEVELS[this.level]; }

  /** Counts a frame at this time (ms). */
  frame(now) {
    if (this.last === null || now - this.last > HIDDEN_MS) {
      this.began = now;
      this.frames = 0;
    }
    this.last = now;
    const passed_ms = now - this.began;
    if (passed_ms >= LOOK_EVERY_MS && this.frames > 0) {
      this.judge(passed_ms / this.frames);
      this.began = now;
      this.frames = 0;
    }
    ++this.frames;
  }

  judge(mean_ms) {
    const isLate = this.isLate();
    this.calm = mean_ms < FAST_MS && !isLate ? this.calm + 1 : 0;
    if (mean_ms > this.slow_ms || isLate) {
      if (this.raised) this.patience = Math.min(2 * this.patience, MOST_PATIENCE);
      this.level = Math.min(this.level + 1, LEVELS.length - 1);
      this.raised = false;
    }
    if (this.calm >= this.patience) {
      this.raised = this.level > 0;
      this.level = Math.max(0, this.level - 1);
      this.calm = 0;
    }
  }
}
