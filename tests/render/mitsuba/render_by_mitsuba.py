#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene of opaque quads and spheres and of quad lamps, by Mitsuba 3's path tracer.

usage: render_by_mitsuba.py SCENE.json OUT.exr BOUNCES SAMPLES

Takes of opaline's scene files what the scenes of test_mitsuba.cpp have; anything else is an error.
"""
import json
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")


def colour(value):
    return {"type": "rgb", "value": value if isinstance(value, list) else [value] * 3}


def rectangle(quad):
    """The matrix that takes Mitsuba's rectangle, [-1, 1]^2 with the normal z, to the quad with the normal u x v."""
    corner, u, v = (np.array(quad[key], float) for key in ("corner", "u", "v"))
    normal = np.cross(u, v)
    matrix = np.eye(4)
    for column, value in enumerate((u / 2, v / 2, normal / np.linalg.norm(normal), corner + u / 2 + v / 2)):
        matrix[:3, column] = value
    return mi.ScalarTransform4f(matrix)


def surface(shape):
    base = colour(shape.pop("reflectance", 0.5))
    if "specular_roughness" not in shape:
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": base}}
    alpha, ratio = shape.pop("specular_roughness") ** 2, 1 - shape.pop("specular_anisotropy", 0)
    if shape.pop("metalness", 0) == 1:
        along = alpha * (2 / (1 + ratio ** 2)) ** 0.5
        return {"type": "roughconductor", "distribution": "ggx", "alpha_u": along, "alpha_v": ratio * along,
                "material": "none", "specular_reflectance": base}
    if ratio != 1:
        raise SystemExit("anisotropy of a coat: not compared")
    return {"type": "roughplastic", "distribution": "ggx", "alpha": alpha, "int_ior": 1.5, "diffuse_reflectance": base,
            "nonlinear": True}


def shape_of(shape):
    shape = dict(shape)
    shape.pop("name", None)
    bsdf = surface(shape)
    (kind, data), = shape.items()
    if kind == "quad":
        return {"type": "rectangle", "to_world": rectangle(data), "bsdf": bsdf}
    if kind == "sphere":
        return {"type": "sphere", "center": data["center"], "radius": data["radius"], "bsdf": bsdf}
    raise SystemExit(f"{kind}: not compared")


def lamp(light):
    if light["type"] != "quad":
        raise SystemExit(f"{light['type']}: not compared")
    return {"type": "rectangle", "to_world": rectangle(light), "bsdf": {"type": "diffuse", "reflectance": colour(0)},
            "emitter": {"type": "area", "radiance": colour(light["radiance"])}}


def main(scene_file, out, bounces, samples):
    with open(scene_file, encoding="utf-8") as file:
        scene = json.load(file)
    camera, (width, height) = scene["camera"], scene["film"]["resolution"]
    parts = {f"shape{i}": shape_of(shape) for i, shape in enumerate(scene["shapes"])}
    parts |= {f"lamp{i}": lamp(light) for i, light in enumerate(scene["lights"])}
    picture = mi.render(mi.load_dict({
        "type": "scene", **parts,
        "integrator": {"type": "path", "max_depth": 2 + int(bounces), "rr_depth": 1000},
        "sensor": {
            "type": "perspective", "fov": camera["field_of_view"], "fov_axis": "y",
            "to_world": mi.ScalarTransform4f().look_at(camera["position"], camera["look_at"], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"},
                     "pixel_format": "rgb", "component_format": "float32"},
            "sampler": {"type": "multijitter", "sample_count": int(samples)},
        }}))
    mi.Bitmap(picture).write(out)


main(*sys.argv[1:])
