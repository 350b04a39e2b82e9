// Lines over a common axis, in panels; each line is named at its end, or below the panel where its name is too wide for
// that, and intervals are bands. Over pose numbers, which are in no order, values are dots that no line joins.

const MOST_PANELS = 4;
// What tells series apart beside their colours.
const STYLES = {
  solid: { dash: undefined, symbol: "circle", sign: "●" },
  dashed: { dash: "6 4", symbol: "triangle", sign: "▲" },
  dotted: { dash: "1.5 4", symbol: "diamond", sign: "◆" },
};
const STYLE_NAMES = Object.keys(STYLES);
const UNORDERED = "pose number";
const SERIES_COLOURS = d3.range(8).map((k) => `var(--series-${k + 1})`);
const LABEL_STEP = 14;

function lines(figure, data) {
  const names = [...new Set(data.panels.flatMap(({ series }) => series.map(({ label }) => label)))];
  const x = values(data.x.value);
  const joined = data.x.label !== UNORDERED;
  const xMarks = (data.marks ?? []).map((mark) => ({ ...mark, unit: data.x.unit }));
  const ticked = new Set(names.slice(0, data.most ?? names.length));
  let panel = 0;

  const place = new Place(figure, (width) => {
    const panels = data.panels.length > MOST_PANELS ? [data.panels[panel]] : data.panels;
    return panels.map((one) => drawPanel(one, width));
  });
  const redraw = () => place.redraw();
  if (data.panels.length > MOST_PANELS)
    place.controls.append(
      select(
        "Show",
        data.panels.map(({ label }) => label),
        (i) => {
          panel = i;
          redraw();
        },
      ),
    );
  if (names.length > 1) place.plot.after(checkboxes());

  function checkboxes() {
    const boxes = names.map((name) => {
      const box = element("input", {
        type: "checkbox",
        ...(ticked.has(name) && { checked: "" }),
        onchange: () => {
          box.checked ? ticked.add(name) : ticked.delete(name);
          redraw();
        },
      });
      return element("label", {}, box, element("span", {}, ...named(name)));
    });
    return element(
      "fieldset",
      { class: "checkboxes" },
      element("legend", {}, "Lines shown"),
      element("div", {}, ...boxes),
    );
  }

  /// Styles other than solid are kept; solid lines take turns where there are more than colours.
  function styleOf(label, style) {
    if (style && style !== "solid") return style;
    return STYLE_NAMES[Math.floor(names.indexOf(label) / SERIES_COLOURS.length) % STYLE_NAMES.length];
  }

  /// [{label, colour, style, points: [{x, y, low, high}]}] of the series ticked.
  function seriesShown({ series }) {
    return series
      .filter(({ label }) => ticked.has(label))
      .map(({ label, value, low, high, style }) => {
        const [y, below, above] = [value, low, high].map(values);
        const points = d3
          .range(x.length)
          .map((k) => ({ x: x[k], y: y[k], low: below ? below[k] : NaN, high: above ? above[k] : NaN }));
        return {
          label,
          colour: SERIES_COLOURS[names.indexOf(label) % SERIES_COLOURS.length],
          style: styleOf(label, style),
          points,
        };
      });
  }

  function drawPanel(one, width) {
    const { unit } = one;
    const shown = seriesShown(one);
    const numbers = shown
      .flatMap(({ points }) => points.flatMap(({ y, low, high }) => [y, low, high]))
      .filter(Number.isFinite);
    if (!numbers.length) return element("div", { class: "panel" }, title(one.label), nothing(whyEmpty(one, shown)));
    const yMarks = (one.marks ?? []).filter(({ value }) => isNear(value, numbers));
    const domain = valueExtent([...numbers, ...yMarks.map(({ value }) => value)]);
    const axis = axisUnit(domain, unit);
    const alone = names.length === 1; // named in the title
    const labelWidth = textWidth(...shown.map(({ label }) => label)) + 16;
    const below = !joined || labelWidth > width * 0.4;
    const marginRight = below || alone ? 16 : labelWidth;
    const height = below ? 240 : Math.max(240, shown.length * LABEL_STEP + 60);
    const scaled = (key) => (point) => point[key] / axis.factor;
    const log = Boolean(data.x.log);
    const marks = shown.flatMap(({ points, colour, style, label }) =>
      [
        joined ? line(points, scaled, colour, style) : dots(points, scaled, colour, style),
        tip(points, {
          x: "x",
          y: scaled("y"),
          maxRadius: 14,
          title: (point) =>
            [
              label,
              about(label),
              `${data.x.label} ${withUnit(plain(point.x), data.x.unit)}`,
              withInterval({ ...point, value: point.y }, unit),
            ]
              .filter(Boolean)
              .join("\n"),
        }),
      ].flat(),
    );
    const [from, to] = extent([...x, ...xMarks.map(({ value }) => value)]);
    const room = ({ value, beyond }) => value + { above: 0.04, below: -0.04 }[beyond] * (to - from); // for the tint
    const xDomain = d3.extent([from, to, ...xMarks.filter(({ beyond }) => beyond).map(room)]);
    const svg = draw(sentence(one, shown, unit), {
      width,
      height,
      marginLeft: 56,
      marginRight,
      marginTop: 10,
      marginBottom: 40,
      x: {
        type: log ? "log" : "linear",
        domain: xDomain,
        inset: joined ? 0 : 8,
        label: labelled(data.x.label, data.x.unit),
        labelAnchor: "center",
        labelArrow: "none",
        ...(log
          ? { ticks: logTicks(xDomain, (width - marginRight - 56) / 60), tickFormat: logTick }
          : { ticks: Math.max(4, Math.floor((width - marginRight) / 90)) }),
        grid: true,
      },
      y: {
        domain: domain.map((v) => v / axis.factor),
        nice: true,
        grid: true,
        label: null,
        ticks: Math.floor(height / 50),
      },
      marks: [
        beyondLimits(xMarks, data.x.unit),
        levels(yMarks, axis.factor, unit),
        ...marks,
        markedValues(xMarks, xDomain, data.x.unit),
        below || alone ? [] : endLabels(shown, axis.factor),
      ],
    });
    const legend = below && !alone ? [seriesLegend(shown, joined)] : [];
    const what = alone && !one.label.includes(names[0]) ? `${one.label}, ${names[0]}` : one.label;
    return element("div", { class: "panel" }, title(labelled(what, axis.unit)), svg, ...legend);
  }

  function whyEmpty({ series }, shown) {
    if (!series.length) return "Nothing to show here.";
    return shown.length ? undefined : "No line is ticked.";
  }

  function sentence(one, shown, unit) {
    const telling = shown.map(({ label, points }) => ({
      label,
      y: (joined ? points.findLast(({ y }) => Number.isFinite(y))?.y : d3.max(points, ({ y }) => y)) ?? NaN,
    }));
    const best = telling[d3.maxIndex(telling, ({ y }) => y)] ?? telling[0];
    const highest = `${best.label} with ${withUnit(number(best.y), unit)}`;
    const marked = [...xMarks, ...(one.marks ?? [])].map((mark) => ` Marked: ${markText(mark, mark.unit)}.`).join("");
    const over = `${one.label} over ${data.x.label}, ${shown.length}`;
    return joined
      ? `Lines: ${over} lines. At its end the highest is ${highest}.${marked}`
      : `Dots: ${over} series. The highest is ${highest}.${marked}`;
  }

  return place;
}

function line(points, scaled, colour, style) {
  return [
    Plot.areaY(points, { x: "x", y1: scaled("low"), y2: scaled("high"), fill: colour, fillOpacity: 0.13 }),
    Plot.line(points, {
      x: "x",
      y: scaled("y"),
      stroke: colour,
      strokeWidth: 1.7,
      strokeDasharray: STYLES[style].dash,
    }),
    points.length <= 40 ? Plot.dot(points, { x: "x", y: scaled("y"), fill: colour, r: 2.2 }) : [],
  ].flat();
}

/// A level that is so far from the numbers that they would be pressed together is not drawn.
function isNear(value, numbers) {
  return Math.abs(value) <= 3 * d3.max(numbers, Math.abs);
}

/// "limit 0.03 mm"; a pure number says less than its label.
function markText({ label, value }, unit) {
  return isUnit(unit) ? `${label} ${withUnit(plain(value), unit)}` : label;
}

/// Limits stand out from other values that are marked.
function markColour({ beyond }) {
  return beyond ? "var(--limit)" : "var(--ink)";
}

const MARK = { stroke: markColour, strokeWidth: 1.5, strokeDasharray: "5 3" };

/// What lies beyond limits of x, which is not allowed, in a tint over the whole height.
function beyondLimits(xMarks) {
  return (index, scales, channels, { marginTop, marginBottom, marginLeft, width, marginRight, height }) => {
    const group = svgElement("g", { fill: "var(--limit)", "fill-opacity": 0.09 });
    for (const { value, beyond } of xMarks) {
      if (!beyond) continue;
      const at = scales.x(value);
      const [from, to] = beyond === "above" ? [at, width - marginRight] : [marginLeft, at];
      if (to > from) group.append(svgElement("rect", { x: from, y: marginTop, width: to - from, height: height - marginTop - marginBottom }));
    }
    return group;
  };
}

/// Levels of y, each named above its line.
function levels(yMarks, factor, unit) {
  const y = ({ value }) => value / factor;
  const text = (mark) => markText(mark, unit);
  const place = { frameAnchor: "left", textAnchor: "start", dx: 4, dy: -8, fontWeight: 600, fill: markColour };
  return [Plot.ruleY(yMarks, { y, ...MARK }), Plot.text(yMarks, { y, text, ...place, stroke: "var(--paper)", strokeWidth: 3 })];
}

/// A rule at each value, named on the side where there is more room.
function markedValues(xMarks, [from, to], unit) {
  const onTheRight = ({ value }) => value > (from + to) / 2;
  const text = (mark) => markText(mark, unit);
  const halo = { fill: markColour, stroke: "var(--paper)", strokeWidth: 3, fontWeight: 600 };
  const name = (some, side, dx) =>
    Plot.text(some, { x: "value", text, frameAnchor: "top", textAnchor: side, dx, dy: 2, ...halo });
  return [
    Plot.ruleX(xMarks, { x: "value", ...MARK }),
    name(xMarks.filter(onTheRight), "end", -5),
    name(xMarks.filter((mark) => !onTheRight(mark)), "start", 5),
  ];
}

function dots(points, scaled, colour, style) {
  return [
    Plot.ruleX(
      points.filter(({ low }) => Number.isFinite(low)),
      { x: "x", y1: scaled("low"), y2: scaled("high"), stroke: colour, strokeOpacity: 0.4 },
    ),
    Plot.dot(points, { x: "x", y: scaled("y"), fill: colour, r: 2.6, symbol: STYLES[style].symbol }),
  ];
}

/// The names of lines or dots, each behind a piece of it.
function seriesLegend(shown, joined) {
  const piece = ({ colour, style }) =>
    joined
      ? element("i", { class: "stroke", style: `border-top-color:${colour};border-top-style:${style}` })
      : element("i", { class: "sign", style: `color:${colour}`, "aria-hidden": "true" }, STYLES[style].sign);
  const entries = shown.map((one) => element("span", { class: "entry" }, piece(one), element("span", {}, ...named(one.label))));
  return element("p", { class: "swatches below" }, ...entries);
}

/// The name of each line beside its last point; moved apart where they would overlap.
function endLabels(shown, factor) {
  return (index, scales, channels, { width: whole, height, marginRight, marginTop, marginBottom }) => {
    const labels = shown
      .map(({ label, colour, points }) => ({ label, colour, last: points.findLast(({ y }) => Number.isFinite(y)) }))
      .filter(({ last }) => last)
      .map((entry) => ({ ...entry, y: scales.y(entry.last.y / factor) }))
      .sort((a, b) => a.y - b.y);
    spread(labels, marginTop, height - marginBottom);
    const group = svgElement("g", { "text-anchor": "start" });
    for (const { label, colour, y } of labels) {
      group.append(
        svgElement(
          "text",
          { x: whole - marginRight + 8, y, dy: "0.32em", fill: colour, "font-weight": 500 },
          label,
        ),
      );
    }
    return group;
  };
}

/// Moves the sorted labels apart to LABEL_STEP, within the frame.
function spread(labels, top, bottom) {
  for (let k = 1; k < labels.length; ++k) labels[k].y = Math.max(labels[k].y, labels[k - 1].y + LABEL_STEP);
  let limit = bottom;
  for (let k = labels.length - 1; k >= 0; --k, limit -= LABEL_STEP)
    labels[k].y = Math.max(top, Math.min(labels[k].y, limit));
}
