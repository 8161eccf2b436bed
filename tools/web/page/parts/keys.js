// The keyboard: the effect of each key, and the overlay that lists the keys.

import {byId, make} from "../draw/dom.js";

const TEN = 10;

/** The keys in the order of the overlay: [{keys, shown, words, does(act, event)}]. */
const KEYS = [
  {keys: [" "], shown: "Space", words: "play or pause", does: (act) => act.toggle()},
  {keys: ["ArrowLeft"], shown: "←", words: "one step back (with Shift: ten)",
   does: (act, {shiftKey}) => act.step(shiftKey ? -TEN : -1)},
  {keys: ["ArrowRight"], shown: "→", words: "one step forward (with Shift: ten)",
   does: (act, {shiftKey}) => act.step(shiftKey ? TEN : 1)},
  {keys: [","], shown: ",", words: "to the previous event", does: (act) => act.jump(-1)},
  {keys: ["."], shown: ".", words: "to the next event", does: (act) => act.jump(1)},
  {keys: ["Home"], shown: "Home", words: "to the beginning", does: (act) => act.begin()},
  {keys: ["End"], shown: "End", words: "to the end", does: (act) => act.end()},
  {keys: ["+", "="], shown: "+", words: "play faster", does: (act) => act.faster(1)},
  {keys: ["-"], shown: "−", words: "play slower", does: (act) => act.faster(-1)},
  {keys: ["l"], shown: "L", words: "follow the live run", does: (act) => act.live()},
  {keys: ["/"], shown: "/", words: "find a field for the curves",
   does: () => byId("field-search").focus()},
  {keys: ["m"], shown: "M", words: "curves of the last minute", does: (act) => act.span("minute")},
  {keys: ["a"], shown: "A", words: "curves of the whole time", does: (act) => act.span("all")},
  {keys: ["1", "2", "3", "4", "5"], shown: "1 – 5", words: "to scene, why, curves, events, health",
   does: (act, {key}) => act.part(Number(key) - 1)},
  {keys: ["c"], shown: "C", words: "copy a link to this moment", does: (act) => act.link()},
  {keys: ["?"], shown: "?", words: "show or hide this list", does: () => toggleHelp()},
];

export function toggleHelp() {
  const help = byId("help");
  if (help.open) help.close();
  else help.showModal();
}

/** Whether the element itself needs the key. */
function needsKey(element, key) {
  if (element.matches("input:not([type=range]), select, textarea")) return true;
  return key === " " && element.matches("button, a, summary");
}

export function listenForKeys(act) {
  byId("keys").replaceChildren(...KEYS.map(({shown, words}) => make("div", {},
    make("dt", {}, make("kbd", {}, shown)), make("dd", {}, words))));
  byId("help-open").addEventListener("click", toggleHelp);
  byId("help-close").addEventListener("click", toggleHelp);
  addEventListener("keydown", (event) => {
    const {key, target, ctrlKey, altKey, metaKey} = event;
    if (ctrlKey || altKey || metaKey || needsKey(target, key)) return;
    const wanted = key.length === 1 ? key.toLowerCase() : key;
    const found = KEYS.find(({keys}) => keys.includes(wanted));
    if (!found || (byId("help").open && wanted !== "?")) return;
    event.preventDefault();
    found.does(act, event);
  });
}
