// Elements, controls and the place of a figure on the page.

/// An element with attributes (undefined ones are left out), listeners ("on...") and children.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/// A select with a visible label; change(index) is called when another option than the first one is chosen. Hidden where
/// nothing can be.
function select(label, options, change, first = 0) {
  const made = element("select", { onchange: () => change(made.selectedIndex) });
  made.append(...options.map((option) => element("option", {}, option)));
  made.selectedIndex = first;
  return element(
    "label",
    { class: "control", ...(options.length < 2 && { hidden: "" }) },
    element("span", {}, ...named(label)),
    made,
  );
}

/// Selects for a figure's choices, whose options number the rows of its arrays; the first choice varies slowest.
class Choices {
  constructor(choices, change) {
    this.choices = choices ?? [];
    this.chosen = this.choices.map(() => 0);
    this.controls = this.choices.map(({ label, options }, k) =>
      select(label, options, (i) => {
        this.chosen[k] = i;
        change();
      }),
    );
  }
  get row() {
    return this.choices.reduce((r, { options }, k) => r * options.length + this.chosen[k], 0);
  }
  get text() {
    return this.choices.map(({ options }, k) => options[this.chosen[k]]).join(", ");
  }
}

// Paper is light whatever the screen is.
const darkScheme = matchMedia("(prefers-color-scheme: dark)");
let printing = false;
addEventListener("beforeprint", () => (printing = true));
addEventListener("afterprint", () => (printing = false));

function isDark() {
  return darkScheme.matches && !printing;
}

/// Where a figure is drawn: controls above, then the plot, drawn by draw(width): at first by fit(), when the figure is
/// whole, and again whenever its width changes.
class Place {
  constructor(figure, draw) {
    this.plot = figure.querySelector(".plot");
    this.controls = element("div", { class: "controls" });
    this.plot.before(this.controls);
    this.width = 0;
    this.draw = draw;
    // In the next frame: what is drawn here changes the height that is observed.
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(this.plot);
    addEventListener("beforeprint", () => this.redraw(PRINT_WIDTH));
    addEventListener("afterprint", () => this.redraw());
    darkScheme.addEventListener("change", () => this.redraw());
  }
  fit() {
    const width = Math.floor(this.plot.clientWidth);
    if (width > 0 && width !== this.width) this.redraw((this.width = width));
  }
  redraw(width = this.width) {
    if (width > 0) this.plot.replaceChildren(...[this.draw(width)].flat());
  }
}

const PRINT_WIDTH = 680;
/// A line for the value under the cursor, which a screen reader says when it changes.
function readout(hint) {
  return element("p", { class: "readout", role: "status" }, hint);
}
