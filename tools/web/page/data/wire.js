// The connection to the server by the protocol fogline.view.v1 (docs/view.md). It decodes no LCM
// message.

const PROTOCOL = "fogline.view.v1";
const RETRY_MS = {first: 1000, then: 2000};  // delay before a new attempt to connect
export const GOING_AWAY = 1001;  // code with which the server closes when its program ends

const KIND = {messages: 1, steps: 2, series: 3};

/** Reads a frame of kind 1: {messages: [{channel, arrived_ms, bytes}]}, in the order of arrival. */
function readMessages(view, buffer) {
  const messages = [];
  for (let at = 1; at < buffer.byteLength;) {
    const length = view.getUint32(at + 10, true);
    messages.push({channel: view.getUint16(at, true), arrived_ms: view.getFloat64(at + 2, true),
                   bytes: new Uint8Array(buffer, at + 14, length)});
    at += 14 + length;
  }
  return {messages};
}

/** Reads a frame of kind 2: {id, messages: [{channel, step, bytes}]}. */
function readSteps(view, buffer) {
  const messages = [];
  for (let at = 5; at < buffer.byteLength;) {
    const length = view.getUint32(at + 10, true);
    messages.push({channel: view.getUint16(at, true), step: Number(view.getBigInt64(at + 2, true)),
                   bytes: new Uint8Array(buffer, at + 14, length)});
    at += 14 + length;
  }
  return {id: view.getUint32(1, true), messages};
}

/** Reads a frame of kind 3: {id, whole, times, values}. */
function readSeries(view, buffer) {
  const n = view.getUint32(6, true);
  const times = new Float64Array(n);
  const values = new Float64Array(n);
  for (let i = 0; i < n; ++i) {
    times[i] = view.getFloat64(10 + 8 * i, true);
    values[i] = view.getFloat64(10 + 8 * (n + i), true);
  }
  return {id: view.getUint32(1, true), whole: view.getUint8(5) === 1, times, values};
}

/**
 * Reads a binary frame: {kind, ...}. Throws a RangeError if the lengths in the frame do not fit.
 */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  const kind = view.getUint8(0);
  if (kind === KIND.messages) return {kind: "messages", ...readMessages(view, buffer)};
  if (kind === KIND.steps) return {kind: "steps", ...readSteps(view, buffer)};
  if (kind === KIND.series) return {kind: "series", ...readSeries(view, buffer)};
  return {kind: "unknown"};
}

/** The address of the server's WebSocket for this page. */
export function socketUrl(location, token) {
  const query = token ? `?token=${encodeURIComponent(token)}` : "";
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws${query}`;
}

/**
 * Keeps a connection to the server. It calls `on.text(object)`, `on.messages(messages)`, and
 * `on.state(state)` with one of four states:
 * "open": there is a connection;
 * "ended": the server has said that its program ends, and there is no new connection yet;
 * "lost": the connection was lost;
 * "refused": there never was a connection.
 * ask() sends a question, and returns a promise of the answer. The promise is rejected if the
 * server answers with an error, or the connection is lost.
 */
export class Wire {
  constructor(url, on) {
    this.url = url;
    this.on = on;
    this.waiting = new Map();
    this.next = 1;
    this.retry_ms = RETRY_MS.first;
    this.wasOpen = false;
    this.hasEnded = false;
    this.connect();
  }

  connect() {
    this.socket = new WebSocket(this.url, [PROTOCOL]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.retry_ms = RETRY_MS.first;
      this.wasOpen = true;
      this.hasEnded = false;
      this.on.state("open");
    };
    this.socket.onmessage = ({data}) => this.receive(data);
    this.socket.onclose = ({code}) => this.lose(code);
  }

  /**
   * Connects to another address, such as an address with a new token.
   * @return false if the address is the present one
   */
  moveTo(url) {
    if (url === this.url) return false;
    this.url = url;
    clearTimeout(this.retrying);
    this.retry_ms = RETRY_MS.first;
    const old = this.socket;
    old.onopen = old.onmessage = old.onclose = null;
    old.close();
    this.rejectAll();
    this.connect();
    return true;
  }

  rejectAll() {
    for (const {reject} of this.waiting.values()) reject(new Error("the connection was lost"));
    this.waiting.clear();
  }

  lose(code) {
    this.rejectAll();
    this.hasEnded ||= code === GOING_AWAY;
    this.on.state(this.hasEnded ? "ended" : this.wasOpen ? "lost" : "refused");
    this.retrying = setTimeout(() => this.connect(), this.retry_ms);
    this.retry_ms = RETRY_MS.then;
  }

  /** Whether all questions have their answers. */
  get isQuiet() { return this.waiting.size === 0; }

  ask(question) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      if (this.socket.readyState !== WebSocket.OPEN) {
        reject(new Error("there is no connection"));
        return;
      }
      this.waiting.set(id, {resolve, reject});
      this.socket.send(JSON.stringify({...question, id}));
    });
  }

  answer(id, settle) {
    const waiting = this.waiting.get(id);
    this.waiting.delete(id);
    if (waiting) settle(waiting);
  }

  receive(data) {
    if (typeof data === "string") {
      this.receiveText(JSON.parse(data));
      return;
    }
    const frame = readFrame(data);
    if (frame.kind === "messages") this.on.messages(frame.messages);
    else this.answer(frame.id, ({resolve}) => resolve(frame));
  }

  receiveText(object) {
    if (object.op === "history") this.answer(object.id, ({resolve}) => resolve(object));
    if (object.op === "error" && object.id != null) {
      this.answer(object.id, ({reject}) => reject(new Error(object.message)));
    }
    this.on.text(object);
  }
}
