// The texts about the run for the person: the side that drives, and the request to take over. The
// texts do not mention sensors, thresholds or conflict. This file does not use the document.

import {stands} from "../data/cars.js";
import {humanDrives, modeOf} from "../data/modes.js";

const TOLD = {
  AUTOMATION: "The automation drives",
  HUMAN: "You drive",
  MINIMAL_RISK: "The car stops by itself",
  REQUEST: "Take over",
  REQUEST_URGENT: "Take over now",
  HANDOVER: "Your answer has come; the automation still drives",
  RECOVERING: "You drive",
  MRM_COMFORT: "The car stops by itself",
  MRM_EMERGENCY: "The car stops by itself, quickly",
  MRM_DONE: "The car stands",
  MRM_FAILED: "The car cannot stop by itself",
  EMERGENCY_BRAKING: "The car brakes in an emergency",
};

// The texts for the end of a drive, by TRUTH.collision (lcmtypes/truth_t.lcm).
const ENDED = [
  "The drive has ended",
  "The drive has ended: your car has hit the car ahead",
  "The drive has ended: the car behind has hit yours",
];

// The texts while there is no connection to the program, by the state of the wire (seat_wire.js).
const GONE = {
  ended: "The program has ended",
  lost: "No connection to the car",
  refused: "No connection to the car",
};

// Modes of a stop that lasts until the end of the run. A person cannot end it.
const FINAL = ["MINIMAL_RISK", "MRM_DONE"];
// Modes of a stop that a person can end by taking over, while the car moves.
const MAY_END = ["MRM_COMFORT", "MRM_EMERGENCY", "MRM_FAILED"];

const noSide = (words) => ({
  side: "unknown", words, asks: false, urgent: false, answered: false, isFinal: false, mayEnd: false,
  hasAuthority: false});

/**
 * The description {side, words, asks, urgent, answered, isFinal, mayEnd, hasAuthority} of a
 * HOST_COMMAND. Without a HOST_COMMAND the drive has not begun. `isFinal`: the stop lasts until the
 * end of the run. `mayEnd`: a person can end the stop by taking over. `hasAuthority`: the human has
 * the authority, also while the car brakes in an emergency.
 * @param truth the newest TRUTH, which says whether the run has ended
 * @param connection state of the wire (seat_wire.js)
 */
export function told(command, truth = null, connection = "open") {
  if (truth?.last) return noSide(ENDED[truth.collision] ?? ENDED[0]);
  if (GONE[connection]) return noSide(GONE[connection]);
  if (!command) return noSide("The drive has not begun");
  const {name, side, asks: waits = false, urgent = false} = modeOf(command.mode, command.lambda_human);
  const asks = waits && name !== "HANDOVER";  // in HANDOVER the person has already answered
  const drives = side === "human" ? TOLD.HUMAN : TOLD.AUTOMATION;
  const words = name === "COLLISION_WARNING" ? `Collision warning. ${drives}`
    : name === "MINIMAL_RISK" && stands(truth) ? TOLD.MRM_DONE
    : TOLD[name] ?? "It is not known who drives";
  return {side, words, asks, urgent, answered: waits && !asks, isFinal: FINAL.includes(name),
          mayEnd: MAY_END.includes(name), hasAuthority: humanDrives(command.lambda_human)};
}

/**
 * Counts down a request to take over.
 * @param request {since_s, begin_known} from the server; null if the server has not sent it.
 *     since_s is the time of the run at which the request began
 * @param time_s the present time of the run
 * @param lead_s the time for a take-over, from the scenario
 * @return {left_s, share, atMost}: the time left, and its share of lead_s. With `atMost`, less time
 *     may be left, because the beginning of the request is not known
 */
export function countdown(request, time_s, lead_s) {
  const {since_s, begin_known} = request ?? {since_s: time_s, begin_known: false};
  const left_s = Math.min(lead_s, Math.max(0, since_s + lead_s - time_s));
  return {left_s, share: lead_s > 0 ? left_s / lead_s : 0, atMost: !begin_known};
}

// Times in ms after a press. The words appear at `after`. The run answers a button within a few
// steps, so an answer would have come before this time. The words disappear at `until`, so that a
// person has time to read them.
const ANSWER_MS = {after: 1000, until: 6000};

/** The text for a button that may have no effect; undefined for any other button. */
function noEffect(button, {side, asks, answered, mayEnd}) {
  if (button === "give_back" && side === "human") {
    return "You still drive: the automation does not take the car yet. Press again later.";
  }
  if (button !== "take_over" || asks || answered) return undefined;
  if (mayEnd) return "You do not drive: the car has not taken your answer.";
  if (side !== "automation") return undefined;
  return "The automation goes on driving: it has not asked you to take over.";
}

/** Tells a person that a button has had no effect. */
export class Answer {
  constructor() {
    this.pressed = null;
  }

  /** @param state the result of told() at this time */
  press(button, state, now_ms) {
    const words = noEffect(button, state);
    this.pressed = words === undefined ? null : {words, side: state.side, at_ms: now_ms};
  }

  /** The words at a time; "" if there is nothing to say. */
  words({side, asks, isFinal}, now_ms) {
    if (this.pressed?.side !== side || asks || isFinal) this.pressed = null;
    if (!this.pressed) return "";
    const passed_ms = now_ms - this.pressed.at_ms;
    const isShown = passed_ms >= ANSWER_MS.after && passed_ms <= ANSWER_MS.until;
    return isShown ? this.pressed.words : "";
  }
}

/** The words after the first press of “Leave the seat”, if leaving.js asks for a second one. */
export const LEAVING = "If you leave now, no person drives. The car may stop for the rest of the run.";

/** The words in the second line when the program has ended. */
export const PROGRAM_ENDED = "If you take part in a study, please tell the experimenter.";

const WHY_AWAY = {
  "not begun": "Press “Begin” when you are ready.",
  "no seat": "Another page has the seat. Press “Begin” to ask for it.",
  refused: "Another person drives. Press “Begin” to ask again.",
  hidden: "This page was hidden, so you do not drive.",
  blurred: "Another window has the keyboard: press “Go on”.",
  busy: "A dialog is open, so you do not drive.",
  unplugged: "The device is unplugged, so you do not drive. Plug it in, or choose another one.",
  "not calibrated": "Calibrate the device first (button “Device”).",
};

const LEFT = "You have left the seat. Press “Begin” to come back.";
const NO_MORE = "Nobody drives any more in this run.";
const LEFT_FOR_GOOD = "You have left the seat. Nobody drives any more in this run.";
const STILL = "You can still take over while the car moves.";

/**
 * The text for a reason of Person.whyAway(); "" if the person is present and needs no text.
 * @param hasLeft whether the person had begun before; side, isFinal, mayEnd: see told()
 */
export function whyAwayInWords(why, {hasLeft = false, side = "unknown", isFinal = false, mayEnd = false} = {}) {
  if (isFinal) return why === "not begun" && hasLeft ? LEFT_FOR_GOOD : NO_MORE;
  if (why === "" && mayEnd) return STILL;
  const words = why === "not begun" && hasLeft ? LEFT : WHY_AWAY[why] ?? "";
  return words !== "" && side === "human" ? `${words} No person presses the pedals now.` : words;
}
