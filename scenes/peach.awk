# SPDX-License-Identifier: GPL-3.0-or-later
# Prints a peach of 68 mm in OBJ, with its blush as vertex colours: a closed mesh of 159,200 triangles, the stalk pit at the top.
# usage: awk -f scenes/noise.awk -f scenes/peach.awk
function radius(theta, phi,    side, depth) {
  side = (phi < pi ? phi : phi - 2 * pi) * sin(theta)             # distance from the cleft
  depth = 0.075 * exp(-(side / 0.085) ^ 2) * (1 - 0.75 * smooth(1.2, 2.6, theta))
  return 34 * (1 - depth - 0.36 * exp(-(theta / 0.24) ^ 2) + 0.03 * exp(-((side - 0.45) / 0.3) ^ 2) \
               + 0.015 * exp(-((side + 0.4) / 0.3) ^ 2) + 0.05 * exp(-((pi - theta) / 0.22) ^ 2))
}
function vertex(theta, phi,    x, y, z, r, blush, spot, far) {
  x = sin(theta) * cos(phi); y = cos(theta); z = sin(theta) * sin(phi)
  r = radius(theta, phi)
  far = noise(2 * x, 2 * y, 2 * z) + 0.5 * noise(5 * x, 5 * y, 5 * z) + 0.25 * noise(16 * x, 6 * y, 16 * z)
  blush = smooth(-0.5, 0.95, 0.75 * x - 0.35 * z + 0.3 * y + 0.9 * (far - 0.875))
  spot = smooth(0.72, 0.9, noise(40 * x, 40 * y, 40 * z))         # pale lenticels
  blush *= 1 - 0.3 * spot
  printf "v %.4f %.4f %.4f %.3f %.3f %.3f\n", r * x, 0.94 * r * y, r * z, \
    mix(1, 0.84, blush), mix(0.97, 0.3, blush), mix(0.86, 0.27, blush)
}
BEGIN {
  pi = atan2(0, -1); columns = 400; rows = 200
  vertex(0, 0)
  for (i = 1; i < rows; ++i)
    for (j = 0; j < columns; ++j) vertex(pi * i / rows, 2 * pi * j / columns)
  vertex(pi, 0)
  for (j = 0; j < columns; ++j) {
    b = (j + 1) % columns
    printf "f 1 %d %d\n", b + 2, j + 2
    for (i = 0; i < rows - 2; ++i)
      printf "f %d %d %d %d\n", i * columns + j + 2, i * columns + b + 2, (i + 1) * columns + b + 2, (i + 1) * columns + j + 2
    printf "f %d %d %d\n", (rows - 2) * columns + j + 2, (rows - 2) * columns + b + 2, (rows - 1) * columns + 2
  }
}
