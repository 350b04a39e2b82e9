// Poses as dots that are coloured by a field. There is a view for each pair of three coordinates, and one that can be
// turned.

const START_VIEW = { yaw: 35, pitch: 22 };
const TURN_STEP = 10;
const SLICES = 10;
const FAINT = 0.12;
// An edge by which dots of light and dark colours stand out from light and dark paper.
const DOT_EDGE = { stroke: "var(--ink)", strokeOpacity: 0.4, strokeWidth: 0.6 };

function workspace(figure, data) {
  const coordinates = varying(data.coordinates);
  const count = values(coordinates[0].value).length;
  const numberOf = (m) => (data.numbers ? values(data.numbers)[m] : m);
  let field = data.fields[0];
  let item = firstItem(field);
  let slice = 0; // 0: all poses; k: those in the k-th of SLICES overlapping parts of the third coordinate's range
  let say = () => {}; // writes beside the slider which slice it is
  const axes = coordinates.slice(0, 3).map((_, k) => k);
  const view = { ...START_VIEW };

  const place = new Place(figure, (width) => {
    items.hidden = !(field.rows?.length > 1);
    return known(shown()).length ? drawViews(width) : nothing();
  });
  const redraw = () => place.redraw();
  const items = element("span", { class: "control-group" });
  place.controls.append(
    select(
      "Colour",
      data.fields.map(({ label }) => label),
      (i) => {
        field = data.fields[i];
        item = firstItem(field);
        offerItems();
        redraw();
      },
    ),
    items,
    ...axisControls(),
    ...(axes.length > 2 ? [sliceControl()] : []),
  );
  offerItems();

  /// The ends of the chosen slice, as values of the third coordinate.
  function sliceEnds() {
    const [low, high] = d3.extent(values(coordinates[axes[2]].value));
    const step = (high - low) / SLICES;
    return slice === 0 ? [low, high] : [low + (slice - 1.5) * step, low + (slice + 0.5) * step];
  }

  function sliceWords() {
    const { name, unit } = coordinates[axes[2]];
    if (slice === 0) return `all ${name}`;
    const [low, high] = d3.extent(values(coordinates[axes[2]].value));
    const [from, to] = sliceEnds();
    return `${name} from ${number(Math.max(from, low))} to ${withUnit(number(Math.min(to, high)), unit)}`;
  }

  /// A slider through the third coordinate. In the first view, poses outside the chosen slice are faint.
  function sliceControl() {
    const said = element("span", {}, sliceWords());
    const { control, say: sayAloud } = slider("slice", SLICES, sliceWords, (k) => {
      slice = k;
      say();
      redraw();
    });
    say = () => {
      said.textContent = sliceWords();
      sayAloud();
    };
    control.append(said);
    return control;
  }

  function offerItems() {
    items.replaceChildren(
      ...(field.rows
        ? [
            select(
              "of",
              field.rows,
              (i) => {
                item = i;
                redraw();
              },
              item,
            ),
          ]
        : []),
    );
  }

  /// The first item, or that which differs most: others may differ nowhere.
  function firstItem({ rows, signed, value }) {
    if (!rows || !signed) return 0;
    const most = (k) => d3.max(row(values(value), k, count), Math.abs);
    return Math.max(0, d3.maxIndex(rows, (_, k) => most(k)));
  }

  /// Which three of more coordinates are shown.
  function axisControls() {
    if (coordinates.length <= 3) return [];
    const names = coordinates.map(({ name }) => name);
    return axes.map((k) => {
      const control = select(`Axis ${k + 1}`, names, (i) => {
        axes[k] = i;
        say();
        redraw();
      });
      control.querySelector("select").selectedIndex = k;
      return control;
    });
  }

  function shown() {
    return row(values(field.value), field.rows ? item : 0, count);
  }

  function drawViews(width) {
    const array = shown();
    const what = field.rows ? `${field.label}, ${field.rows[item]}` : field.label;
    const { colour, legend } = fieldColours(array, { ...field, label: what });
    const poses = d3.range(count).map((m) => ({
      m,
      value: array[m],
      colour: colour(array[m]) ?? "var(--unknown)",
      at: axes.map((k) => values(coordinates[k].value)[m]),
    }));
    const chosen = axes.map((k) => coordinates[k]);
    const size = width < 620 ? width : Math.floor((width - 24) / 2);
    const pairs = d3.cross(d3.range(axes.length), d3.range(axes.length)).filter(([a, b]) => a < b);
    const text = ({ m, value }) =>
      [`pose ${numberOf(m)}`, ...positionOf(m, chosen), withUnit(number(value), field.unit)].join("\n");
    const highest = poses[d3.maxIndex(poses, ({ value }) => value)];
    const largest = `${withUnit(number(highest.value), field.unit)} at ${positionOf(highest.m, chosen).join(", ")}`;
    const sentence = `${what} at ${count} poses; the largest is ${largest}.`;

    const [from, to] = axes.length > 2 ? sliceEnds() : [0, 0];
    const isFaint = ({ at }) => slice > 0 && (at[2] < from || at[2] > to);
    const flat = (pairs.length ? pairs : [[0, 0]]).map(([a, b], n) =>
      projection(poses, chosen, a, b, size, text, sentence, n === 0 ? isFaint : () => false),
    );
    const views = axes.length > 2 ? [...flat, turning(poses, chosen, size, sentence)] : flat;
    return [legend(width), element("div", { class: "views" }, ...views)];
  }

  function projection(poses, chosen, a, b, size, text, sentence, isFaint) {
    const coordinate = (k) => (pose) => pose.at[k];
    const labels = [a, b].map((k) => labelled(chosen[k].name, chosen[k].unit));
    const domains = [a, b].map((k) => extent(poses.map(coordinate(k))));
    const y = a === b ? () => 0 : coordinate(b);
    return draw(`Dots: ${sentence} Seen along ${labels.join(" and ")}.`, {
      width: size,
      height: a === b ? 100 : Math.round(size * 0.72),
      marginLeft: 52,
      marginBottom: 40,
      marginRight: 14,
      inset: 8,
      x: { domain: domains[0], label: labels[0], labelAnchor: "center", labelArrow: "none", ticks: 5, grid: true },
      y: a === b ? { axis: null } : { domain: domains[1], label: labels[1], labelArrow: "none", ticks: 5, grid: true },
      marks: [
        Plot.dot(poses.filter(isFaint), { x: coordinate(a), y, fill: "colour", r: dotSize(count), opacity: FAINT }),
        Plot.dot(
          poses.filter((pose) => !isFaint(pose)),
          { x: coordinate(a), y, fill: "colour", r: dotSize(count), ...DOT_EDGE },
        ),
        tip(poses, { x: coordinate(a), y, title: text }),
      ],
    });
  }

  function turning(poses, chosen, size, sentence) {
    const box = element("div");
    const show = () => box.replaceChildren(turned(poses, chosen, size, view, sentence));
    show();
    return turnable(box, "View", view, START_VIEW, TURN_STEP, show);
  }

  return place;
}

// The edges of the box that serve as axes: at the front, below and at the left. Each is named at its far end.
const AXIS_STARTS = [
  [-0.5, -0.5, -0.5],
  [-0.5, -0.5, -0.5],
  [-0.5, 0.5, -0.5],
];

/// The coordinates in which the poses differ, or the first one if they differ in none.
function varying(coordinates) {
  const list = coordinates.filter(({ value }) => d3.min(values(value)) < d3.max(values(value)));
  return list.length ? list : coordinates.slice(0, 1);
}

function dotSize(count) {
  return Math.max(1.6, Math.min(4.5, 90 / Math.sqrt(count)));
}

/// An orthographic picture of the box that the three coordinates fill, each over its range.
function turned(poses, chosen, size, { yaw, pitch }, sentence) {
  const ranges = chosen.map((_, k) => extent(poses.map(({ at }) => at[k])));
  const [sinYaw, cosYaw, sinPitch, cosPitch] = [yaw, pitch].flatMap((angle) => [
    Math.sin((angle * Math.PI) / 180),
    Math.cos((angle * Math.PI) / 180),
  ]);
  const project = ([x, y, z]) => {
    const [right, deep] = [x * cosYaw - y * sinYaw, x * sinYaw + y * cosYaw];
    return { x: right, y: z * cosPitch + deep * sinPitch, depth: deep * cosPitch - z * sinPitch };
  };
  const within = (at) => at.map((v, k) => (v - ranges[k][0]) / (ranges[k][1] - ranges[k][0]) - 0.5);
  const dots = poses.map((pose) => ({ ...project(within(pose.at)), colour: pose.colour }));
  dots.sort((a, b) => b.depth - a.depth);

  const corners = d3.cross(d3.cross([-0.5, 0.5], [-0.5, 0.5]), [-0.5, 0.5], ([x, y], z) => [x, y, z]);
  const edges = corners.flatMap((from) =>
    [0, 1, 2].filter((k) => from[k] < 0).map((k) => ({ from, k, to: from.with(k, 0.5) })),
  );
  const lines = edges.map(({ from, k, to }) => ({
    from: project(from),
    to: project(to),
    axis: from.every((v, j) => v === AXIS_STARTS[k][j]),
  }));
  // A little outside the box, so that numbers and dots do not cover each other.
  const besides = (k, at) => AXIS_STARTS[k].map((v, j) => (j === k ? at : 1.22 * v));
  // Names of the axes below stand behind their last numbers, where those of the upright axis do not reach.
  const names = chosen.map(({ name, unit }, k) => ({
    ...project(k === 2 ? AXIS_STARTS[k].with(k, 0.6) : besides(k, 0.62)),
    text: labelled(name, unit),
  }));
  const numbers = chosen.flatMap((_, k) =>
    d3.ticks(...ranges[k], 3).map((v) => ({
      ...project(besides(k, (v - ranges[k][0]) / (ranges[k][1] - ranges[k][0]) - 0.5)),
      text: plain(v),
    })),
  );
  return draw(`Dots in three dimensions, turned by ${Math.round(yaw)} and ${Math.round(pitch)} degrees: ${sentence}`, {
    width: size,
    height: Math.round(size * 0.72),
    margin: 0,
    x: { domain: [-1.25, 1.25], axis: null },
    y: { domain: [-0.9, 0.9], axis: null },
    marks: [
      Plot.link(lines, {
        x1: (d) => d.from.x,
        y1: (d) => d.from.y,
        x2: (d) => d.to.x,
        y2: (d) => d.to.y,
        stroke: (d) => (d.axis ? "var(--ink)" : "var(--quiet)"),
        strokeOpacity: (d) => (d.axis ? 1 : 0.4),
        strokeWidth: (d) => (d.axis ? 1.5 : 1),
      }),
      Plot.dot(dots, { x: "x", y: "y", fill: "colour", r: dotSize(poses.length), ...DOT_EDGE }),
      Plot.text(numbers, { x: "x", y: "y", text: "text", fill: "var(--quiet)" }),
      ["end", "middle", "start"].map((textAnchor, side) =>
        Plot.text(
          names.filter(({ x }) => (x < -0.1 ? 0 : x < 0.1 ? 1 : 2) === side),
          { x: "x", y: "y", text: "text", textAnchor, fill: "currentColor", stroke: "var(--paper)", strokeWidth: 4 },
        ),
      ),
    ],
  });
}
