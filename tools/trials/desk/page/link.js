// The connection of a page to its session. When the connection breaks, the page connects again.

const RETRY_MS = 500;
const GOING_AWAY = 1001;  // code with which the server closes when its program ends
const BROKEN = "The connection is broken. This page tries again.";
const ENDED = "The program has ended. When it is started again, it prints a new address for this page.";

/** Moves the token from the address, where other people could read it, into this tab's storage. */
function takeToken() {
  const key = "fogline.trials.token";
  const token = new URLSearchParams(location.hash.replace(/^#/, "")).get("token");
  if (token) {
    sessionStorage.setItem(key, token);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem(key) ?? "";
}

/**
 * Calls onState with each state of the session, and onBroken(words) when the connection breaks or
 * the program ends.
 * @returns a function that sends an object, and returns false if there is no connection
 */
export function connect(onState, onBroken) {
  const token = takeToken();
  let socket = null;
  let over = false;
  let words = BROKEN;
  const open = () => {
    const query = token ? `?token=${encodeURIComponent(token)}` : "";
    socket = new WebSocket(`ws://${location.host}/ws${query}`);
    socket.onmessage = (event) => {
      const state = JSON.parse(event.data);
      over = state.stage === "finished";
      words = BROKEN;
      onState(state);
    };
    socket.onclose = ({code}) => {
      if (over) return;
      if (code === GOING_AWAY) words = ENDED;
      onBroken(words);
      setTimeout(open, RETRY_MS);
    };
  };
  open();
  // The next session has another token. If its address is opened in this tab, the browser does not
  // load the page again by itself, because only the fragment differs.
  addEventListener("hashchange", () => {
    if (location.hash.includes("token=")) location.reload();
  });
  return (message) => {
    if (socket.readyState !== WebSocket.OPEN) return false;
    socket.send(JSON.stringify(message));
    return true;
  };
}

/** Shows or hides a message about a problem. */
export function showProblem(text) {
  const problem = document.getElementById("problem");
  problem.textContent = text;
  problem.hidden = text === "";
}

/** "Run 2 of 3" */
export function titleOf(state) {
  return `${state.practice ? "Practice run" : "Run"} ${state.run} of ${state.of}`;
}

/** "1 min 40 s" */
export function timeInWords(time_s) {
  const [minutes, seconds] = [Math.floor(time_s / 60), time_s % 60];
  return minutes === 0 ? `${seconds} s` : `${minutes} min ${seconds} s`;
}

/** Counts a wait down, and calls onTick with the whole seconds that are left; 0 at the end. */
export function countDown(seconds, onTick) {
  const end = performance.now() + 1000 * seconds;
  const tick = () => {
    const left = Math.max(0, Math.ceil((end - performance.now()) / 1000));
    onTick(left);
    if (left === 0) clearInterval(timer);
  };
  const timer = setInterval(tick, 200);
  tick();
  return () => clearInterval(timer);
}
