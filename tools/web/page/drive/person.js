// The input of the person at the page: keys, a gamepad or a wheel, buttons of the page, and whether
// a person is present. This file does not use the document.

import {isComplete, isDown, pedalValue, rawOf} from "./calibration.js";
import {Ramps} from "./ramps.js";

export const KEYBOARD = {id: "", kind: "keyboard", name: "Keyboard"};
export const PEDAL_KEYS = {ArrowUp: "throttle", ArrowDown: "brake"};
export const BUTTON_KEYS = {t: "take_over", g: "give_back"};

// A pressed button counts as down for at least this time. Otherwise a short click could fall
// between two steps of the run. In this time the page sends at least two messages.
const LEAST_PRESS_MS = 120;
// Smaller changes of raw values are noise: analogue sticks at rest move less than this.
const NOISE = 0.01;
// If the page has not looked at the devices for this time, the server has counted the page as
// silent (Seat::kSilent). So the page then handles the pedals as if the person had been away.
const SILENT_MS = 300;
// When a person comes back, a pedal below this share of its travel counts as released. Our choice:
// the rest position of consumer pedals moves by 1 to 2 %, which is less. A person hardly feels 5 %.
const RELEASED = 0.05;
const PEDALS = ["throttle", "brake"];

/** "wheel" or "gamepad", from the name that the device reports. */
export function kindOf(id) {
  return /wheel|racing|pedal|driving force|\bg(25|27|29|920|923)\b|\bt(150|248|300|500)\b|fanatec|simucube|moza/i
    .test(id) ? "wheel" : "gamepad";
}

export const deviceOf = ({id}) => ({id, kind: kindOf(id), name: id});

const movesBeyondNoise = (before, after) =>
  before.length !== after.length || before.some((value, i) => Math.abs(value - after[i]) > NOISE);

/** Whether the page uses a key. */
export const isDriving = (key) => key in PEDAL_KEYS || key.toLowerCase() in BUTTON_KEYS;

export class Person {
  constructor() {
    this.ramps = new Ramps();
    this.device = KEYBOARD;
    this.calibration = null;
    this.begun = false;       // whether the person has said that they are ready
    this.visible = true;
    this.focused = true;
    this.busy = false;        // whether a dialog is open
    this.seated = false;      // whether the server has given the seat to this page
    this.down = new Set();    // buttons that a key holds
    this.until_ms = {take_over: -Infinity, give_back: -Infinity};
    this.touched_ms = null;   // time of the newest input of the device
    this.looked_ms = -Infinity;
    this.raw = [];
    this.forgetPad();
  }

  /** Forgets the state of the device. Called if it is unplugged, or if another device is chosen. */
  forgetPad() {
    this.pad = null;            // newest state of the chosen gamepad; null: not connected
    this.firstAxes = [];        // values of its axes when it was connected
    this.moved = new Set();     // its axes that have moved since then
    this.released = new Set();  // pedals that were released since the person came
  }

  /** Chooses a device. @param calibration of a gamepad; null for the keyboard */
  choose(device, calibration = null) {
    if (device.id !== this.device.id) {
      this.forgetPad();
      this.raw = [];
      this.drop();
    }
    this.device = device;
    this.calibration = calibration;
  }

  /** Releases all keys and buttons, because no person is present. */
  drop() {
    this.leavePedals();
    this.down.clear();
    this.until_ms = {take_over: -Infinity, give_back: -Infinity};
  }

  /** Releases the pedals. A pedal of a device acts again only after the person has released it. */
  leavePedals() {
    this.ramps.drop();
    this.released.clear();
  }

  /**
   * Sets visible, focused, busy, seated or begun. If the person then does not drive, releases all
   * keys and buttons.
   */
  set(name, value) {
    this[name] = value;
    if (this.whyAway() !== "") this.drop();
  }

  /**
   * Handles a change of a key.
   * @param down whether the key is pressed
   * @param at_ms time of the change
   * @param now_ms present time; a busy page handles a change late
   * @return whether the page uses the key
   */
  key(key, down, at_ms, now_ms = at_ms) {
    // While the person is away, keys are ignored. When the person comes back, all keys count as
    // released.
    if (this.whyAway() !== "") return false;
    const pedal = PEDAL_KEYS[key];
    const button = BUTTON_KEYS[key.toLowerCase()];
    if (pedal) {
      if (this.device.kind !== "keyboard") return false;
      if (this.ramps.held[pedal] === down) return true;  // the keyboard repeats a key
      this.ramps.hold(pedal, down, at_ms);
    } else if (button) {
      if (this.down.has(button) === down) return true;
      if (down) this.press(button, at_ms, now_ms);
      if (down) this.down.add(button);
      else this.down.delete(button);
    } else {
      return false;
    }
    this.touched_ms = at_ms;
    return true;
  }

  /**
   * Takes a click on a button of the page, or the beginning of a press of a key. The shortest press
   * lasts from the present time on, so that it is sent even if the page handles it late.
   */
  press(button, at_ms, now_ms = at_ms) {
    this.until_ms[button] = now_ms + LEAST_PRESS_MS;
    this.touched_ms = at_ms;
  }

  /** Takes the states of all gamepads (navigator.getGamepads()). */
  look(pads, now_ms) {
    if (now_ms - this.looked_ms >= SILENT_MS) this.leavePedals();
    this.looked_ms = now_ms;
    if (this.device.kind === "keyboard") return;
    const pad = [...pads].find((one) => one?.connected && one.id === this.device.id);
    if (!pad) {
      this.forgetPad();
      this.drop();
      return;
    }
    if (!this.pad) this.firstAxes = [...pad.axes];
    this.pad = pad;
    this.notePedals();
    const raw = [...this.pad.axes, ...this.pad.buttons.map(({value}) => value)];
    if (!movesBeyondNoise(this.raw, raw)) return;
    this.raw = raw;
    // `timestamp` is the time at which the browser got the state. It is 0 in some browsers.
    const {timestamp} = this.pad;
    this.touched_ms = timestamp > 0 && timestamp <= now_ms ? timestamp : now_ms;
  }

  /** Notes the axes that have moved, and the pedals that are released. */
  notePedals() {
    this.pad.axes.forEach((value, axis) => {
      if (value !== this.firstAxes[axis]) this.moved.add(axis);
    });
    if (this.whyAway() !== "") return;
    for (const pedal of PEDALS) {
      if (this.position(this.calibration[pedal]) < RELEASED) this.released.add(pedal);
    }
  }

  /**
   * Position of a pedal in [0, 1]; null if the device has no such axis or button. An axis that has
   * not moved yet counts as released. A browser may report 0 for such an axis, but 0 is the middle
   * of its range.
   */
  position(pedal) {
    const value = pedalValue(this.pad, pedal);
    const isUnknown = pedal.axis !== undefined && !this.moved.has(pedal.axis);
    return value !== null && isUnknown ? 0 : value;
  }

  /** The reason why the person does not drive; "" if the person drives. */
  whyAway() {
    if (!this.begun) return "not begun";
    return this.seated ? this.whyNotReady() : "no seat";
  }

  /** The reason why the person would not drive even with a seat; "" if the person is ready. */
  whyNotReady() {
    if (!this.begun) return "not begun";
    if (!this.visible) return "hidden";
    if (this.busy) return "busy";
    if (!this.focused) return "blurred";
    if (this.device.kind === "keyboard") return "";
    if (!this.pad) return "unplugged";
    return isComplete(this.calibration) && this.pedals(0) ? "" : "not calibrated";
  }

  pedals(now_ms) {
    if (this.device.kind === "keyboard") return this.ramps.advance(now_ms);
    const [throttle, brake] = PEDALS.map((pedal) => {
      const position = this.position(this.calibration[pedal]);
      return position === null || this.released.has(pedal) ? position : 0;
    });
    return throttle === null || brake === null ? null : {throttle, brake};
  }

  /** The values of the device: of its axes, and then of the buttons that are throttle and brake. */
  values() {
    if (!this.pad) return [];
    const buttons = PEDALS.map((pedal) => this.calibration?.[pedal])
      .filter((pedal) => pedal && pedal.axis === undefined);
    return [...this.pad.axes, ...buttons.map((pedal) => rawOf(this.pad, pedal) ?? 0)];
  }

  holds(button, now_ms) {
    return this.down.has(button) || now_ms < this.until_ms[button] ||
      (this.pad !== null && isDown(this.pad, this.calibration[button]));
  }

  /** The input at this time: {present, throttle, brake, axes, buttons, device}. */
  input(now_ms) {
    const present = this.whyAway() === "";
    const {throttle, brake} = present ? this.pedals(now_ms) : {throttle: 0, brake: 0};
    return {
      present, throttle, brake, device: this.device, axes: this.values(),
      buttons: present ? ["take_over", "give_back"].filter((name) => this.holds(name, now_ms)) : [],
    };
  }
}
