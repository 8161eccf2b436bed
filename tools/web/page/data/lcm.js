// Decodes LCM messages by the description of their types, which the server sends in `hello`: {TYPE:
// {constants: {NAME: number}, members: [{name, type, dims: [number or name], ...}]}}. The decoder
// makes no code from text, because the page's content security policy forbids this.

const FINGERPRINT_BYTES = 8;
const MOST_DEPTH = 16;  // limit for types within types; sensible descriptions are less deep

const PRIMITIVES = {
  int8_t: {bytes: 1, read: (view, at) => view.getInt8(at)},
  byte: {bytes: 1, read: (view, at) => view.getUint8(at)},
  boolean: {bytes: 1, read: (view, at) => view.getUint8(at) !== 0},
  int16_t: {bytes: 2, read: (view, at) => view.getInt16(at)},
  int32_t: {bytes: 4, read: (view, at) => view.getInt32(at)},
  int64_t: {bytes: 8, read: (view, at) => plainInteger(view.getBigInt64(at))},
  float: {bytes: 4, read: (view, at) => view.getFloat32(at)},
  double: {bytes: 8, read: (view, at) => view.getFloat64(at)},
};

/** Thrown for a message that does not fit its type. */
export class DecodeError extends Error {}

/** An integer as a number if a number can hold it exactly, otherwise as a BigInt. */
function plainInteger(value) {
  const number = Number(value);
  return Number.isSafeInteger(number) ? number : value;
}

function claim(reader, bytes) {
  if (reader.at + bytes > reader.view.byteLength) throw new DecodeError("the message is too short");
  reader.at += bytes;
  return reader.at - bytes;
}

function primitiveReader({bytes, read}) {
  const readOne = (reader) => read(reader.view, claim(reader, bytes));
  readOne.least = bytes;
  return readOne;
}

const utf8 = new TextDecoder();

function readString(reader) {
  const length = reader.view.getInt32(claim(reader, 4));
  if (length < 1) throw new DecodeError("a text has an impossible length");
  const at = claim(reader, length);
  if (reader.view.getUint8(at + length - 1) !== 0) throw new DecodeError("a text has no end");
  return utf8.decode(new Uint8Array(reader.view.buffer, reader.view.byteOffset + at, length - 1));
}
readString.least = 5;

/**
 * Makes a function that reads a list. The function refuses a length for which the message has too
 * few remaining bytes.
 */
function listReader(readItem, dim) {
  const readList = (reader, message) => {
    const length = typeof dim === "number" ? dim : Number(message[dim]);
    if (!(length >= 0)) throw new DecodeError(`the length ${dim} is impossible`);
    if (length * readItem.least > reader.view.byteLength - reader.at) {
      throw new DecodeError(`the length ${dim} does not fit`);
    }
    const list = new Array(length);
    for (let i = 0; i < length; ++i) list[i] = readItem(reader, message);
    return list;
  };
  readList.least = typeof dim === "number" ? dim * readItem.least : 0;
  return readList;
}

function memberReader(types, {type, dims}, depth) {
  let read;
  if (type in PRIMITIVES) read = primitiveReader(PRIMITIVES[type]);
  else if (type === "string") read = readString;
  else read = structReader(types, type, depth + 1);
  for (const dim of [...dims].reverse()) read = listReader(read, dim);
  return read;
}

function structReader(types, name, depth) {
  if (!Object.hasOwn(types, name)) throw new DecodeError(`no type ${name}`);
  if (depth > MOST_DEPTH) throw new DecodeError(`${name} contains itself`);
  const members = types[name].members.map(
    (member) => ({name: member.name, read: memberReader(types, member, depth)}));
  const readStruct = (reader) => {
    const message = {};
    for (const {name: member, read} of members) message[member] = read(reader, message);
    return message;
  };
  readStruct.least = members.reduce((sum, {read}) => sum + read.least, 0);
  return readStruct;
}

/**
 * Makes a function that decodes the bytes (Uint8Array) of a message of this type. The function
 * ignores bytes after the members, such as a signature. It throws a DecodeError for a message that
 * does not fit the type.
 */
export function makeDecoder(types, name) {
  const read = structReader(types, name, 0);
  return (bytes) => {
    const reader = {view: new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), at: 0};
    claim(reader, FINGERPRINT_BYTES);
    return read(reader);
  };
}

/** The fingerprint of a message's type, such as "0x1f...", or "" if the message has none. */
export function fingerprintOf(bytes) {
  if (bytes.byteLength < FINGERPRINT_BYTES) return "";
  const value = new DataView(bytes.buffer, bytes.byteOffset).getBigUint64(0);
  return `0x${value.toString(16).padStart(16, "0")}`;
}

/** Splits a path: "header.step" becomes ["header", "step"], "state[0]" becomes ["state", 0]. */
export function parsePath(path) {
  return path.split(/[.[]/).map((part) => part.endsWith("]") ? Number(part.slice(0, -1)) : part);
}

/** The value at a parsed path; undefined if the message does not have it. */
export function valueAt(message, parts) {
  let value = message;
  for (const part of parts) value = value?.[part];
  return value;
}

/** The value at a parsed path as a number; NaN if the message has no number there. */
export function numberAt(message, parts) {
  const value = valueAt(message, parts);
  if (typeof value === "number") return value;
  return typeof value === "boolean" || typeof value === "bigint" ? Number(value) : NaN;
}

/** The indices of a list, such as "[0][1]". A dimension of variable length has only the index 0. */
function indices(dims) {
  return dims.reduce((tuples, dim) => tuples.flatMap((tuple) => {
    const length = typeof dim === "number" ? dim : 1;
    return Array.from({length}, (_, i) => `${tuple}[${i}]`);
  }), [""]);
}

/** All numeric fields of a type: [{path, unit, comment}]. */
export function fieldsOf(types, name, depth = 0) {
  if (!Object.hasOwn(types, name) || depth > MOST_DEPTH) return [];
  return types[name].members.flatMap(({name: member, type, dims, unit, comment}) => {
    const paths = indices(dims).map((index) => member + index);
    if (type in PRIMITIVES) {
      return paths.map((path) => ({path, unit: unit ?? "", comment: comment ?? ""}));
    }
    return paths.flatMap((path) => fieldsOf(types, type, depth + 1)
      .map((field) => ({...field, path: `${path}.${field.path}`})));
  });
}
