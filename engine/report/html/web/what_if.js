// What the yield would be if errors had other sizes. Sliders set the sizes; the yield is predicted from machines whose
// responses change linearly with their errors.

/// Machines with the study's sizes, and how their responses change with their errors. Predicts the yield at other
/// sizes.
class SizedMachines {
  constructor(data) {
    this.data = data;
    this.components = values(data.components);
    this.deviations = values(data.deviations);
    this.slopes = values(data.slopes);
    this.errors = this.deviations.length / data.machines;
    this.good = this.distances(data.sliders.map(() => 1)).map((distance) => (distance <= 0 ? 1 : 0));
  }

  /// For each machine, how far its worst response at any pose is beyond its limit, in the unit of the limit. Negative
  /// if the machine is within all limits.
  distances(factors) {
    const { machines, poses, limits, sliders } = this.data;
    const changes = sliders.flatMap(({ errors }, g) => errors.map((e) => ({ e, change: factors[g] - 1 })));
    const moving = changes.filter(({ change }) => change !== 0);
    const worst = new Float64Array(machines).fill(-Infinity);
    let row = 0;
    for (let k = 0; k < poses; ++k) {
      for (const limit of limits) {
        const rows = d3.range(limit.components).map(() => this.changed(row++, moving));
        for (let b = 0; b < machines; ++b) {
          const value = rows.length > 1 ? Math.hypot(...rows.map((one) => one[b])) : rows[0][b];
          const beyond = Math.max((limit.low ?? -Infinity) - value, value - (limit.high ?? Infinity));
          worst[b] = Number.isNaN(beyond) ? Infinity : Math.max(worst[b], beyond);
        }
      }
    }
    return worst;
  }

  /// One component of the limited responses, for all machines, after errors changed their sizes.
  changed(row, moving) {
    const { machines } = this.data;
    const numbers = Float64Array.from(this.components.subarray(row * machines, (row + 1) * machines));
    for (const { e, change } of moving) {
      const slope = change * this.slopes[row * this.errors + e];
      for (let b = 0; b < machines; ++b) numbers[b] += slope * this.deviations[e * machines + b];
    }
    return numbers;
  }

  /// The predicted yield with its interval. The interval covers chance, machines that the linear map may misjudge, and
  /// machines that are rejected only by poses not shown here.
  yield(factors) {
    const { machines, linearError, missed } = this.data;
    const [study, low, high] = this.data.yield;
    const farthest = d3.max(factors, (factor) => Math.abs(factor - 1));
    if (farthest === 0) return { value: study, low, high };
    const distances = this.distances(factors);
    const near = linearError * farthest;
    const count = (holds) => d3.range(machines).filter((b) => holds(distances[b])).length;
    const doubtful = Math.max(
      count((distance) => distance > -near && distance <= 0),
      count((distance) => distance > 0 && distance <= near),
    );
    const other = doubtful / machines + missed;
    const { value, slope, chance } = this.regression(distances);
    return {
      value: Math.min(1, Math.max(0, value)),
      low: Math.max(0, value - Math.hypot(slope * (study - low), chance) - other),
      high: Math.min(1, value + Math.hypot(slope * (high - study), chance) + other),
    };
  }

  /// The predicted share of good machines, by regression. distances: those of the machines at the new sizes. These
  /// machines are part of all machines of the study, so their share is corrected by the difference between their yield
  /// and the study's yield at the study's sizes. The correction is stronger the more often a machine is good at both
  /// sizes. chance: the half-width of what chance leaves. As Agresti and Coull do for one proportion, one is added to
  /// each of the four counts.
  regression(distances) {
    const { machines, quantile } = this.data;
    const counts = [0, 0, 0, 0]; // good at both sizes, only at the study's, only at the new ones, at neither
    this.good.forEach((good, b) => ++counts[(good ? 0 : 2) + (distances[b] <= 0 ? 0 : 1)]);
    const all = machines + 4;
    const [both, before, after] = counts.map((one) => (one + 1) / all);
    const [was, is] = [both + before, both + after];
    const slope = (both - was * is) / (was * (1 - was));
    const rest = is * (1 - is) - slope * slope * was * (1 - was);
    return {
      value: (counts[0] + counts[2] + slope * (machines * this.data.yield[0] - counts[0] - counts[1])) / machines,
      slope,
      chance: quantile * Math.sqrt(rest / all),
    };
  }
}

/// A share in percent, with two decimals near 0 and 100 %. A tie goes to the even digit, as in the program's tables.
function percent(share) {
  const digits = Math.min(share, 1 - share) < 0.01 ? 2 : 1;
  const scaled = 100 * share * 10 ** digits;
  const even = scaled % 2 === 0.5 ? scaled - 0.5 : scaled;
  return `${(even / 10 ** digits).toFixed(digits)}\u202f%`;
}

function whatIf(figure, data) {
  const machines = new SizedMachines(data);
  const same = data.factors.indexOf(1);
  const chosen = data.sliders.map(() => same);
  const factorsNow = () => chosen.map((i) => data.factors[i]);
  const ofStudy = machines.yield(data.sliders.map(() => 1));
  const said = element("output", { class: "what-if-said", "aria-live": "polite" });
  const place = new Place(figure, (width) => drawYields(ofStudy, machines.yield(factorsNow()), width));
  const sliders = data.sliders.map((slider, g) =>
    sizeSlider(slider, data.factors, same, `what-if-${g}`, (i) => {
      chosen[g] = i;
      update();
    }),
  );

  function update() {
    said.textContent = whatIfWords(data, machines.yield(factorsNow()), chosen, same);
    place.redraw();
  }

  const back = element("button", { type: "button", onclick: () => sliders.forEach(({ set }) => set(same)) }, "As in the study");
  const group = element("div", { class: "what-if-sliders", role: "group", "aria-label": "Sizes" }, ...sliders.map(({ box }) => box));
  place.controls.replaceWith(group, back, said);
  update();
  return place;
}

/// A slider over factors, with its name and the resulting sizes. change(i) is called with the index of the chosen
/// factor.
function sizeSlider({ name, sizes }, factors, same, id, change) {
  const words = (i) =>
    sizes.map(({ label, value, unit }) => `${label} ${withUnit(number(value * factors[i]), unit)}`).join(", ");
  const times = (i) => (i === same ? "as in the study" : `× ${factors[i].toFixed(2)}`);
  const shown = element("span", { class: "what-if-size", "aria-hidden": "true" });
  const input = element("input", { type: "range", id, min: 0, max: factors.length - 1, step: 1, value: same });
  const show = () => {
    const i = Number(input.value);
    shown.textContent = `${words(i)}, ${times(i)}`;
    input.setAttribute("aria-valuetext", shown.textContent);
    return i;
  };
  input.addEventListener("input", () => change(show()));
  show();
  const set = (i) => {
    input.value = i;
    change(show());
  };
  const label = element("label", { for: id }, ...named(name));
  return { box: element("div", { class: "what-if-slider" }, label, input, shown), set };
}

/// The prediction in words, with the cost if costs are stated.
function whatIfWords(data, { value, low, high }, chosen, same) {
  const yields =
    `Predicted yield ${percent(value)} (${percent(low)} to ${percent(high)}); ` + `the study: ${percent(data.yield[0])}.`;
  if (data.sliders.every(({ costs }) => !costs)) return yields;
  const cost = (at) => data.otherCosts + d3.sum(data.sliders, ({ costs }, g) => costs?.[at(g)] ?? 0);
  return `${yields} Predicted cost ${number(cost((g) => chosen[g]))}; the study: ${number(cost(() => same))}.`;
}

function drawYields(study, prediction, width) {
  const rows = [
    { name: "the study", ...study },
    { name: "prediction", ...prediction },
  ].map(({ name, value, low, high }) => ({ name, series: 0, value: 100 * value, low: 100 * low, high: 100 * high }));
  const valueText = ({ value }) => percent(value / 100);
  const marginLeft = textWidth(...rows.map(({ name }) => name)) + 10;
  const svg = draw(`Yields: of the study ${valueText(rows[0])}, predicted ${valueText(rows[1])}.`, {
    width,
    height: rows.length * (BAR + BAR_GAP) + 26,
    marginLeft,
    marginRight: textWidth("100.00 %") + 14,
    marginTop: 24,
    marginBottom: 2,
    x: { domain: [0, 100], ticks: Math.max(3, Math.floor(width / 140)), axis: "top", label: null, grid: true },
    y: { type: "band", domain: rows.map(({ name }) => name), padding: 0, label: null, tickSize: 0 },
    marks: [seriesMarks(rows, 0, 1, { start: 0, at: (v) => v }, valueText), Plot.ruleX([0], { stroke: "var(--ink)" })],
  });
  const note = element("p", { class: "note" }, "Prediction, certified only at the study's sizes.");
  return [note, title("yield [%]"), svg];
}
