// The newest messages of the run that the participant's page needs. Older messages are not stored.

import {headerOf} from "../data/catalogue.js";

const NEEDED = new Set(["TRUTH", "HOST_COMMAND", "DRIVER_COMMAND"]);

/**
 * The page to open when the server has ended; "": no page is opened. The fragment names this page
 * as "back=URL". The URL must be an http page of this machine, or of the machine of the server. Any
 * other URL is ignored, because an address can be forged.
 */
export function backOf(fragment, hostname) {
  const back = new URLSearchParams(fragment.replace(/^#/, "")).get("back") ?? "";
  if (!URL.canParse(back)) return "";
  const {protocol, hostname: there, href} = new URL(back);
  const isNear = there === hostname || there === "127.0.0.1" || there === "localhost";
  return protocol === "http:" && isNear ? href : "";
}

export class Newest {
  constructor(catalogue) {
    this.catalogue = catalogue;
    this.run = null;
    this.forget(null);
  }

  forget(runId) {
    this.runId = runId;
    this.frame = {};        // {NAME: message}
    this.steps = {};
    this.taken_ms = 0;      // clock of the page at the newest TRUTH
  }

  get step() { return this.steps.TRUTH ?? -1; }

  setRun(run) {
    const id = BigInt.asIntN(64, BigInt(run.run_id));
    if (id !== this.runId) this.forget(id);
    this.run = run;
  }

  /**
   * Takes a message of the network.
   * @return {name, message} with the decoded message if it is new and needed; otherwise null
   */
  add({channel: id, bytes}, now_ms) {
    const channel = this.catalogue.channels.get(id);
    if (!NEEDED.has(channel?.name)) return null;
    const header = headerOf(bytes);
    if (!header) return null;
    this.runId ??= header.run_id;  // the server has not yet named the run that it follows
    if (header.run_id !== this.runId || header.step <= (this.steps[channel.name] ?? -1)) return null;
    const message = this.catalogue.decode(channel, bytes);
    if (!message) return null;
    this.frame[channel.name] = message;
    this.steps[channel.name] = header.step;
    if (channel.name === "TRUTH") this.taken_ms = now_ms;
    return {name: channel.name, message};
  }
}
