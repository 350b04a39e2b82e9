// Lines over a common axis, in panels; each line is named at its end, and intervals are bands.

const MOST_PANELS = 4;
const DASHES = { solid: undefined, dashed: "6 4", dotted: "1.5 4" };
const SERIES_COLOURS = d3.range(8).map((k) => `var(--series-${k + 1})`);
// Where there are more lines than colours.
const CYCLE_DASHES = [undefined, "8 3", "2 3"];
const LABEL_STEP = 14;

function lines(figure, data) {
  const names = [...new Set(data.panels.flatMap(({ series }) => series.map(({ label }) => label)))];
  const x = values(data.x.value);
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
      return element("label", {}, box, element("span", {}, name));
    });
    return element(
      "fieldset",
      { class: "checkboxes" },
      element("legend", {}, "Lines shown"),
      element("div", {}, ...boxes),
    );
  }

  /// [{label, colour, dash, points: [{x, y, low, high}]}] of the series ticked.
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
          dash:
            DASHES[style] ??
            CYCLE_DASHES[Math.floor(names.indexOf(label) / SERIES_COLOURS.length) % CYCLE_DASHES.length],
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
    if (!numbers.length)
      return element(
        "div",
        { class: "panel" },
        title(one.label),
        shown.length ? nothing() : element("p", { class: "plot-nothing" }, "No line is ticked."),
      );
    const domain = extent(numbers);
    const axis = axisUnit(domain, unit);
    const marginRight = Math.min(textWidth(...shown.map(({ label }) => label)) + 16, width * 0.4);
    const height = Math.max(240, shown.length * LABEL_STEP + 60);
    const scaled = (key) => (point) => point[key] / axis.factor;
    const log = Boolean(data.x.log);
    const marks = shown.flatMap(({ points, colour, dash, label }) =>
      [
        Plot.areaY(points, { x: "x", y1: scaled("low"), y2: scaled("high"), fill: colour, fillOpacity: 0.13 }),
        Plot.line(points, { x: "x", y: scaled("y"), stroke: colour, strokeWidth: 1.7, strokeDasharray: dash }),
        points.length <= 40 ? Plot.dot(points, { x: "x", y: scaled("y"), fill: colour, r: 2.2 }) : [],
        tip(points, {
          x: "x",
          y: scaled("y"),
          maxRadius: 14,
          title: (point) =>
            `${label}\n${data.x.label} ${withUnit(plain(point.x), data.x.unit)}\n${withInterval({ ...point, value: point.y }, unit)}`,
        }),
      ].flat(),
    );
    const xDomain = extent(x);
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
        label: labelled(data.x.label, data.x.unit),
        labelAnchor: "center",
        labelArrow: "none",
        ...(log
          ? { ticks: logTicks(xDomain, (width - marginRight - 56) / 60), tickFormat: logTick }
          : { ticks: Math.max(3, Math.floor((width - marginRight) / 90)) }),
      },
      y: {
        domain: domain.map((v) => v / axis.factor),
        nice: true,
        grid: true,
        label: null,
        ticks: Math.floor(height / 50),
      },
      marks: [...marks, endLabels(shown, axis.factor, marginRight - 12)],
    });
    return element("div", { class: "panel" }, title(labelled(one.label, axis.unit)), svg);
  }

  function sentence(one, shown, unit) {
    const ends = shown.map(({ label, points }) => ({
      label,
      y: points.findLast(({ y }) => Number.isFinite(y))?.y ?? NaN,
    }));
    const best = ends[d3.maxIndex(ends, ({ y }) => y)] ?? ends[0];
    const highest = `${best.label} with ${withUnit(number(best.y), unit)}`;
    return `Lines: ${one.label} over ${data.x.label}, ${shown.length} lines. At its end the highest is ${highest}.`;
  }
}

/// The name of each line beside its last point; moved apart where they would overlap.
function endLabels(shown, factor, width) {
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
          shortened(label, width),
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
