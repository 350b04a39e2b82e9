// Ranked horizontal bars with the interval of each; several series stand below each other, told apart by filling.

const FIRST_BARS = 25;
const SERIES_FILLS = [
  { fill: "var(--first)", stroke: "var(--first)" },
  { fill: "var(--second-light)", stroke: "var(--second)" },
];

function bars(figure, data) {
  const names = data.items;
  const series = data.series ?? [""];
  let quantity = data.quantities[0];
  let all = false;

  const place = new Place(figure, (width) => {
    const rows = rowsShown();
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
  const quantities = data.quantities.map(({ label }) => label);
  place.controls.append(
    ...choices.controls,
    select("Quantity", quantities, (i) => {
      quantity = data.quantities[i];
      place.redraw();
    }),
  );
  place.plot.after(more);

  function unitOf(p) {
    const unit = quantity.units[choices.row];
    return Array.isArray(unit) ? unit[p] : unit;
  }

  /// [{name, unit, series, value, low, high}], a row for each item shown and series.
  function rowsShown() {
    const at = (array) =>
      array
        ? (s, p) => array[(s * (array.length / names.length / series.length) + choices.row) * names.length + p]
        : () => NaN;
    const [value, low, high] = [quantity.value, quantity.low, quantity.high].map((name) => at(values(name)));
    const largest = names.map((_, p) => d3.max(series, (_, s) => Math.abs(value(s, p))));
    const order = data.sort === "none" ? d3.range(names.length) : ranked(largest);
    return order
      .slice(0, all ? names.length : FIRST_BARS)
      .flatMap((p) =>
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

  function drawBars(rows, width) {
    const oneUnit = new Set(rows.map(({ unit }) => unit)).size === 1;
    const ends = rows
      .flatMap(({ value, low, high }) => [value, low, high])
      .filter((v) => Number.isFinite(v) && (!data.log || v > 0));
    const log = Boolean(data.log) && ends.length > 0;
    const domain = log
      ? [d3.min(ends) / 1.3, d3.max(ends) * 1.3]
      : [Math.min(0, d3.min(ends)), Math.max(0, d3.max(ends)) || 1];
    const axis = log ? { factor: 1, unit: rows[0].unit } : axisUnit(domain, rows[0].unit);
    const scaled = (v) => (log && !(v > 0) ? NaN : v / axis.factor);
    const valueText = ({ value, unit }) => (oneUnit ? number(value / axis.factor) : withUnit(number(value), unit));

    const marginLeft = Math.min(textWidth(...rows.map(({ name }) => name)) + 10, width * 0.42);
    const marginRight = textWidth(...rows.map(valueText)) + 14;
    const thickness = series.length === 1 ? 13 : 14;
    const step = thickness * series.length + (series.length === 1 ? 8 : 10);
    const count = rows.length / series.length;
    const offset = (s) => (s + 0.5 - series.length / 2) * thickness;
    const channels = (s) => ({ y: "name", dy: offset(s) });
    const tip = ({ name, series: s, value, low, high, unit }) =>
      [
        name,
        series[s],
        withUnit(number(value), unit),
        Number.isFinite(low) ? `interval ${number(low)} to ${withUnit(number(high), unit)}` : "",
      ]
        .filter(Boolean)
        .join("\n");

    // Behind whatever of the bar and its interval reaches farthest to the right.
    const labelAt = ({ value, high }) =>
      Math.max(domain[0], d3.max([value, high, log ? domain[0] : 0].filter(Number.isFinite)));

    const marks = series.flatMap((_, s) => {
      const mine = rows.filter((d) => d.series === s);
      const { fill, stroke } = series.length === 1 ? { fill: "var(--bar)", stroke: "var(--bar)" } : SERIES_FILLS[s % 2];
      const base = log ? domain[0] : 0;
      return [
        log
          ? [
              Plot.ruleY(mine, { ...channels(s), x1: base, x2: (d) => scaled(d.value), stroke, strokeOpacity: 0.35 }),
              Plot.dot(mine, { ...channels(s), x: (d) => scaled(d.value), r: 4, fill, stroke }),
            ]
          : Plot.rect(mine, {
              x1: 0,
              x2: (d) => scaled(d.value),
              y: "name",
              insetTop: offset(s) + step / 2 - thickness / 2 + 0.5,
              insetBottom: step / 2 - offset(s) - thickness / 2 + 0.5,
              fill,
              stroke,
              strokeWidth: 1,
            }),
        Plot.ruleY(
          mine.filter((d) => Number.isFinite(d.low)),
          {
            ...channels(s),
            x1: (d) => scaled(d.low),
            x2: (d) => scaled(d.high),
            stroke: "var(--ink)",
            strokeWidth: 1.2,
            marker: "tick",
          },
        ),
        Plot.text(mine, {
          ...channels(s),
          x: (d) => scaled(labelAt(d)),
          text: valueText,
          textAnchor: "start",
          dx: 6,
          fontVariant: "tabular-nums",
        }),
      ].flat();
    });
    const svg = draw(describe(rows), {
      width,
      height: count * step + 26,
      marginLeft,
      marginRight,
      marginTop: 24,
      marginBottom: 2,
      x: {
        type: log ? "log" : "linear",
        domain: domain.map((v) => v / axis.factor),
        axis: "top",
        label: null,
        grid: true,
        ...(log
          ? { ticks: logTicks(domain, (width - marginLeft - marginRight) / 45), tickFormat: logTick }
          : { ticks: Math.max(2, Math.floor((width - marginLeft - marginRight) / 90)) }),
      },
      y: {
        type: "band",
        domain: rows.filter((d) => d.series === 0).map((d) => d.name),
        padding: 0,
        label: null,
        tickSize: 0,
        tickFormat: (name) => shortened(name, marginLeft - 10),
      },
      marks: [
        ...marks,
        log ? [] : Plot.ruleX([0], { stroke: "var(--ink)" }),
        Plot.tip(rows, Plot.pointerY({ x: (d) => scaled(d.value), y: "name", title: tip, anchor: "left" })),
      ],
    });
    return [title(labelled(quantity.label, oneUnit ? axis.unit : "")), series.length > 1 ? legend() : [], svg].flat();
  }

  function legend() {
    const entries = series.map((name, s) => swatch(SERIES_FILLS[s % 2].fill, SERIES_FILLS[s % 2].stroke, name));
    return element("p", { class: "swatches" }, ...entries);
  }

  function describe(rows) {
    const best = rows[d3.maxIndex(rows, ({ value }) => Math.abs(value))];
    const of = choices.text ? ` of ${choices.text}` : "";
    const whose = series.length > 1 ? ` (${series[best.series]})` : "";
    return `Bars: ${quantity.label}${of}. The largest of ${names.length} is ${best.name}${whose} with ${withUnit(number(best.value), best.unit)}.`;
  }
}
