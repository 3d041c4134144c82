import { element, number } from "./elements.js";

const kSteps = 240;  // of a replay, one for each frame

/** Controls for a moment of a run: {place, show(seconds), hide(), moment()}. `changed` is called with each new moment. */
export function replayControls(id, changed) {
  const slider = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0, id: `${id}time`, "aria-label": "Time" });
  const play = element("button", { type: "button", id: `${id}play` }, "Play");
  const clock = element("span", { class: "note clock", id: `${id}clock` });
  const place = element("span", { class: "controls replay" }, play, slider, clock);
  let whole = 0, playing = false;
  const moment = () => Number(slider.value) * whole;
  const tell = () => {
    clock.textContent = `${number(moment())} of ${number(whole)} s`;
    changed(moment());
  };
  const set = (on) => {
    playing = on;
    play.textContent = on ? "Pause" : "Play";
  };
  const step = () => {
    if (!playing || !place.isConnected) return;
    slider.value = Math.min(1, Number(slider.value) + 1 / kSteps);
    tell();
    if (Number(slider.value) < 1) requestAnimationFrame(step);
    else set(false);
  };
  play.addEventListener("click", () => {
    if (!playing && Number(slider.value) >= 1) slider.value = 0;
    set(!playing);
    step();
  });
  slider.addEventListener("input", tell);
  const show = (seconds) => {
    if (seconds !== whole) {
      set(false);
      slider.value = 0;
      whole = seconds;
    }
    place.style.display = "";
    tell();
  };
  const hide = () => {
    set(false);
    place.style.display = "none";
  };
  return { place, show, hide, moment };
}
