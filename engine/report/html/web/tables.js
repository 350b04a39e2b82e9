// Where a table has too little room, the columns that matter least are hidden, and a button shows them. On paper they
// are left out, and a note says so. The names of the rows and the number that the table is about always stay. If there
// is too little room even for these, names and words are broken.

// How early a column is hidden: the largest number first. Those above 0 are hidden before names are broken.
const UNIT = -1;
const NEXT_RESULT = -2;
const NEVER = -Infinity;

class FittedTable {
  constructor(wrap) {
    this.wrap = wrap;
    this.table = wrap.querySelector("table");
    this.spare = this.order();
    this.groups = [...new Set(this.spare)].filter((group) => group > NEVER).sort((a, b) => b - a);
    this.button = element("button", { type: "button", class: "more", hidden: "", onclick: () => this.toggle() });
    this.note = element("p", { class: "note paper-note" });
    wrap.after(this.button, this.note);
    this.width = 0;
    this.whole = false;
    // Before the frame that shows the new width.
    addEventListener("resize", () => this.fit());
    // When details are opened. Waits for the next frame, because hiding columns changes the height that is observed.
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(wrap.parentElement);
  }
  /// For each column, how early it is hidden. After those that the report names, the last one is hidden first, and the
  /// end of an interval with its beginning.
  order() {
    const heads = [...this.wrap.querySelectorAll("thead th")];
    const late = this.late(heads);
    return heads.map((head, c) => {
      const first = head.textContent.startsWith("high") ? c - 1 : c;
      return late.get(c) ?? (Number(head.dataset.spare ?? 0) || (first + 1) / (heads.length + 1));
    });
  }
  /// The columns that are hidden late or never: the names of the rows, and those that the report marks as main. If it
  /// marks none, the first number, or the first other column of a table without numbers. If this is a value of result
  /// A, the value of the next result too. And a unit beside these.
  late(heads) {
    const naming = [...(this.wrap.querySelector("tbody tr")?.cells ?? [])].findIndex((cell) => cell.tagName === "TH");
    const text = (c) => heads[c].textContent;
    const needed = [...heads.keys()].filter((c) => c !== naming && !heads[c].dataset.spare);
    const units = needed.filter((c) => text(c) === "unit");
    const values = needed.filter((c) => !units.includes(c));
    const marked = values.filter((c) => "main" in heads[c].dataset);
    const numbers = values.filter((c) => heads[c].classList.contains("n"));
    const main = marked.length ? marked : (numbers.length ? numbers : values).slice(0, 1);
    const next = values.filter((c) => c > main[0] && text(c).replace(/\b[B-Z]\b/, "A") === text(main[0])).slice(0, 1);
    const isBeside = (unit) => [...main, ...next].some((c) => Math.abs(needed.indexOf(c) - needed.indexOf(unit)) === 1);
    const all = (columns, group) => columns.map((c) => [c, group]);
    return new Map([...all(units.filter(isBeside), UNIT), ...all(next, NEXT_RESULT), ...all([naming, ...main], NEVER)]);
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
    this.wrap.classList.remove("broken");
    let hidden = this.hideWhatIsTooWide("spare", 0);
    if (this.isTooWide()) {
      this.breakNames();
      hidden = this.hideWhatIsTooWide("spare");
    }
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
  isTooWide() {
    const width = (box) => box.getBoundingClientRect().width;
    return width(this.table) > width(this.wrap) + 0.5; // the rest is rounding
  }
  /// Lets the lines of names end behind underscores, and those of other words at blanks.
  breakNames() {
    this.wrap.classList.add("broken");
    for (const cell of this.wrap.querySelectorAll("tbody th:not(:has(wbr))")) {
      for (const text of [...cell.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE)) {
        const pieces = text.data.split(/(?<=_)/);
        text.replaceWith(...pieces.flatMap((piece, k) => (k ? [element("wbr"), piece] : [piece])));
      }
    }
  }
  /// Gives cells the class until the table has room, and returns how many columns have it. Only columns that are hidden
  /// earlier than `limit` get it.
  hideWhatIsTooWide(name, limit = NEVER) {
    let hidden = this.hide(Infinity, name);
    for (const group of this.groups.filter((one) => one > limit)) {
      if (!this.isTooWide()) break;
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
