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
let marked = "";  // the marker that was sent last, until the session has taken it

const send = connect(show, showProblem);

byId("begin").onclick = () => send({op: "begin", state: last.state});
byId("marker").onsubmit = (event) => {
  event.preventDefault();
  const input = byId("marker-text");
  const text = input.value.trim();
  if (!send({op: "marker", text})) return;
  marked = text;
  input.value = "";
};

function show(state) {
  last = state;
  if (state.lines.some(({text}) => text === `marker: ${marked}`)) marked = "";
  if (state.refused && byId("marker-text").value === "") byId("marker-text").value = marked;
  const what = marked === "" ? "This had no effect" : "The marker was not saved";
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
