// Views that can be turned.

/// Lets a reader turn the view that a box shows, by dragging and by arrow keys, each of which turns it by `step`
/// degrees. view: its { yaw, pitch } in degrees; the key Home and a button set them to those of `start`. show() draws
/// the view. Returns the box with its button.
function turnable(box, what, view, start, step, show) {
  const turn = (yaw, pitch) => {
    view.yaw = (view.yaw + yaw) % 360;
    view.pitch = Math.max(-90, Math.min(90, view.pitch + pitch));
    show();
  };
  const reset = () => {
    Object.assign(view, start);
    show();
  };
  const steps = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
  box.classList.add("turning");
  setAttributes(box, {
    tabindex: "0",
    role: "application",
    "aria-label": `${what} that can be turned: drag it, or use the arrow keys; Home resets it.`,
  });
  box.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey || !(event.key in steps || event.key === "Home")) return;
    event.preventDefault();
    event.key === "Home" ? reset() : turn(...steps[event.key]);
  });
  box.addEventListener("pointerdown", (event) => box.setPointerCapture(event.pointerId));
  box.addEventListener("pointermove", (event) => {
    if (box.hasPointerCapture(event.pointerId)) turn(event.movementX * 0.5, event.movementY * 0.5);
  });
  const button = element("button", { type: "button", onclick: reset }, "Reset view");
  return element("div", { class: "turning-view" }, box, button);
}
