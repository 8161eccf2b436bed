// The scene: the driver's view with its instruments, and the road from above.

import {carsOf, timeGap} from "../data/cars.js";
import {byId, say, setAttribute} from "../draw/dom.js";
import {decimal, kmh, visibility, withUnit} from "../draw/format.js";
import {loadView} from "../draw/view_file.js";
import {Road, roadInWords} from "./road.js";

const WORDS_EVERY_MS = 1000;
const AFTER_PICTURE_MS = 100;
const MOST_FOG_M = 1000;  // largest visibility in fog, by the definition of meteorology
const LONG_S = 60;  // a longer time gap is shown as “over 60 s”

export class Scene {
  constructor() {
    this.road = new Road(byId("road"));
    this.view = null;
    this.frame = null;  // the frame that was drawn last
    this.wordsAt = 0;
    this.pictures = 0;  // number of drawn pictures of the road
    this.isLoading = false;
  }

  /**
   * Loads the driver's view, if the loading has not begun. A browser without a graphics processor
   * needs more than a second to prepare the view, and does nothing else meanwhile. So the page
   * calls this method only when it has drawn all other parts. The method waits until the other
   * parts are visible on the screen.
   */
  loadView() {
    if (this.isLoading) return;
    this.isLoading = true;
    setTimeout(async () => {
      this.view = await loadView();
      this.drawn = "";
    }, AFTER_PICTURE_MS);
  }

  /**
   * Draws the moment if it differs from the moment that was drawn last.
   * @param budget {ratio, every}: while time goes on, the view has the share `ratio` of its full
   * resolution, and is drawn in one of `every` frames
   */
  draw(moment, {ratio, every}) {
    const {frame, ahead_s, step, side} = moment;
    byId("no-road").hidden = Boolean(frame?.TRUTH);
    if (!frame?.TRUTH) {
      if (this.frame !== null) this.forget();
      return;
    }
    const {clientWidth, clientHeight} = this.road.canvas;
    const view = byId("driver-view");
    const drawn = `${step} ${ahead_s} ${side} ${clientWidth} ${clientHeight} ${view.clientWidth} ` +
      `${view.clientHeight} ${frame.TRUTH.header.run_id} ${moment.moves}`;
    if (drawn === this.drawn && frame === this.frame) return;
    this.drawn = drawn;
    this.frame = frame;
    this.turn = (this.turn ?? 0) + 1;
    if (this.turn % every === 0 || !moment.moves) this.view?.draw(moment, moment.moves ? ratio : 1);
    this.road.draw(moment);
    ++this.pictures;
    this.sayNumbers(frame);
    this.describe(moment);
  }

  /** Removes the texts about the previous run. */
  forget() {
    this.frame = null;
    this.drawn = "";
    for (const id of ["speed-now", "gap-now", "sight-now"]) say(byId(id), "–");
    for (const id of ["speed-kmh", "gap-time", "sight-fog"]) say(byId(id), "");
    for (const id of ["speed-now", "gap-now"]) byId(id).removeAttribute("data-value");
    setAttribute(byId("road"), "aria-label", "The road from above");
    setAttribute(byId("driver-view"), "aria-label", "The driver’s view");
    byId("collision").hidden = true;
  }

  sayNumbers({TRUTH: truth}) {
    const gap_s = timeGap(truth);
    say(byId("speed-now"), decimal(truth.host_speed_mps, 1));
    say(byId("speed-kmh"), `${kmh(truth.host_speed_mps)} km/h`);
    say(byId("gap-now"), decimal(truth.host_gap_m, 1));
    const words = gap_s > LONG_S ? `over ${LONG_S}` : decimal(gap_s, 2);
    say(byId("gap-time"), gap_s === null ? "" : `time gap ${withUnit(words, "s")}`);
    say(byId("sight-now"), visibility(truth.fog_visibility_m));
    const isHidden = truth.fog_present && truth.fog_visibility_m > MOST_FOG_M;
    say(byId("sight-fog"), isHidden ? "fog: LiDAR only" : truth.fog_present ? "in fog" : "");
    setAttribute(byId("gap-now"), "data-value", String(truth.host_gap_m));
    setAttribute(byId("speed-now"), "data-value", String(truth.host_speed_mps));
    byId("collision").hidden = truth.collision === 0;
  }

  /** Describes the pictures in words, for readers who do not see them. */
  describe({frame, length_m, moves}) {
    const now = performance.now();
    if (moves && now - this.wordsAt < WORDS_EVERY_MS) return;
    this.wordsAt = now;
    const {TRUTH: truth} = frame;
    setAttribute(byId("road"), "aria-label", roadInWords(frame, length_m));
    const lamps = carsOf(truth, 0)[0].brakes ? "Its brake lamps shine. " : "";
    setAttribute(byId("driver-view"), "aria-label",
      `The driver’s view: the preceding car is ${decimal(truth.host_gap_m, 1)} m ahead. ${lamps}` +
      `The visibility is ${visibility(truth.fog_visibility_m)}.`);
  }
}
