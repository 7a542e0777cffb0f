# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversions between Blender's conventions and those of a scene file.

Blender has z up and lengths in Blender units; a scene file has y up, and `mm_per_unit` relates its lengths to millimetres.
Images have the same numbers as those of Cycles: a radiance of 1 W/(m^2 sr) in Blender is 1 in both. The scene file states
light in W/mm^2, so intensities are multiplied by the square of `mm_per_unit`.
"""

import math

import numpy as np

TO_Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)
CYCLES_RADIUS = 0.25 / math.pi  # mean free path over radius, of "Random Walk" and "Christensen-Burley"
LOWEST_RADIUS = 1e-6  # Blender units; 0 is no medium


def y_up(vector):
    """A position or direction of Blender with y up."""
    x, y, z = vector
    return [float(x), float(z), float(-y)]


def z_up(vectors):
    """Positions or directions with y up, as an array of any shape x 3, in Blender's axes."""
    return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)


def matrix_rows(matrix):
    """Object to world of Blender, as the three rows of a `matrix` step."""
    return (TO_Y_UP @ np.array(matrix, float))[:3].tolist()


def dipole_reflectance(albedo, a):
    """Total diffuse reflectance by reduced albedo (Jensen et al. 2001), a: 4/3 A of the boundary."""
    s = math.sqrt(3 * (1 - albedo))
    return 0.5 * albedo * (1 + math.exp(-a * s)) * math.exp(-s)


def reduced_albedo_of(reflectance, ior):
    """Inverse of dipole_reflectance by bisection, within Cycles' limits."""
    if reflectance < 1e-4:
        return 0.0
    if reflectance >= 0.995:
        return 0.999999
    diffuse_fresnel = (-1.44 / ior + 0.71) / ior + 0.668 + 0.0636 * ior
    a = 4 / 3 * (1 + diffuse_fresnel) / (1 - diffuse_fresnel)
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        if dipole_reflectance(middle, a) < reflectance:
            low = middle
        else:
            high = middle
    return low


def mean_free_path(method, radius, scale, anisotropy, color, ior):
    """Mean free path 1/sigma_t of Cycles' subsurface scattering, per channel, in Blender units.

    Cycles multiplies radius x scale by 1/(4 pi) ("Random Walk", "Christensen-Burley"), or by sqrt(3 (1 - alpha')) with the
    reduced albedo of the colour ("Random Walk (Skin)"). The product is the reduced mean free path 1/sigma_t'; sigma_t is
    sigma_t' / (1 - g).
    """
    lengths = []
    for channel in range(3):
        factor = CYCLES_RADIUS
        if method == "RANDOM_WALK_SKIN":
            factor = math.sqrt(3 * (1 - reduced_albedo_of(color[channel], ior)))
        lengths.append(max(radius[channel] * scale, LOWEST_RADIUS) * factor * (1 - anisotropy))
    return lengths
