// The experimenter's page: the condition, the events, and the markers.
import {connect, countDown, showProblem, timeInWords, titleOf} from "./link.js";

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
let stopCount = () => {};
let counted = "";  // the state whose words the page shows
let pending = null;  // the marker that was sent last, until it is in the list: {text, after_ms}
let refusal = "";    // shown until the page sends its next message, or the next run begins

const send = connect(show, showProblem);

byId("begin").onclick = () => {
  pending = null;
  refusal = "";
  send({op: "begin", state: last.state});
};
byId("marker").onsubmit = (event) => {
  event.preventDefault();
  const text = byId("marker-text").value.trim();
  refusal = "";
  if (send({op: "marker", text})) pending = {text, after_ms: last.lines.at(-1)?.at_ms ?? 0};
};

/** Empties the field of the marker when the marker is in the list. */
function takePending({lines}) {
  const isSaved = ({text, at_ms}) => text === `marker: ${pending?.text}` && at_ms > pending.after_ms;
  if (!lines.some(isSaved)) return;
  const input = byId("marker-text");
  if (input.value.trim() === pending.text) input.value = "";
  pending = null;
}

/**
 * Stores the reason of a refusal. When a run begins, deletes the reason and the marker of the
 * previous run.
 */
function keepRefusal({refused, stage}) {
  if (refused) refusal = `${pending ? `The marker “${pending.text}” was not saved` : "This had no effect"}: ${refused}.`;
  if (stage !== "driving" || last.stage === "driving") return;
  refusal = byId("marker-text").value = "";
  pending = null;
}

/** Shows the condition and the present stage. In a break, counts the remaining time down. */
function showWords(state) {
  counted = `${state.state} ${state.stage}`;
  stopCount();
  const condition = state.condition && state.stage !== "finished" ? `Condition: ${state.condition}. ` : "";
  stopCount = countDown(state.stage === "waiting" ? state.wait_s : 0, (left) => {
    const words = left > 0 ? `The participant has a break, for ${timeInWords(left)} more.` : WORDS[state.stage];
    byId("words").textContent = condition + words;
  });
}

function show(state) {
  takePending(state);
  keepRefusal(state);
  last = state;
  showProblem(refusal);
  byId("title").textContent = `Participant ${state.participant}, ${titleOf(state).toLowerCase()}`;
  if (counted !== `${state.state} ${state.stage}`) showWords(state);
  byId("begin").hidden = byId("begin-hint").hidden = state.stage !== "waiting" || state.wait_s > 0;
  byId("begin-hint").textContent = state.drives
    ? "This button does what “Begin” does on the participant’s page: it opens the seat there."
    : "This button does what “Begin” does on the participant’s page: the run begins at once.";
  byId("marker").hidden = state.stage !== "driving";
  const view = byId("view");
  // Before and after a run, no server answers at the address of the view.
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
