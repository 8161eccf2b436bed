// The input of the person at the page: keys, a gamepad or a wheel, buttons of the page, and whether
// a person is present. This file does not use the document.

import {isComplete, isDown, pedalValue} from "./calibration.js";
import {Ramps} from "./ramps.js";

export const KEYBOARD = {id: "", kind: "keyboard", name: "Keyboard"};
export const PEDAL_KEYS = {ArrowUp: "throttle", ArrowDown: "brake"};
export const BUTTON_KEYS = {t: "take_over", g: "give_back"};

// A button counts as down for at least this time, in which the page sends at least two messages.
// Otherwise a short click could fall between two steps of the run.
const LEAST_PRESS_MS = 120;
// Smaller changes of raw values are noise: analogue sticks at rest move less than this.
const NOISE = 0.01;

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
    this.pad = null;          // newest state of the chosen gamepad; null: not connected
    this.begun = false;       // whether the person has said that they are ready
    this.visible = true;
    this.focused = true;
    this.busy = false;        // whether a dialog is open
    this.seated = false;      // whether the server has given the seat to this page
    this.down = new Set();    // buttons that a key holds
    this.until_ms = {take_over: -Infinity, give_back: -Infinity};
    this.touched_ms = null;   // time of the newest input of the device
    this.raw = [];
  }

  /** Chooses a device. @param calibration of a gamepad; null for the keyboard */
  choose(device, calibration = null) {
    if (device.id !== this.device.id) {
      this.pad = null;
      this.raw = [];
      this.drop();
    }
    this.device = device;
    this.calibration = calibration;
  }

  /** Releases all keys and buttons, because no person is present. */
  drop() {
    this.ramps.drop();
    this.down.clear();
    this.until_ms = {take_over: -Infinity, give_back: -Infinity};
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
   * Takes a change of a key. @param down whether the key is pressed. @return whether the page uses
   * the key
   */
  key(key, down, now_ms) {
    if (this.whyAway() !== "") return false;  // all keys are up when the person comes back
    const pedal = PEDAL_KEYS[key];
    const button = BUTTON_KEYS[key.toLowerCase()];
    if (pedal) {
      if (this.device.kind !== "keyboard") return false;
      if (this.ramps.held[pedal] === down) return true;  // the keyboard repeats a key
      this.ramps.hold(pedal, down, now_ms);
    } else if (button) {
      if (this.down.has(button) === down) return true;
      if (down) this.press(button, now_ms);
      if (down) this.down.add(button);
      else this.down.delete(button);
    } else {
      return false;
    }
    this.touched_ms = now_ms;
    return true;
  }

  /** Takes a click on a button of the page, or the beginning of a press of a key. */
  press(button, now_ms) {
    this.until_ms[button] = now_ms + LEAST_PRESS_MS;
    this.touched_ms = now_ms;
  }

  /** Takes the states of all gamepads (navigator.getGamepads()). */
  look(pads, now_ms) {
    if (this.device.kind === "keyboard") return;
    this.pad = [...pads].find((pad) => pad?.connected && pad.id === this.device.id) ?? null;
    if (!this.pad) return;
    const raw = [...this.pad.axes, ...this.pad.buttons.map(({value}) => value)];
    if (!movesBeyondNoise(this.raw, raw)) return;
    this.raw = raw;
    // `timestamp` is the time at which the browser got the state. It is 0 in some browsers.
    const {timestamp} = this.pad;
    this.touched_ms = timestamp > 0 && timestamp <= now_ms ? timestamp : now_ms;
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
    if (!this.focused) return "blurred";
    if (this.busy) return "busy";
    if (this.device.kind === "keyboard") return "";
    if (!this.pad) return "unplugged";
    return isComplete(this.calibration) && this.pedals(0) ? "" : "not calibrated";
  }

  pedals(now_ms) {
    if (this.device.kind === "keyboard") return this.ramps.advance(now_ms);
    const throttle = pedalValue(this.pad, this.calibration.throttle);
    const brake = pedalValue(this.pad, this.calibration.brake);
    return throttle === null || brake === null ? null : {throttle, brake};
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
      present, throttle, brake, device: this.device,
      axes: this.pad ? [...this.pad.axes] : [],
      buttons: present ? ["take_over", "give_back"].filter((name) => this.holds(name, now_ms)) : [],
    };
  }
}
