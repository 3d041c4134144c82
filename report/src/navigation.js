import { select } from "d3-selection";
import { zoom, zoomIdentity } from "d3-zoom";

const kStep = 60;  // pixels
const kRest = 40;  // milliseconds

/** Mouse, touch and keys move and zoom the view in a canvas; then changed() is called. */
export function navigate(canvas, view, changed) {
  const selection = select(canvas);
  const behavior = zoom().scaleExtent([0.5, 1e6]).on("zoom", ({ transform }) => {
    view.transform = transform;
    canvas.dataset.zoom = transform.k.toFixed(3);
    changed();
  });
  selection.call(behavior);
  const by = (x, y) => () => behavior.translateBy(selection, (x * kStep) / view.transform.k, (y * kStep) / view.transform.k);
  const keys = {
    ArrowLeft: by(1, 0),
    ArrowRight: by(-1, 0),
    ArrowUp: by(0, 1),
    ArrowDown: by(0, -1),
    "+": () => behavior.scaleBy(selection, 1.5),
    "-": () => behavior.scaleBy(selection, 1 / 1.5),
    0: () => behavior.transform(selection, zoomIdentity),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
}

/** Calls find(x, y), in pixels of the canvas, where the pointer comes to rest. */
export function whenPointed(canvas, find) {
  let timer = 0;
  canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => {
    clearTimeout(timer);
    timer = setTimeout(() => find(offsetX, offsetY), kRest);
  });
}
