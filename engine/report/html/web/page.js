// Elements and controls, and the place of a figure on the page.

/// Makes an element with attributes, listeners ("on...") and children. Attributes that are undefined are left out.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/// A select with a visible label. change(index) is called when the reader chooses another option. Hidden if there is
/// nothing to choose.
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

/// A slider from 0 to `last` with a visible label. text(k): the words of a screen reader for position k. change(k) is
/// called when the slider moves. Returns { control, say }; say() updates the words.
function slider(label, last, text, change) {
  const input = element("input", {
    type: "range",
    min: 0,
    max: last,
    step: 1,
    value: 0,
    oninput: () => {
      change(Number(input.value));
      say();
    },
  });
  const say = () => input.setAttribute("aria-valuetext", text(Number(input.value)));
  say();
  const control = element(
    "label",
    { class: "control", ...(last < 1 && { hidden: "" }) },
    element("span", {}, label),
    input,
  );
  return { control, say };
}

/// Selects for the choices of a figure. Together their options number the rows of the figure's arrays; the first choice
/// varies slowest.
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

// Paper is light, whatever the scheme of the screen is.
const darkScheme = matchMedia("(prefers-color-scheme: dark)");
let printing = false;
addEventListener("beforeprint", () => (printing = true));
addEventListener("afterprint", () => (printing = false));

function isDark() {
  return darkScheme.matches && !printing;
}

/// The place of a figure: controls above, then the plot. fit() calls draw(width) when the figure is complete, and again
/// when its width changes.
class Place {
  constructor(figure, draw) {
    this.plot = figure.querySelector(".plot");
    this.controls = element("div", { class: "controls" });
    this.plot.before(this.controls);
    this.width = 0;
    this.draw = draw;
    // Waits for the next frame, because drawing changes the height that is observed.
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
/// A line of text about the value under the cursor. A screen reader reads it when it changes.
function readout(hint) {
  return element("p", { class: "readout", role: "status" }, hint);
}
