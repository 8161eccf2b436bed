// The connection to the seat by the protocol fogline.drive.v1 (docs/view.md).

import {fragmentWithoutToken, readFragment} from "../data/address.js";
import {GOING_AWAY, readFrame} from "../data/wire.js";

const PROTOCOL = "fogline.drive.v1";
const TOKEN = "fogline.drive.token";
const RETRY_MS = 1000;  // delay after the connection was lost

/**
 * Takes the driver's token out of the address, where other people could read it, and stores it for
 * this tab. The view has a different token. A reload needs the other parts of the address, so they
 * stay.
 */
export function takeDriverToken() {
  const {token} = readFragment(location.hash);
  if (token) {
    sessionStorage.setItem(TOKEN, token);
    const rest = fragmentWithoutToken(location.hash);
    history.replaceState(null, "", location.pathname + rest);
  }
  return sessionStorage.getItem(TOKEN) ?? "";
}

/**
 * Keeps a connection to the seat. It calls `on.text(object)`, `on.messages(messages)`, and
 * `on.state(state)` with "open", "ended", "lost" or "refused". The state is "ended" if the server
 * has said that its program ends, and there is no new connection yet. It is "refused" if there
 * never was a connection.
 */
export class SeatWire {
  constructor(url, on) {
    this.url = url;
    this.on = on;
    this.wasOpen = false;
    this.hasEnded = false;
    this.connect();
  }

  get isOpen() { return this.socket.readyState === WebSocket.OPEN; }

  connect() {
    clearTimeout(this.retry);
    this.socket = new WebSocket(this.url, [PROTOCOL]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.wasOpen = true;
      this.hasEnded = false;
      this.on.state("open");
    };
    this.socket.onmessage = ({data}) => {
      if (typeof data === "string") this.on.text(JSON.parse(data));
      else this.on.messages(readFrame(data).messages ?? []);
    };
    this.socket.onclose = ({code}) => {
      this.hasEnded ||= code === GOING_AWAY;
      this.on.state(this.hasEnded ? "ended" : this.wasOpen ? "lost" : "refused");
      this.retry = setTimeout(() => this.connect(), RETRY_MS);
    };
  }

  /** Connects again, to the old address or to one with a new token. */
  again(url) {
    this.url = url;
    const {socket} = this;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    this.connect();
  }

  send(object) {
    this.socket.send(JSON.stringify(object));
  }
}
