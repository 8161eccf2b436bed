// The page for viewers: connects the server, the reader's clock, and the parts of the page.

import {fragmentOf, readFragment, takeToken} from "./data/address.js";
import {Budget} from "./draw/budget.js";
import {Catalogue} from "./data/catalogue.js";
import {Clock} from "./data/clock.js";
import {Curves} from "./parts/curves.js";
import {byId, darkScheme, reducedMotion, say, setAttribute} from "./draw/dom.js";
import {hasStopped, Health} from "./parts/health.js";
import {listenForKeys} from "./parts/keys.js";
import {LiveStore} from "./data/live_store.js";
import {LogStore} from "./data/log_store.js";
import {Now} from "./parts/now.js";
import {sayOrigin} from "./parts/origin.js";
import {Scene} from "./parts/scene.js";
import {readTheme} from "./draw/theme.js";
import {eventFrom, Timebar} from "./parts/timebar.js";
import {Why} from "./parts/why.js";
import {socketUrl, Wire} from "./data/wire.js";

const PARTS = ["scene", "why", "curves", "events-part", "health"];
const MOST_EVENTS = 5000;  // as many as the server sends of one run
const HASH_EVERY_MS = 500;
const MOST_WAIT_MS = 1000;  // for the data of the first picture of a log

class Page {
  constructor() {
    this.token = takeToken();
    this.link = readFragment(location.hash);  // the moment to go to when the first history has come
    this.clock = new Clock();
    this.theme = readTheme();
    this.scene = new Scene();
    this.now = new Now();
    this.why = new Why((time) => this.goToTime(time));
    this.curves = new Curves({onPick: (time) => this.goToTime(time), onFull: (words) => this.tell(words)});
    this.health = new Health();
    this.act = this.actions();
    this.timebar = new Timebar({...this.act, speed: (speed) => { this.clock.speed = speed; }});
    this.frame = null;
    this.budget = new Budget();
    listenForKeys(this.act);
    this.listen();
    this.wire = new Wire(socketUrl(location, this.token), {
      text: (object) => this.receive(object),
      messages: (messages) => this.take(messages),
      state: (state) => this.showConnection(state),
    });
    requestAnimationFrame((now) => this.loop(now));
  }

  /** Number of later events of the run that the server has not listed. */
  get eventsLeftOut() {
    return (this.isLive ? this.lastHealth : this.log)?.events_left_out ?? 0;
  }

  get isLive() { return this.hello?.mode === "live"; }
  /** Whether the page waits for a run. */
  get waits() { return this.isLive && this.store.lastStep < 0; }
  get run() { return this.store?.run ?? {step_s: this.store?.step_s ?? 0.1, run_id: ""}; }
  get step() {
    const step = this.clock.step(this.run.step_s);
    return this.within(step);
  }

  /** The nearest step that the store has. */
  within(step) {
    const {firstStep, lastStep} = this.store;
    return Math.max(firstStep, Math.min(step, lastStep));
  }

  listen() {
    darkScheme.addEventListener("change", () => {
      this.theme = readTheme();
      this.build();
    });
    const sizes = new ResizeObserver(() => {
      this.why.resize();
      this.curves.resize();
    });
    sizes.observe(byId("main"));
    addEventListener("hashchange", ({newURL}) => {
      // keepAddress() may have changed the address since this event. So this function uses the
      // address in the event.
      const {hash} = new URL(newURL);
      const {step, run, token} = readFragment(hash);
      if (token) this.takeToken(hash);
      else if (step !== null && this.store) this.goToLinked({step, run});
    });
    byId("parts").addEventListener("click", (event) => {
      const link = event.target.closest("a");
      if (!link) return;
      event.preventDefault();  // keeps the shown step in the fragment of the address
      this.showPart(link.getAttribute("href").slice(1));
    });
  }

  /**
   * Connects with a new token, when the reader pastes the address of a server that was started
   * again. If the address has the present token, goes to its step.
   */
  takeToken(hash) {
    this.link = readFragment(hash);
    this.token = takeToken(hash);
    const isSame = !this.wire.moveTo(socketUrl(location, this.token));
    // A live page that waits for its history opens the link after it.
    if (isSame && this.store && !this.early) this.openLink();
  }

  actions() {
    return {
      toggle: () => this.toggle(),
      step: (n) => this.goTo(this.step + n),
      jump: (direction) => this.jump(direction),
      goTo: (step) => this.goTo(step),
      begin: () => this.goTo(this.store?.firstStep ?? 0),
      end: () => this.goTo(this.store?.lastStep ?? 0),
      faster: (direction) => this.clock.changeSpeed(direction),
      live: () => { if (this.isLive) this.clock.follow(); },
      link: () => this.copyLink(),
      span: (span) => this.curves.setSpan(span),
      part: (place) => this.showPart(PARTS[place]),
    };
  }

  showPart(id) {
    byId(id).scrollIntoView({behavior: reducedMotion.matches ? "auto" : "smooth"});
    byId(id).focus({preventScroll: true});
  }

  receive(object) {
    const takers = {
      hello: () => this.begin(object),
      channel: () => { this.catalogue.add(object); this.rebuildSoon(); },
      run: () => this.setRun(object),
      log: () => this.setLog(object),
      event: () => this.addEvent(object),
      health: () => { this.lastHealth = object; this.healthIsNew = true; },
      error: () => { if (object.id == null) this.complain(object.message); },
    };
    if (Object.hasOwn(takers, object.op)) takers[object.op]();
  }

  addEvent(event) {
    const events = event.number === 0 ? [] : this.events;  // at number 0 the list begins again
    const place = events.findLastIndex(({step}) => step <= event.step) + 1;
    this.events = events.toSpliced(place, 0, event).slice(-MOST_EVENTS);
  }

  begin(hello) {
    this.hello = hello;
    Object.assign(this, {frame: null, isOver: false});
    say(byId("title"), "Waiting for a run");
    this.catalogue = new Catalogue(hello);
    this.events = [];
    this.log = null;
    this.store = this.isLive ? new LiveStore(this.catalogue)
                             : new LogStore(this.catalogue, this.wire);
    setAttribute(document.body, "data-mode", hello.mode);
    this.curves.setSpan(this.isLive ? "minute" : "all");
    if (this.isLive) {
      this.build();
      this.clock.follow();
      this.askForHistory();
    }
    this.showConnection("open");
  }

  /**
   * Asks for the history. Until the history is complete, the page only stores received messages.
   * The answer gives the number of messages in the history. Stored messages that came before the
   * history are not used.
   */
  askForHistory() {
    this.early = [];
    this.wire.ask({op: "history"}).then(({messages}) => {
      const history = messages > 0 ? this.early.slice(-messages) : [];
      this.early = null;
      this.take(history);
      this.openLink();
    }, () => { this.early = null; });
  }

  openLink() {
    const {link} = this;
    this.link = null;
    if (link && link.step !== null) this.goToLinked(link);
  }

  /**
   * Goes to a step of a link. A live page may not have this step: it keeps only one run, and only
   * the last part of a long run.
   */
  goToLinked({step, run}) {
    const {firstStep, lastStep, runId} = this.store;
    if (!this.isLive) this.goTo(step);
    else if (lastStep < 0) this.tell("There is no run yet, so the link leads nowhere.");
    else if (run && run !== String(runId)) this.tell("The link is to a moment of another run.");
    else if (step >= firstStep && step <= lastStep) this.goTo(step);
    else this.tell(`This page has the steps ${firstStep} to ${lastStep}; the link is to step ${step}.`);
  }

  take(messages) {
    if (!this.isLive) return;
    if (this.early) this.early.push(...messages);
    else for (const message of messages) this.store.add(message);
  }

  setRun(run) {
    const isNew = run.run_id !== this.store.run?.run_id;
    this.store.setRun(run);
    say(byId("title"), run.title || "A run without a title");
    // The tooltip has the whole text, because a narrow window may not show it.
    setAttribute(byId("title"), "title", run.title);
    document.title = `${run.title || "Run"} – Fogline`;
    this.length_m = run.scenario?.world?.vehicle_length_m ?? 4.5;
    // The server sends all events again, with the texts for this scenario. So the page drops the
    // events that it has.
    if (this.isLive) this.events = [];
    if (!isNew) return;
    this.isOver = false;
    this.frame = null;
    if (this.isLive) {
      this.build();
      this.clock.follow();
    }
  }

  setLog(log) {
    this.log = log;
    this.events = log.events;
    this.store.setLog(log);
    this.timebar.setRange(this.store);
    const {step} = readFragment(location.hash);
    this.clock.pause();
    this.clock.time = this.store.timeOf(step ?? log.first_step);
    this.store.frame(this.step);  // requests the step's messages before the values of the curves
    this.build();
    this.showConnection("open");
  }

  /** Makes all charts again, for another run, other channels, or other colours. */
  build() {
    if (!this.store || (!this.isLive && !this.log)) return;
    this.generation = this.store.generation;
    this.why.build(this.store, this.theme);
    this.curves.build(this.store, this.catalogue, this.theme);
    this.scene.drawn = "";
    this.timebar.drawnTrack = "";
  }

  rebuildSoon() {
    clearTimeout(this.rebuilding);
    this.rebuilding = setTimeout(() => this.build(), 100);
  }

  toggle() {
    if (this.store) this.clock.toggle(this.store.firstTime, this.store.lastTime, this.isOver);
  }

  goTo(step) {
    if (step < this.store?.firstStep) this.tell(`The data begin at step ${this.store.firstStep}.`);
    if (this.store) this.clock.goTo(this.store.timeOf(this.within(step)));
  }

  goToTime(time) {
    this.goTo(Math.round(time / this.run.step_s));
  }

  jump(direction) {
    const event = this.store && eventFrom(this.events, this.step, direction);
    if (event) this.goTo(event.step);
  }

  async copyLink() {
    if (!this.store) return;
    const run = this.isLive ? this.run.run_id : "";
    const link = new URL(fragmentOf(this.step, this.token, run), location.href).href;
    const words = `a link to step ${this.step}`;
    try {
      await navigator.clipboard.writeText(link);
      this.tell(`Copied ${words}.`);
    } catch {
      history.replaceState(null, "", fragmentOf(this.step, "", run));
      this.tell(`The address of this page is now ${words}.`);
    }
  }

  /** Shows a short note to the reader. */
  tell(words) {
    const note = byId("note");
    say(note, words);
    note.classList.add("shown");
    clearTimeout(this.noteTimer);
    this.noteTimer = setTimeout(() => note.classList.remove("shown"), 4000);
  }

  complain(message) {
    byId("problem").hidden = false;
    say(byId("problem"), message);
  }

  showConnection(state) {
    this.connection = state;
    sayOrigin(this);
    if (state === "refused") {
      if (!this.hello) for (const id of ["who", "title"]) say(byId(id), "No connection");
      this.complain("The server does not answer, or it refuses this address. Open exactly the address that it has " +
                    "printed: for other machines it contains a token. If the server has ended, start it again.");
    } else {
      byId("problem").hidden = true;
    }
  }

  loop(now) {
    requestAnimationFrame((next) => this.loop(next));
    const passed_s = Math.min(0.25, (now - (this.before ?? now)) / 1000);
    this.before = now;
    // After a new hello, the charts of the page before are there until the log or the run comes.
    if (!this.store || this.why.charts.length === 0 || !(this.isLive || this.log)) return;
    this.budget.frame(now);
    if (this.store.generation !== this.generation) this.build();
    const played = this.clock.state === "playing";
    this.clock.advance(passed_s, this.store.firstTime, this.store.lastTime);
    // If the clock has played up to the newest step of a live run, it follows the run again.
    if (this.isLive && played && this.clock.state === "paused") this.clock.follow();
    if (!this.isLive && this.waitsForFirst(now)) return;
    this.draw();
  }

  /**
   * Whether the page still waits for the data of the first picture of a log. In a browser without a
   * graphics processor a picture takes much time, so the page draws no picture without data.
   */
  waitsForFirst(now) {
    if (this.hasFirst) return false;
    this.askedAt ??= now;
    const {step} = this;
    const moment = {time: this.store.timeOf(step)};
    this.store.frame(step);
    this.why.fetch(moment);
    this.curves.fetch(moment);
    this.hasFirst = this.wire.isQuiet || now - this.askedAt > MOST_WAIT_MS;
    return !this.hasFirst;
  }

  /**
   * Simulated time since the shown step, in s. The page draws the cars as if they had driven on for
   * this time at their last speeds.
   */
  aheadOf(step) {
    const [{state}, {step_s, pace}] = [this.clock, this.run];
    if (reducedMotion.matches || state === "paused" || (state === "live" && this.isOver)) return 0;
    const ahead_s = state === "live"
      ? ((performance.now() - this.store.taken_ms) / 1000) * (pace || 0)
      : this.clock.time - this.store.timeOf(step);
    return Math.min(step_s, Math.max(0, ahead_s));
  }

  draw() {
    const {clock, store, run, theme, step} = this;
    const frame = store.frame(step);
    if (frame) {
      this.frame = frame;
      this.frameStep = step;
    }
    // Until the messages of a step have come, all parts except the time bar show the last step with
    // messages.
    const shown = this.frame ? this.frameStep : step;
    const time = store.timeOf(shown);
    const {modes, lambdas} = this.why;
    const moment = {frame: this.frame, step: shown, time, run, theme, length_m: this.length_m, isLive: this.isLive, hello: this.hello,
                    isOver: this.isOver && shown >= store.lastStep, ahead_s: frame ? this.aheadOf(step) : 0, moves: clock.state === "playing" || (clock.state === "live" && !this.isOver)};
    sayOrigin(this);
    const {rest_ms} = this.budget.now;
    moment.side = this.now.draw(moment, modes, lambdas);
    this.scene.draw(moment, this.budget.now);
    this.why.draw(moment, rest_ms);
    this.curves.draw(moment, 2 * rest_ms);
    this.timebar.draw({clock, store, step, time: store.timeOf(step), run, isLive: this.isLive, isOver: this.isOver}, modes, lambdas,
                      this.events, theme);
    this.timebar.drawEvents(this.events, step, run, this.eventsLeftOut);
    this.drawHealth();
    const isThere = this.isLive || (frame && this.curves.isCurrent);
    if (isThere && this.wire.isQuiet) this.scene.loadView();
    this.keepAddress(step);
    setAttribute(document.body, "data-step", String(this.frameStep ?? ""));
  }

  drawHealth() {
    if (this.isLive && this.healthIsNew) {
      this.healthIsNew = false;
      const {store} = this;
      this.isOver = Boolean(store.frame(store.lastStep)?.TRUTH?.last) || hasStopped(this.lastHealth, store.run);
      this.health.drawLive(this.lastHealth, store.run, store.statuses, this.isOver);
    }
    if (!this.isLive && this.log && this.healthLog !== this.log) {
      this.healthLog = this.log;
      this.health.drawLog(this.log, this.run);
    }
  }

  /** Keeps the shown step of a log in the address, so that a reload shows the same step. */
  keepAddress(step) {
    if (this.isLive || this.clock.state !== "paused" || step === this.keptStep) return;
    const now = performance.now();
    if (now - (this.keptAt ?? 0) < HASH_EVERY_MS) return;
    this.keptAt = now;
    this.keptStep = step;
    history.replaceState(null, "", fragmentOf(step, ""));
  }
}

window.foglinePage = new Page();
