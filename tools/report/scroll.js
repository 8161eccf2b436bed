// Marks each table that is wider than its container. The marks are a shade at the hidden side and a
// line of text below the table.

/** Marks whether a table's container can be scrolled, and whether it hides columns on the right. */
function markScroll(element) {
  const {scrollWidth, clientWidth, scrollLeft} = element;
  const slack = 2;  // pixels, because widths are rounded
  element.classList.toggle("wide", scrollWidth > clientWidth + slack);
  element.classList.toggle("more", scrollWidth > clientWidth + scrollLeft + slack);
}

// Marks change the size of the observed element. If an observer changes sizes during its call, the
// browser reports an error. So the marks are set in the next frame.
const scrollSizes = new ResizeObserver((entries) => {
  const changed = new Set(entries.map(({target}) => target.closest(".scroll")));
  requestAnimationFrame(() => changed.forEach(markScroll));
});

/** Keeps the marks of all tables inside an element up to date. */
function watchScrolls(root) {
  for (const element of root.querySelectorAll(".scroll")) {
    element.addEventListener("scroll", () => markScroll(element), {passive: true});
    scrollSizes.observe(element);
    for (const child of element.children) scrollSizes.observe(child);
  }
}
