// Values of one field over time, in columns that grow.

import {upTo} from "./modes.js";

let versions = 0;  // the newest version number of all series

/**
 * Columns of values, with NaN where the series `valid` is 0. At these times the sensor has no
 * value.
 */
export function whereValid({times, values}, valid) {
  return {times, values: values.map((value, i) => valid.at(times[i]) ? value : NaN)};
}

export class Series {
  constructor(times = new Float64Array(256), values = new Float64Array(256), n = 0) {
    this.allTimes = times;
    this.allValues = values;
    this.from = 0;
    this.to = n;
    this.version = ++versions;  // no other state of any series has this number
    this.whole = true;  // whether it has every value, and not only the extremes of each span
  }

  get times() { return this.allTimes.subarray(this.from, this.to); }
  get values() { return this.allValues.subarray(this.from, this.to); }
  get length() { return this.to - this.from; }

  push(time, value) {
    if (this.to === this.allTimes.length) this.makeRoom();
    this.allTimes[this.to] = time;
    this.allValues[this.to++] = value;
    this.version = ++versions;
  }

  makeRoom() {
    const capacity = Math.max(256, 2 * this.length);
    const grow = (column) => {
      const larger = new Float64Array(capacity);
      larger.set(column.subarray(this.from, this.to));
      return larger;
    };
    this.allTimes = grow(this.allTimes);
    this.allValues = grow(this.allValues);
    this.to = this.length;
    this.from = 0;
  }

  /** Forgets the values before a time. */
  forgetBefore(time) {
    while (this.from < this.to && this.allTimes[this.from] < time) ++this.from;
  }

  /** Forgets all but the last n values. */
  keepLast(n) { this.from = Math.max(this.from, this.to - n); }

  replace({times, values}) {
    this.allTimes = times;
    this.allValues = values;
    this.from = 0;
    this.to = times.length;
    this.version = ++versions;
  }

  /** The times in [from, to] and their values; also one more value before and one more after. */
  within(from, to) {
    const begin = Math.max(0, upTo(this.times, from));
    const end = Math.min(this.length, upTo(this.times, to) + 2);
    return {times: this.times.subarray(begin, end), values: this.values.subarray(begin, end)};
  }

  /** The last value at or before a time; NaN before the first value. */
  at(time) {
    const place = upTo(this.times, time);
    return place < 0 ? NaN : this.values[place];
  }
}
