import { element } from "./elements.js";
import { MeshView } from "./mesh_view.js";
import { navigate, whenPointed } from "./navigation.js";

/** As high as the mesh wants it, within reason. */
const heightFor = ([x, y], width) => Math.max(260, Math.min(680, 0.8 * window.innerHeight, (width * y) / (x || 1)));

/** A canvas that is moved, zoomed and pointed at: {canvas, said, begin(mesh), view(), redraw()}. describe(t, [x, y]) says what is told of a
 * triangle and a place in it. begin(), once the canvas is in the page, returns whether the mesh can be drawn. */
export function meshCanvas({ canvasId, saidId, label }, describe) {
  const canvas = element("canvas", { tabindex: 0, role: "img", "aria-label": label, id: canvasId });
  const said = element("p", { class: "told", id: saidId, "aria-live": "polite" });
  let view = null, waiting = false;
  const redraw = () => {
    if (waiting || !view) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      view.resize();
      view.draw();
      canvas.dataset.drawn = view.drawn;
    });
  };
  const find = (x, y) => {
    const t = view.triangleAt(x, y);
    said.textContent = t < 0 ? "" : describe(t, view.placeOf(x, y));
    if (view.marked === t) return;
    view.marked = t;
    redraw();
  };
  const begin = (mesh) => {
    try {
      view = new MeshView(canvas, mesh);
    } catch (error) {
      said.textContent = `The mesh cannot be drawn: ${error.message}.`;
      return false;
    }
    navigate(canvas, view, redraw);
    whenPointed(canvas, find);
    new ResizeObserver(() => {
      canvas.style.height = `${heightFor(mesh.half, canvas.clientWidth)}px`;
      redraw();
    }).observe(canvas);
    return true;
  };
  return { canvas, said, begin, view: () => view, redraw };
}
