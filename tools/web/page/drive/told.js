// The texts about the run for the person: the side that drives, and the request to take over. They
// do not mention sensors, thresholds or conflict. It knows no document.

import {modeOf} from "../data/modes.js";

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

/**
 * {side, words, asks, urgent} for a HOST_COMMAND; without one the drive has not begun.
 * @param isOver whether the last step of the run has come
 */
export function told(command, isOver = false) {
  if (isOver) return {side: "unknown", words: "The drive has ended", asks: false, urgent: false};
  if (!command) return {side: "unknown", words: "The drive has not begun", asks: false, urgent: false};
  const {name, side, asks: waits = false, urgent = false} = modeOf(command.mode, command.lambda_human);
  const asks = waits && name !== "HANDOVER";  // then the person has answered
  const drives = side === "human" ? TOLD.HUMAN : TOLD.AUTOMATION;
  const words = name === "COLLISION_WARNING" ? `Collision warning. ${drives}`
    : TOLD[name] ?? "It is not known who drives";
  return {side, words, asks, urgent};
}

/** Counts down a request to take over. */
export class Countdown {
  constructor() {
    this.since_s = null;
  }

  /**
   * @param asks whether HOST_COMMAND of this time asks; time_s of the run; lead_s of the scenario
   * @return {left_s, share}, or null if the person is not asked
   */
  see(asks, time_s, lead_s) {
    if (!asks) this.since_s = null;
    if (!asks) return null;
    if (this.since_s === null || time_s < this.since_s) this.since_s = time_s;
    const left_s = Math.max(0, this.since_s + lead_s - time_s);
    return {left_s, share: lead_s > 0 ? left_s / lead_s : 0};
  }
}

const WHY_AWAY = {
  "not begun": "Press “Begin” when you are ready.",
  "no seat": "Another page has the seat. Press “Begin” to ask for it.",
  refused: "Another person drives. Press “Begin” to ask again.",
  hidden: "This page was hidden, so you do not drive.",
  blurred: "Another window has the keyboard, so you do not drive. Click here to go on.",
  busy: "A dialog is open, so you do not drive.",
  unplugged: "The device is unplugged, so you do not drive. Plug it in, or choose another one.",
  "not calibrated": "Calibrate the device first (button “Device”).",
};

/** The text for a reason of Person.whyAway(); "" if the person drives. */
export const whyAwayInWords = (why) => WHY_AWAY[why] ?? "";
