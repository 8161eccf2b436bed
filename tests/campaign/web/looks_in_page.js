// Finds what a reader cannot see in this page. looks.js adds this script to a page, as `looks`,
// before the page's own scripts.
(() => {
  const SLACK_PX = 1;          // boxes have fractions of a pixel
  const LEADING = 0.15;        // share of a line's height above and below its letters
  const LEAST_CONTRAST = 4.5;  // of a text and its background (WCAG 2.2, 1.4.3)
  const CONTROLS = "a[href], button, input, select, summary, textarea, [tabindex='0']";
  const FIELDS = "input:not([type=checkbox], [type=radio], [type=range]), select, textarea";
  // Texts for screen readers only, and a link that appears when it has the focus.
  const APART = ".unseen, .skip:not(:focus)";
  const PARTS = "header, main, footer, dialog";

  /** The part of the page that a reader can use: the open dialog, or the whole page. */
  const top = () => document.querySelector("dialog[open]") ?? document.body;
  const all = (selector) => [...top().querySelectorAll(selector)];
  const isSeen = (element) => !element.closest(APART) &&
    element.checkVisibility({visibilityProperty: true, opacityProperty: true});

  function nameOf(element) {
    const {tagName, id, classList} = element;
    return tagName.toLowerCase() + (id ? `#${id}` : [...classList].map((one) => `.${one}`).join(""));
  }
  const quoted = ({element, text}) => `"${text.slice(0, 50)}" in ${nameOf(element)}`;

  // ---- boxes ------------------------------------------------------------------------------------

  const boxOf = ({left, top: high, right, bottom}) => ({left, top: high, right, bottom});

  /** The left edge and the right edge of an element's content, without the padding. */
  function contentBox(element) {
    const {left, right} = element.getBoundingClientRect();
    const {paddingLeft, paddingRight} = getComputedStyle(element);
    return {left: left + parseFloat(paddingLeft), right: right - parseFloat(paddingRight)};
  }

  /** The box of a text without the space above and below the letters. */
  function letters({left, top: high, right, bottom}) {
    const leading = LEADING * (bottom - high);
    return {left, top: high + leading, right, bottom: bottom - leading};
  }

  /**
   * The part of a box that is visible inside the scrolled elements around it; null if no part is
   * visible. Calls onCut for an element that cuts the box and that a reader cannot scroll.
   */
  function shownPart(box, element, onCut) {
    const shown = {...box};
    for (let around = element; around && around !== document.body; around = around.parentElement) {
      const {overflowX, overflowY, display, position} = getComputedStyle(around);
      if (display !== "inline") {
        const outer = around.getBoundingClientRect();
        const left = outer.left + around.clientLeft;
        const high = outer.top + around.clientTop;
        for (const [from, to, start, end, overflow] of [
          ["left", "right", left, left + around.clientWidth, overflowX],
          ["top", "bottom", high, high + around.clientHeight, overflowY]]) {
          if (overflow === "visible") continue;
          const isCut = shown[from] < start - SLACK_PX || shown[to] > end + SLACK_PX;
          if (isCut && (overflow === "hidden" || overflow === "clip")) onCut(around);
          shown[from] = Math.max(shown[from], start);
          shown[to] = Math.min(shown[to], end);
        }
      }
      if (position === "fixed") break;
    }
    return shown.right > shown.left && shown.bottom > shown.top ? shown : null;
  }

  // ---- texts ------------------------------------------------------------------------------------

  /** The texts in fields. */
  function fieldTexts() {
    return all(FIELDS).filter(isSeen).map((element) => ({
      element, text: element.value || element.placeholder || "", box: () => boxOf(element.getBoundingClientRect()),
      colour: getComputedStyle(element, element.value || !element.placeholder ? null : "::placeholder").color}));
  }

  /** Each line of each text: {element, text, colour, box()}. */
  function lines() {
    const found = fieldTexts();
    const walker = document.createTreeWalker(top(), NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const {parentElement: element, data} = walker.currentNode;
      const text = data.trim().replace(/\s+/g, " ");
      if (!text || !isSeen(element)) continue;
      const range = document.createRange();
      range.selectNodeContents(walker.currentNode);
      const {color: colour} = getComputedStyle(element);
      [...range.getClientRects()].forEach(({width, height}, i) => {
        if (width <= SLACK_PX || height <= SLACK_PX) return;
        found.push({element, text, colour, box: () => letters(range.getClientRects()[i])});
      });
    }
    return found;
  }

  /**
   * The element that lies over the rest of the page and contains `element`, such as a bar that
   * stays in sight or an opened list.
   */
  function layerOf(element) {
    for (let around = element; around; around = around.parentElement) {
      const {position, zIndex} = getComputedStyle(around);
      if (position === "sticky" || position === "fixed" || (position !== "static" && zIndex !== "auto")) return around;
    }
    return null;
  }

  const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > SLACK_PX &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > SLACK_PX;

  /** Calls `tell` for each pair of boxes that overlap. */
  function tellOverlaps(boxes, tell) {
    boxes.forEach((one, i) => {
      for (const other of boxes.slice(i + 1)) if (overlap(one.box, other.box)) tell(one, other);
    });
  }

  // ---- colours ----------------------------------------------------------------------------------

  const colours = new Map();
  const pen = new OffscreenCanvas(1, 1).getContext("2d", {willReadFrequently: true});

  /** A colour of CSS as [red, green, blue, opacity], each from 0 to 1. */
  function parts(css) {
    if (!colours.has(css)) {
      pen.clearRect(0, 0, 1, 1);
      pen.fillStyle = css;
      pen.fillRect(0, 0, 1, 1);
      colours.set(css, [...pen.getImageData(0, 0, 1, 1).data].map((value) => value / 255));
    }
    return colours.get(css);
  }

  /** The colour that results if a colour lies over another colour. */
  const over = ([r, g, b, opacity], under) =>
    [...[r, g, b].map((value, i) => opacity * value + (1 - opacity) * under[i]), 1];

  /** The relative luminance of a colour (WCAG 2.2). */
  function luminance([r, g, b]) {
    const [red, green, blue] = [r, g, b].map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  }

  function contrast(a, b) {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  }

  /**
   * The colour behind a text. `elements` lie over each other, the highest first. Pictures and
   * gradients are left out.
   */
  function backgroundOf(elements) {
    const under = elements.map((element) => parts(getComputedStyle(element).backgroundColor));
    const opaque = under.findIndex(([, , , opacity]) => opacity === 1);
    return under.slice(0, opaque).reduceRight((colour, one) => over(one, colour), under[opaque] ?? [1, 1, 1, 1]);
  }

  /** The opacity of an element, together with the elements around it. */
  function opacityOf(element) {
    let opacity = 1;
    for (let around = element; around; around = around.parentElement) opacity *= getComputedStyle(around).opacity;
    return opacity;
  }

  /** Scrolls to a text, and tells if something covers the text, or if its colour is too faint. */
  function tellContrast({element, text, colour, box: boxNow}, tell) {
    element.scrollIntoView({block: "center", inline: "nearest", behavior: "instant"});
    const box = shownPart(boxNow(), element, () => {});
    if (!box) return;
    const stack = document.elementsFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
    const [first] = stack;
    if (first !== element && !element.contains(first)) {
      const isUnder = first && layerOf(first) !== layerOf(element);  // such as an opened list
      if (!isUnder) tell(`${quoted({element, text})} is covered by ${first ? nameOf(first) : "the window's edge"}`);
      return;
    }
    const background = backgroundOf(stack);
    const [r, g, b, opacity] = parts(colour);
    const ratio = contrast(over([r, g, b, opacity * opacityOf(element)], background), background);
    if (ratio < LEAST_CONTRAST) tell(`${quoted({element, text})} has a contrast of ${ratio.toFixed(2)}`);
  }

  // ---- texts in canvases ------------------------------------------------------------------------

  const drawn = new Map();  // by canvas: [{text, box}] since it was cleared
  const {clearRect, fillText} = CanvasRenderingContext2D.prototype;

  CanvasRenderingContext2D.prototype.clearRect = function (...area) {
    if (area[0] === 0 && area[1] === 0) drawn.delete(this.canvas);
    clearRect.apply(this, area);
  };

  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...more) {
    const {actualBoundingBoxLeft, actualBoundingBoxRight, actualBoundingBoxAscent, actualBoundingBoxDescent} =
      this.measureText(text);
    const transform = this.getTransform();
    const corners = [[x - actualBoundingBoxLeft, y - actualBoundingBoxAscent],
                     [x + actualBoundingBoxRight, y + actualBoundingBoxDescent]]
      .map(([at, down]) => transform.transformPoint({x: at, y: down}));
    const [xs, ys] = [corners.map((one) => one.x), corners.map((one) => one.y)];
    const box = {left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys)};
    if (!drawn.has(this.canvas)) drawn.set(this.canvas, []);
    drawn.get(this.canvas).push({text, box});
    fillText.call(this, text, x, y, ...more);
  };

  function tellDrawn(tell) {
    for (const [canvas, texts] of drawn) {
      if (!canvas.isConnected || !top().contains(canvas) || !isSeen(canvas)) continue;
      const where = nameOf(canvas.id ? canvas : canvas.closest("[id]"));
      for (const {text, box: {left, top: high, right, bottom}} of texts) {
        const isCut = left < -SLACK_PX || high < -SLACK_PX || right > canvas.width + SLACK_PX ||
          bottom > canvas.height + SLACK_PX;
        if (isCut) tell(`"${text}" is cut off in the picture ${where}`);
      }
      tellOverlaps(texts, (a, b) => tell(`"${a.text}" and "${b.text}" overlap in the picture ${where}`));
    }
  }

  // ---- all --------------------------------------------------------------------------------------

  /** Tells if a box is partly outside of the window, or outside of its part of the page. */
  function tellOutside(element, box, what, tell) {
    const part = element.closest(PARTS);
    const bounds = part ? contentBox(part) : {left: 0, right: innerWidth};
    const [left, right] = [Math.max(0, bounds.left), Math.min(innerWidth, bounds.right)];
    const out = Math.max(left - box.left, box.right - right);
    if (out > SLACK_PX) tell(`${what} stands out by ${Math.round(out)} px`);
  }

  /** The faults in the looks of the page, as a list of sentences. */
  function flaws() {
    const found = new Set();
    const tell = (words) => found.add(words);
    const wide = document.documentElement.scrollWidth - innerWidth;
    if (wide > 0) tell(`the page is ${wide} px too wide`);
    const isDark = luminance(parts(getComputedStyle(document.body).backgroundColor)) < 0.5;
    if (isDark !== matchMedia("(prefers-color-scheme: dark)").matches) tell(`the page is ${isDark ? "dark" : "light"}`);
    const texts = lines();
    const boxes = [];
    for (const line of texts) {
      const box = shownPart(line.box(), line.element, (by) => tell(`${quoted(line)} is cut off by ${nameOf(by)}`));
      if (!box) continue;
      boxes.push({...line, box, layer: layerOf(line.element)});
      tellOutside(line.element, box, quoted(line), tell);
    }
    for (const element of all(`${CONTROLS}, canvas`).filter(isSeen)) {
      const box = shownPart(boxOf(element.getBoundingClientRect()), element.parentElement, () => {});
      if (box) tellOutside(element, box, nameOf(element), tell);
    }
    tellOverlaps(boxes, (a, b) => {
      if (a.layer === b.layer && a.element !== b.element) tell(`${quoted(a)} and ${quoted(b)} overlap`);
    });
    tellDrawn(tell);
    const place = [scrollX, scrollY];
    for (const line of texts) if (!line.element.matches(":disabled, :disabled *")) tellContrast(line, tell);
    scrollTo(...place);
    return [...found];
  }

  // ---- controls ---------------------------------------------------------------------------------

  const stops = new Set();  // elements that had the focus
  const unmarked = new Set();

  addEventListener("focusin", ({target}) => {
    stops.add(target);
    const {outlineStyle, outlineWidth} = getComputedStyle(target);
    if (outlineStyle === "none" || parseFloat(outlineWidth) < 2) unmarked.add(target);
  });

  const mustStop = () => all(CONTROLS).filter((element) => !element.disabled && !element.closest(".unseen") &&
    element.tabIndex >= 0 && element.checkVisibility());

  /**
   * Forgets which elements had the focus. @return how often a reader must press Tab to reach every
   * control
   */
  function beginStops() {
    stops.clear();
    unmarked.clear();
    return mustStop().length;
  }

  /** The controls that have not had the focus since beginStops(), or did not show their focus. */
  function missedStops() {
    const groups = new Set([...stops].filter(({type}) => type === "radio").map(({name}) => name));
    const missed = mustStop().filter((element) => !stops.has(element) &&
      !(element.type === "radio" && groups.has(element.name)));
    return [...missed.map((element) => `Tab does not reach ${nameOf(element)} "${element.textContent.trim()}"`),
            ...[...unmarked].map((element) => `the focus on ${nameOf(element)} is not to be seen`)];
  }

  window.looks = {flaws, beginStops, missedStops};
})();
