// The channels and types that the server has described. The catalogue finds channels, decodes
// messages, and lists fields.

import {DecodeError, fieldsOf, fingerprintOf, makeDecoder} from "./lcm.js";

const FOGLINE_HEADER = "header_t";
const CONTROL = new Set(["RUN", "STATUS", "RESEND", "DRIVER_INPUT", "TRIAL"]);  // not in every step
const OF_EACH_ROLE = "STATUS";  // the messages of each role are a separate series
// Offsets in bytes of run_id, step and utime, and of the end of header_t, in a message that begins
// with header_t.
const AT = {run_id: 8, step: 16, utime: 24, end: 32};

export class Catalogue {
  constructor({types, fingerprints, channels, roles}) {
    this.types = types;
    this.roles = roles ?? [];
    this.fingerprints = fingerprints ?? {};
    this.channels = new Map();
    this.decoders = new Map();
    this.undecodable = 0;
    for (const channel of channels) this.add(channel);
  }

  add({id, name, type, from, what}) {
    const known = type != null && Object.hasOwn(this.types, type);
    const hasHeader = known && this.types[type].members[0]?.type === FOGLINE_HEADER;
    const channel = {id, name, type, from: from ?? "", what: what ?? "", known, hasHeader,
                     isStepwise: hasHeader && !CONTROL.has(name)};
    this.channels.set(id, channel);
    return channel;
  }

  named(name) {
    for (const channel of this.channels.values()) if (channel.name === name) return channel;
    return null;
  }

  decoder(type) {
    if (!this.decoders.has(type)) this.decoders.set(type, makeDecoder(this.types, type));
    return this.decoders.get(type);
  }

  /** The decoded message; null if the bytes are not a message of the channel's type. */
  decode(channel, bytes) {
    if (!channel?.known) return null;
    const expected = this.fingerprints[channel.type];
    try {
      if (expected && fingerprintOf(bytes) !== expected) throw new DecodeError("another type");
      return this.decoder(channel.type)(bytes);
    } catch (problem) {
      if (!(problem instanceof DecodeError) && !(problem instanceof RangeError)) throw problem;
      ++this.undecodable;
      return null;
    }
  }

  /**
   * All numeric fields of the messages with a header: [{channel, path, name, unit, comment,
   * isStepwise}]. name is "CHANNEL.path". channel is "CHANNEL/ROLE" if each role sends messages on
   * the channel.
   */
  fields() {
    return [...this.channels.values()].filter(({hasHeader}) => hasHeader)
      .flatMap((channel) => this.sourcesOf(channel).flatMap((source) => (
        fieldsOf(this.types, channel.type).map((field) => (
          {...field, channel: source, name: `${source}.${field.path}`,
           isStepwise: channel.isStepwise})))));
  }

  sourcesOf({name}) {
    return name === OF_EACH_ROLE ? this.roles.map((role) => `${name}/${role}`) : [name];
  }
}

/** Run, step and simulated time (s) in a message's header; null if the message is too short. */
export function headerOf(bytes) {
  if (bytes.byteLength < AT.end) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  return {run_id: view.getBigInt64(AT.run_id), step: Number(view.getBigInt64(AT.step)),
          time_s: Number(view.getBigInt64(AT.utime)) / 1e6};
}

/**
 * The fields that fit the text that the reader typed, the best first. Each word must occur in the
 * field's name, comment or unit. A word in the name counts more than one in the comment or unit.
 */
export function searchFields(fields, typed, most) {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const weigh = ({name, comment, unit}) => {
    const low = name.toLowerCase();
    let weight = low.length / 1000 + (low.includes(".header.") ? 10 : 0);
    for (const word of words) {
      const place = low.indexOf(word);
      if (place >= 0) weight += /[./_]/.test(low[place - 1] ?? ".") ? 0 : 1;
      else if (`${comment} ${unit}`.toLowerCase().includes(word)) weight += 3;
      else return Infinity;
    }
    return weight;
  };
  return fields.map((field) => ({field, weight: weigh(field)}))
    .filter(({weight}) => weight < Infinity)
    .sort((a, b) => a.weight - b.weight)
    .slice(0, most)
    .map(({field}) => field);
}
