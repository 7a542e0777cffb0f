# SPDX-License-Identifier: GPL-3.0-or-later
# Reads a head in OFF with z up, and prints it in OBJ, 240 mm high with y up, with UVs around it: a tile of them is 12 mm wide.
# Vertex colours redden the ears and the nose.
# usage: awk -f scenes/head.awk scenes/assets/mannequin-devil.off
function red(x, y, z, cx, cy, cz, size) { return exp(-((x - cx) ^ 2 + (y - cy) ^ 2 + (z - cz) ^ 2) / size ^ 2) }
NR == 1 { next }
NR == 2 { points = $1; next }
NF == 0 { next }
++read <= points {
  px[read] = $1; py[read] = $3; pz[read] = -$2
  if (read == 1) { low_x = high_x = px[1]; low_y = high_y = py[1]; low_z = high_z = pz[1] }
  if (px[read] < low_x) low_x = px[read]
  if (px[read] > high_x) high_x = px[read]
  if (py[read] < low_y) low_y = py[read]
  if (py[read] > high_y) high_y = py[read]
  if (pz[read] < low_z) low_z = pz[read]
  if (pz[read] > high_z) high_z = pz[read]
  next
}
{ first[++faces] = $2 + 1; second[faces] = $3 + 1; third[faces] = $4 + 1 }
END {
  pi = atan2(0, -1); tiles = 39
  scale = 240 / (high_y - low_y)
  for (i = 1; i <= points; ++i) {
    x = (px[i] - (low_x + high_x) / 2) * scale; y = (py[i] - low_y) * scale; z = (pz[i] - (low_z + high_z) / 2) * scale
    blood = red(x, y, z, 75, 130, -12, 24) + red(x, y, z, -75, 130, -12, 24) + 0.6 * red(x, y, z, 0, 110, 97, 16)
    u[i] = tiles * (0.5 + atan2(x, z) / (2 * pi))
    printf "v %.4f %.4f %.4f %.3f %.3f %.3f\nvt %.4f %.4f\nvt %.4f %.4f\n", x, y, z, 1, 1 - 0.34 * blood, 1 - 0.34 * blood, \
      u[i], y / 12, u[i] + tiles, y / 12
  }
  for (i = 1; i <= faces; ++i) {
    a = first[i]; b = second[i]; c = third[i]
    most = u[a] > u[b] ? u[a] : u[b]; most = most > u[c] ? most : u[c]  # a face across the seam takes the UVs of one side
    printf "f %d/%d %d/%d %d/%d\n", a, 2 * a - (u[a] > most - tiles / 2), b, 2 * b - (u[b] > most - tiles / 2), \
      c, 2 * c - (u[c] > most - tiles / 2)
  }
}
