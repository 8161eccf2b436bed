// Small helpers for the document.

export const byId = (id) => document.getElementById(id);

/** Makes an element with attributes and children. Null children are omitted. */
export function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) element.setAttribute(key, "");
    else if (value !== false && value != null) element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child != null));
  return element;
}

/** Sets a text only if it differs, because each change costs a layout. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function setAttribute(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

/**
 * Gives a canvas one pixel for each pixel of the screen that it covers, and clears it.
 * @return {context, width, height}: its 2D context, and its width and height, in CSS pixels
 */
export function fitCanvas(canvas) {
  const ratio = devicePixelRatio;
  const {clientWidth: width, clientHeight: height} = canvas;
  const [pixelWidth, pixelHeight] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== pixelWidth || canvas.height !== pixelHeight) {
    canvas.width = pixelWidth;
    canvas.height = pixelHeight;
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return {context, width, height};
}

/** A pattern of diagonal lines, by which areas can be distinguished without colour. */
export function hatch(context, colour, {both = false, size = 6} = {}) {
  const ratio = devicePixelRatio;
  const tile = document.createElement("canvas");
  tile.width = tile.height = Math.round(size * ratio);
  const pen = tile.getContext("2d");
  pen.strokeStyle = colour;
  pen.lineWidth = Math.max(1, 1.2 * ratio);
  const n = tile.width;
  for (const shift of [-n, 0, n]) {
    pen.moveTo(shift - 1, n + 1);
    pen.lineTo(shift + n + 1, -1);
    if (both) {
      pen.moveTo(shift - 1, -1);
      pen.lineTo(shift + n + 1, n + 1);
    }
  }
  pen.stroke();
  const pattern = context.createPattern(tile, "repeat");
  pattern.setTransform(new DOMMatrix().scale(1 / ratio));
  return pattern;
}

export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
export const darkScheme = matchMedia("(prefers-color-scheme: dark)");
