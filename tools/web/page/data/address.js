// The fragment of the page's address: "#step=190" is the shown step, "#token=..." gives access.

const TOKEN = "fogline.token";

/** Returns {step, token}; step is null if the address has no step. */
export function readFragment(fragment) {
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  const step = /^\d+$/.test(parts.get("step") ?? "") ? Number(parts.get("step")) : null;
  return {step, token: parts.get("token") ?? ""};
}

/** The fragment of an address that shows a step again. */
export function fragmentOf(step, token) {
  return `#${token ? `token=${encodeURIComponent(token)}&` : ""}step=${step}`;
}

/** The other parts of a fragment, with their "#"; "" without other parts. */
export function fragmentWithoutToken(fragment) {
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  parts.delete("token");
  const rest = parts.toString();
  return rest === "" ? "" : `#${rest}`;
}

/** Moves the token from the address, where other people could read it, into this tab's storage. */
export function takeToken(hash = location.hash) {
  const {step, token} = readFragment(hash);
  if (token) {
    sessionStorage.setItem(TOKEN, token);
    history.replaceState(null, "", step === null ? location.pathname : fragmentOf(step, ""));
  }
  return sessionStorage.getItem(TOKEN) ?? "";
}
