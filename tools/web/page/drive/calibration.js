// The axes and buttons of a device that are its pedals, and how far they move. This file does not
// use the document: the browser's localStorage comes as an argument.
//
// A calibration: {throttle: PEDAL, brake: PEDAL, take_over: BUTTON, give_back: BUTTON}. A PEDAL is
// {axis or button, released, pressed, dead}: the raw values of the released and of the fully
// pressed pedal, and the dead zone as a share of the pedal's travel. `pressed` may be below
// `released`. A BUTTON is the number of a button, or null.

const KEPT_UNDER = "fogline.drive.calibration.";
const MOST_DEAD = 0.3;      // a larger dead zone would leave too little of the pedal's travel
const DEFAULT_DEAD = 0.03;  // our choice: the rest position of consumer pedals moves by 1 to 2 %
// Smallest change of a raw value that counts as a pressed pedal. A pedal has a travel of 2 on an
// axis, and of 1 on a button. A smaller change is noise, or another axis that also moves.
const LEAST_WAY = 0.4;

/**
 * The calibration of gamepads with the browser's "standard" mapping. The right and the left trigger
 * (W3C Gamepad, 8: buttons 7 and 6) are throttle and brake. The lower and the right button (0 and
 * 1) take over and give back.
 */
const STANDARD = {
  throttle: {button: 7, released: 0, pressed: 1, dead: DEFAULT_DEAD},
  brake: {button: 6, released: 0, pressed: 1, dead: DEFAULT_DEAD},
  take_over: 0,
  give_back: 1,
};

/**
 * The raw value of an axis or of a button; null if the device has no axis or button of this number.
 */
export function rawOf(pad, {axis, button}) {
  const value = axis === undefined ? pad.buttons[button]?.value : pad.axes[axis];
  return Number.isFinite(value) ? value : null;
}

/** Position of a pedal in [0, 1]; null if the device has no such axis or button. */
export function pedalValue(pad, pedal) {
  const raw = rawOf(pad, pedal);
  if (raw === null) return null;
  const way = (raw - pedal.released) / (pedal.pressed - pedal.released);
  const beyond = (way - pedal.dead) / (1 - pedal.dead);
  return Math.min(1, Math.max(0, beyond));
}

export const isDown = (pad, button) => button !== null && pad.buttons[button]?.pressed === true;

/** The pedal with `released` and `pressed` exchanged. */
export const inverted = (pedal) => ({...pedal, released: pedal.pressed, pressed: pedal.released});

/** The pedal with another dead zone, limited to [0, MOST_DEAD]. */
export function withDeadZone(pedal, dead) {
  return {...pedal, dead: Number.isFinite(dead) ? Math.min(MOST_DEAD, Math.max(0, dead)) : 0};
}

function isPedal(pedal) {
  const {axis, button, released, pressed, dead} = pedal ?? {};
  const place = axis ?? button;
  return Number.isInteger(place) && place >= 0 && (axis === undefined) !== (button === undefined) &&
    [released, pressed, dead].every(Number.isFinite) && released !== pressed && dead >= 0 &&
    dead <= MOST_DEAD;
}

const isButton = (button) => button === null || (Number.isInteger(button) && button >= 0);

/** Whether a calibration has valid pedals and buttons, so that a person can drive with it. */
export function isComplete(calibration) {
  return isPedal(calibration?.throttle) && isPedal(calibration?.brake) &&
    isButton(calibration.take_over) && isButton(calibration.give_back);
}

/**
 * The stored calibration of a device, if it is complete; otherwise STANDARD, if the device has the
 * "standard" mapping; otherwise null. With null the person must first calibrate the device.
 */
export function calibrationOf(storage, {id, mapping}) {
  try {
    const kept = JSON.parse(storage.getItem(KEPT_UNDER + id));
    if (isComplete(kept)) return kept;
  } catch {
    // The entry cannot be read, so it does not count. Another program may have written it, or the
    // browser stores nothing.
  }
  return mapping === "standard" ? structuredClone(STANDARD) : null;
}

/** Stores the calibration of a device. @return whether the browser has stored it */
export function keepCalibration(storage, {id}, calibration) {
  try {
    storage.setItem(KEPT_UNDER + id, JSON.stringify(calibration));
    return true;
  } catch {
    return false;
  }
}

/** Removes the stored calibration of a device. */
export function forgetCalibration(storage, {id}) {
  try {
    storage.removeItem(KEPT_UNDER + id);
  } catch {
    // The browser stores nothing.
  }
}

/**
 * Learns a pedal while a person presses the pedal fully and releases it. A browser may report 0 for
 * an axis that has not moved yet. So the rest position is the last value, not the first one.
 */
export class PedalLesson {
  constructor() {
    this.seen = new Map();  // {axis or button, least, most, last} by place
  }

  see(pad) {
    pad.axes.forEach((value, axis) => this.note(`axis ${axis}`, {axis}, value));
    pad.buttons.forEach(({value}, button) => this.note(`button ${button}`, {button}, value));
  }

  note(place, source, value) {
    const {least = value, most = value} = this.seen.get(place) ?? {};
    this.seen.set(place, {...source, least: Math.min(least, value), most: Math.max(most, value),
                          last: value});
  }

  /** The pedal that has moved farthest; null if no pedal has moved far enough. */
  result() {
    let best = null;
    for (const {least, most, last, ...source} of this.seen.values()) {
      const pressed = most - last > last - least ? most : least;
      const way = Math.abs(pressed - last);
      if (way >= LEAST_WAY && way > (best?.way ?? 0)) {
        best = {way, pedal: {...source, released: last, pressed, dead: DEFAULT_DEAD}};
      }
    }
    return best?.pedal ?? null;
  }
}

/** Learns a button: the first button that is pressed. */
export class ButtonLesson {
  constructor() {
    this.before = null;
  }

  /** @return the number of the button; null if no button was pressed yet */
  see(pad) {
    const down = pad.buttons.map(({pressed}) => pressed);
    const found = this.before ? down.findIndex((now, i) => now && !this.before[i]) : -1;
    this.before = down;
    return found < 0 ? null : found;
  }
}
