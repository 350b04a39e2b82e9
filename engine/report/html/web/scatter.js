// A scatter plot of two results, with a dot for each item. The largest items, and those farthest from the diagonal, are
// named.

const MOST_NAMES = 12;

function scatter(figure, data) {
  const names = data.names;
  const place = new Place(figure, drawScatter);
  const choices = new Choices(data.choices, () => place.redraw());
  place.controls.append(...choices.controls);

  function drawScatter(width) {
    const [x, y] = [data.x, data.y].map(({ value }) => row(values(value), choices.row, names.length));
    const unit = data.units?.[choices.row] ?? "";
    const all = names
      .map((name, p) => ({ name, x: x[p], y: y[p] }))
      .filter((point) => Number.isFinite(point.x) && Number.isFinite(point.y));
    if (!all.length) return nothing();
    const log = apart(all);
    const points = log ? all.filter(positive) : all;
    const [low, high] = valueExtent(points.flatMap((point) => [point.x, point.y]));
    const margin = 0.04 * (high - low);
    const axis = log ? { factor: 1, unit } : axisUnit([low, high], unit);
    const domain = log ? [low / 1.5, high * 1.5] : [low < 0 ? low - margin : 0, high + margin].map((v) => v / axis.factor);
    const size = Math.min(width, 600);
    const at = { x: (point) => point.x / axis.factor, y: (point) => point.y / axis.factor };
    const said = (point) =>
      `${point.name}\n${data.x.label}: ${withUnit(number(point.x), unit)}\n${data.y.label}: ${withUnit(number(point.y), unit)}`;
    const most = Math.max(3, Math.floor(size / 90));
    const scale = log
      ? { type: "log", domain, grid: true, ticks: logTicks(domain, most), tickFormat: logTick }
      : { domain, grid: true, ticks: most };
    return draw(sentence(points, unit), {
      width: size,
      height: size,
      marginLeft: 56,
      marginBottom: 42,
      marginTop: 30,
      marginRight: 16,
      x: { ...scale, label: labelled(data.x.label, axis.unit), labelAnchor: "center", labelArrow: "none" },
      y: { ...scale, label: labelled(data.y.label, axis.unit), labelArrow: "none" },
      marks: [
        Plot.line(
          domain.map((v) => [v, v]),
          { stroke: "var(--quiet)", strokeDasharray: "4 4" },
        ),
        Plot.dot(points, { ...at, r: 4, fill: "var(--bar)", fillOpacity: 0.35, stroke: "var(--bar)" }),
        pointNames(points, at),
        tip(points, { ...at, title: said }),
      ],
    });
  }

  function sentence(points, unit) {
    const best = points[d3.maxIndex(points, (point) => Math.max(point.x, point.y))];
    const of = choices.text ? ` for ${choices.text}` : "";
    const largest = `${best.name} with ${withUnit(number(best.x), unit)} and ${withUnit(number(best.y), unit)}`;
    return `Dots: ${data.y.label} against ${data.x.label}${of}, ${points.length} items. The largest is ${largest}.`;
  }

  return place;
}

function positive({ x, y }) {
  return x > 0 && y > 0;
}

/// Whether some item differs a hundredfold between the two results, so that both axes are logarithmic. Never if a value
/// is negative.
function apart(points) {
  if (points.some(({ x, y }) => x < 0 || y < 0)) return false;
  return points.filter(positive).some(({ x, y }) => Math.max(x / y, y / x) >= HUNDREDFOLD);
}

/// Names beside dots, the most important first, as far as they cover no dot and no other name.
function pointNames(points, at) {
  const telling = d3.sort(
    points,
    (point) => -Math.max(Math.abs(point.x), Math.abs(point.y)) - 4 * Math.abs(point.x - point.y),
  );
  return (index, scales, channels, { width, marginRight }) => {
    const dots = points.map((point) => ({
      left: scales.x(at.x(point)) - 5,
      right: scales.x(at.x(point)) + 5,
      top: scales.y(at.y(point)) - 5,
      bottom: scales.y(at.y(point)) + 5,
    }));
    const taken = [...dots];
    const free = (box) =>
      taken.every(
        (other) => box.right < other.left || box.left > other.right || box.bottom < other.top || box.top > other.bottom,
      );
    const group = svgElement("g", { fill: "currentColor", "text-anchor": "start" });
    for (const point of telling.slice(0, MOST_NAMES)) {
      const [x, y, w] = [scales.x(at.x(point)), scales.y(at.y(point)), textWidth(point.name)];
      const spots = [
        { left: x + 8, right: x + 8 + w },
        { left: x - 8 - w, right: x - 8 },
      ].map((spot) => ({ ...spot, top: y - 7, bottom: y + 7 }));
      const box = spots.find((spot) => spot.right < width - marginRight + 12 && spot.left > 0 && free(spot));
      if (!box) continue;
      taken.push(box);
      group.append(svgElement("text", { x: box.left, y, dy: "0.32em" }, point.name));
    }
    return group;
  };
}
