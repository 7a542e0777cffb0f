# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits sigma_a and sigma_s_prime of a plate to photographs of both its sides, by rendering them (inverse rendering).

    python3 src/python/examples/fit_slab.py

The photographs are renders with known coefficients and 1 % of noise; replace them with arrays of your own.
"""
import numpy as np
import opaline
from scipy.optimize import least_squares

TRUE = np.array([0.05, 1.5])  # sigma_a, sigma_s_prime, 1/mm
PLATE = {
    "media": {"plate": {"sigma_a": TRUE[0], "sigma_s_prime": TRUE[1], "specular_ior": 1.3, "specular_weight": 0}},
    "shapes": [{"name": "plate", "slab": {"width": 30, "depth": 30, "thickness": 3}, "medium": "plate"}],
    "lights": [{"name": "lamp", "type": "spot", "position": [0, 60, 0], "direction": [0, -1, 0], "intensity": 5e4,
                "outer_angle": 4}],
    "film": {"resolution": [32, 32], "pixel_type": "float"},
    "settings": {"method": "volume_diffusion"},
}
SIDES = {"lit": [0, 60, 1], "dark": [0, -60, 1]}  # the camera's places
sessions = {side: opaline.Session(PLATE, {"camera.position": place}) for side, place in SIDES.items()}


def photographs(coefficients):
    sigma_a, sigma_s_prime = np.exp(coefficients)  # positive
    images = []
    for session in sessions.values():
        session.set({"media.plate.sigma_a": sigma_a, "media.plate.sigma_s_prime": sigma_s_prime})
        images.append(session.render()["diffuse"][..., 1])
    return np.stack(images)


truth = photographs(np.log(TRUE))
photos = truth * (1 + .01 * np.random.default_rng(1).standard_normal(truth.shape))
# Each side counts alike, its darkest parts little.
scale = photos.max(axis=(1, 2), keepdims=True) * .05 + photos

found = least_squares(lambda x: ((photographs(x) - photos) / scale).ravel(), np.log([0.2, 0.7]), diff_step=.02)
print(f"sigma_a {np.exp(found.x[0]):.4f} (true {TRUE[0]}), sigma_s_prime {np.exp(found.x[1]):.3f} (true {TRUE[1]}), "
      f"{found.nfev} evaluations")
