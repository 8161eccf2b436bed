// The dialog for the device with which the person drives, and for its calibration.

import {byId, make, say, setAttribute} from "../draw/dom.js";
import {
  ButtonLesson, calibrationOf, forgetCalibration, inverted, isComplete, keepCalibration, PedalLesson,
  pedalValue, withDeadZone,
} from "./calibration.js";
import {deviceOf, KEYBOARD} from "./person.js";

const CHOSEN = "fogline.drive.device";
const PEDALS = ["throttle", "brake"];
const BUTTONS = ["take_over", "give_back"];
const EMPTY = {throttle: null, brake: null, take_over: null, give_back: null};

const placeOf = (pedal) => pedal === null ? "not learned"
  : pedal.axis === undefined ? `button ${pedal.button}` : `axis ${pedal.axis}`;

export class Setup {
  /** @param onBusy is called with true when the dialog opens, and with false when it closes */
  constructor(person, onBusy) {
    this.person = person;
    this.dialog = byId("setup");
    this.list = byId("device");
    this.lesson = null;  // {name, teacher}
    this.edited = {...EMPTY};
    this.known = "";
    byId("setup-open").addEventListener("click", () => this.dialog.showModal());
    byId("setup-close").addEventListener("click", () => this.dialog.close());
    this.dialog.addEventListener("close", () => onBusy(this.end()));
    new MutationObserver(() => onBusy(this.dialog.open))
      .observe(this.dialog, {attributeFilter: ["open"]});
    this.list.addEventListener("change", () => this.choose(this.list.value, true));
    byId("forget").addEventListener("click", () => this.forget());
    for (const name of [...PEDALS, ...BUTTONS]) {
      byId(`learn-${name}`).addEventListener("click", () => this.learn(name));
    }
    for (const name of PEDALS) {
      byId(`dead-${name}`).addEventListener("change", ({target}) => (
        this.change(name, (pedal) => withDeadZone(pedal, Number(target.value) / 100))));
      byId(`invert-${name}`).addEventListener("click", () => this.change(name, inverted));
    }
  }

  /** The pedals that the person must still calibrate before driving with the device. */
  get lacks() {
    if (this.person.device.kind === "keyboard") return [];
    return PEDALS.filter((name) => this.edited[name] === null);
  }

  end() {
    this.lesson = null;
    return this.dialog.open;
  }

  /** Takes the gamepads that are connected at present. */
  look(pads) {
    const there = [...pads].filter((pad) => pad?.connected);
    const known = there.map(({id}) => id).join("\n");
    if (known !== this.known) {
      this.known = known;
      this.fill(there);
    }
    if (this.dialog.open) this.teach();
  }

  /** Fills the list of devices. A chosen device stays in the list while it is unplugged. */
  fill(there) {
    const {id} = this.person.device;
    const ids = new Set([...there.map((pad) => pad.id), ...(id === "" ? [] : [id])]);
    const has = (pads) => pads.some((pad) => pad.id === id);
    const hasCome = has(there) && !has(this.pads ?? []);
    this.pads = there;
    this.list.replaceChildren(
      make("option", {value: ""}, KEYBOARD.name),
      ...[...ids].map((one) => make("option", {value: one},
        there.some((pad) => pad.id === one) ? one : `${one} (unplugged)`)));
    this.list.value = id;
    // Before the person has begun, the page chooses the device that the person used last, or else
    // the first device. It chooses none if the person's last choice was the keyboard.
    if (!this.person.begun && id === "" && there.length > 0) {
      const before = this.remembered();
      if (before !== "") this.choose((there.find((pad) => pad.id === before) ?? there[0]).id, false);
    }
    const isNew = Object.values(this.edited).every((one) => one === null);
    if (hasCome && isNew) this.choose(id, false);  // reads the calibration, which needs the device
    this.show();
  }

  /** The last choice of the person: an id, "" for the keyboard, or null for no choice. */
  remembered() {
    try {
      return localStorage.getItem(CHOSEN);
    } catch {
      return null;
    }
  }

  choose(id, byPerson) {
    const pad = this.pads?.find((one) => one.id === id);
    const calibration = pad ? calibrationOf(localStorage, pad) : null;
    this.lesson = null;
    this.edited = {...EMPTY, ...calibration};
    this.person.choose(id === "" ? KEYBOARD : deviceOf({id}), calibration);
    this.list.value = id;
    if (byPerson) {
      try {
        localStorage.setItem(CHOSEN, id);
      } catch {
        // The browser stores nothing.
      }
    }
    this.show();
  }

  forget() {
    forgetCalibration(localStorage, this.person.device);
    this.choose(this.person.device.id, false);
    say(byId("setup-note"), "The calibration of this device is forgotten.");
  }

  /** Handles the button “Learn”: it begins a lesson, and also ends the lesson of a pedal. */
  learn(name) {
    if (this.lesson?.name === name) {
      this.finish(name, this.lesson.teacher.result?.() ?? null);
      return;
    }
    const isPedal = PEDALS.includes(name);
    this.lesson = {name, teacher: isPedal ? new PedalLesson() : new ButtonLesson()};
    say(byId("setup-note"), isPedal
      ? "Press the pedal fully, release it, and then press “Done”."
      : "Press the button of the device.");
    this.show();
  }

  finish(name, found) {
    this.lesson = null;
    if (found === null) {
      say(byId("setup-note"), "Nothing has moved far enough. Try once more.");
      this.show();
      return;
    }
    this.set(name, found);
    say(byId("setup-note"), "Learned.");
  }

  change(name, how) {
    if (this.edited[name]) this.set(name, how(this.edited[name]));
  }

  set(name, value) {
    this.edited = {...this.edited, [name]: value};
    if (isComplete(this.edited)) {
      this.person.choose(this.person.device, this.edited);
      if (!keepCalibration(localStorage, this.person.device, this.edited)) {
        say(byId("setup-note"), "This browser does not keep the calibration.");
      }
    }
    this.show();
  }

  teach() {
    const {pad} = this.person;
    for (const name of PEDALS) {
      const value = pad && this.edited[name] ? pedalValue(pad, this.edited[name]) : 0;
      byId(`try-${name}`).value = value ?? 0;
    }
    if (!this.lesson || !pad) return;
    const found = this.lesson.teacher.see(pad);
    if (Number.isInteger(found)) this.finish(this.lesson.name, found);
  }

  show() {
    const {device} = this.person;
    byId("forget").disabled = Object.values(this.edited).every((one) => one === null);
    byId("calibration").hidden = device.kind === "keyboard";
    say(byId("setup-lack"), this.lacks.length === 0 ? ""
      : `You cannot drive with this device yet: learn the ${this.lacks.join(" and the ")}.`);
    for (const name of [...PEDALS, ...BUTTONS]) {
      const isLearning = this.lesson?.name === name;
      say(byId(`learn-${name}`), isLearning ? (PEDALS.includes(name) ? "Done" : "Waiting") : "Learn");
      setAttribute(byId(`learn-${name}`), "aria-pressed", String(isLearning));
    }
    for (const name of PEDALS) {
      const pedal = this.edited[name];
      say(byId(`place-${name}`), placeOf(pedal));
      byId(`dead-${name}`).disabled = byId(`invert-${name}`).disabled = pedal === null;
      if (pedal) byId(`dead-${name}`).value = String(Math.round(100 * pedal.dead));
      const runsDown = pedal !== null && pedal.pressed < pedal.released;
      setAttribute(byId(`invert-${name}`), "aria-pressed", String(runsDown));
    }
    for (const name of BUTTONS) {
      const button = this.edited[name];
      say(byId(`place-${name}`), button === null ? "only the keyboard" : `button ${button}`);
    }
  }
}
