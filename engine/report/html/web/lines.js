// Lines over a common axis, in panels. Each line is named at its end, or below the panel if its name is too wide; its
// interval is a band. Over pose numbers, which have no order, values are dots that are not joined.

const MOST_PANELS = 4;
// How series differ in addition to their colours.
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
  const ticked = new Set(firstNames(data, names));
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
      element("legend", {}, joined ? "Lines shown" : "Dots shown"),
      element("div", {}, ...boxes),
    );
  }

  /// The style of a series. Solid lines take turns with other styles if there are more series than colours.
  function styleOf(label, style) {
    if (style && style !== "solid") return style;
    return STYLE_NAMES[Math.floor(names.indexOf(label) / SERIES_COLOURS.length) % STYLE_NAMES.length];
  }

  /// [{label, colour, style, points: [{x, y, low, high}]}] for the series that the reader ticked.
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
    const alone = names.length === 1; // its name is in the title
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
    const room = ({ value, beyond }) => value + { above: 0.04, below: -0.04 }[beyond] * (to - from); // room for the tint
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
          : { ticks: linearTicks(xDomain, Math.max(4, Math.floor((width - marginRight) / 90)), joined) }),
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
        markedValues(xMarks, shown, xDomain, domain, data.x.unit),
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

/// The names that are ticked at first: as many as the report says, and the first of each panel, which matters most there.
function firstNames({ panels, most }, names) {
  const firsts = panels.length > MOST_PANELS ? [] : panels.flatMap(({ series }) => series.slice(0, 1));
  return [...names.slice(0, most ?? names.length), ...firsts.map(({ label }) => label)];
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

/// Ticks of an axis; pose numbers are whole.
function linearTicks(domain, most, joined) {
  return joined ? most : d3.ticks(...domain, most).filter(Number.isInteger);
}

/// A level that is so far from the numbers that they would be pressed together is not drawn.
function isNear(value, numbers) {
  return Math.abs(value) <= 3 * d3.max(numbers, Math.abs);
}

/// The text of a mark: "limit 0.03 mm", or only its label if the value has no unit.
function markText({ label, value }, unit) {
  return isUnit(unit) ? `${label} ${withUnit(plain(value), unit)}` : label;
}

/// The colour of a mark; limits differ from other marked values.
function markColour({ beyond }) {
  return beyond ? "var(--limit)" : "var(--ink)";
}

const MARK = { stroke: markColour, strokeWidth: 1.5, strokeDasharray: "5 3" };

/// Tints the areas beyond limits of x, over the whole height.
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

/// Marks at values of y, each a horizontal line with its name above.
function levels(yMarks, factor, unit) {
  const y = ({ value }) => value / factor;
  const text = (mark) => markText(mark, unit);
  const place = { frameAnchor: "left", textAnchor: "start", dx: 4, dy: -8, fontWeight: 600, fill: markColour };
  return [Plot.ruleY(yMarks, { y, ...MARK }), Plot.text(yMarks, { y, text, ...place, stroke: "var(--paper)", strokeWidth: 3 })];
}

/// A rule at each value, named on the side where there is more room; at the bottom where lines pass through the top there.
function markedValues(xMarks, shown, [from, to], [low, high], unit) {
  const onTheRight = ({ value }) => value > (from + to) / 2;
  const isTaken = (mark) => {
    const ends = [mark.value, mark.value + (onTheRight(mark) ? -0.2 : 0.2) * (to - from)].sort(d3.ascending);
    const isThere = ({ x, y }) => x >= ends[0] && x <= ends[1] && y > low + 0.85 * (high - low);
    return shown.some(({ points }) => points.some(isThere));
  };
  const text = (mark) => markText(mark, unit);
  const halo = { fill: markColour, stroke: "var(--paper)", strokeWidth: 3, fontWeight: 600 };
  const names = d3.cross([false, true], [false, true], (right, taken) => {
    const some = xMarks.filter((mark) => onTheRight(mark) === right && isTaken(mark) === taken);
    const side = right ? { textAnchor: "end", dx: -5 } : { textAnchor: "start", dx: 5 };
    const end = taken ? { frameAnchor: "bottom", dy: -4 } : { frameAnchor: "top", dy: 2 };
    return Plot.text(some, { x: "value", text, ...side, ...end, ...halo });
  });
  return [Plot.ruleX(xMarks, { x: "value", ...MARK }), ...names];
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

/// A legend of series: each name with a piece of its line or with its dot.
function seriesLegend(shown, joined) {
  const piece = ({ colour, style }) =>
    joined
      ? element("i", { class: "stroke", style: `border-top-color:${colour};border-top-style:${style}` })
      : element("i", { class: "sign", style: `color:${colour}`, "aria-hidden": "true" }, STYLES[style].sign);
  const entries = shown.map((one) => element("span", { class: "entry" }, piece(one), element("span", {}, ...named(one.label))));
  return element("p", { class: "swatches below" }, ...entries);
}

/// The names of lines beside their last points, moved apart if they would overlap.
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

/// Moves sorted labels apart by LABEL_STEP, within the frame.
function spread(labels, top, bottom) {
  for (let k = 1; k < labels.length; ++k) labels[k].y = Math.max(labels[k].y, labels[k - 1].y + LABEL_STEP);
  let limit = bottom;
  for (let k = labels.length - 1; k >= 0; --k, limit -= LABEL_STEP)
    labels[k].y = Math.max(top, Math.min(labels[k].y, limit));
}
