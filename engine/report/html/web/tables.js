// Where a table has too little room, the columns that matter least are hidden, and a button shows them. On paper they are
// left out, and a note says so.

const NAMING_COLUMNS = 2; // which are never hidden

class FittedTable {
  constructor(wrap) {
    this.wrap = wrap;
    this.spare = this.order([...wrap.querySelectorAll("thead th")]);
    this.groups = [...new Set(this.spare)].filter((group) => group > 0).sort((a, b) => b - a);
    this.button = element("button", { type: "button", class: "more", hidden: "", onclick: () => this.toggle() });
    this.note = element("p", { class: "note paper-note" });
    wrap.after(this.button, this.note);
    this.width = 0;
    this.whole = false;
    // Waits for the next frame, because hiding columns changes the height that is observed.
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(wrap.parentElement);
  }
  /// For each column, how early it is hidden; 0: never. After those that the report names, the last one is hidden first,
  /// and the end of an interval with its beginning.
  order(heads) {
    return heads.map((head, c) => {
      const named = Number(head.dataset.spare ?? 0);
      const first = head.textContent.startsWith("high") ? c - 1 : c;
      return named > 0 || c < NAMING_COLUMNS ? named : first / heads.length;
    });
  }
  toggle() {
    this.whole = !this.whole;
    this.update();
  }
  fit() {
    const width = this.wrap.parentElement.clientWidth;
    if (width > 0 && width !== this.width) {
      if (this.width === 0) this.fitToPaper();
      this.width = width;
      this.update();
    }
  }
  update() {
    const hidden = this.hideWhatIsTooWide("spare");
    if (this.whole) this.hide(Infinity, "spare");
    this.button.hidden = hidden === 0;
    this.button.textContent = this.whole ? "Fewer columns" : `Show ${columns(hidden)}`;
  }
  fitToPaper() {
    this.wrap.classList.add("measured");
    const hidden = this.hideWhatIsTooWide("off-paper");
    this.wrap.classList.remove("measured");
    if (hidden > 0) this.note.textContent = `${columns(hidden)}: in the HTML file, and by poesy export`;
  }
  /// Gives cells the class until the table has room, and returns how many columns have it.
  hideWhatIsTooWide(name) {
    let hidden = this.hide(Infinity, name);
    for (const group of this.groups) {
      if (this.wrap.scrollWidth <= this.wrap.clientWidth) break;
      hidden = this.hide(group, name);
    }
    return hidden;
  }
  /// Gives the class to the columns of this group and of those with larger numbers, and returns how many these are.
  hide(group, name) {
    const spare = this.spare.map((own) => own >= group);
    for (const row of this.wrap.querySelectorAll("tr")) {
      [...row.cells].forEach((cell, c) => cell.classList.toggle(name, spare[c]));
    }
    return spare.filter(Boolean).length;
  }
}

function columns(count) {
  return `${count} more column${count === 1 ? "" : "s"}`;
}
