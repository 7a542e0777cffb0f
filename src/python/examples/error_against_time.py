# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots error against time for several numbers of samples.

    python3 src/python/examples/error_against_time.py scenes/bunny-marble.json error.png
"""
import sys
import time

import matplotlib.pyplot as plt
import opaline

scene, output = sys.argv[1:3]
size = {"film.resolution": [128, 128], "settings.method": "hierarchical"}
reference = opaline.render(scene, size | {"settings.samples": 200_000, "settings.evaluator": "brute_force"})

seconds, errors = [], []
for samples in (1_000, 3_000, 10_000, 30_000):
    start = time.process_time()
    image = opaline.render(scene, size | {"settings.samples": samples})
    seconds.append(time.process_time() - start)
    errors.append(100 * opaline.compare(image, reference, "diffuse")["mean"])
    print(f"{samples:6} samples: {seconds[-1]:.2f} s of CPU, {errors[-1]:.2f} %")

plt.loglog(seconds, errors, "o-")
plt.xlabel("CPU time, s")
plt.ylabel("mean relative error, %")
plt.savefig(output)
