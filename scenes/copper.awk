# SPDX-License-Identifier: GPL-3.0-or-later
# Prints a copper pot, 78 mm high, in OBJ: a turned profile of the outside, the lip and the inside, with u around and v along it.
# usage: awk -f scenes/copper.awk
function ring(radius, height,    j, angle) {
  for (j = 0; j <= columns; ++j) {
    angle = 2 * pi * j / columns
    printf "v %.4f %.4f %.4f\nvt %.5f %.5f\n", radius * cos(angle), height, -radius * sin(angle), j / columns, rows / 240
  }
  ++rows
}
function belly(t) { return 25 + 13 * sin(pi * (0.08 + 0.8 * t)) + 7 * t ^ 6 } # radius at the height t, from 0 to 1
BEGIN {
  pi = atan2(0, -1); columns = 240
  for (i = 0; i < 10; ++i) ring(0.5 + (belly(0) - 3.5) * i / 9, 0)                                                  # the bottom
  for (i = 1; i <= 9; ++i) ring(belly(0) - 3 + 3 * sin(pi / 2 * i / 9), 3 - 3 * cos(pi / 2 * i / 9))                # its edge
  for (i = 1; i <= 100; ++i) ring(belly(i / 100), 3 + 74 * i / 100)                                                 # the outside
  for (i = 1; i <= 12; ++i) ring(belly(1) - 0.9 + 0.9 * cos(pi * i / 12), 77 + 0.9 * sin(pi * i / 12))              # the lip
  for (i = 99; i >= 0; --i) ring(belly(i / 100) - 1.8, 3 + 74 * i / 100)                                            # the inside
  for (i = 8; i >= 0; --i) ring(0.5 + (belly(0) - 2.3) * i / 9, 3)
  for (i = 0; i < rows - 1; ++i)
    for (j = 0; j < columns; ++j) {
      a = i * (columns + 1) + j + 1; b = a + columns + 1
      printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, b, b
    }
}
