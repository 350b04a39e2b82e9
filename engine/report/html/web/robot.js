// The picture of the mechanism. The poses that C++ drew can be turned, with the frame and the effect of a chosen error.

const NO_ERROR = "none";
const DISPLACEMENTS = { none: 0, same: 1, own: 2 }; // one factor for all, or each error its own
const SHOWN_MOTION = 0.15; // largest displacement over the picture's height, if each error has its own factor
const FRAME_AXIS = 36; // pixels, the same as in sketch_picture.cpp
const NAME_WIDTH = 150; // pixels
const ARC = 18; // pixels, radius of the arrow of a rotation

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const moved = (a, scale, b) => a.map((v, k) => v + scale * b[k]);

/// The points in an attribute data-p="x,y,z x,y,z".
function robotPoints(part, name = "p") {
  return part.dataset[name].split(" ").map((point) => point.split(",").map(Number));
}

/// The function that gives the place of a point in the picture, as SketchView::at() does.
function robotProjection(data, { yaw, pitch }, { width, height }) {
  const [sinYaw, cosYaw, sinPitch, cosPitch] = [yaw, pitch].flatMap((angle) => [
    Math.sin((angle * Math.PI) / 180),
    Math.cos((angle * Math.PI) / 180),
  ]);
  const sign = data.down ? -1 : 1;
  return (point) => {
    const [x, y, z] = point.map((v, k) => (k > 0 ? sign : 1) * (v - data.centre[k]));
    const deep = x * sinYaw + y * cosYaw;
    const up = z * cosPitch + deep * sinPitch;
    return [width / 2 + data.scale * (x * cosYaw - y * sinYaw), height / 2 - data.scale * up];
  };
}

/// Puts the name of an axis beside the axis' end, on the side to which the axis points if there is room.
function turnAway(text, toRight) {
  const x = text.parentElement.transform.baseVal.consolidate().matrix.e;
  const width = text.getBBox().width || 1.4 * textWidth(text.textContent); // 0 while the picture is hidden
  const room = { left: x - width, right: text.ownerSVGElement.viewBox.baseVal.width - x - width };
  const left = toRight < 0 ? room.left > 0 || room.right < 0 : room.right < 0;
  setAttributes(text, { "text-anchor": left ? "end" : "start", x: left ? -4 : 4 });
}

/// Moves lines, outlines and groups of a picture to where their points are seen.
function placeParts(svg, project) {
  for (const part of svg.querySelectorAll("[data-p]")) {
    const at = robotPoints(part).map(project);
    if (part.tagName === "line") {
      setAttributes(part, { x1: at[0][0], y1: at[0][1], x2: at[1][0], y2: at[1][1] });
    } else if (part.tagName === "path") {
      part.setAttribute("d", `M${at.map((p) => p.join(" ")).join("L")}${part.dataset.open === undefined ? "Z" : ""}`);
    } else {
      part.setAttribute("transform", `translate(${at[0].join(" ")})`);
      if (part.dataset.from) turnAway(part.querySelector("text"), at[0][0] - project(robotPoints(part, "from")[0])[0]);
    }
  }
}

/// A part of a picture, with its points as an attribute.
function robotPart(tag, points, attributes, text) {
  const part = svgElement(tag, { ...attributes, "data-p": points.map((p) => p.join(",")).join(" ") });
  if (text !== undefined) part.append(svgElement("text", { x: 4, y: -4 }, text));
  return part;
}

/// The frame of an error with the error's axis emphasised, or only this axis if the frame is the error's own. A rotation
/// has an arrow around the axis.
function markedFrame(data, k, error) {
  const count = values(data.frames).length / 12 / data.poses.length;
  const numbers = Array.from(row(values(data.frames), k * count + error.frame, 12));
  const origin = numbers.slice(0, 3);
  const axes = [3, 6, 9].map((from) => numbers.slice(from, from + 3));
  const group = svgElement("g", { class: "marked" });
  axes.forEach((axis, a) => {
    const own = a === error.axis;
    if (error.isOwn && !own) return;
    const letter = error.isOwn ? "" : "xyz"[a];
    const end = moved(origin, ((own ? 1.5 : 1) * FRAME_AXIS) / data.scale, axis);
    group.append(robotPart("line", [origin, end], { class: own ? "error-axis" : "other-axis" }));
    const label = robotPart("g", [end], { class: "error-name", "data-from": origin.join(",") }, letter);
    // On paper the pictures are too small for names.
    const name = `${letter && ": "}${shortened(error.name, NAME_WIDTH)}`;
    if (own) label.firstChild.append(svgElement("tspan", { class: "on-screen" }, name));
    group.append(label);
  });
  if (!error.turns) return group;
  const [u, v] = [axes[(error.axis + 1) % 3], axes[(error.axis + 2) % 3]];
  const middle = moved(origin, (0.9 * FRAME_AXIS) / data.scale, axes[error.axis]);
  const on = (angle, radius = ARC) =>
    moved(moved(middle, (radius / data.scale) * Math.cos(angle), u), (radius / data.scale) * Math.sin(angle), v);
  const arc = d3.range(0, 5.01, 0.25).map((angle) => on(angle));
  const head = [on(4.6, ARC + 5), on(5), on(4.6, ARC - 5)];
  group.append(robotPart("path", arc, { class: "error-turn", "data-open": "" }));
  group.append(robotPart("path", head, { class: "error-turn", "data-open": "" }));
  return group;
}

/// The motion of the platform by each limb if the error has its size, [rotation; displacement]. Only one motion if all
/// limbs give the same; none if it is not known.
function motionsOf(data, k, e) {
  if (!data.motions) return [];
  const at = (k * data.errors.length + e) * data.limbs;
  const motions = d3.range(data.limbs).map((i) => Array.from(row(values(data.motions), at + i, 6)));
  if (!motions.flat().every(Number.isFinite)) return [];
  const size = Math.max(...motions.flat().map(Math.abs));
  const alike = motions.every((motion) => motion.every((v, c) => Math.abs(v - motions[0][c]) <= 1e-6 * size));
  return alike ? motions.slice(0, 1) : motions;
}

const displacement = (motion, p) => moved(motion.slice(3), 1, cross(motion.slice(0, 3), p));

/// The factor by which motions are enlarged: the same one for all errors, or the one that shows these motions best.
function exaggerationOf(data, motions, svg, choice) {
  if (choice !== DISPLACEMENTS.own) return choice === DISPLACEMENTS.none ? 0 : data.exaggeration;
  const points = robotPoints(svg.querySelector(".platform"));
  const largest = d3.max(motions, (motion) => d3.max(points, (p) => Math.hypot(...displacement(motion, p))));
  if (!(largest > 0)) return data.exaggeration;
  const most = (SHOWN_MOTION * svg.viewBox.baseVal.height) / data.scale / largest;
  const power = 10 ** Math.floor(Math.log10(most));
  return power * (most < 2 * power ? 1 : most < 5 * power ? 2 : 5);
}

/// The displaced platform as each limb holds it. Only one if all limbs hold it alike.
function displacedPlatforms(motions, svg, times) {
  const group = svgElement("g", { class: "displaced" });
  if (times === 0) return group;
  const platform = robotPoints(svg.querySelector(".platform"));
  const tools = [...svg.querySelectorAll(".tool")];
  for (const [i, motion] of motions.entries()) {
    const displaced = (p) => moved(p, times, displacement(motion, p));
    const style = motions.length === 1 ? "" : `--limb: var(--series-${(i % 8) + 1})`;
    group.append(robotPart("path", platform.map(displaced), { style }));
    for (const tool of tools) group.append(robotPart("line", robotPoints(tool).map(displaced), { style }));
    if (motions.length > 1) group.append(robotPart("g", [displaced(platform[i])], { style }, `by ${i + 1}`));
  }
  return group;
}

/// What the picture shows, in words.
function robotWords(data, k, e, motions, times, choice) {
  const error = data.errors[e];
  if (!error) return `${data.poses[k]}.`;
  const share = error.share ? `, ${error.share}` : "";
  const whose = motions.length > 1 ? "The platform as it would be held by each limb" : "The displaced platform";
  const motion =
    motions.length && times > 0
      ? ` ${whose} is that of an error of ${error.size}, to first order, × ${number(times)}${choice === DISPLACEMENTS.own ? ", a factor of its own" : ""}.`
      : "";
  return `${error.name}${share}: ${error.words}.${motion}`;
}

function robot(figure, data) {
  const pictures = [...figure.querySelectorAll(".robot-pose")];
  const box = figure.querySelector(".robot-poses");
  const start = { yaw: data.yaw, pitch: data.pitch };
  const view = { ...start };
  const shown = { pose: 0, error: data.errors[0]?.share ? 0 : -1, times: DISPLACEMENTS.same };
  const said = readout("");
  for (const mark of box.querySelectorAll(".marked")) mark.remove();

  // Only the pose that is shown is drawn, except for printing.
  const update = (all = false) => {
    pictures.forEach((picture, k) => {
      picture.classList.toggle("other", k !== shown.pose);
      picture.hidden = k !== shown.pose && k > 2;
      if (k !== shown.pose && !all) return;
      const svg = picture.querySelector("svg");
      for (const old of svg.querySelectorAll(".marked, .displaced")) old.remove();
      const motions = shown.error < 0 ? [] : motionsOf(data, k, shown.error);
      const times = exaggerationOf(data, motions, svg, shown.times);
      if (shown.error >= 0) {
        svg.append(displacedPlatforms(motions, svg, times), markedFrame(data, k, data.errors[shown.error]));
      }
      placeParts(svg, robotProjection(data, view, svg.viewBox.baseVal));
      if (k === shown.pose) said.textContent = robotWords(data, k, shown.error, motions, times, shown.times);
    });
  };
  const { controls, choose } = robotControls(data, shown, update);
  figure.querySelector(".plot").before(controls);
  const place = box.parentElement;
  place.append(turnable(box, "Mechanism", view, start, TURN_STEP, update), said);
  addEventListener("beforeprint", () => update(true));
  figure.classList.add("live");
  chooseInTables(data.errors, (e) => {
    choose(e);
    figure.scrollIntoView({ block: "nearest" });
  });
  return { fit: () => update(true) };
}

/// A slider over poses, and selects for the error and its displacement. choose(e) chooses an error.
function robotControls(data, shown, update) {
  const choose = (e) => {
    shown.error = e;
    update();
  };
  const errors = select(
    "error",
    [NO_ERROR, ...data.errors.map(({ name, share }) => (share ? `${name} (${share})` : name))],
    (i) => choose(i - 1),
    shown.error + 1,
  );
  const factors = ["not shown", `× ${number(data.exaggeration)}, as of all errors`, "by a factor of its own, said below"];
  const displacement = select(
    "its displacement",
    data.motions ? factors : [],
    (i) => {
      shown.times = i;
      update();
    },
    shown.times,
  );
  const poses = slider(
    "pose",
    data.poses.length - 1,
    (k) => data.poses[k],
    (k) => {
      shown.pose = k;
      update();
    },
  ).control;
  poses.classList.add("robot-slider");
  const chooseHere = (e) => {
    errors.querySelector("select").selectedIndex = e + 1;
    choose(e);
  };
  return { controls: element("div", { class: "controls" }, poses, errors, displacement), choose: chooseHere };
}

/// Lets a click on the name of an error in a table choose this error. Pointing at the name tells where the error is.
function chooseInTables(errors, choose) {
  const positions = new Map(errors.map(({ name }, e) => [name, e]));
  for (const cell of document.querySelectorAll("[data-table] tbody th")) {
    const e = positions.get(cell.textContent);
    if (e === undefined) continue;
    cell.classList.add("in-picture");
    cell.title = `${errors[e].words}; click to see it in the picture of the mechanism`;
    cell.addEventListener("click", () => choose(e));
  }
}
