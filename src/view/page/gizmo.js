// SPDX-License-Identifier: GPL-3.0-or-later
// Handles over the selected shape: they move it along the axes, turn it about them, or scale it along its own axes.
import {add, basis, dot, heightAt, project, scale, sub, unit} from "./camera.js";
import {newStroke, pausedStroke} from "./connection.js";
import {svg} from "./overlay.js";
import {movedBy, ownAxes, placementOf, scaledBy, stepsOf, turnedBy} from "./placement.js";

const kReach = .16;              // length of the axes, as a fraction of the image height
const kStep = .02, kKeyTurn = 5, kKeyScale = 1.05;  // a key: fraction of the camera's distance, degrees, factor
const kEdgeOn = .3;              // cosine to the line of sight of a ring dragged along itself
const kFaceOn = .8;              // cosine to the line of sight of a ring drawn as a whole
const kSmallest = .01;           // factor of a scale
const kRing = 48;
const kAxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], kNames = ["x", "y", "z", "all"];
const kWords = {move: "along", turn: "about", scale: "along its"};

const pathOfPoints = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

// A point on each side of a direction, for the head of an arrow.
function head([x, y], [fromX, fromY], size) {
  const [dx, dy] = unit([x - fromX, y - fromY, 0]), at = (along, across) => [x + along * dx - across * dy, y + along * dy + across * dx];
  return `${pathOfPoints([at(size, 0), at(-size / 2, size * .6), at(-size / 2, -size * .6)])}Z`;
}
const square = ([x, y], r) => `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}Z`;

export class Gizmo {
  // state: {scene, camera, film, boxes, selected}; selected: path of a shape, or null; set(values, stroke): changes the scene;
  // pathOf(list, index): "shapes.left"
  constructor(root, state, set, pathOf) {
    Object.assign(this, {root, state, set, pathOf, mode: "move", active: null, keyStroke: pausedStroke()});
    this.group = svg("g", {class: "gizmo", role: "group", "aria-label": "Selected shape", hidden: ""});
    this.handles = [...kAxes, null].map((_, axis) => {
      const handle = svg("g", {class: `handle ${kNames[axis]}`, tabindex: "0", role: "button", "data-axis": kNames[axis]});
      handle.append(svg("path", {class: "grip"}), svg("path", {class: "line"}), svg("path", {class: "end"}));
      handle.addEventListener("pointerdown", (event) => this.drag(event, handle, axis));
      handle.addEventListener("keydown", (event) => this.key(event, axis));
      return handle;
    });
    this.group.append(...this.handles);
    root.append(this.group);
  }

  // Index of the selected shape, or -1.
  index() {
    return (this.state.scene?.shapes || []).findIndex((_, i) => this.pathOf("shapes", i) === this.state.selected);
  }

  setMode(mode) {
    this.mode = mode;
    this.update();
  }

  placement() {
    return placementOf(this.state.scene.shapes[this.index()].transform);
  }

  update() {
    const box = this.state.boxes?.[this.index()];
    this.group.toggleAttribute("hidden", !box || !this.state.camera);
    if (!box || !this.state.camera) return;
    this.size = this.root.getBoundingClientRect();
    this.pivot = this.active?.pivot ?? scale(add(...box), .5);
    const {forward} = basis(this.state.camera);
    const depth = dot(sub(this.pivot, this.state.camera.position), forward);
    this.height = heightAt(this.state.camera, Math.max(depth, 1e-9)) * this.state.film.shownHeight;
    this.reach = kReach * this.height;
    this.group.toggleAttribute("hidden", depth <= 0);
    const axes = this.axes(), name = this.state.selected.slice("shapes.".length);
    this.handles.forEach((handle, axis) => {
      handle.toggleAttribute("hidden", axis === 3 && this.mode === "turn");
      handle.setAttribute("aria-label", `${this.mode} ${name} ${axis === 3 ? "freely" : `${kWords[this.mode]} ${kNames[axis]}`}: drag, arrow keys`);
      const [grip, line, end] = this.marks(axes[axis]);
      [grip, line, end].forEach((d, i) => handle.children[i].setAttribute("d", d));
    });
  }

  axes() {
    return this.mode === "scale" ? ownAxes(this.placement()) : kAxes;
  }

  // Position of a point on the overlay.
  at(point) {
    const seen = this.state.film.place(project(this.state.camera, this.state.film.aspect, point));
    return [seen.x * this.size.width, seen.y * this.size.height];
  }

  // Towards the camera.
  sight() {
    const {camera} = this.state;
    return camera.orthographic_height ? scale(basis(camera).forward, -1) : unit(sub(camera.position, this.pivot));
  }

  ringAt(axis, angle) {
    const first = unit(Math.abs(axis[0]) < .9 ? [0, -axis[2], axis[1]] : [axis[2], 0, -axis[0]]);
    const second = [axis[1] * first[2] - axis[2] * first[1], axis[2] * first[0] - axis[0] * first[2], axis[0] * first[1] - axis[1] * first[0]];
    return add(scale(first, Math.cos(angle)), scale(second, Math.sin(angle)));
  }

  // Lines of a handle: to grab, of the axis or ring, of its end. axis: undefined: the one in the middle
  marks(axis) {
    const middle = this.at(this.pivot);
    if (!axis) return [square(middle, 10), "", square(middle, 5)];
    if (this.mode === "turn") {
      const sight = this.sight();
      const ring = Array.from({length: kRing + 1}, (_, i) => this.ringAt(axis, 2 * Math.PI * i / kRing));
      const isWhole = Math.abs(dot(axis, sight)) > kFaceOn, isSeen = (p) => isWhole || dot(p, sight) > -.05;  // else the front half
      const path = ring.slice(1).map((p, i) => isSeen(p) && isSeen(ring[i])
        ? pathOfPoints([ring[i], p].map((q) => this.at(add(this.pivot, scale(q, this.reach))))) : "").join("");
      return [path, path, ""];
    }
    const end = this.at(add(this.pivot, scale(axis, this.reach))), line = pathOfPoints([middle, end]);
    return [line, line, this.mode === "move" ? head(end, middle, 9) : square(end, 5)];
  }

  // Length along the axis for a movement of pixels along its image.
  along(axis, [dx, dy]) {
    const from = this.at(this.pivot), to = this.at(add(this.pivot, scale(axis, this.reach)));
    const size = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (size < 4) return 0;  // towards the camera
    const [x, y] = [(to[0] - from[0]) / size, (to[1] - from[1]) / size], wanted = dx * x + dy * y;
    let length = wanted / size * this.reach;
    for (let i = 0; i < 4; ++i) {  // perspective
      const at = this.at(add(this.pivot, scale(axis, length))), now = (at[0] - from[0]) * x + (at[1] - from[1]) * y;
      if (now * wanted > 0) length *= Math.min(2, wanted / now);
    }
    return length;
  }

  // Degrees about the axis: around its image, or along a ring seen from its edge.
  around(axis, start, now) {
    const [x, y] = this.at(this.pivot), facing = dot(axis, this.sight());
    const angle = ([px, py]) => Math.atan2(py - this.size.top - y, px - this.size.left - x);
    if (Math.abs(facing) > kEdgeOn) {
      const turn = (angle(start) - angle(now)) * Math.sign(facing) * 180 / Math.PI;
      return turn - 360 * Math.round(turn / 360);
    }
    const sight = this.sight(), tangent = unit([axis[1] * sight[2] - axis[2] * sight[1], axis[2] * sight[0] - axis[0] * sight[2], axis[0] * sight[1] - axis[1] * sight[0]]);
    return this.along(tangent, sub(now, start)) / this.reach * 180 / Math.PI;
  }

  // In the plane through the pivot parallel to the image.
  inPlane([dx, dy]) {
    const {right, up} = basis(this.state.camera), pixel = this.height / this.size.height;
    return add(scale(right, dx * pixel), scale(up, -dy * pixel));
  }

  // Sets the shape's place. by: of the mode: a vector, [axis, degrees], or factors
  change(path, from, pivot, by, stroke) {
    const now = this.mode === "move" ? movedBy(from, by) : this.mode === "turn" ? turnedBy(from, pivot, ...by) : scaledBy(from, pivot, by);
    this.set({[`${path}.transform`]: stepsOf(now)}, stroke);
  }

  // axis: of the handle; from, now: of the pointer
  changeOf(axis, from, now) {
    const moved = sub(now, from), direction = this.active.axes[axis];
    const factor = (x) => Math.max(kSmallest, 1 + x / this.reach);
    if (this.mode === "move") return direction ? scale(direction, this.along(direction, moved)) : this.inPlane(moved);
    if (this.mode === "turn") return [direction, this.around(direction, from, now)];
    if (!direction) return [0, 1, 2].map(() => factor((moved[0] - moved[1]) * this.height / this.size.height));
    return [0, 1, 2].map((i) => i === axis ? factor(this.along(direction, moved)) : 1);
  }

  drag(event, handle, axis) {
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    const path = this.state.selected, stroke = newStroke(), start = [event.clientX, event.clientY];
    const from = this.placement(), pivot = this.pivot, index = this.index();
    this.active = {pivot, axes: this.axes()};
    handle.onpointermove = (now) => {
      this.pivot = pivot;
      const by = this.changeOf(axis, start, [now.clientX, now.clientY]);
      if (this.mode === "move") this.active.pivot = add(pivot, by);
      this.change(path, from, pivot, by, stroke);
    };
    handle.onpointerup = handle.onpointercancel = () => {
      handle.onpointermove = handle.onpointerup = handle.onpointercancel = null;
      const by = sub(this.active.pivot, pivot);
      if (this.state.boxes[index]) this.state.boxes[index] = this.state.boxes[index].map((corner) => add(corner, by));  // until the server tells
      this.active = null;
      this.update();
    };
  }

  key(event, axis) {
    const [x, y] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key] || [0, 0], sign = x + y;
    if (!sign || event.ctrlKey) return;
    event.preventDefault();
    const {right, up, distance} = basis(this.state.camera), step = kStep * distance;
    const by = {
      move: () => axis === 3 ? add(scale(right, x * step), scale(up, y * step)) : scale(kAxes[axis], sign * step),
      turn: () => [kAxes[axis], sign * kKeyTurn],
      scale: () => [0, 1, 2].map((i) => i === axis || axis === 3 ? kKeyScale ** sign : 1),
    }[this.mode]();
    this.change(this.state.selected, this.placement(), this.pivot, by, this.keyStroke());
  }
}
