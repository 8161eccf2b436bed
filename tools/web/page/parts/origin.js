// The words at the top that say where the displayed data come from, and whether they are behind the
// run.

import {byId, say, setAttribute} from "../draw/dom.js";

const OF_LIVE = {live: "Live", paused: "Paused; the run goes on", playing: "Behind the run"};

function originInWords({connection, isLive, waits, isOver, log, clock}) {
  if (connection === "ended") return "The program has ended";
  if (connection !== "open") return "No connection, trying again";
  if (!isLive) return log ? log.file : "Connecting";
  if (isOver) return "The run has ended";
  return waits ? "Connected" : OF_LIVE[clock.state];
}

/**
 * Shows the origin of the data.
 * @param page {connection, isLive, waits, isOver, hello, log, clock}
 */
export function sayOrigin(page) {
  const {connection, isLive, waits, isOver, hello, clock} = page;
  const isBehind = connection === "ended" || (isLive && (isOver || clock.state !== "live"));
  const isLost = !["open", "ended"].includes(connection);
  const state = isLost ? "lost" : waits ? "none" : isBehind ? "behind" : hello?.mode ?? "none";
  setAttribute(byId("origin"), "data-state", state);
  say(byId("origin-words"), originInWords(page));
}
