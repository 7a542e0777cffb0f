// SPDX-License-Identifier: GPL-3.0-or-later
// Place of a shape: the last steps of its transform, a scale, rotations and a translation. Earlier steps stay as they are.
import {rounded} from "./camera.js";

const kAxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const kRadian = Math.PI / 180;
const kMostDigits = 6;

const times = (m, v) => m.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const transposed = (m) => kAxes.map((_, i) => m.map((row) => row[i]));
const product = (a, b) => transposed(transposed(b).map((column) => times(a, column)));

// Rows of a rotation, after Rodrigues.
export function rotation(axis, degrees) {
  const length = Math.hypot(...axis), [x, y, z] = axis.map((a) => a / length);
  const c = Math.cos(degrees * kRadian), s = Math.sin(degrees * kRadian), k = 1 - c;
  return [[c + x * x * k, x * y * k - z * s, x * z * k + y * s],
    [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
    [z * x * k - y * s, z * y * k + x * s, c + z * z * k]];
}

const rotationOf = (turns) => turns.reduce((m, {rotate}) => product(rotation(rotate.axis, rotate.degrees), m), kAxes);

// Degrees about x, then y, then z.
function anglesOf(m) {
  const flat = Math.hypot(m[0][0], m[1][0]);
  const angles = flat > 1e-9 ? [Math.atan2(m[2][1], m[2][2]), Math.atan2(-m[2][0], flat), Math.atan2(m[1][0], m[0][0])]
    : [Math.atan2(-m[1][2], m[1][1]), Math.atan2(-m[2][0], flat), 0];
  return angles.map((angle) => Number((angle / kRadian).toFixed(kMostDigits)) || 0);
}

// The axis of each step where they are x, y and z in this order, else null.
function axesOf(turns) {
  const axes = turns.map(({rotate}) => kAxes.findIndex((axis) => axis.join() === rotate.axis.join()));
  return axes.every((axis, i) => axis > (i ? axes[i - 1] : -1)) ? axes : null;
}

const three = (scale) => Array.isArray(scale) ? scale : [scale, scale, scale];

// Steps of a transform as {before, scale, turns, move}: scale and move three numbers, turns steps.
export function placementOf(steps = []) {
  const before = [...steps], turns = [];
  const take = (key) => before.length && key in before[before.length - 1] ? before.pop() : null;
  const move = take("translate");
  for (let turn = take("rotate"); turn; turn = take("rotate")) turns.unshift(turn);
  const scale = take("scale");
  return {before, scale: three(scale?.scale ?? 1), turns, move: move?.translate ?? [0, 0, 0], has: {scale: scale !== null, move: move !== null}};
}

export function turnOf(placement) {
  const axes = axesOf(placement.turns);
  if (!axes) return anglesOf(rotationOf(placement.turns));
  return kAxes.map((_, i) => axes.includes(i) ? placement.turns[axes.indexOf(i)].rotate.degrees : 0);
}

// Steps of the scene stay, even without effect: they may be keyed.
export function stepsOf({before, scale, turns, move, has}) {
  const isUniform = scale[0] === scale[1] && scale[1] === scale[2];
  return [...before, ...(has.scale || !isUniform || scale[0] !== 1 ? [{scale: isUniform ? scale[0] : scale}] : []), ...turns,
    ...(has.move || move.some(Boolean) ? [{translate: move}] : [])];
}

export const movedTo = (placement, move) => ({...placement, move});
export const scaledTo = (placement, scale) => ({...placement, scale});

export function turnedTo(placement, angles) {
  const old = axesOf(placement.turns) || [];
  const turns = angles.flatMap((degrees, i) => degrees || old.includes(i) ? [{rotate: {axis: kAxes[i], degrees}}] : []);
  return {...placement, turns};
}

// About a fixed point: x -> m (x - pivot) + pivot; without the noise of rounding.
function about(pivot, m, move) {
  const made = times(m, move.map((x, i) => x - pivot[i])).map((x, i) => x + pivot[i]);
  const size = Math.max(...made.map(Math.abs), ...pivot.map(Math.abs));
  return made.map((x) => Math.abs(x) < 1e-9 * size ? 0 : rounded(x));
}

export const movedBy = (placement, by) => movedTo(placement, rounded(placement.move.map((x, i) => x + by[i])));

export function turnedBy(placement, pivot, axis, degrees) {
  const turn = rotation(axis, degrees);
  const old = axesOf(placement.turns), own = kAxes.findIndex((a) => a.join() === axis.join());
  const isAlone = old && own >= 0 && old.every((a) => a === own);
  const angles = isAlone ? turnOf(placement).map((x, i) => i === own ? x + degrees : x) :
    anglesOf(product(turn, rotationOf(placement.turns)));
  return {...turnedTo(placement, angles.map((x) => Number(x.toFixed(3)))), move: about(pivot, turn, placement.move)};
}

// Along the shape's own axes, as columns of this rotation.
export const ownAxes = (placement) => transposed(rotationOf(placement.turns));

export function scaledBy(placement, pivot, factors) {
  const turn = rotationOf(placement.turns);
  const stretch = product(product(turn, kAxes.map((axis, i) => axis.map((x) => x * factors[i]))), transposed(turn));
  return {...placement, scale: placement.scale.map((x, i) => Number((x * factors[i]).toPrecision(4))), move: about(pivot, stretch, placement.move)};
}
