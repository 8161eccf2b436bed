// The bar at the bottom, with the controls of the time: live, pause, play, step, jump to events,
// slider, speed, link.

import {byId, fitCanvas, hatch, make, say, setAttribute} from "../draw/dom.js";
import {clockTime, count, decimal, seconds, timeDecimals} from "../draw/format.js";
import {requestSpans, sideSpans, spansOf} from "../data/modes.js";
import {SPEEDS} from "../data/clock.js";

const TRACK_HZ = 4;
const LONG_S = 600;  // a run of this time or more is long
export const EVENT_MARKS = {
  fog: "≋", transfer: "⇄", request: "◎", input: "➤", alarm: "!", manoeuvre: "△", braking: "▼", collision: "✕"};

export class Timebar {
  /** @param act {toggle, step, jump, goTo, speed, live, link} */
  constructor(act) {
    this.slider = byId("time");
    this.track = byId("track");
    this.play = byId("play");
    this.speed = byId("speed");
    this.liveButton = byId("live");
    this.speed.append(...SPEEDS.map((speed) => make("option", {value: speed}, `${speed}×`)));
    this.slider.addEventListener("input", () => act.goTo(Number(this.slider.value)));
    this.speed.addEventListener("change", () => act.speed(Number(this.speed.value)));
    const buttons = {
      play: act.toggle, live: act.live, link: act.link,
      "step-back": () => act.step(-1), "step-on": () => act.step(1),
      "event-back": () => act.jump(-1), "event-on": () => act.jump(1)};
    for (const [id, action] of Object.entries(buttons)) byId(id).addEventListener("click", action);
    byId("events").addEventListener("click", ({target}) => {
      const button = target.closest("button[data-step]");
      if (button) act.goTo(Number(button.dataset.step));
    });
    this.trackAt = 0;
  }

  /** Sets the first and the last step of the slider. */
  setRange({firstStep, lastStep}) {
    const {slider} = this;
    const min = String(firstStep);
    const max = String(Math.max(firstStep, lastStep));
    if (slider.min !== min) slider.min = min;
    if (slider.max !== max) slider.max = max;
  }

  draw({clock, store, step, time, run, isLive, isOver}, modes, lambdas, events, theme) {
    const {slider} = this;
    this.setRange(store);
    if (slider.value !== String(step)) slider.value = step;
    setAttribute(slider, "aria-valuetext", `${seconds(time, run.step_s)}, step ${step}`);
    say(byId("time-now"), decimal(time, timeDecimals(run.step_s)));
    say(byId("time-end"), ` / ${seconds(store.lastTime, run.step_s)}`);
    say(byId("step-now"), placeWords(step, time, endOf(store, run)));
    this.keepRoom(store, run);
    const follows = clock.state === "live" && !isOver;
    const running = follows || clock.state === "playing";
    setAttribute(this.play, "aria-label", running ? "Pause" : "Play");
    setAttribute(this.play, "data-running", String(running));
    if (this.speed.value !== String(clock.speed)) this.speed.value = String(clock.speed);
    this.speed.disabled = follows;
    this.liveButton.hidden = !isLive || isOver;
    setAttribute(this.liveButton, "aria-pressed", String(follows));
    this.drawTrack(store, modes, lambdas, events, theme);
  }

  /** Keeps room for the longest texts of the run, so that the slider does not move. */
  keepRoom(store, run) {
    const last = lastStepOf(store, run);
    const end = endOf(store, run);
    const longest = decimal(end, timeDecimals(run.step_s));
    if (this.room === `${longest} ${last}`) return;
    this.room = `${longest} ${last}`;
    const digits = longest.length;
    byId("time-now").style.minWidth = `${digits}ch`;
    byId("time-end").style.minWidth = `${digits + " / ".length + " s".length}ch`;
    byId("step-now").style.minWidth = `${placeWords(last, end, end).length}ch`;
  }

  /** Draws fog, the side that drives, and events over the whole time. */
  drawTrack(store, modes, lambdas, events, theme) {
    const fog = store.changes("TRUTH", "fog_present");
    const state = [modes.version, lambdas.version, fog.version, store.lastStep, events.length,
                   this.track.clientWidth, theme.ink].join(" ");
    const now = performance.now();
    if (state === this.drawnTrack || now - this.trackAt < 1000 / TRACK_HZ) return;
    this.drawnTrack = state;
    this.trackAt = now;
    const {context: pen, width, height} = fitCanvas(this.track);
    const {firstTime, lastTime} = store;
    const x = (time) => ((time - firstTime) / Math.max(1e-9, lastTime - firstTime)) * width;
    const fill = ({from, to}, style, top, tall) => {
      pen.fillStyle = style;
      pen.fillRect(x(from), top, Math.max(1, x(to) - x(from)), tall);
    };
    pen.fillStyle = theme.grid;
    pen.fillRect(0, 9, width, 8);
    for (const span of spansOf(fog.times, fog.values, lastTime)) {
      if (span.value) fill(span, theme.fog, 0, height);
    }
    const patterns = {human: hatch(pen, theme.surface, {size: 5}),
                      risk: hatch(pen, theme.surface, {size: 5, both: true})};
    for (const span of sideSpans(modes, lambdas, -Infinity, Infinity, lastTime)) {
      const side = span.value;
      if (side === "unknown") continue;
      fill(span, theme[side], 9, 8);
      if (patterns[side]) fill(span, patterns[side], 9, 8);
    }
    for (const span of requestSpans(modes, -Infinity, Infinity, lastTime)) fill(span, theme.risk, 6, 3);
    pen.fillStyle = theme.ink;
    for (const {time_s} of events) pen.fillRect(Math.round(x(time_s)) - 0.5, 2, 1.5, height - 4);
  }

  /**
   * Fills the list of events, and marks the last event at or before the shown step. Elements that
   * are already in the list are not replaced, because one of them may have the focus.
   */
  drawEvents(events, step, run, leftOut) {
    byId("more-events").hidden = leftOut === 0;
    say(byId("more-events"), `${count(leftOut)} later events are not listed.`);
    const list = byId("events");
    const {drawn = []} = this;
    const isLonger = this.drawnRun === run.run_id && drawn.at(-1) === events[drawn.length - 1];
    if (!isLonger) list.replaceChildren();
    if (!isLonger || events.length > drawn.length) {
      list.append(...events.slice(isLonger ? drawn.length : 0).map((event) => make("li", {}, make("button", {
        type: "button", "data-step": event.step},
        make("span", {class: "event-mark", "aria-hidden": "true"}, EVENT_MARKS[event.kind] ?? "·"),
        make("span", {class: "event-time"}, seconds(event.time_s, run.step_s)),
        make("span", {class: "event-text"}, event.text)))));
      byId("no-events").hidden = events.length > 0;
      this.current = null;
    }
    this.drawn = events;
    this.drawnRun = run.run_id;
    const place = events.findLastIndex((event) => event.step <= step);
    if (`${place} ${list.clientHeight}` === this.current) return;
    this.current = `${place} ${list.clientHeight}`;
    [...list.children].forEach((item, i) => {
      const button = item.firstElementChild;
      if (i === place) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    });
    keepInSight(list, list.children[place]);
  }
}

/** Scrolls only this box, so that an item in it is visible. */
function keepInSight(box, item) {
  if (!item) return;
  const isAbove = item.offsetTop < box.scrollTop;
  const isBelow = item.offsetTop + item.offsetHeight > box.scrollTop + box.clientHeight;
  if (isAbove || isBelow) box.scrollTop = item.offsetTop - (box.clientHeight - item.offsetHeight) / 2;
}

/** The last step of the run, also if a live run has not reached it yet. */
const lastStepOf = (store, run) => Math.max(store.lastStep, (run.steps ?? 0) - 1);
const endOf = (store, run) => store.timeOf(lastStepOf(store, run));

/** The step, and in a long run the time in minutes, as on the time axes of the curves. */
function placeWords(step, time, end) {
  return end < LONG_S ? `step ${step}` : `step ${step}, ${clockTime(time)}`;
}

/** The next (+1) or previous (-1) event, seen from a step; null if there is none. */
export function eventFrom(events, step, direction) {
  const found = direction > 0 ? events.find((event) => event.step > step)
                              : events.findLast((event) => event.step < step);
  return found ?? null;
}
