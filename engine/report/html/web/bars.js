// Horizontal bars, ranked, each with its interval. Bars of several series are drawn below each other in different
// fills.

const FIRST_BARS = 25;
const BAR = 14; // px
const BAR_GAP = 8;
const SERIES_FILLS = [
  { fill: "var(--first)", stroke: "var(--first)" },
  { fill: "var(--second-light)", stroke: "var(--second)" },
];

function bars(figure, data) {
  const names = data.items;
  const series = data.series ?? [""];
  let quantity = data.quantities[0];
  let all = false;

  const SCALES = ["linear", "logarithmic"];
  let scale; // index of the scale that the reader chose

  const place = new Place(figure, (width) => {
    const rows = rowsShown();
    const offered = differ(rows);
    scales.hidden = !offered;
    scales.querySelector("select").selectedIndex = Number(isLog(rows));
    more.hidden = names.length <= FIRST_BARS;
    more.textContent = all ? `Show the first ${FIRST_BARS} of ${names.length}` : `Show all ${names.length}`;
    return rows.some(({ value }) => Number.isFinite(value)) ? [drawBars(rows, width)].flat() : nothing();
  });
  const choices = new Choices(data.choices, () => place.redraw());
  const more = element("button", {
    type: "button",
    class: "more",
    onclick: () => {
      all = !all;
      place.redraw();
    },
  });
  const scales = select("Scale", SCALES, (i) => {
    scale = i;
    place.redraw();
  });
  const quantities = data.quantities.map(({ label }) => label);
  place.controls.append(
    ...choices.controls,
    select("Quantity", quantities, (i) => {
      quantity = data.quantities[i];
      place.redraw();
    }),
    scales,
  );
  place.plot.after(more);

  function unitOf(p) {
    const unit = quantity.units[choices.row];
    return Array.isArray(unit) ? unit[p] : unit;
  }

  /// A function of series and item that gives the number in the array of this name, or NaN if there is none.
  function at(name) {
    const array = values(name);
    if (!array) return () => NaN;
    return (s, p) => array[(s * (array.length / names.length / series.length) + choices.row) * names.length + p];
  }

  /// Whether all items of a quantity have the same unit. Values in different units do not say which is larger.
  function comparable({ units }) {
    return !Array.isArray(units[choices.row]) || new Set(units[choices.row]).size === 1;
  }

  /// The quantity by which items are sorted; undefined if items keep their order.
  function measure() {
    if (data.sort === "none") return undefined;
    return comparable(quantity) ? quantity : data.quantities.find(comparable);
  }

  function order() {
    const by = measure();
    if (!by) return d3.range(names.length);
    const value = at(by.value);
    const deciding = data.sort === "first" ? [0] : d3.range(series.length);
    return ranked(names.map((_, p) => d3.max(deciding, (s) => Math.abs(value(s, p)))));
  }

  /// [{name, unit, series, value, low, high}], one for each item that is shown and each series.
  function rowsShown() {
    const [value, low, high] = [quantity.value, quantity.low, quantity.high].map(at);
    return order().slice(0, all ? names.length : FIRST_BARS).flatMap((p) =>
      series.map((_, s) => ({
        name: names[p],
        unit: unitOf(p),
        series: s,
        value: value(s, p),
        low: low(s, p),
        high: high(s, p),
      })),
    );
  }

  /// Whether the axis is logarithmic: as the reader chose, or else if series of an item differ a hundredfold, because
  /// then shorter bars could not be seen.
  function isLog(rows) {
    if (!differ(rows)) return false;
    if (scale !== undefined) return scale === 1;
    return d3.groups(rows, ({ name }) => name).some(([, same]) => same.length > 1 && differ(same));
  }

  function drawBars(rows, width) {
    const oneUnit = new Set(rows.map(({ unit }) => unit)).size === 1;
    const axis = barAxis(rows, oneUnit ? rows[0].unit : undefined, isLog(rows));
    const valueText = ({ value, unit }) => (oneUnit ? number(value / axis.factor) : withUnit(number(value), unit));
    const said = (d) => [d.name, about(d.name), series[d.series], withInterval(d, d.unit)].filter(Boolean).join("\n");
    const marginLeft = Math.min(textWidth(...rows.map(({ name }) => name)) + 10, width * 0.42);
    const marginRight = textWidth(...rows.map(valueText)) + 14;
    const shown = rows.filter((d) => d.series === 0).map(({ name }) => name);
    const step = BAR * series.length + BAR_GAP;
    const svg = draw(sentence(rows), {
      width,
      height: shown.length * step + 26,
      marginLeft,
      marginRight,
      marginTop: 24,
      marginBottom: 2,
      x: { ...axis.options(width - marginLeft - marginRight), axis: "top", label: null, grid: true },
      y: {
        type: "band",
        domain: shown,
        padding: 0,
        label: null,
        tickSize: 0,
        tickFormat: (name) => shortened(name, marginLeft - 10),
      },
      marks: [
        series.map((_, s) => seriesMarks(rows, s, series.length, axis, valueText)),
        Plot.ruleX([axis.start], { stroke: "var(--ink)" }),
        tip(rows, { x: (d) => axis.at(d.value), y: "name", title: said, anchor: "left" }, Plot.pointerY),
      ],
    });
    return [title(labelled(quantity.label, axis.unit) + ordered()), series.length > 1 ? legend() : [], svg].flat();
  }

  function legend() {
    const entries = series.map((name, s) => swatch(SERIES_FILLS[s % 2].fill, SERIES_FILLS[s % 2].stroke, name));
    return element("p", { class: "swatches" }, ...entries);
  }

  /// A text for the caption that names the quantity by which bars are sorted, if they show another one.
  function ordered() {
    const by = measure();
    return by && by !== quantity ? `, in the order of: ${by.label}` : "";
  }

  function sentence(rows) {
    const of = choices.text ? ` of ${choices.text}` : "";
    if (!comparable(quantity)) return `Bars: ${quantity.label}${of}, ${names.length} items${ordered()}.`;
    const best = rows[d3.maxIndex(rows, ({ value }) => Math.abs(value))];
    const whose = series.length > 1 ? ` (${series[best.series]})` : "";
    const largest = `${best.name}${whose} with ${withUnit(number(best.value), best.unit)}`;
    return `Bars: ${quantity.label}${of}. The largest of ${names.length} is ${largest}.`;
  }

  return place;
}

const HUNDREDFOLD = 100;

/// Whether values differ a hundredfold, so that a logarithmic axis shows them better. Never if a value is negative.
function differ(rows) {
  const numbers = rows.map(({ value }) => value).filter(Number.isFinite);
  if (d3.min(numbers) < 0) return false;
  const [low, high] = d3.extent(numbers.filter((v) => v > 0));
  return high >= HUNDREDFOLD * low;
}

/// The axis of bars. It includes 0 unless it is logarithmic. Bars begin at `start`; at(value) is the position of a
/// value.
function barAxis(rows, unit, log) {
  const numbers = rows.flatMap(({ value, low, high }) => [value, low, high]).filter(Number.isFinite);
  if (log) return logAxis(rows, unit, d3.max(numbers));
  const range = d3.extent([0, ...numbers]);
  const whole = range[0] < range[1] ? range : [0, 1];
  const axis = unit === undefined ? { factor: 1, unit: "" } : axisUnit(whole, unit);
  const domain = whole.map((v) => v / axis.factor);
  const options = (width) => ({ domain, ticks: Math.max(3, Math.floor(width / 90)) });
  return { ...axis, options, start: 0, at: (v) => v / axis.factor };
}

/// A logarithmic axis for bars. It starts at half the smallest value, but at most six powers of ten below the largest,
/// because smaller values are rounding errors. A value of 0 has no bar.
function logAxis(rows, unit, high) {
  const smallest = d3.min(rows, ({ value }) => (value > 0 ? value : undefined));
  const start = Math.max(0.5 * smallest, 1e-6 * high);
  const options = (width) => ({
    type: "log",
    domain: [start, high],
    ticks: logTicks([start, high], Math.max(2, Math.floor(width / 90))),
    tickFormat: logTick,
  });
  return { factor: 1, unit: unit ?? "", options, start, at: (v) => Math.max(v, start) };
}

/// The bars of series s with their intervals, and their values to the right. of: number of series.
function seriesMarks(rows, s, of, axis, valueText) {
  const mine = rows.filter((d) => d.series === s);
  const dy = (s + 0.5 - of / 2) * BAR;
  const colours = of === 1 ? { fill: "var(--bar)", stroke: "var(--bar)" } : SERIES_FILLS[s % SERIES_FILLS.length];
  const end = ({ value, high }) => d3.max([axis.start, ...[value, high].map(axis.at)]);
  return [
    fullBars(mine, axis, dy, (BAR * (of - 1) + BAR_GAP) / 2, colours),
    Plot.ruleY(
      mine.filter((d) => Number.isFinite(d.low)),
      {
        y: "name",
        dy,
        x1: (d) => axis.at(d.low),
        x2: (d) => axis.at(d.high),
        stroke: "var(--ink)",
        strokeWidth: 1.2,
        marker: "tick",
      },
    ),
    Plot.text(mine, { y: "name", dy, x: end, text: valueText, textAnchor: "start", dx: 6 }),
  ];
}

function fullBars(rows, axis, dy, inset, colours) {
  const edges = { insetTop: inset + dy + 0.5, insetBottom: inset - dy + 0.5 };
  return Plot.rect(rows, { y: "name", x1: axis.start, x2: (d) => axis.at(d.value), ...edges, ...colours, strokeWidth: 1 });
}
