// How much the page may draw, so that it shows at least 30 frames a second on slow machines, too.
// It looks at the time between frames, because that contains the work of the graphics processor. A
// page may also say that something else is late. A level that was too slow before is tried again
// after a longer time.

const SLOW_MS = 30;         // mean time between frames
const FAST_MS = 20;
const LOOK_EVERY_MS = 500;
const CALM_LOOKS = 10;      // fast looks before more is drawn again; twice as many after each relapse
const MOST_PATIENCE = 320;
const HIDDEN_MS = 1000;     // a longer time between frames: the page was hidden

/** For each level: rest between two drawings of a chart; pixels and rate of the driver's view. */
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
   * @param slow_ms mean time between frames from which on it draws less
   * @param isLate says every LOOK_EVERY_MS whether something else is late, because too much is drawn
   */
  constructor({slow_ms = SLOW_MS, isLate = () => false} = {}) {
    this.slow_ms = slow_ms;
    this.isLate = isLate;
    this.patience = CALM_LOOKS;
    this.level = 0;
    this.began = null;
    this.frames = 0;
    this.calm = 0;
    this.raised = false;  // the last change of the level was that more is drawn
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
