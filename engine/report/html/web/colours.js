// Colours of fields, and legends.

/// An entry of a legend: a patch of colour and its meaning.
function swatch(fill, stroke, text) {
  const patch = element("i", { class: "swatch", style: `background:${fill};border-color:${stroke}` });
  return element("span", { class: "entry" }, patch, element("span", {}, ...named(text)));
}

/// Colours like those of PuOr, but with 0 near the colour of dark paper, so that differences stand out there, too.
const DARK_DIFFERENCES = d3.piecewise(d3.interpolateRgb, ["#d3c2ff", "#9276dd", "#2a2f37", "#c9771f", "#ffcb8a"]);

/// Viridis without its darkest part, which would not stand out from dark paper.
const DARK_VALUES = (t) => d3.interpolateViridis(0.2 + 0.8 * t);

/// The colours of a field: colour(value), null where it is not known, and legend(width) with its label and unit.
/// A field with both signs, and a difference whatever its values, has two hues that meet at 0; another one has the
/// colours of viridis.
function fieldColours(array, { label, unit, signed }) {
  const domain = symmetric(valueExtent(array), signed);
  const differs = domain[0] < 0 && domain[1] > 0;
  const interpolate = differs
    ? (isDark() ? DARK_DIFFERENCES : d3.interpolatePuOr)
    : (isDark() ? DARK_VALUES : d3.interpolateViridis);
  const scale = d3.scaleSequential(domain, interpolate);
  const colour = (value) => (Number.isFinite(value) ? scale(value) : null);
  const unknown = known(array).length < array.length ? [swatch("var(--unknown)", "var(--unknown)", "unknown")] : [];

  const legend = (width) => {
    const axis = axisUnit(domain, unit);
    const ends = domain.map((v) => v / axis.factor);
    const ramp = Plot.legend({
      color: { type: "linear", domain: ends, interpolate },
      width: Math.min(width, 280),
      height: 36,
      marginTop: 4,
      marginBottom: 20,
      marginLeft: 14,
      marginRight: 26,
      ticks: 4,
      tickFormat: (value, k) => tickText(value, k, d3.ticks(...ends, 4)),
      style: FIGURE_STYLE,
    });
    setNames(ramp);
    const [low, high] = domain.map((v) => withUnit(number(v), unit));
    describe(ramp, `Colours from ${low} to ${high}.`);
    return element("div", { class: "legend" }, element("span", {}, ...named(labelled(label, axis.unit))), ramp, ...unknown);
  };
  return { colour, legend };
}

/// Makes the range of a field symmetric about 0, if it has both signs or is of differences.
function symmetric([low, high], signed) {
  const largest = Math.max(-low, high);
  return signed || (low < 0 && high > 0) ? [-largest, largest] : [low, high];
}
