// SPDX-License-Identifier: GPL-3.0-or-later
// Camera of a scene: its rotation, and the projection of points. Lengths in scene units.

export const add = (a, b) => a.map((x, i) => x + b[i]);
export const sub = (a, b) => a.map((x, i) => x - b[i]);
export const scale = (a, s) => a.map((x) => x * s);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.sqrt(dot(a, a));
export const unit = (a) => scale(a, 1 / (length(a) || 1));

// Rounds to few digits, to keep commands short.
export const rounded = (x) => Array.isArray(x) ? x.map(rounded) : Number(x.toPrecision(6));

// Free camera of the view, if any: scene.look.
export function cameraOf(scene) {
  const given = {...scene.camera, ...scene.look};
  return {
    position: given.position || [0, 0, 5],
    look_at: given.look_at || [0, 0, 0],
    up: given.up || [0, 1, 0],
    field_of_view: given.field_of_view || 40,
    orthographic_height: given.orthographic_height,
    shift: given.shift || [0, 0],
  };
}

export const lookOf = ({position, look_at}) => ({position: rounded(position), look_at: rounded(look_at)});

export function basis(camera) {
  const forward = unit(sub(camera.look_at, camera.position));
  const right = unit(cross(forward, camera.up));
  return {forward, right, up: cross(right, forward), distance: length(sub(camera.look_at, camera.position))};
}

// About an axis through the origin, after Rodrigues.
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

// Keys rotating a distant light about +y, counterclockwise seen from above, in radians; null for near lights.
export function turnedLight(light, angle) {
  if (light.type === "directional") return {direction: rounded(turned(light.direction, [0, 1, 0], angle))};
  if (light.type !== "environment") return null;
  const degrees = (light.rotation || 0) + angle * 180 / Math.PI;
  return {rotation: rounded(degrees - 360 * Math.round(degrees / 360))};
}

// Orbits the point of interest, as on a turntable. Angles in radians.
export function orbit(camera, around, over) {
  const {right} = basis(camera), up = unit(camera.up);
  const from = sub(camera.position, camera.look_at);
  const height = Math.acos(Math.max(-1, Math.min(1, dot(unit(from), up))));
  const tilt = Math.max(.03, Math.min(Math.PI - .03, height + over)) - height;
  return {...camera, position: add(camera.look_at, turned(turned(from, right, tilt), up, around))};
}

// Fractions of the image height.
export function pan(camera, x, y) {
  const {right, up, distance} = basis(camera);
  const size = heightAt(camera, distance);
  const by = add(scale(right, -x * size), scale(up, y * size));
  return {...camera, position: add(camera.position, by), look_at: add(camera.look_at, by)};
}

export function dolly(camera, factor) {
  return {...camera, position: add(camera.look_at, scale(sub(camera.position, camera.look_at), factor))};
}

const kMargin = 1.15;  // around framed things

// The camera moved along its line of sight and across it, to show a box: its lowest and highest corner.
export function framed(camera, aspect, [low, high]) {
  const {forward, right, up} = basis(camera), middle = scale(add(low, high), .5);
  const slope = Math.tan(camera.field_of_view * Math.PI / 360);
  let distance = length(sub(high, low)) * 1e-3, height = distance;
  for (let corner = 0; corner < 8; ++corner) {
    const to = sub([0, 1, 2].map((i) => (corner >> i & 1 ? high : low)[i]), middle);
    const half = Math.max(Math.abs(dot(to, up)), Math.abs(dot(to, right)) / aspect);
    height = Math.max(height, 2 * half);
    distance = Math.max(distance, half / slope - dot(to, forward));
  }
  const made = {...camera, look_at: middle, position: sub(middle, scale(forward, kMargin * distance))};
  return camera.orthographic_height ? {...made, orthographic_height: kMargin * height} : made;
}

// Box around boxes; without flat ones, as floors, if there are others.
export function boxAround(boxes) {
  const isFlat = ([low, high]) => Math.min(...sub(high, low)) < 1e-6 * Math.max(...sub(high, low));
  const solid = boxes.filter((box) => !isFlat(box)), all = solid.length ? solid : boxes;
  if (!all.length) return null;
  return [Math.min, Math.max].map((extreme, side) => [0, 1, 2].map((i) => extreme(...all.map((box) => box[side][i]))));
}

// Height of the image at a depth.
export const heightAt = (camera, depth) =>
  camera.orthographic_height || 2 * depth * Math.tan(camera.field_of_view * Math.PI / 360);

// Projection of a point: x and y in [0, 1] of the full film, and its depth. Points behind the camera keep
// their side.
export function project(camera, aspect, point) {
  const {forward, right, up, distance} = basis(camera);
  const to = sub(point, camera.position);
  const depth = dot(to, forward), size = heightAt(camera, Math.max(depth, distance * .05));
  const [across, above] = camera.shift;
  return {x: .5 - across + dot(to, right) / (size * aspect), y: .5 + above - dot(to, up) / size, depth};
}
