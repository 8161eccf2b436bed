// The experimenter's page: the condition, the events, and the markers.
import {connect, showProblem, titleOf} from "./link.js";

const byId = (id) => document.getElementById(id);
const WORDS = {
  starting: "The session starts.",
  waiting: "The participant can begin.",
  seating: "The participant goes to the seat.",
  driving: "The run is under way.",
  ended: "The run has ended.",
  asking: "The participant answers questions.",
  finished: "All runs are done.",
};
let last = {};
let pending = null;  // the marker that was sent last, until it is in the list: {text, before}

const send = connect(show, showProblem);

byId("begin").onclick = () => {
  pending = null;
  send({op: "begin", state: last.state});
};
byId("marker").onsubmit = (event) => {
  event.preventDefault();
  const text = byId("marker-text").value.trim();
  if (send({op: "marker", text})) pending = {text, before: timesMarked(last, text)};
};

/** How often a marker is in the list. */
const timesMarked = ({lines}, text) => lines.filter((line) => line.text === `marker: ${text}`).length;

/** Empties the field of the marker when the marker is in the list. A refused marker stays there. */
function takePending(state) {
  if (!pending || timesMarked(state, pending.text) <= pending.before) return;
  const input = byId("marker-text");
  if (input.value.trim() === pending.text) input.value = "";
  pending = null;
}

function show(state) {
  last = state;
  takePending(state);
  const what = pending ? "The marker was not saved" : "This had no effect";
  showProblem(state.refused ? `${what}: ${state.refused}.` : "");
  byId("title").textContent = `Participant ${state.participant}, ${titleOf(state).toLowerCase()}`;
  const words = state.wait_s > 0 ? "The participant has a break." : WORDS[state.stage];
  const isOver = state.stage === "finished";
  byId("words").textContent = state.condition && !isOver ? `Condition: ${state.condition}. ${words}` : words;
  byId("begin").hidden = byId("begin-hint").hidden = state.stage !== "waiting" || state.wait_s > 0;
  byId("begin-hint").textContent = state.drives
    ? "This button does what “Begin” does on the participant’s page: it opens the seat there."
    : "This button does what “Begin” does on the participant’s page: the run begins at once.";
  byId("marker").hidden = state.stage !== "driving";
  const view = byId("view");
  // Before and after a run nobody answers at the address of its view.
  byId("view-line").hidden = state.view === "" || !["seating", "driving"].includes(state.stage);
  if (state.view !== "") {
    view.href = state.view;
    view.hostname = location.hostname;  // the name by which this browser knows the machine
  }
  byId("lines").replaceChildren(...state.lines.toReversed().map(({at_ms, text}) => {
    const row = document.createElement("li");
    const time = document.createElement("time");
    time.dateTime = new Date(at_ms).toISOString();
    time.textContent = new Date(at_ms).toLocaleTimeString("en-GB");
    row.append(time, text);
    return row;
  }));
}
