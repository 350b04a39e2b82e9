// A heat map of items and poses, drawn as an image, with a cursor that the pointer and the arrow keys move.

const ROW_HEIGHT = 16;
const MAP_HEIGHT = 1400;
const PRINT_MAP_HEIGHT = 590; // no more than a page has, so that names are not printed smaller

function heatmap(figure, data) {
  const rows = data.rows;
  const coordinates = data.columns.coordinates;
  let layer = data.layers[0];
  const orders = columnOrders(coordinates);
  let orderedBy = orders.find(({ name }) => name === data.columns.order) ?? orders[0];
  const cursor = { row: 0, column: 0 };
  const count = values(layer.value).length / rows.length;
  const numberOf = (m) => (data.columns.numbers ? values(data.columns.numbers)[m] : m);

  const place = new Place(figure, (width) => (known(values(layer.value)).length ? drawMap(width) : nothing()));
  const noun = data.columns.label;
  place.controls.append(
    select(
      "Colour",
      data.layers.map(({ label }) => label),
      (i) => {
        layer = data.layers[i];
        place.redraw();
      },
    ),
    select(
      `Order ${noun}s by`,
      orders.map(({ name }) => name),
      (i) => {
        orderedBy = orders[i];
        place.redraw();
      },
      orders.indexOf(orderedBy),
    ),
  );
  const said = readout("Point at the map, or focus it and use the arrow keys, to read a value.");
  place.plot.after(said);

  /// The columns in their order from left to right.
  function order() {
    const { by } = orderedBy;
    return d3.range(count).sort((a, b) => (by ? d3.ascending(by(a), by(b)) : 0) || a - b);
  }

  function drawMap(width) {
    const array = values(layer.value);
    const poses = order();
    const colours = fieldColours(array, layer);
    const rowHeight = Math.max(2, Math.min(ROW_HEIGHT, (printing ? PRINT_MAP_HEIGHT : MAP_HEIGHT) / rows.length));
    const named = d3.range(0, rows.length, Math.ceil((ROW_HEIGHT - 1) / rowHeight));
    const marginLeft = Math.min(textWidth(...rows) + 10, width * 0.36);
    const ticks = ticksAt(poses, width - marginLeft);
    const svg = draw(sentence(array), {
      width,
      height: rowHeight * rows.length + 44,
      marginLeft,
      marginRight: 12,
      marginTop: 2,
      marginBottom: 42,
      x: { type: "linear", domain: [0, count], axis: null },
      y: { type: "linear", domain: [rows.length, 0], axis: null },
      marks: [
        Plot.frame({ fill: "var(--unknown)", stroke: "none" }),
        imageMark(image(array, poses, colours.colour, rowHeight), count),
        Plot.axisX(
          ticks.map(({ at }) => at),
          {
            tickFormat: (at) => ticks.find((tick) => tick.at === at).text,
            label: labelled(orderedBy.by ? `${noun}s in the order of ${orderedBy.name}` : noun, orderedBy.unit),
            labelAnchor: "center",
            labelArrow: "none",
          },
        ),
        Plot.axisY(
          named.map((p) => p + 0.5),
          { tickFormat: (at) => shortened(rows[Math.floor(at)], marginLeft - 10), tickSize: 0, label: null },
        ),
      ],
    });
    const box = svgElement("rect", { class: "cursor", visibility: "hidden" });
    svg.append(box);
    const map = element(
      "div",
      {
        class: "map",
        tabindex: "0",
        role: "application",
        "aria-label": `Heat map of ${layer.label}. The arrow keys move the cursor.`,
      },
      svg,
    );
    follow(map, svg, box, poses, array);
    return [colours.legend(width), map];
  }

  /// The columns that are numbered below the map.
  function ticksAt(poses, width) {
    const { by } = orderedBy;
    const square = !coordinates.length && count === rows.length; // columns and rows are the same items
    if (square && width / count > textWidth(...rows) + 8) return rows.map((name, c) => ({ at: c + 0.5, text: name }));
    if (!by)
      return d3
        .ticks(0, count - 1, Math.min(count, width / 70))
        .filter(Number.isInteger)
        .map((v) => ({ at: v + 0.5, text: plain(numberOf(v)) }));
    const step = Math.max(1, Math.ceil(count / Math.max(2, Math.floor(width / 70))));
    return d3.range(0, count, step).map((c) => ({ at: c + 0.5, text: plain(Number(by(poses[c]).toPrecision(3))) }));
  }

  function sentence(array) {
    const i = d3.maxIndex(array);
    const where = `${rows[Math.floor(i / count)]} at ${noun} ${numberOf(i % count)}`;
    const largest = `${where} with ${withUnit(number(array[i]), layer.unit)}`;
    return `Heat map: ${layer.label}, ${rows.length} rows, ${count} ${noun}s. The largest value is that of ${largest}.`;
  }

  function follow(map, svg, box, poses, array) {
    const x = svg.scale("x");
    const y = svg.scale("y");
    const show = (r, c) => {
      cursor.row = Math.max(0, Math.min(rows.length - 1, r));
      cursor.column = Math.max(0, Math.min(count - 1, c));
      const [left, right, top, bottom] = [
        x.apply(cursor.column),
        x.apply(cursor.column + 1),
        y.apply(cursor.row),
        y.apply(cursor.row + 1),
      ];
      const wide = Math.max(3, right - left);
      const frame = { x: (left + right - wide) / 2, y: top, width: wide, height: bottom - top, visibility: "visible" };
      setAttributes(box, frame);
      const pose = poses[cursor.column];
      const where = coordinates.length ? ` (${positionOf(pose, coordinates).join(", ")})` : "";
      const value = withUnit(number(array[cursor.row * count + pose]), layer.unit);
      const meaning = about(rows[cursor.row]);
      said.textContent = `${rows[cursor.row]}, ${noun} ${numberOf(pose)}${where}: ${value}${meaning && ` – ${meaning}`}`;
    };
    map.addEventListener("pointermove", (event) => {
      const scale = svg.viewBox.baseVal.width / svg.getBoundingClientRect().width;
      const corner = svg.getBoundingClientRect();
      const [column, r] = [
        x.invert((event.clientX - corner.left) * scale),
        y.invert((event.clientY - corner.top) * scale),
      ];
      if (column >= 0 && column < count && r >= 0 && r < rows.length) show(Math.floor(r), Math.floor(column));
    });
    const steps = {
      ArrowLeft: [0, -1],
      ArrowRight: [0, 1],
      ArrowUp: [-1, 0],
      ArrowDown: [1, 0],
      PageUp: [-10, 0],
      PageDown: [10, 0],
      Home: [0, -count],
      End: [0, count],
    };
    map.addEventListener("keydown", (event) => {
      const step = steps[event.key];
      if (!step || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      const moves = box.getAttribute("visibility") === "visible";
      show(cursor.row + (moves ? step[0] : 0), cursor.column + (moves ? step[1] : 0));
    });
  }

  /// The map as an image. A column is one pixel wide, because the image is stretched when drawn; a row has its height
  /// in pixels.
  function image(array, poses, colour, rowHeight) {
    const small = element("canvas", { width: count, height: rows.length }).getContext("2d");
    const pixels = small.createImageData(count, rows.length);
    const rgba = colourTable(colour);
    poses.forEach((pose, c) =>
      rows.forEach((_, r) => pixels.data.set(rgba(array[r * count + pose]), 4 * (r * count + c))),
    );
    small.putImageData(pixels, 0, 0);
    const high = element("canvas", { width: count, height: Math.round(rows.length * rowHeight) });
    const context = high.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.drawImage(small.canvas, 0, 0, high.width, high.height);
    return high.toDataURL();
  }

  return place;
}

/// [{name, unit, by}] for the orders of a map's columns, which are sorted by by(m) of column m. Columns without `by`
/// keep their order. There is an order for each coordinate, and one for the magnitude of a coordinate with both signs.
function columnOrders(coordinates) {
  const orders = [{ name: "number" }];
  for (const { name, unit, value } of coordinates) orders.push({ name, unit, by: (m) => values(value)[m] });
  for (const { name, unit, value } of coordinates) {
    const [low, high] = extent(values(value));
    if (low < 0 && high > 0) orders.push({ name: `|${name}|`, unit, by: (m) => Math.abs(values(value)[m]) });
  }
  return orders;
}

/// A function that converts a value to [red, green, blue, alpha], transparent if the value is unknown. Each colour is
/// parsed once.
function colourTable(colour) {
  const parsed = new Map();
  return (value) => {
    const text = colour(value);
    if (text === null) return [0, 0, 0, 0];
    if (!parsed.has(text)) {
      const { r, g, b } = d3.rgb(text);
      parsed.set(text, [r, g, b, 255]);
    }
    return parsed.get(text);
  };
}

/// The image, stretched over the whole frame. Pixels stay sharp if they are larger than those of the screen.
function imageMark(source, columns) {
  return (index, scales, channels, { width, height, marginLeft, marginTop, marginRight, marginBottom }) => {
    const shown = width - marginLeft - marginRight;
    return svgElement("image", {
      href: source,
      x: marginLeft,
      y: marginTop,
      width: shown,
      height: height - marginTop - marginBottom,
      preserveAspectRatio: "none",
      style: columns < shown ? "image-rendering:pixelated" : "",
    });
  };
}
