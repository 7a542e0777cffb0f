# SPDX-License-Identifier: GPL-3.0-or-later
# Prints a bent candle with drips, 100 mm high, in OBJ: the parts "wax", a closed mesh of 40,000 triangles, and "wick".
# usage: awk -v bend=DEGREES -f scenes/candle.awk
function ring(radius, height, columns, is_wax,    a, c, j, angle, x, out) {
  a = bend * height / 100
  for (j = 0; j < columns; ++j) {
    angle = 2 * pi * j / columns
    out = radius * (1 + is_wax * drip(angle, height))
    x = out * cos(angle)
    c = bend == 0 ? 0 : 100 / bend
    printf "v %.6f %.6f %.6f\n", (bend == 0 ? x : c - (c - x) * cos(a)), (bend == 0 ? height : (c - x) * sin(a)), \
      out * sin(angle)
  }
}
function drip(angle, height,    k, near, sum) {
  for (k = 0; k < 7; ++k) {
    near = 1 - cos(angle - 2.4 * k)
    sum += 0.13 * exp(-30 * near) / (1 + exp((97 - 5 * k - height) / -1.5)) / (1 + exp((97 - 9 * k - height) / 2))
    sum += 0.1 * exp(-60 * near) / (1 + exp((60 + 5 * k - height) / 1.5))
  }
  return sum
}
BEGIN {
  pi = atan2(0, -1); columns = 160; rows = 125; bend *= pi / 180
  print "usemtl wax"
  for (i = 0; i <= rows; ++i) {
    if (i < 8) ring(10 * sin(pi / 2 * (i + 0.2) / 8.2), 0.4 * i / 8, columns, 1) # the bottom
    else if (i < 105) ring(10, 0.4 + 97 * (i - 8) / 96, columns, 1)           # the side
    else ring(0.2 + 9.8 * cos(pi / 2 * (i - 104) / 21), 97.4 + 2.4 * sin(pi * (i - 104) / 21) - (i - 104) / 7, columns, 1)
  }
  printf "v 0 0 0\n"
  for (i = 0; i < rows; ++i)
    for (j = 0; j < columns; ++j) {
      a = i * columns + j + 1; b = i * columns + (j + 1) % columns + 1
      printf "f %d %d %d %d\n", a, a + columns, b + columns, b
    }
  for (j = 1; j <= columns; ++j)
    printf "f %d %d %d\n", j, j % columns + 1, (rows + 1) * columns + 1
  printf "f"
  for (j = columns; j > 0; --j) printf " %d", rows * columns + j
  first = (rows + 1) * columns + 2
  printf "\nusemtl wick\n"
  for (i = 0; i <= 8; ++i) ring(0.6, 92 + i * 1.5, 12, 0)
  for (i = 0; i < 8; ++i)
    for (j = 0; j < 12; ++j) {
      a = first + i * 12 + j; b = first + i * 12 + (j + 1) % 12
      printf "f %d %d %d %d\n", a, a + 12, b + 12, b
    }
  printf "f"
  for (j = 11; j >= 0; --j) printf " %d", first + 96 + j
  printf "\n"
}
