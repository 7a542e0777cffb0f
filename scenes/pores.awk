# SPDX-License-Identifier: GPL-3.0-or-later
# Prints the relief of skin as a tile of 256 x 256 heights in PGM: cells between fine furrows, and pores in some corners.
# usage: awk -f scenes/pores.awk
function hash(i, j, k,    x) {
  x = sin(i * 12.9898 + j * 78.233 + k * 37.719) * 43758.5453
  return x - int(x) + (x < 0)
}
function smooth(low, high, x) {
  x = (x - low) / (high - low); x = x < 0 ? 0 : x > 1 ? 1 : x
  return x * x * (3 - 2 * x)
}
BEGIN {
  size = 256; cells = 12
  for (i = 0; i < cells; ++i)
    for (j = 0; j < cells; ++j) { at_x[i, j] = hash(i, j, 1); at_y[i, j] = hash(i, j, 2); is_pore[i, j] = hash(i, j, 3) < 0.3 }
  printf "P2\n%d %d\n255\n", size, size
  for (row = 0; row < size; ++row)
    for (column = 0; column < size; ++column) {
      x = column * cells / size; y = row * cells / size
      nearest = next_one = pore = 9
      for (i = int(x) - 1; i <= int(x) + 1; ++i)
        for (j = int(y) - 1; j <= int(y) + 1; ++j) {
          a = (i + cells) % cells; b = (j + cells) % cells
          far = sqrt((i + at_x[a, b] - x) ^ 2 + (j + at_y[a, b] - y) ^ 2)
          if (is_pore[a, b] && far < pore) pore = far
          if (far < nearest) { next_one = nearest; nearest = far } else if (far < next_one) next_one = far
        }
      print int(255 * smooth(-0.1, 0.35, next_one - nearest) * (0.15 + 0.85 * smooth(0.1, 0.45, pore)))
    }
}
