// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, touch and keys on the image: the free camera, and the rotation of distant lights.
import {dolly, orbit, pan, rounded, turnedLight} from "./camera.js";
import {newStroke, pausedStroke} from "./connection.js";

const kTurn = 4, kKeyTurn = .1, kKeyPan = .05, kKeyDolly = 1.1;  // radians a height; a key
const kClick = 4;                                                  // maximum movement of a click, pixels

export class CameraInput {
  // state: {scene, camera}; turn(change): moves the camera; set(values, stroke): changes the scene;
  // pathOf(list, index): "lights.sun"; click(event): a press without movement
  constructor(canvas, state, {turn, set, pathOf, click}) {
    Object.assign(this, {canvas, state, turn, set, pathOf, click, isDragging: false, fingers: new Map(), keyStroke: pausedStroke()});
    canvas.addEventListener("pointerdown", (event) => this.drag(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // Parallel rays look nearer in a lower view.
  approach(factor, stroke) {
    const height = this.state.camera.orthographic_height;
    if (height) this.set({"camera.orthographic_height": rounded(height * factor)}, stroke);
    else this.turn((camera) => dolly(camera, factor));
  }

  // Rotates the environment together with distant lights. from: the lights before.
  turnLights(from, angle, stroke) {
    const values = {};
    from.forEach((light, index) => Object.entries(turnedLight(light, angle) || {}).forEach(([key, value]) => {
      values[`${this.pathOf("lights", index)}.${key}`] = value;
    }));
    if (Object.keys(values).length) this.set(values, stroke);
  }

  // Two fingers pan by their middle, and dolly by their distance.
  pinch(now, height, stroke) {
    const old = this.fingers.get(now.pointerId), [, other] = [...this.fingers].find(([id]) => id !== now.pointerId);
    const apart = ([x, y]) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
    const next = [now.clientX, now.clientY];
    this.fingers.set(now.pointerId, next);
    this.turn((camera) => pan(camera, (next[0] - old[0]) / (2 * height), (next[1] - old[1]) / (2 * height)));
    this.approach(apart(old) / apart(next), stroke);
  }

  drag(event) {
    if (event.button > 1 || !this.state.camera) return;
    event.preventDefault();
    if (event.pointerType === "touch") this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const {canvas} = this, stroke = newStroke(), height = canvas.getBoundingClientRect().height;
    canvas.focus();
    canvas.setPointerCapture(event.pointerId);
    this.isDragging = true;
    let last = [event.clientX, event.clientY];
    const start = event.clientX, lights = this.state.scene.lights || [];
    let isClick = true;
    const move = (now) => {
      if (now.pointerId !== event.pointerId) return;
      isClick = isClick && this.fingers.size < 2 && Math.hypot(now.clientX - start, now.clientY - event.clientY) < kClick;
      if (isClick) return;
      if (this.fingers.size === 2) {
        last = [now.clientX, now.clientY];
        return this.pinch(now, height, stroke);
      }
      if (event.altKey) return this.turnLights(lights, -kTurn * (now.clientX - start) / height, stroke);
      const x = (now.clientX - last[0]) / height, y = (now.clientY - last[1]) / height;
      last = [now.clientX, now.clientY];
      if (event.ctrlKey) return this.approach(Math.exp(2 * y), stroke);
      this.turn((camera) => event.shiftKey ? pan(camera, x, y) : orbit(camera, -kTurn * x, -kTurn * y));
    };
    const end = (now) => {
      if (now.pointerId !== event.pointerId) return;
      this.fingers.delete(event.pointerId);
      this.isDragging = false;
      if (now.type === "pointerup" && isClick) this.click(now);
      canvas.removeEventListener("pointermove", move);
      for (const name of ["pointerup", "pointercancel"]) canvas.removeEventListener(name, end);
    };
    canvas.addEventListener("pointermove", move);
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, end);
  }

  wheel(event) {
    event.preventDefault();
    this.approach(kKeyDolly ** Math.sign(event.deltaY), this.keyStroke());
  }

  key(event) {
    const [x, y] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key] || [0, 0];
    const nearer = {"+": 1 / kKeyDolly, "=": 1 / kKeyDolly, "-": kKeyDolly}[event.key];
    if (!(x || y || nearer) || event.ctrlKey) return;
    event.preventDefault();
    if (event.altKey) return this.turnLights(this.state.scene.lights || [], -kKeyTurn * x, this.keyStroke());
    if (nearer) return this.approach(nearer, this.keyStroke());
    this.turn((camera) => event.shiftKey ? pan(camera, kKeyPan * x, kKeyPan * y) : orbit(camera, -kKeyTurn * x, -kKeyTurn * y));
  }
}
