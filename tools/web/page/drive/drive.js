// The participant's page. It shows the road and whether the automation or the human drives. It
// sends the inputs of the person.

import {socketUrl} from "../data/wire.js";
import {Catalogue} from "../data/catalogue.js";
import {Budget} from "../draw/budget.js";
import {byId, reducedMotion, say, setAttribute} from "../draw/dom.js";
import {decimal, kmh, withUnit} from "../draw/format.js";
import {loadView} from "../draw/view_file.js";
import {Alarm} from "./alarm.js";
import {Latency} from "./latency.js";
import {Leaving} from "./leaving.js";
import {backOf, Newest} from "./newest.js";
import {isDriving, Person} from "./person.js";
import {ratesOf} from "./ramps.js";
import {SeatWire, takeDriverToken} from "./seat_wire.js";
import {LEAST_GAP_MS, LOOK_EVERY_MS, Sender} from "./sender.js";
import {Setup} from "./setup.js";
import {Answer, countdown, LEAVING, PROGRAM_ENDED, told, whyAwayInWords} from "./told.js";

// If the mean time between frames is longer than this, the page draws less. At 60 Hz the mean time
// is longer if one of three frames is missed. The limit is low, because a person waits for the next
// frame after each input. The page also draws less if inputs are late.
const SLOW_MS = 22;
// A press within this time after the window got the keyboard focus counts as the press that gave
// the focus to the window.
const WITH_FOCUS_MS = 500;
const GONE_MS = 5000;  // after this time without the server, the page calls goBack()

class Drive {
  constructor() {
    this.person = new Person();
    this.sender = new Sender();
    this.latency = new Latency();
    this.alarm = new Alarm();
    this.answer = new Answer();
    this.leaving = new Leaving();
    this.told = told(null);
    this.budget = new Budget({slow_ms: SLOW_MS, isLate: () => this.latency.takeLate()});
    this.newest = null;
    this.request = null;     // the newest request to take over: {since_s, begin_known}
    this.view = null;
    this.instance = "";
    this.state = "";         // of the seat: yours, taken, lost; "": unknown
    // Last time at which the window got the keyboard while “Go on” was shown.
    this.backAt_ms = -Infinity;
    this.isForFocus = false;     // whether the present press has given the window the keyboard
    this.hasLeft = false;    // whether the person had begun, and has left the seat
    this.refused = false;    // whether this page has asked for the seat, but another page has it
    this.back = backOf(location.hash, location.hostname);
    this.setup = new Setup(this.person, (open) => this.set("busy", open));
    loadView().then((view) => { this.view = view; });
    this.listen();
    this.wire = new SeatWire(socketUrl(location, takeDriverToken()), {
      text: (object) => this.receive(object),
      messages: (messages) => this.take(messages),
      state: (state) => this.showConnection(state),
    });
    setInterval(() => this.pump(), LOOK_EVERY_MS);
    requestAnimationFrame((now) => this.loop(now));
  }

  // ---- inputs of the person ---------------------------------------------------------------------

  listen() {
    addEventListener("keydown", (event) => this.key(event, true));
    addEventListener("keyup", (event) => this.key(event, false));
    addEventListener("blur", () => this.set("focused", false));
    addEventListener("focus", () => {
      if (!byId("go-on").hidden) this.backAt_ms = performance.now();
      this.set("focused", true);
    });
    document.addEventListener("visibilitychange", () => this.set("visible", !document.hidden));
    addEventListener("pagehide", () => this.set("visible", false));
    for (const name of ["gamepadconnected", "gamepaddisconnected"]) addEventListener(name, () => this.pump());
    // While another window has the keyboard, the page shows “Go on” in the place of “Begin”. A
    // press on “Go on” gives the focus to this window, and the page shows “Begin” at once. So the
    // press arrives at “Begin”, which must ignore it.
    byId("begin").addEventListener("pointerdown", ({timeStamp}) => {
      this.isForFocus = timeStamp - this.backAt_ms < WITH_FOCUS_MS;
    });
    byId("begin").addEventListener("click", () => {
      if (!this.isForFocus) this.begin();
      this.isForFocus = false;
    });
    byId("go-on").addEventListener("click", () => this.set("focused", document.hasFocus()));
    byId("try-sound").addEventListener("click", () => {
      this.alarm.allow();
      this.alarm.context?.resume().then(() => this.alarm.change());
    });
    // Called when the person opens the address of another program in this tab.
    addEventListener("hashchange", () => {
      if (!location.hash) return;
      this.back = backOf(location.hash, location.hostname);
      this.wire.again(socketUrl(location, takeDriverToken()));
    });
    for (const [id, button] of [["take-over", "take_over"], ["give-back", "give_back"]]) {
      byId(id).addEventListener("click", ({timeStamp}) => {
        this.person.press(button, timeStamp, performance.now());
        this.pump();
      });
    }
    for (const [id, key] of [["touch-throttle", "ArrowUp"], ["touch-brake", "ArrowDown"]]) this.touch(byId(id), key);
    this.person.set("focused", document.hasFocus());
    this.person.set("visible", !document.hidden);
  }

  /** Makes a finger on a button of the page act like a held key. */
  touch(button, key) {
    const hold = (down) => ({timeStamp, pointerId}) => {
      if (down) button.setPointerCapture(pointerId);
      this.person.key(key, down, timeStamp);
      this.pump();
    };
    button.addEventListener("pointerdown", hold(true));
    for (const name of ["pointerup", "pointercancel"]) button.addEventListener(name, hold(false));
    // A long press would open the menu.
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  begin() {
    this.alarm.allow();
    const {side, hasAuthority, asks, answered, isFinal} = this.told;
    const isMissed = (side === "risk" || hasAuthority || asks || answered) && !isFinal;
    if (this.person.begun && !this.leaving.press(isMissed, performance.now())) return;
    this.hasLeft = this.person.begun;
    this.set("begun", !this.person.begun);
    if (this.person.begun) byId("begin").blur();  // the space bar would press the button again
  }

  /**
   * Sets a condition of driving, such as "focused". Sends the new input and sets the buttons at
   * once, because a Tab or a click may come before the next frame.
   */
  set(name, value) {
    this.person.set(name, value);
    const state = this.tell();
    this.pump();
    this.drawPerson(state);
  }

  key(event, down) {
    const {key, ctrlKey, altKey, metaKey, repeat, target, timeStamp} = event;
    if (!isDriving(key) || (down && (ctrlKey || altKey || metaKey))) return;
    if (down && target.matches?.("input, select, textarea")) return;
    // A repeated event belongs to a key that was pressed before, perhaps while the person was away.
    // So it moves no pedal.
    if (!repeat && !this.person.key(key, down, timeStamp, performance.now())) return;
    event.preventDefault();  // the arrows would scroll
    if (repeat) return;
    this.alarm.allow();
    this.pump();
  }

  /** Looks at the devices, and sends a frame if one is due. */
  pump() {
    const now = performance.now();
    const pads = navigator.getGamepads?.() ?? [];
    this.person.look(pads, now);
    this.setup.look(pads);
    const input = this.person.input(now);
    // While another page has the seat, an input with `present` asks for the seat.
    if (this.state === "taken") input.present = this.person.whyNotReady() === "";
    for (const button of input.buttons) {
      if (!this.input?.buttons.includes(button)) this.answer.press(button, this.told, now);
    }
    this.input = input;
    if (!this.wire?.isOpen) return;
    if (!this.sender.isDue(input, now)) {
      if (this.sender.isHeldBack(input)) this.pumpSoon();
      return;
    }
    const {touched_ms} = this.person;
    const frame = this.sender.next(input, now, touched_ms, this.latency.takeUnsent());
    this.wire.send(frame);
    if (input.present && touched_ms !== null && touched_ms !== this.followed_ms) {
      this.followed_ms = touched_ms;
      this.latency.sent(frame.sequence, touched_ms, now);
    }
  }

  pumpSoon() {
    clearTimeout(this.soon);
    this.soon = setTimeout(() => this.pump(), LEAST_GAP_MS);
  }

  // ---- messages of the server -------------------------------------------------------------------

  showConnection(state) {
    this.connection = state;
    const words = {open: "Connected", ended: "The program has ended", lost: "No connection, trying again",
                   refused: "No connection"}[state];
    setAttribute(document.body, "data-connection", state);
    setAttribute(byId("origin"), "data-state", {open: "live", ended: "behind"}[state] ?? "lost");
    say(byId("origin-words"), words);
    byId("problem").hidden = state !== "refused";
    say(byId("problem"), state !== "refused" ? "" : "No seat answers. The page of view alone has none. " +
        "Open exactly the address that the program has printed: for other machines the address contains a token.");
    this.sender.begin();
    this.latency.forget();
    if (state !== "open") this.sit("");
    if (state === "open") {
      clearTimeout(this.goneTimer);
      this.goneTimer = undefined;
    } else {
      this.goneTimer ??= setTimeout(() => this.goBack(), GONE_MS);
    }
    if (state === "ended") this.goBack();
  }

  receive(object) {
    if (object.op === "hello") {
      this.newest = new Newest(new Catalogue(object));
      this.request = null;
      this.side = undefined;
    }
    if (object.op === "request") this.request = object;
    if (object.op === "run") this.setRun(object);
    if (object.op === "seat") this.sit(object.state);
    if (object.op === "published") {
      this.instance = object.instance;
      this.latency.published(object.sequence, object.input);
    }
    if (object.op === "error") console.warn(object.message);
  }

  setRun(run) {
    this.newest.setRun(run);
    this.person.ramps.rates = ratesOf(run.scenario);
    this.length_m = run.scenario?.world?.vehicle_length_m ?? 4.5;
    byId("override").hidden = run.scenario?.person?.override_by !== "brake";
  }

  sit(state) {
    this.refused = state === "taken" && this.state === "taken";
    if (this.refused) this.person.set("begun", false);
    this.state = state;
    // "lost": the server got no input from this page for some time, even if the page itself has
    // noticed no pause. So the person was away.
    if (state === "lost") this.person.leavePedals();
    // A lost seat still belongs to this page: the page's next frame takes the seat again.
    this.set("seated", state === "yours" || state === "lost");
  }

  /** Opens the page from which the person came, if there is one. Called if the server is gone. */
  goBack() {
    if (this.back !== "") location.replace(this.back);
    this.back = "";
  }

  take(messages) {
    const now = performance.now();
    for (const message of messages) {
      const taken = this.newest?.add(message, now);
      if (taken?.name !== "DRIVER_COMMAND") continue;
      const {input_instance, input_sequence} = taken.message;
      if (String(input_instance) === this.instance) this.latency.commanded(Number(input_sequence));
    }
  }

  // ---- drawing ----------------------------------------------------------------------------------

  loop(now) {
    requestAnimationFrame((next) => this.loop(next));
    this.pump();
    this.budget.frame(now);
    this.draw();
    this.latency.drawn(performance.now());
    this.drawLatency();
  }

  /**
   * Updates `told`, the description of who drives, from the newest messages, and returns it. set()
   * also calls this function, because messages come between two frames, too.
   */
  tell() {
    const {frame = {}} = this.newest ?? {};
    this.told = told(frame.HOST_COMMAND, frame.TRUTH, this.connection);
    return this.told;
  }

  draw() {
    const {frame = {}, run} = this.newest ?? {};
    const state = this.tell();
    const time_s = Number(frame.HOST_COMMAND?.header.utime ?? 0) / 1e6;
    const lead_s = run?.scenario?.arbitrator?.take_over?.lead_s ?? 10;
    const left = state.asks ? countdown(this.request, time_s, lead_s) : null;
    this.alarm.sound(state);
    this.soundChange(state.side);
    this.drawState(state, left);
    this.drawPerson(state);
    this.drawRoad(frame.TRUTH);
    setAttribute(document.body, "data-step", String(this.newest?.step ?? ""));
  }

  /**
   * Plays a sound if the side that drives has changed. A lost connection and the end of the run are
   * no change.
   */
  soundChange(side) {
    if (this.connection !== "open" || side === "unknown") return;
    if (this.side !== undefined && this.side !== side) this.alarm.change();
    this.side = side;
  }

  drawState({side, words, asks, urgent}, left) {
    setAttribute(byId("now"), "data-side", side);
    say(byId("who"), words);
    say(byId("announcement"), words);
    const request = byId("request");
    request.hidden = !asks;
    setAttribute(document.body, "data-asks", String(asks));
    byId("setup-request").hidden = !asks;
    setAttribute(request, "data-urgent", String(urgent));
    if (!left) return;
    // If another window has the keyboard, the person must first press “Go on”.
    say(byId("request-words"), byId("go-on").hidden ? words : "First “Go on”");
    const left_s = withUnit(decimal(Math.ceil(left.left_s), 0), "s");
    const leftWords = left.atMost ? `at most ${left_s}` : left_s;
    say(byId("request-left"), leftWords);
    const first = this.setup.lacks.length === 0 ? "Close" : "Choose the keyboard and close";
    say(byId("setup-words"), `${words}. ${first} this dialog to answer.`);
    say(byId("setup-left"), leftWords);
    byId("request-bar").value = left.share;
  }

  drawPerson(state) {
    const {side, isFinal, mayEnd, hasAuthority} = state;
    const why = this.person.whyAway();
    const seat = this.refused ? "refused" : "no seat";
    const isGone = this.connection === "ended";
    const words = isGone ? PROGRAM_ENDED : this.state === "" ? ""
      : whyAwayInWords(this.state === "taken" ? seat : why, {hasLeft: this.hasLeft, side, isFinal, mayEnd});
    const now = performance.now();
    const leaves = this.person.begun && this.leaving.asks(now);
    const answer = leaves ? LEAVING : why === "" ? this.answer.words(state, now) : "";
    say(byId("away"), words);
    byId("away").hidden = words === "" || answer !== "";
    // The page has room for only one of the texts "away", "answer" and "meanwhile".
    byId("meanwhile").hidden = !state.asks || words !== "" || answer !== "";
    say(byId("answer"), answer);
    byId("answer").hidden = answer === "";
    const leave = leaves ? "Press again to leave" : "Leave the seat";
    say(byId("begin"), this.person.begun ? leave : "Begin");
    setAttribute(byId("begin"), "data-begun", String(this.person.begun));
    setAttribute(document.body, "data-present", String(why === ""));
    const isBlurred = why === "blurred" && this.state === "yours";
    byId("go-on").hidden = !isBlurred;
    byId("begin").hidden = isBlurred;
    byId("begin").disabled = isGone || (isFinal && !this.person.begun);
    byId("take-over").disabled = why !== "" || isFinal || hasAuthority || (side !== "automation" && side !== "risk");
    byId("give-back").disabled = why !== "" || side !== "human";
    const {throttle = 0, brake = 0} = this.input ?? {};
    byId("throttle").value = throttle;
    byId("brake").value = brake;
    const {name, kind} = this.person.device;
    say(byId("device-name"), this.setup.lacks.length === 0 ? name : `${name} (not calibrated)`);
    setAttribute(byId("keys-of-drive"), "data-keyboard", String(kind === "keyboard"));
  }

  drawRoad(truth) {
    const isOpen = this.connection === "open";
    byId("no-road").hidden = Boolean(truth);
    setAttribute(byId("picture"), "data-old", String(!truth || !isOpen));
    say(byId("speed"), truth && isOpen ? kmh(truth.host_speed_mps) : "–");
    if (!truth) return;
    const {run, taken_ms} = this.newest;
    const ahead_s = reducedMotion.matches || truth.last ? 0
      : Math.min(run?.step_s ?? 0.1, Math.max(0, (performance.now() - taken_ms) / 1000) * (run?.pace || 1));
    const {ratio, every} = this.budget.now;
    this.turn = (this.turn ?? 0) + 1;
    if (this.turn % every !== 0) return;
    this.view?.draw({frame: {TRUTH: truth}, ahead_s, length_m: this.length_m ?? 4.5}, ratio);
  }

  drawLatency() {
    const {newest} = this.latency;
    const now = performance.now();
    const highest = this.latency.highest(now);
    const isHigh = this.told.side !== "unknown" && this.latency.isHigh(now);
    const words = newest === null ? "not measured yet" : withUnit(decimal(newest, 0), "ms");
    const longest = `; the longest of the last inputs: ${withUnit(decimal(highest, 0), "ms")}`;
    say(byId("resolution"), `${decimal(100 * this.budget.now.ratio, 0)} %`);
    say(byId("latency"), isHigh && highest > newest ? words + longest : words);
    byId("latency-warning").hidden = !isHigh;
  }
}

window.foglineDrive = new Drive();
