// The sounds of the page, by WebAudio: no file is loaded. A browser lets a page make sounds only
// after the person has pressed something on the page.

// Tones in Hz and times in s. We chose two alternating tones, because a person hears them even in
// noise, and even if the person hears one of them badly. The urgent request is faster and higher.
const REQUEST = {tones: [660, 880], tone_s: 0.14, every_s: 0.9, gain: 0.25};
const URGENT = {tones: [880, 1175], tone_s: 0.1, every_s: 0.35, gain: 0.35};
const CHANGE = {tones: [523], tone_s: 0.15, gain: 0.15};
const EDGE_S = 0.01;  // a tone that begins or ends suddenly would click

export class Alarm {
  constructor() {
    this.context = null;
    this.nextAt = 0;
    this.played = 0;   // number of tones so far
  }

  /** Call this when the person presses something. */
  allow() {
    if (!window.AudioContext) return;
    this.context ??= new AudioContext();
    this.context.resume();
  }

  get isAllowed() { return this.context?.state === "running"; }

  /**
   * Call this in each frame.
   * @param asks whether there is a request to take over
   * @param urgent whether the request is urgent
   */
  sound({asks, urgent}) {
    if (!asks) {
      this.nextAt = 0;
      return;
    }
    const kind = urgent ? URGENT : REQUEST;
    const now = this.context?.currentTime ?? 0;
    if (!this.isAllowed || now < this.nextAt) return;
    this.nextAt = now + kind.every_s;
    this.play(kind);
  }

  /**
   * Plays the sound for a change of the side that drives. The person can test the volume with this
   * sound, too.
   */
  change() {
    if (this.isAllowed) this.play(CHANGE);
  }

  play({tones, tone_s, gain}) {
    const begin = this.context.currentTime;
    tones.forEach((tone, i) => {
      const oscillator = this.context.createOscillator();
      const loudness = this.context.createGain();
      const from = begin + i * tone_s;
      oscillator.frequency.value = tone;
      loudness.gain.setValueAtTime(0, from);
      loudness.gain.linearRampToValueAtTime(gain, from + EDGE_S);
      loudness.gain.setValueAtTime(gain, from + tone_s - EDGE_S);
      loudness.gain.linearRampToValueAtTime(0, from + tone_s);
      oscillator.connect(loudness).connect(this.context.destination);
      oscillator.start(from);
      oscillator.stop(from + tone_s);
      ++this.played;
    });
  }
}
