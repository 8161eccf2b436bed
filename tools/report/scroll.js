// Tables that are wider than their place say so: a shade where they go on, and a line below.

/** Marks a table's place by whether it can be scrolled, and whether something lies to the right. */
function markScroll(element) {
  const {scrollWidth, clientWidth, scrollLeft} = element;
  const slack = 2;  // pixels: widths are rounded
  element.classList.toggle("wide", scrollWidth > clientWidth + slack);
  element.classList.toggle("more", scrollWidth > clientWidth + scrollLeft + slack);
}

// A mark changes the size of what is observed, so it waits for the next picture.
const scrollSizes = new ResizeObserver((entries) => {
  const changed = new Set(entries.map(({target}) => target.closest(".scroll")));
  requestAnimationFrame(() => changed.forEach(markScroll));
});

/** Keeps the marks of all tables below an element true. */
function watchScrolls(root) {
  for (const element of root.querySelectorAll(".scroll")) {
    element.addEventListener("scroll", () => markScroll(element), {passive: true});
    scrollSizes.observe(element);
    for (const child of element.children) scrollSizes.observe(child);
  }
}
