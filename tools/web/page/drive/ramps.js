// Arrow keys as pedals. A key is only down or up, so each pedal follows its key at a constant rate
// (a ramp). The ramp begins with a jump: the pedal moves at once as far as it otherwise moves in
// FIRST_S. So the page can send the change at once. This file does not use the document.

// Rates before the page knows the scenario: the defaults of /person/key_press_ps and
// key_release_ps.
const RATES = {press_ps: 1.5, release_ps: 4};

// Time in s. When a key is pressed or released, its pedal moves at once as far as it otherwise
// moves in this time. Our choice: for a pressed key this is 3 % of the pedal's travel
// (RATES.press_ps x FIRST_S), and a person does not feel this. FIRST_S equals step_s of
// scenario/drive.json.
export const FIRST_S = 0.02;

// Between two calls of advance(), a held key moves its pedal for at most this time. If more time
// has passed, the page has paused. The limit is more than ten times LOOK_EVERY_MS (sender.js).
const MOST_PASSED_S = 0.1;

/**
 * The rates of a scenario: shares of a pedal's travel per second while its key is down, and while
 * its key is up.
 */
export function ratesOf(scenario) {
  const {key_press_ps: press_ps, key_release_ps: release_ps} = scenario?.person ?? {};
  return press_ps > 0 && release_ps > 0 ? {press_ps, release_ps} : RATES;
}

export class Ramps {
  constructor(rates = RATES) {
    this.rates = rates;
    this.held = {throttle: false, brake: false};
    this.value = {throttle: 0, brake: 0};
    this.at_ms = null;
  }

  /** @param pedal "throttle" or "brake" */
  hold(pedal, down, now_ms) {
    this.advance(now_ms);
    this.held[pedal] = down;
    this.move(FIRST_S);
  }

  /** Releases both keys and both pedals at once, because no person is at the keyboard. */
  drop() {
    this.held = {throttle: false, brake: false};
    this.value = {throttle: 0, brake: 0};
  }

  follow(pedal, down, passed_s) {
    const moved = down ? this.value[pedal] + this.rates.press_ps * passed_s
                       : this.value[pedal] - this.rates.release_ps * passed_s;
    this.value[pedal] = Math.min(1, Math.max(0, moved));
  }

  /**
   * Moves the pedals up to this time. The brake has priority: while the key of the brake is down,
   * the throttle goes back, because a driver has one foot for both pedals.
   * @return {throttle, brake} in [0, 1]
   */
  advance(now_ms) {
    const passed_s = Math.min(MOST_PASSED_S, Math.max(0, now_ms - (this.at_ms ?? now_ms)) / 1000);
    this.at_ms = now_ms;
    this.move(passed_s);
    return {...this.value};
  }

  move(passed_s) {
    this.follow("throttle", this.held.throttle && !this.held.brake, passed_s);
    this.follow("brake", this.held.brake, passed_s);
  }
}
