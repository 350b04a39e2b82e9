// Helpers for SVG figures: texts, descriptions, and marks that Plot lacks.

const FONT_SIZE = 12;
const FIGURE_STYLE = { fontSize: `${FONT_SIZE}px`, fontFamily: "var(--sans)" };
const measuring = document.createElement("canvas").getContext("2d");

/// The width of the widest text in the font of figures, in px.
function textWidth(...texts) {
  measuring.font = `${FONT_SIZE}px ${getComputedStyle(document.body).getPropertyValue("--sans") || "sans-serif"}`;
  const width = (text) => measuring.measureText(text).width;
  const set = ({ text, letter, index }) => (letter ? width(letter) + SUB_SIZE * width(index) : width(text));
  return d3.max(texts, (text) => d3.sum(pieces(text), set)) ?? 0;
}

/// The text, cut at its end if it is wider than this width in px.
function shortened(text, width) {
  if (textWidth(text) <= width) return text;
  let end = text.length;
  while (end > 1 && textWidth(`${text.slice(0, end)}…`) > width) --end;
  return `${text.slice(0, end)}…`;
}

/// Plot.plot with the options that all figures share. For a screen reader the SVG is one picture, described by one
/// sentence.
function draw(description, options) {
  const [x, y] = [options.x, options.y].map(withTicks);
  const svg = Plot.plot({ ...options, x, y, style: FIGURE_STYLE });
  setNames(svg);
  describe(svg, description);
  return svg;
}

/// A linear scale whose ticks are written like all other numbers.
function withTicks(scale) {
  const written = !scale || scale.axis === null || scale.tickFormat || (scale.type ?? "linear") !== "linear";
  return written ? scale : { ...scale, tickFormat: tickText };
}

/// Makes Plot's SVG one picture with one description, instead of a group of unnamed parts with labels.
function describe(svg, description) {
  for (const part of svg.querySelectorAll("[aria-label]")) {
    part.dataset.mark = part.getAttribute("aria-label");
    part.removeAttribute("aria-label");
  }
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", description);
}

/// A box with a text on the item under the pointer. Readers without a pointer find the same in the tables.
function tip(items, options, pointer = Plot.pointer) {
  return Object.assign(Plot.tip(items, pointer(options)), { ariaLabel: undefined });
}

function title(text) {
  return element("p", { class: "plot-title" }, ...named(text));
}

/// A paragraph that is shown if there is nothing to draw.
function nothing(text = "No value is known here.") {
  return element("p", { class: "plot-nothing" }, text);
}

function setAttributes(made, attributes) {
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
}

/// An SVG element, for marks that Plot does not have.
function svgElement(tag, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  setAttributes(made, attributes);
  if (text !== undefined) made.textContent = text;
  return made;
}
