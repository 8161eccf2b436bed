// Checks how a page looks at all widths and in both colour schemes, and that a keyboard alone is
// enough to use the page.

import assert from "node:assert/strict";
import {fileURLToPath} from "node:url";

import {breaches} from "./window.js";

const IN_PAGE = fileURLToPath(new URL("looks_in_page.js", import.meta.url));
// Sizes of a desktop, of a part of a desktop, of a phone, and of the narrowest window in which a
// page must not scroll sideways (WCAG 2.2, 1.4.10).
const SIZES = [[1600, 1000], [1000, 800], [390, 844], [320, 640]];
const LOOKS = SIZES.flatMap(([width, height]) => ["light", "dark"].map(
  (colorScheme) => ({size: {width, height}, colorScheme})));

/** Prepares the context of a page, so that looksWell() can look at the page. */
export const prepareLooks = (context) => context.addInitScript({path: IN_PAGE});

/** The controls that the Tab key does not reach, or that do not show their focus. */
async function missedStops(page) {
  const count = await page.evaluate(() => looks.beginStops());
  // After the last stop, the tab key leaves the page, and then continues with the first stop. Boxes
  // that scroll may be stops, too. So the loop presses Tab more often than there are controls.
  for (let i = 0; i < count + 8; ++i) await page.keyboard.press("Tab");
  // A page without the keyboard focus may look different, and the next window size is checked after
  // this. So if the focus has left the page, a further Tab brings it back. A page without controls
  // cannot get the focus by Tab.
  const isIn = () => page.evaluate(() => document.hasFocus());
  if (count > 0 && !await isIn()) await page.keyboard.press("Tab");
  const lost = count > 0 && !await isIn() ? ["Tab does not come back to the page"] : [];
  return [...lost, ...await page.evaluate(() => {
    document.activeElement.blur();
    return looks.missedStops();
  })];
}

/**
 * Checks the page in each window and each colour scheme.
 * @param keys whether to press Tab to go through the page; this closes elements that are open only
 * while they have the focus
 */
export async function looksWell(page, what, {keys = true} = {}) {
  const flaws = [];
  for (const {size, colorScheme} of LOOKS) {
    await page.setViewportSize(size);
    await page.emulateMedia({colorScheme});
    await page.evaluate(async () => {  // until the page has drawn itself with both settings
      for (let i = 0; i < 5; ++i) await new Promise(requestAnimationFrame);
    });
    const found = [...await page.evaluate(() => looks.flaws()), ...await breaches(page),
                   ...(keys ? await missedStops(page) : [])];
    flaws.push(...found.map((flaw) => `${size.width} px, ${colorScheme}: ${flaw}`));
  }
  assert.deepEqual(flaws, [], what);
}
