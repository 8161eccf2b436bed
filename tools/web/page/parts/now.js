// The strip at the top: the side that drives, since when, and why; the request to take over with
// its countdown; the end of the run.

import {byId, make, say, setAttribute} from "../draw/dom.js";
import {decimal, seconds, withUnit} from "../draw/format.js";
import {stands} from "../data/cars.js";
import {drivingSince, manoeuvreAt, modeOf, requestAt, SIDES} from "../data/modes.js";

// Without this delay, a screen reader would speak each change while a person moves through the time
// of the run.
const ANNOUNCE_AFTER_MS = 400;

const LASTS = {
  automation: "The automation has driven for", human: "The human has driven for",
  risk: "The manoeuvre has lasted", unknown: "This has lasted"};

// The reasons for a collision warning and for emergency braking. A collision warning shows its
// reason and then the Degree of Conflict. Emergency braking shows only its reason.
const REASONS = {
  COLLISION_WARNING: "The car ahead is too near. ",
  EMERGENCY_BRAKING: "A collision is near.",
};
const NO_DRIVER = "Neither the automation nor the human goes on driving. ";

/** Why a manoeuvre has begun, by the rules of services/decision/take_over/take_over_table.h. */
function causeOf(manoeuvre) {
  const {first, before} = manoeuvre ?? {};
  if (before?.side === "human") return "The human no longer drives.";
  if (!before?.asks) return "";
  return first.name === "MRM_EMERGENCY" ? "The situation became severe before the human took over."
                                        : "The human has not taken over in time.";
}

/**
 * The reason why the side of this HOST_COMMAND drives, as text. The conflict is no reason for a
 * manoeuvre or for emergency braking.
 * @param hasPerson whether the driver in this run is a person, who can leave the seat
 * @param manoeuvre as manoeuvreAt() gives it
 */
export function reason({mode, lambda_human, doc, threshold}, hasPerson = false, manoeuvre = null) {
  const {name, stops} = modeOf(mode, lambda_human);
  if (name === "MINIMAL_RISK") {
    return NO_DRIVER + (hasPerson ? "Inputs have failed, or the person has gone." : "Inputs have failed.");
  }
  if (stops) return (NO_DRIVER + causeOf(manoeuvre)).trim();
  if (name === "EMERGENCY_BRAKING") return REASONS[name];
  const compared = doc >= threshold ? "at or above" : "below";
  return (REASONS[name] ?? "") +
    `The Degree of Conflict ${decimal(doc, 2)} is ${compared} the threshold ${decimal(threshold, 2)}.`;
}

const STANDS = "Minimal risk manoeuvre: the car stands";
const ENDED = "The run has ended";

/**
 * Tells the reader what the page waits for, or how to start a run: {words, command}.
 * @param isKnown whether the page knows the run
 * @param hello {url, follows, waits_for_person} of the server
 */
function hint(isKnown, {url, follows, waits_for_person}) {
  if (waits_for_person) return {words: "The drive begins when the participant presses “Begin” at the seat."};
  if (isKnown) return {words: "The run has not sent a step. It waits for roles, or it has just begun."};
  const network = follows ? "" : ` --lcm-url '${url}'`;
  return {words: "Start one, such as: ", command: `fogline run scenario/dense_fog.json --pace 1${network}`};
}

/** Shows words and a command. A line break never divides an option of the command. */
function showHint(place, {words, command = ""}) {
  if (place.textContent === words + command) return;
  const parts = command.split(/(--\S+)/).map((part, i) => (i % 2 ? make("span", {class: "option"}, part) : part));
  place.replaceChildren(words, ...(command === "" ? [] : [make("code", {}, ...parts)]));
}

export class Now {
  constructor() {
    this.strip = byId("now");
    this.words = byId("who");
    this.reason = byId("reason");
    this.request = byId("request");
    this.left = byId("request-left");
    this.bar = byId("request-bar");
    this.live = byId("announcement");
    this.said = "";
    this.timer = 0;
  }

  /** Draws the strip. @return the side that drives */
  draw({frame, time, run, isLive, isOver, hello}, modes, lambdas) {
    const command = frame?.HOST_COMMAND;
    if (!command) {
      say(this.words, isOver ? ENDED : isLive ? "Waiting for a run" : SIDES.unknown.words);
      showHint(this.reason, isOver ? {words: "It has sent no step."} : isLive ? hint(run.run_id !== "", hello) : {words: ""});
      setAttribute(this.strip, "data-side", "unknown");
      setAttribute(this.strip, "data-asks", "false");
      this.request.hidden = true;
      return "unknown";
    }
    const mode = modeOf(command.mode, command.lambda_human);
    const drives = mode.name === "MINIMAL_RISK" && stands(frame.TRUTH) ? STANDS : mode.words;
    const words = isOver ? ENDED : drives;
    setAttribute(this.strip, "data-side", isOver ? "ended" : mode.side);
    say(this.words, words);
    const since = drivingSince(modes, lambdas, time);
    const lasted = since === null ? ""
      : ` ${LASTS[mode.side]} ${seconds(time - since, run.step_s)}.`;
    const hasPerson = run.scenario?.person?.drives;
    const why = reason(command, hasPerson, manoeuvreAt(modes.times, modes.values, time));
    const gone = hasPerson && !isOver && frame.DRIVER_COMMAND?.readiness === 0 ? " No person is ready at the seat." : "";
    say(this.reason, (isOver ? `In its last step: “${drives}”. ` : "") + why + gone + lasted);
    const lead_s = run.scenario?.arbitrator?.take_over?.lead_s ?? 10;
    const request = isOver ? null : requestAt(modes.times, modes.values, time, lead_s);
    setAttribute(this.strip, "data-asks", String(request !== null));
    this.drawRequest(request);
    this.announce(words);
    return mode.side;
  }

  drawRequest(request) {
    this.request.hidden = request === null;
    if (request === null) return;
    say(this.left, withUnit(decimal(request.left_s, 1), "s"));
    this.bar.value = request.share;
    this.bar.textContent = `${decimal(request.left_s, 1)} s left`;
  }

  /** Announces a change of the driver to readers who cannot see the page. */
  announce(words) {
    if (words === this.wanted) return;
    this.wanted = words;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (this.said !== words) say(this.live, `${words}.`);
      this.said = words;
    }, ANNOUNCE_AFTER_MS);
  }
}
