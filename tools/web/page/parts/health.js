// The health of the run: roles, senders, and channels. It shows the same data as `fogline top`.

import {byId, make, say, setAttribute} from "../draw/dom.js";
import {count, decimal, share} from "../draw/format.js";
import {lacksOf, lossesOf} from "../data/losses.js";

const INPUT_STATES = ["awaited", "OK", "stale", "lost"];

function refusals(refused) {
  const texts = Object.entries(refused ?? {})
    .map(([kind, n]) => `${n} ${kind.replaceAll("_", " ")}`);
  return texts.join(", ") || "0";
}

/** The fallback of a role with the channel that caused it, and the stale and lost inputs. */
function fallbackOf(status) {
  if (!status) return "";
  const bad = (status.input ?? []).filter((_, i) => status.input_state[i] >= 2)
    .map((name, i) => `${name} ${INPUT_STATES[status.input_state[status.input.indexOf(name)]]}`);
  const cause = status.fallback && status.waiting_for ? ` (because of ${status.waiting_for})` : "";
  return [status.fallback ? status.fallback + cause : "", ...bad].filter(Boolean).join("; ");
}

/** The health of a role: "good", "note" or "bad". Silence after the run's end is "good". */
function grade(role, status, isOver) {
  if (isOver && !role.error && role.state !== "FAILED") return "good";
  if (role.silent || role.state === "FAILED" || role.error) return "bad";
  return status?.fallback || Object.keys(role.refused ?? {}).length ? "note" : "good";
}

const MARKS = {good: "●", note: "▲", bad: "■"};
const MARK_WORDS = {good: "well", note: "look at it", bad: "trouble"};

function cell(text, attributes = {}) {
  return make("td", attributes, text);
}

function mark(kind) {
  const attributes = {class: `mark ${kind}`, role: "img", "aria-label": MARK_WORDS[kind]};
  return make("span", attributes, MARKS[kind]);
}

function roleRow(role, status, isOver) {
  const kind = grade(role, status, isOver);
  const waits = role.waiting_for && !status?.fallback ? `waits for ${role.waiting_for}` : "";
  const trouble = [...(isOver ? [] : [fallbackOf(status), waits]), role.error].filter(Boolean).join("; ");
  return make("tr", {},
    make("th", {scope: "row"}, mark(kind), role.role),
    cell(isOver ? "ended" : role.silent ? `${role.state}, silent` : role.state ?? "", {class: "text"}),
    cell(count(role.step)),
    cell(isOver ? "–" : `${decimal(role.age_s, 1)} s`),
    cell(`${count(role.repairs_asked)} / ${count(role.repairs_served)}`),
    cell(refusals(role.refused)),
    cell(role.cpu_percent == null ? "–" : `${decimal(role.cpu_percent, 0)} %`),
    cell(trouble || "–", {class: "text"}));
}

function senderRow({address, received, lost, late, duplicates}) {
  return make("tr", {},
    make("th", {scope: "row"}, mark(lost ? "note" : "good"), address),
    cell(count(received)), cell(count(lost)), cell(share(lost, lost + received)),
    cell(count(late)), cell(count(duplicates)));
}

function channelRow(channel, isOver) {
  return make("tr", {},
    make("th", {scope: "row"}, channel.channel),
    cell(channel.type ?? "unknown", {class: "text"}),
    cell(count(channel.messages)),
    cell(isOver ? "–" : `${decimal(channel.rate_hz, 1)} Hz`),
    cell(channel.jitter_ms == null ? "–" : `${decimal(channel.jitter_ms, 1)} ms`),
    cell(isOver ? "–" : `${decimal(channel.age_s, 1)} s`),
    cell(count(channel.lost ?? 0)), cell(count(channel.late ?? 0)),
    cell(count(channel.undecodable)));
}

/** The traffic of the run that the page shows; of the newest run if the page knows no run. */
function shownRun(traffic, run) {
  const runs = traffic?.runs ?? [];
  return run ? runs.find(({run_id}) => run_id === run.run_id) : runs.at(-1);
}

/** Whether the runner has said that the shown run has ended. A run can end before its last step. */
export const hasStopped = (health, run) => Boolean(run) && shownRun(health.traffic, run)?.phase === "STOP";

export class Health {
  constructor() {
    this.parts = {roles: byId("roles"), senders: byId("senders"), channels: byId("channels")};
    this.summary = byId("health-summary");
    this.network = byId("network");
  }

  fill(part, rows) {
    const table = this.parts[part];
    table.hidden = rows.length === 0;
    table.querySelector("tbody").replaceChildren(...rows);
  }

  /** Shows a `health` frame of a live run. @param isOver whether the run has ended */
  drawLive(health, run, statuses, isOver) {
    const shown = shownRun(health.traffic, run);
    const roles = shown?.roles ?? [];
    this.fill("roles", roles.map((role) => roleRow(role, statuses.get(role.role), isOver)));
    this.fill("senders", (health.senders ?? []).map(senderRow));
    const ofRun = (shown?.channels ?? []).map((channel) => channelRow(channel, isOver));
    const others = (health.traffic?.others ?? []).map((channel) => channelRow(channel, false));
    this.fill("channels", [...ofRun, ...others]);
    const bad = roles.filter((role) => grade(role, statuses.get(role.role), isOver) === "bad");
    this.conclude(bad, roles, health, isOver);
  }

  conclude(bad, roles, health, isOver) {
    const isSilent = roles.length === 0 && !health.senders?.length && !health.traffic?.others?.length;
    const losses = isSilent ? {count: 0, words: ""} : lossesOf(health, count);
    const names = bad.map(({role}) => role).join(", ");
    const first = isSilent ? "Nothing has come yet."
      : roles.length === 0 ? "No role has reported yet."
      : bad.length === 0 ? (isOver ? "The run has ended." : `All ${roles.length} roles answer.`)
      : bad.length === 1 ? `One role is in trouble: ${names}.`
      : `${bad.length} roles are in trouble: ${names}.`;
    const overall = bad.length ? "bad" : losses.count ? "note" : roles.length === 0 ? "none" : "good";
    setAttribute(this.summary, "data-grade", overall);
    say(this.summary, `${first} ${losses.words}`.trim());
    const {viewers = 1, drivers = 0} = health;
    const url = health.traffic?.lcm_url;
    const facts = [url && `Network ${url}`, viewers === 1 ? "1 viewer" : `${count(viewers)} viewers`,
                   drivers > 0 && (drivers === 1 ? "1 page of the seat" : `${count(drivers)} pages of the seat`),
                   ...lacksOf(health, count)];
    say(this.network, facts.filter(Boolean).join(" · "));
  }

  /**
   * Shows whether the log of a recorded run is complete. For a log, the page shows no roles,
   * senders and channels.
   */
  drawLog(log, run) {
    for (const part of Object.keys(this.parts)) this.fill(part, []);
    setAttribute(this.summary, "data-grade", log.complete ? "good" : "note");
    const steps = log.last_step - log.first_step + 1;
    say(this.summary, `${log.complete ? "The log is complete" : "The log is not complete"}: ` +
      `${count(steps)} of ${count(run.steps ?? steps)} steps.${log.note ? ` ${log.note}` : ""}`);
    say(this.network, `${log.file}, run ${run.run_id} · A live run also shows its roles, senders ` +
      "and channels here.");
  }
}
