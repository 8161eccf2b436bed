// The fragment of the page's address. "#step=190" is the shown step. "#run=..." is the id of its
// run in a live view. "#token=..." gives access.

const TOKEN = "fogline.token";

/** Returns {step, run, token}; step is null, and run and token are "", if the address has none. */
export function readFragment(fragment) {
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  const step = /^\d+$/.test(parts.get("step") ?? "") ? Number(parts.get("step")) : null;
  return {step, run: parts.get("run") ?? "", token: parts.get("token") ?? ""};
}

/**
 * The fragment of an address that shows this step.
 * @param run the id of a live run; "": the step is of a log
 */
export function fragmentOf(step, token, run = "") {
  const parts = Object.entries({token, run}).filter(([, value]) => value)
    .map(([name, value]) => `${name}=${encodeURIComponent(value)}&`);
  return `#${parts.join("")}step=${step}`;
}

/** All parts of a fragment except the token, with a "#" before them; "" if there are none. */
export function fragmentWithoutToken(fragment) {
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  parts.delete("token");
  const rest = parts.toString();
  return rest === "" ? "" : `#${rest}`;
}

/** Moves the token from the address, where other people could read it, into this tab's storage. */
export function takeToken(hash = location.hash) {
  const {step, run, token} = readFragment(hash);
  if (token) {
    sessionStorage.setItem(TOKEN, token);
    history.replaceState(null, "", step === null ? location.pathname : fragmentOf(step, "", run));
  }
  return sessionStorage.getItem(TOKEN) ?? "";
}
