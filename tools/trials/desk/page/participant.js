// The participant's page: the next run, and the questions after it.
import {connect, countDown, showProblem, timeInWords, titleOf} from "./link.js";

const byId = (id) => document.getElementById(id);
let shown = -1;  // number of the state that the page shows
let stopCount = () => {};

/** Says that the connection is gone. Answers that are not sent yet stay in the form. */
function onBroken(words) {
  showProblem(byId("questions").hidden ? words : `${words} Your answers stay here.`);
}

const send = connect(show, onBroken);
let refused = -1;  // number of the state in which the session has refused a message

/** The element with these attributes and children. */
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

function scaleOf(item, index) {
  const steps = Math.round((item.max - item.min) / item.step);
  const marks = [];
  for (let i = 0; i <= steps; ++i) {
    // The value is rounded to 12 digits, because in binary 0.1 + 0.2 is not exactly 0.3. A value that
    // is only a rounding error is 0. The last mark is set to the end of the scale, because a rounded
    // step, such as 0.1428571429, does not divide the scale exactly.
    const sum = item.min + i * item.step;
    const rounded = Math.abs(sum) < 1e-6 * item.step ? 0 : Number(sum.toPrecision(12));
    const value = String(i === steps ? item.max : rounded);
    marks.push(make("label", {},
      make("input", {type: "radio", name: `item-${index}`, value}), value));
  }
  return [
    make("div", {class: "ends", id: `ends-${index}`}, ...[[item.min, item.low], [item.max, item.high]]
      .map(([mark, words]) => make("span", {}, words === "" ? "" : `${mark}: ${words}`))),
    make("div", {class: "scale"}, ...marks),
    make("p", {class: "missing", id: `missing-${index}`, hidden: ""}, "Please choose an answer."),
  ];
}

function questionOf(item, index) {
  const legend = make("legend", {}, item.text);
  if (item.kind === "text") {
    legend.append(" ", make("span", {class: "hint"}, "(optional)"));
    return make("fieldset", {}, legend,
      make("textarea", {name: `item-${index}`, rows: "3", maxlength: "120", "aria-label": item.text}));
  }
  return make("fieldset", {role: "radiogroup", "aria-required": "true", "aria-describedby": `ends-${index}`}, legend, ...scaleOf(item, index));
}

/** Shows below a scale whether its answer is missing. */
function markMissing(scale, isMissing) {
  const words = scale.querySelector(".missing");
  scale.setAttribute("aria-invalid", String(isMissing));
  const {id} = scale.querySelector(".ends");
  scale.setAttribute("aria-describedby", isMissing ? `${words.id} ${id}` : id);
  words.hidden = !isMissing;
}

/**
 * Whether each scale has an answer. Text may be missing. Marks the scales without an answer, and
 * moves the focus to the first of them. The inputs have no attribute `required`, because the
 * browser's own message would cover the scale.
 */
function hasAllAnswers(form) {
  const scales = [...form.querySelectorAll("[role=radiogroup]")];
  const missing = scales.filter((scale) => !scale.querySelector(":checked"));
  for (const scale of scales) markMissing(scale, missing.includes(scale));
  if (missing.length === 0) return true;
  missing[0].querySelector("input").focus({preventScroll: true});
  missing[0].scrollIntoView({block: "center"});
  return false;
}

function showQuestions(state) {
  const form = byId("questions");
  form.replaceChildren(...state.items.map(questionOf), make("button", {type: "submit"}, "Next"));
  form.onchange = ({target}) => {
    const scale = target.closest("[role=radiogroup]");
    if (scale) markMissing(scale, false);
  };
  form.onsubmit = (event) => {
    event.preventDefault();
    if (!hasAllAnswers(form)) return;
    refused = -1;
    const data = new FormData(form);
    const values = state.items.map((_, i) =>
      String(data.get(`item-${i}`) ?? "").replace(/\s+/g, " ").trim());
    if (!send({op: "answers", state: state.state, values})) {
      onBroken("The connection is broken. This page tries again.");
    }
  };
}

function showWait(state) {
  const button = byId("begin");
  button.onclick = () => send({op: "begin", state: state.state});
  stopCount = countDown(state.wait_s, (left) => {
    button.disabled = state.wait_s > 0;
    byId("words").textContent = state.wait_s > 0 ? `You have a break. It ends in ${timeInWords(left)}.`
      : state.drives ? "You drive in this run. “Begin” opens the seat, and the run begins when you are ready there."
      : "Begin when you are ready.";
  });
}

/** Opens the seat in this tab. After the run the seat opens this page again. */
function goToSeat(address) {
  const seat = new URL(address);
  seat.hostname = location.hostname;  // the name by which this browser knows the machine
  seat.hash += `&back=${encodeURIComponent(location.origin + location.pathname)}`;
  location.replace(seat);
}

/** The text above buttons and questions; "" before a run, when showWait() writes the text. */
function wordsOf({stage, drives}) {
  if (stage === "finished") return "Thank you. Please tell the experimenter that you are done.";
  if (stage === "asking") return "Please answer about the run that has just ended.";
  if (stage === "seating" || stage === "ended" || (stage === "driving" && drives)) return "Please wait.";
  return stage === "driving" ? "The run is under way." : "";
}

function show(state) {
  if (state.refused) {
    console.warn(state.refused);
    refused = state.state;
  }
  showProblem(state.state === refused ? "This was not taken. Please try again, or tell the experimenter." : "");
  if (state.state === shown) return;
  shown = state.state;
  stopCount();
  byId("title").textContent = state.stage === "finished" ? "That was the last run"
    : state.stage === "starting" ? "Please wait" : titleOf(state);
  byId("words").textContent = wordsOf(state);
  byId("begin").hidden = state.stage !== "waiting";
  byId("questions").hidden = state.stage !== "asking";
  if (state.stage === "waiting") showWait(state);
  if (state.stage === "asking") {
    showQuestions(state);
    byId("title").focus();
    scrollTo(0, 0);
  }
  if (state.seat) goToSeat(state.seat);
}
