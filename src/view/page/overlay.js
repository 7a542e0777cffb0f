// SPDX-License-Identifier: GPL-3.0-or-later
// Overlay of the image: lights to drag, a ruler in millimetres, and the edge of the wipe.
import {add, basis, heightAt, project, rounded, scale, sub} from "./camera.js";
import {newStroke, pausedStroke} from "./connection.js";

const kInset = .03;  // inset of the handle of a light outside, as a fraction of the image
const kStep = .02;   // step of a key, as a fraction of the camera's distance

export const svg = (name, attributes) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
};

// Position of a light, with the key moving it; null for distant lights.
function placeOf(light) {
  if (light.type === "point" || light.type === "spot") return {key: "position", at: light.position, middle: light.position};
  if (light.type === "sphere") return {key: "center", at: light.center, middle: light.center};
  if (light.type !== "quad") return null;
  return {key: "corner", at: light.corner, middle: add(light.corner, scale(add(light.u, light.v), .5))};
}

export const brightnessKey = (light) => ["intensity", "radiance", "irradiance"].find((key) => key in light);

// The longest of 1, 2, 5 times a power of ten within a length.
function niceLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * [5, 2, 1].find((n) => n * power <= most);
}
const lengthText = (mm) => mm >= 1000 ? `${rounded(mm / 1000)} m` : mm >= 1 || !mm ? `${rounded(mm)} mm` : `${rounded(mm * 1000)} µm`;

export class Overlay {
  // state: {scene, camera, film, wipe}; set(values, stroke): changes the scene; pathOf(list, index): "lights.key"
  constructor(root, state, set, pathOf) {
    Object.assign(this, {root, state, set, pathOf, wheelStroke: pausedStroke(), keyStroke: pausedStroke()});
    this.handles = new Map();
    this.lights = svg("g", {role: "group", "aria-label": "Lights"});
    this.ruler = svg("g", {});
    this.edge = svg("line", {class: "edge", y1: "0", y2: "100%", hidden: ""});
    root.append(this.lights, this.ruler, this.edge);
  }

  update() {
    if (!this.state.scene) return;
    this.size = this.root.getBoundingClientRect();
    this.updateLights();
    this.updateRuler();
    this.edge.toggleAttribute("hidden", !this.state.wipe);
    for (const x of ["x1", "x2"]) this.edge.setAttribute(x, `${this.state.wipe}%`);
  }

  updateLights() {
    const shown = new Set();
    (this.state.scene.lights || []).forEach((light, index) => {
      const place = placeOf(light);
      if (!place) return;
      const path = this.pathOf("lights", index);
      shown.add(path);
      if (!this.handles.has(path)) this.addHandle(path, index);
      const seen = this.state.film.place(project(this.state.camera, this.state.film.aspect, place.middle));
      const inside = (v) => Math.max(kInset, Math.min(1 - kInset, v));
      const x = inside(seen.x) * this.size.width, y = inside(seen.y) * this.size.height;
      const handle = this.handles.get(path), isRight = x > .75 * this.size.width;
      handle.setAttribute("transform", `translate(${x} ${y})`);
      handle.lastChild.setAttribute("x", isRight ? -12 : 12);
      handle.lastChild.setAttribute("text-anchor", isRight ? "end" : "start");
    });
    for (const [path, handle] of this.handles)
      if (!shown.has(path)) {
        handle.remove();
        this.handles.delete(path);
      }
  }

  addHandle(path, index) {
    const name = path.slice("lights.".length);
    const handle = svg("g", {class: "light", tabindex: "0", role: "button", "data-path": path,
      "aria-label": `Light ${name}: arrow keys move it, plus and minus change its brightness`});
    const text = svg("text", {y: 4});
    text.textContent = name;
    handle.append(svg("circle", {r: 7}), svg("path", {d: "M-11 0H-8M8 0H11M0-11V-8M0 8V11"}), text);
    handle.addEventListener("pointerdown", (event) => this.drag(event, handle, path, index));
    handle.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.brighten(path, index, 1.1 ** -Math.sign(event.deltaY), this.wheelStroke());
    });
    handle.addEventListener("keydown", (event) => this.key(event, path, index));
    this.handles.set(path, handle);
    this.lights.append(handle);
  }

  // Moves in the plane through the light parallel to the image; fractions of the image height.
  move(path, index, from, x, y, stroke) {
    const place = placeOf(from), {right, up, forward, distance} = basis(this.state.camera);
    const depth = Math.max(sub(place.middle, this.state.camera.position).reduce((sum, v, i) => sum + v * forward[i], 0), distance * .2);
    const size = heightAt(this.state.camera, depth) * this.state.film.shownHeight;
    this.set({[`${path}.${place.key}`]: rounded(add(place.at, add(scale(right, x * size), scale(up, -y * size))))}, stroke);
  }

  drag(event, handle, path, index) {
    if (event.button !== 0) return;
    event.preventDefault();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    const from = this.state.scene.lights[index], stroke = newStroke(), start = [event.clientX, event.clientY];
    handle.onpointermove = (now) =>
      this.move(path, index, from, (now.clientX - start[0]) / this.size.height, (now.clientY - start[1]) / this.size.height, stroke);
    handle.onpointerup = handle.onpointercancel = () => {
      handle.onpointermove = handle.onpointerup = handle.onpointercancel = null;
    };
  }

  brighten(path, index, factor, stroke) {
    const light = this.state.scene.lights[index], key = brightnessKey(light);
    if (typeof light[key] === "string") return;
    const value = rounded(Array.isArray(light[key]) ? scale(light[key], factor) : light[key] * factor);
    this.set({[`${path}.${key}`]: value}, stroke);
  }

  key(event, path, index) {
    const by = {ArrowLeft: [-kStep, 0], ArrowRight: [kStep, 0], ArrowUp: [0, -kStep], ArrowDown: [0, kStep]}[event.key];
    const factor = {"+": 1.1, "=": 1.1, "-": 1 / 1.1}[event.key];
    if (by) this.move(path, index, this.state.scene.lights[index], ...by, this.keyStroke());
    if (factor) this.brighten(path, index, factor, this.keyStroke());
    if (by || factor) event.preventDefault();
  }

  // At the depth of the point of interest.
  updateRuler() {
    const mm = this.state.scene.mm_per_unit || 1, {distance} = basis(this.state.camera);
    const height = heightAt(this.state.camera, distance) * mm * this.state.film.shownHeight;
    if (!(height > 0)) return;  // an invalid value, to be refused
    const size = niceLength(height * .3), pixels = size / height * this.size.height;
    const y = this.size.height - 14;
    const bar = svg("path", {class: "rule", d: `M14 ${y - 5}V${y}H${14 + pixels}V${y - 5}`});
    const text = svg("text", {x: 14, y: y - 9, id: "ruler"});
    text.textContent = lengthText(size);
    this.ruler.replaceChildren(bar, text);
  }
}
