# SPDX-License-Identifier: GPL-3.0-or-later
# Value noise and interpolation for the other .awk files; the variable `seed` chooses the pattern.
function hash(i, j, k,    x) {
  x = sin(i * 12.9898 + j * 78.233 + k * 37.719 + seed) * 43758.5453
  return x - int(x) + (x < 0)
}
function mix(a, b, t) { return a + (b - a) * t }
function smooth(low, high, x) {
  x = (x - low) / (high - low); x = x < 0 ? 0 : x > 1 ? 1 : x
  return x * x * (3 - 2 * x)
}
function noise(x, y, z,    i, j, k, u, v, w) { # value noise, from 0 to 1, for coordinates above -100
  x += 100; y += 100; z += 100
  i = int(x); j = int(y); k = int(z)
  u = smooth(0, 1, x - i); v = smooth(0, 1, y - j); w = smooth(0, 1, z - k)
  return mix(mix(mix(hash(i, j, k), hash(i + 1, j, k), u), mix(hash(i, j + 1, k), hash(i + 1, j + 1, k), u), v), \
             mix(mix(hash(i, j, k + 1), hash(i + 1, j, k + 1), u), mix(hash(i, j + 1, k + 1), hash(i + 1, j + 1, k + 1), u), v), w)
}
