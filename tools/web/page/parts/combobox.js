// A search box with a list of suggestions, by the ARIA pattern of a combobox.

import {make, setAttribute} from "../draw/dom.js";

export class Combobox {
  /**
   * @param suggest(typed) returns options [{key, parts: [nodes], chosen}]; onChoose(key) is called
   * when the reader chooses an option
   */
  constructor(input, list, {suggest, onChoose}) {
    Object.assign(this, {input, list, suggest, onChoose});
    this.active = -1;
    this.options = [];
    input.addEventListener("input", () => this.open());
    input.addEventListener("focus", () => this.open());
    input.addEventListener("click", () => this.open());
    input.addEventListener("blur", () => this.close());
    input.addEventListener("keydown", (event) => this.key(event));
    list.addEventListener("pointerdown", (event) => {
      event.preventDefault();  // the box keeps the focus
      const option = event.target.closest("[role=option]");
      if (option) this.choose(this.options[Number(option.dataset.index)]);
    });
  }

  open() {
    this.options = this.suggest(this.input.value);
    this.active = this.input.value && this.options.length ? 0 : -1;
    this.list.replaceChildren(...this.options.map(({parts, chosen}, index) => make("li", {
      role: "option", id: `${this.list.id}-${index}`, "data-index": index,
      "aria-selected": String(Boolean(chosen))}, ...parts)));
    if (this.options.length === 0) {
      this.list.append(make("li", {class: "none", role: "option", "aria-disabled": "true",
                                   "aria-selected": "false"}, "No field has these words."));
    }
    this.list.hidden = false;
    this.list.scrollIntoView({block: "nearest"});
    this.show();
  }

  close() {
    this.list.hidden = true;
    setAttribute(this.input, "aria-expanded", "false");
    this.input.removeAttribute("aria-activedescendant");
  }

  show() {
    setAttribute(this.input, "aria-expanded", "true");
    [...this.list.children].forEach((option, index) => {
      option.classList.toggle("active", index === this.active);
    });
    const option = this.list.children[this.active];
    if (this.active < 0 || !option) {
      this.input.removeAttribute("aria-activedescendant");
      return;
    }
    this.input.setAttribute("aria-activedescendant", option.id);
    option.scrollIntoView({block: "nearest"});
  }

  choose(option) {
    if (!option) return;
    this.input.value = "";
    this.onChoose(option.key);
    this.close();  // the list would cover the chosen field
  }

  key(event) {
    const {key} = event;
    const n = this.options.length;
    if (key === "Escape") {
      if (this.list.hidden) this.input.blur();
      else this.close();
    } else if (key === "Enter") {
      if (this.list.hidden) this.open();
      else this.choose(this.options[this.active]);
    } else if (key === "ArrowDown" || key === "ArrowUp") {
      if (this.list.hidden) this.open();
      const direction = key === "ArrowDown" ? 1 : -1;
      const from = Math.max(this.active, direction < 0 ? 0 : -1);
      this.active = n === 0 ? -1 : (from + direction + n) % n;
      this.show();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }
}
