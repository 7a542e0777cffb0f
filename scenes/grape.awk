# SPDX-License-Identifier: GPL-3.0-or-later
# Prints a grape, 18 mm wide and 22 mm long, with its stalk, in OBJ: the parts "berry", a closed mesh with its specks as vertex
# colours, and "stalk". The stalk is at the top.
# usage: awk -v seed=NUMBER -f scenes/noise.awk -f scenes/grape.awk
function berry(theta, phi,    x, y, z, r, speck, tint, scar) {
  x = sin(theta) * cos(phi); y = cos(theta); z = sin(theta) * sin(phi)
  r = 9 * (1 + 0.05 * (noise(1.5 * x, 1.5 * y, 1.5 * z) - 0.5) - 0.1 * exp(-(theta / 0.16) ^ 2) \
           - 0.02 * exp(-((pi - theta) / 0.07) ^ 2))
  speck = smooth(0.8, 0.95, noise(24 * x, 24 * y, 24 * z)) * 0.3
  scar = smooth(0.2, 0.12, theta) + smooth(0.05, 0.03, pi - theta)
  tint = (1 - speck) * (0.86 + 0.14 * smooth(0.2, 0.7, noise(4 * x, 4 * y, 4 * z)))
  printf "v %.4f %.4f %.4f %.3f %.3f %.3f\n", r * x, r * y * 1.2 * (1 - 0.04 * y), r * z, \
    mix(tint, 0.5, scar), mix(tint, 0.36, scar), mix(tint, 0.2, scar)
}
function lathe(first, columns, rows,    i, j, a, b) { # faces of rings from the top, counted from a vertex
  for (i = 0; i < rows; ++i)
    for (j = 0; j < columns; ++j) {
      a = first + i * columns + j; b = first + i * columns + (j + 1) % columns
      printf "f %d %d %d %d\n", a, b, b + columns, a + columns
    }
}
BEGIN {
  pi = atan2(0, -1); columns = 160; rows = 120
  print "usemtl berry"
  for (i = 0; i <= rows; ++i)
    for (j = 0; j < columns; ++j) berry(0.02 + (pi - 0.04) * i / rows, 2 * pi * j / columns)
  lathe(1, columns, rows)
  printf "f"
  for (j = columns; j > 0; --j) printf " %d", j
  printf "\nf"
  for (j = 1; j <= columns; ++j) printf " %d", rows * columns + j
  printf "\nusemtl stalk\n"
  for (i = 0; i <= 40; ++i)
    for (j = 0; j < 24; ++j) {
      t = 1 - i / 40                                                          # from the end to the berry
      r = 0.8 + 0.9 * exp(-(t / 0.12) ^ 2) + 0.25 * exp(-((1 - t) / 0.06) ^ 2) \
          + 0.1 * noise(6 * cos(2 * pi * j / 24), 20 * t, 6 * sin(2 * pi * j / 24))
      shade = 0.8 + 0.4 * (noise(3 * cos(2 * pi * j / 24), 9 * t, 3 * sin(2 * pi * j / 24)) - 0.5)
      printf "v %.4f %.4f %.4f %.3f %.3f %.3f\n", r * cos(2 * pi * j / 24) + 3.5 * t * t, 9 + 8 * t, r * sin(2 * pi * j / 24), \
        0.62 * shade, mix(0.42, 0.55, t) * shade, 0.24 * shade
    }
  lathe((rows + 1) * columns + 1, 24, 40)
  printf "f"
  for (j = 24; j > 0; --j) printf " %d", (rows + 1) * columns + j
  printf "\n"
}
