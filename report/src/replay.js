import { element, number } from "./elements.js";

const kSteps = 240;  // of a replay, one for each frame

/** A button that plays and a slider from 0 to `last`: {place, slider, position(), toggle(), to(position), stop()}. moved() is called with
 * each new position; what plays goes on by `step` once the promise that it returns is kept. */
export function player(id, label, { last, step, grid = "any" }, moved) {
  const slider = element("input", { type: "range", min: 0, max: last, step: grid, value: 0, id: `${id}time`, "aria-label": label });
  const button = element("button", { type: "button", id: `${id}play` }, "Play");
  const place = element("span", { class: "controls replay" }, button, slider);
  let playing = 0, times = 0;  // how often it has begun to play; 0 while it does not
  const position = () => Number(slider.value);
  const set = (on) => {
    playing = on ? ++times : 0;
    button.textContent = on ? "Pause" : "Play";
  };
  const play = async (time) => {
    while (time && playing === time && place.isConnected) {
      slider.value = Math.min(last, position() + step);
      await moved();
      if (playing === time && position() >= last) set(false);
    }
  };
  const to = (next) => {
    slider.value = Math.min(last, Math.max(0, next));
    return moved();
  };
  const toggle = async () => {
    set(!playing);
    const time = playing;
    if (time && position() >= last) await to(0);
    play(time);
  };
  button.addEventListener("click", toggle);
  slider.addEventListener("input", moved);
  return { place, slider, position, toggle, to, stop: () => set(false) };
}

/** Controls for a moment of a run: {place, show(seconds), hide(), moment()}. `changed` is called with each new moment. */
export function replayControls(id, changed) {
  const clock = element("span", { class: "note clock", id: `${id}clock` });
  let whole = 0;
  const moment = () => controls.position() * whole;
  const tell = () => {
    clock.textContent = `${number(moment())} of ${number(whole)} s`;
    changed(moment());
    return new Promise(requestAnimationFrame);
  };
  const controls = player(id, "Time", { last: 1, step: 1 / kSteps }, tell);
  controls.place.append(clock);
  const show = (seconds) => {
    if (seconds !== whole) {
      controls.stop();
      whole = seconds;
      controls.slider.value = 0;
    }
    controls.place.style.display = "";
    tell();
  };
  const hide = () => {
    controls.stop();
    controls.place.style.display = "none";
  };
  return { place: controls.place, show, hide, moment };
}
