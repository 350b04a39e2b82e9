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

/// A select with a visible label; change(index) is called when another option is chosen. Hidden where there is no choice.
function select(label, options, change) {
  const made = element("select", { onchange: () => change(made.selectedIndex) });
  made.append(...options.map((option) => element("option", {}, option)));
  return element(
    "label",
    { class: "control", ...(options.length < 2 && { hidden: "" }) },
    element("span", {}, label),
    made,
  );
}

/// Selects for a figure's choices, whose options together number the rows of its arrays; the first choice varies slowest.
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

/// Where a figure is drawn: controls above, then the plot, drawn again by draw(width) whenever its width changes.
class Place {
  constructor(figure, draw) {
    this.plot = figure.querySelector(".plot");
    this.controls = element("div", { class: "controls" });
    this.plot.before(this.controls);
    this.width = 0;
    this.draw = draw;
    // In the next frame: what is drawn here changes the height that is observed.
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(this.plot);
    addEventListener("beforeprint", () => this.width && this.redraw(PRINT_WIDTH));
    addEventListener("afterprint", () => this.redraw());
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
const FONT_SIZE = 12;
const measuring = document.createElement("canvas").getContext("2d");

/// The width of the widest text in the font of figures, in px.
function textWidth(...texts) {
  measuring.font = `${FONT_SIZE}px ${getComputedStyle(document.body).getPropertyValue("--sans") || "sans-serif"}`;
  return d3.max(texts, (text) => measuring.measureText(text).width) ?? 0;
}

/// The text, its end left out where it is wider than the width in px.
function shortened(text, width) {
  if (textWidth(text) <= width) return text;
  let end = text.length;
  while (end > 1 && textWidth(`${text.slice(0, end)}…`) > width) --end;
  return `${text.slice(0, end)}…`;
}

/// Plot.plot with what all figures share: an SVG that is one picture to a screen reader, described by one sentence.
function draw(description, options) {
  const svg = Plot.plot({
    ...options,
    style: { fontSize: `${FONT_SIZE}px`, fontFamily: "var(--sans)", ...options.style },
  });
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", description);
  return svg;
}

function title(text) {
  return element("p", { class: "plot-title" }, text);
}

/// What stands where no value is known.
function nothing() {
  return element("p", { class: "plot-nothing" }, "No value is known here.");
}

/// An SVG element, for marks that Plot does not have.
function svgElement(tag, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

/// An entry of a legend: a patch of colour and what it stands for.
function swatch(fill, stroke, text) {
  const patch = element("i", { class: "swatch", style: `background:${fill};border-color:${stroke}` });
  return element("span", { class: "entry" }, patch, text);
}

const FIELD_COLOURS = d3.interpolateViridis;

/// The colour scale of a field: options for Plot, and a legend with its label and unit.
function fieldColours(array, label, unit, log = false) {
  const positive = Array.from(array).filter((v) => v > 0);
  const logarithmic = log && positive.length > 0;
  const domain = extent(logarithmic ? positive : array);
  const axis = logarithmic ? { factor: 1, unit } : axisUnit(domain, unit);
  const type = logarithmic ? "log" : "linear";
  const scale = logarithmic ? d3.scaleSequentialLog(domain, FIELD_COLOURS) : d3.scaleSequential(domain, FIELD_COLOURS);
  const colour = (value) => (Number.isFinite(value) && !(logarithmic && value <= 0) ? scale(value) : null);
  const legend = (width) => {
    const ramp = Plot.legend({
      color: { type, domain: domain.map((v) => v / axis.factor), interpolate: FIELD_COLOURS },
      width: Math.min(width, 280),
      height: 36,
      marginTop: 4,
      marginBottom: 20,
      marginLeft: 14,
      marginRight: 26,
      ...(logarithmic ? { ticks: logTicks(domain, 5), tickFormat: logTick } : { ticks: 5 }),
      style: { fontSize: `${FONT_SIZE}px`, fontFamily: "var(--sans)" },
    });
    ramp.setAttribute("role", "img");
    ramp.setAttribute(
      "aria-label",
      `Colours from ${withUnit(number(domain[0]), unit)} to ${withUnit(number(domain[1]), unit)}.`,
    );
    const unknown = known(array).length < array.length ? [swatch("var(--unknown)", "var(--unknown)", "unknown")] : [];
    return element("div", { class: "legend" }, element("span", {}, labelled(label, axis.unit)), ramp, ...unknown);
  };
  return { colour, legend };
}

/// A line for the value under the cursor, which a screen reader says when it changes.
function readout(hint) {
  return element("p", { class: "readout", role: "status" }, hint);
}
