# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares F12 by Cycles and by opaline with random walks, on a skin head and a marble bunny.

usage: python3 tests/blender/compare_with_cycles.py IMAGE.png [PROGRAM]

Runs in a Python with `bpy`. Prints the error of both engines against `--method volume` and writes their images side by side:
Cycles on the left, opaline on the right.
"""

import math
import os
import pathlib
import shutil
import struct
import sys
import tempfile
import zlib

import bpy
import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from blender_scenes import ROOT, prepare_output, register  # noqa: E402  finds the add-on, too
from blender import exr_file, properties  # noqa: E402

SIZE, SHOWN = 320, 280  # pixels of a render, and of its copy in the PNG
CYCLES_SAMPLES, OPALINE_SAMPLES = 256, 16
WALK_NOISE = 3  # percent
BLOCK = 4  # pixels: errors are those of the means of blocks, to leave out most noise of single pixels


def material(name, color, radius, scale, **inputs):
    """A translucent Principled BSDF; with Cycles' radius, in Blender units."""
    made = bpy.data.materials.new(name)
    if made.node_tree is None:
        made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    values = {"Base Color": (*color, 1), "Subsurface Weight": 1, "Subsurface Radius": radius, "Subsurface Scale": scale,
              "Specular IOR Level": 0.5, "Roughness": 0.5} | inputs
    for key, value in values.items():
        shader.inputs[key].default_value = value
    return made


def bump(points, center, width, height):
    """Height of a smooth bump at directions near a centre."""
    center = np.array(center, float) / np.linalg.norm(center)
    return height * np.exp(-((points - center) ** 2).sum(axis=1) / width**2)


def head_mesh():
    """A head of 0.2 units: a sphere with nose, brow, chin, lips, ears and eye sockets."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, radius=1)
    made = bpy.context.object
    points = np.empty(3 * len(made.data.vertices), np.float32)
    made.data.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    radius = np.ones(len(points))
    for center, width, height in (((0, -1, -0.05), 0.16, 0.22), ((0, -1, -0.18), 0.13, 0.16), ((0, -0.85, -0.75), 0.3, 0.15),
                                  ((0, -1, 0.3), 0.45, 0.05), ((0, -1, -0.43), 0.14, 0.06), ((0, -1, -0.56), 0.12, 0.05),
                                  ((0.36, -0.93, 0.1), 0.2, -0.16), ((-0.36, -0.93, 0.1), 0.2, -0.16),
                                  ((1, 0.05, 0), 0.13, 0.25), ((-1, 0.05, 0), 0.13, 0.25)):
        radius += bump(points, center, width, height)
    points = points * radius[:, None] * np.array([0.075, 0.092, 0.11])
    made.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
    made.data.update()
    return made


def bunny_mesh():
    bpy.ops.wm.obj_import(filepath=str(ROOT / "scenes/assets/bunny.obj"))
    made = bpy.context.object
    bpy.ops.object.select_all(action="DESELECT")
    corners = np.array([corner[:] for corner in made.bound_box])
    made.scale = [0.1 / (corners.max(axis=0) - corners.min(axis=0)).max()] * 3
    bpy.context.view_layer.update()
    corners = np.array([(made.matrix_world @ bpy.context.scene.camera.location.__class__(corner))[:]
                        for corner in made.bound_box])
    made.location -= made.location.__class__((corners.max(axis=0) + corners.min(axis=0)) / 2)
    return made


def place(thing, location, target=(0, 0, 0)):
    thing.location = location
    direction = thing.location.__class__(target) - thing.location
    thing.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    return thing


def make_scene(kind):
    """The head in a soft light from the side, or the bunny with a light behind it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(26)
    scene.camera = place(camera, (0.1, -0.6, 0.06) if kind == "head" else (0.05, -0.27, 0.07))
    if kind == "head":
        made, made_of = head_mesh(), material("skin", (0.8, 0.55, 0.42), (1, 0.4, 0.25), 0.12, IOR=1.4)
        lights = (((0.3, -0.3, 0.25), 0.15, 2.2), ((-0.35, 0.2, 0.1), 0.1, 1.2))
    else:
        made, made_of = bunny_mesh(), material("marble", (0.83, 0.79, 0.75), (1, 0.8, 0.7), 0.06, IOR=1.5)
        lights = (((0.15, -0.15, 0.2), 0.08, 0.5), ((-0.12, 0.18, 0.08), 0.06, 0.5))
    made.data.materials.clear()
    made.data.materials.append(made_of)
    for polygon in made.data.polygons:
        polygon.use_smooth = True
    for number, (location, size, power) in enumerate(lights):
        data = bpy.data.lights.new(f"light{number}", "AREA")
        data.size, data.energy = size, power
        place(bpy.data.objects.new(data.name, data), location)
    render = scene.render
    render.resolution_x = render.resolution_y = SIZE
    render.film_transparent, render.threads_mode, render.threads = True, "FIXED", 2
    scene.opaline.samples = OPALINE_SAMPLES
    return scene


def render(scene, engine, method="auto"):
    """F12: height x width x 4, from the top row."""
    scene.render.engine = engine
    scene.opaline.method, scene.opaline.until_error = method, WALK_NOISE
    if engine == "CYCLES":
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = CYCLES_SAMPLES, False, False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.filter_width = 1
    folder = tempfile.mkdtemp(prefix="opaline_compare_")
    try:
        output = prepare_output(scene, folder)
        bpy.ops.render.render(write_still=True)
        return exr_file.read_exr(output).layer("ViewLayer.Combined", "RGBA")
    finally:
        shutil.rmtree(folder)


def blocks(image):
    """Means of blocks of pixels."""
    size = SIZE // BLOCK
    return image.astype(float).reshape(size, BLOCK, size, BLOCK, 4).mean(axis=(1, 3))


def covered_pair(image, reference):
    """Colours of the blocks covered in both images."""
    ours, theirs = blocks(image), blocks(reference)
    inside = (ours[..., 3] > 0.999) & (theirs[..., 3] > 0.999)
    return ours[inside][:, :3], theirs[inside][:, :3]


def error(image, reference):
    """Rms difference over covered blocks, relative to the mean of the reference, per channel."""
    ours, theirs = covered_pair(image, reference)
    return np.sqrt(((ours - theirs) ** 2).mean(axis=0)) / theirs.mean(axis=0)


def brightness(image, reference):
    """Relative difference of the mean over covered blocks."""
    ours, theirs = covered_pair(image, reference)
    return ours.mean() / theirs.mean() - 1


def encoded(image, exposure):
    """sRGB over grey."""
    linear = image[..., :3] * exposure + (1 - image[..., 3:]) * 0.05
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def shrunk(image):
    """Area means of a square image, at SHOWN pixels."""
    edges = np.arange(SHOWN + 1) * (SIZE / SHOWN)
    pixels = np.arange(SIZE)
    overlap = np.minimum(edges[1:, None], pixels + 1) - np.maximum(edges[:-1, None], pixels)
    weights = np.clip(overlap, 0, None) * (SHOWN / SIZE)
    return np.einsum("yi,xj,ijc->yxc", weights, weights, image, optimize=True)


def write_png(path, rows):
    """Writes an image with values from 0 to 1 as an 8-bit PNG."""
    height, width, _ = rows.shape
    pixels = (rows * 255 + 0.5).astype(np.uint8)
    data = b"".join(b"\x02" + difference.tobytes() for difference in np.diff(pixels, axis=0, prepend=0 * pixels[:1]))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def main():
    register()
    if len(sys.argv) > 2:
        properties.DefaultPreferences.program = sys.argv[2]
    rows = []
    for kind in ("head", "bunny"):
        scene = make_scene(kind)
        cycles, opaline = render(scene, "CYCLES"), render(scene, "OPALINE")
        reference = render(scene, "OPALINE", "volume")
        framing = opaline[..., 3].sum() / cycles[..., 3].sum() - 1
        print(f"RESULT {kind}: covered area of opaline over Cycles {100 * framing:+.2f} %")
        for name, image in (("Cycles", cycles), ("opaline", opaline)):
            text = ", ".join(f"{100 * each:.1f}" for each in error(image, reference))
            mean = 100 * brightness(image, reference)
            print(f"RESULT {kind}: {name} against volume: rms {text} % (R, G, B), mean {mean:+.1f} %", flush=True)
        bright = np.percentile(reference[reference[..., 3] > 0.999][:, :3].max(axis=1), 98)
        rows.append(np.hstack([shrunk(encoded(image, 0.9 / bright)) for image in (cycles, opaline)]))
    write_png(sys.argv[1], np.vstack(rows))
    os._exit(0)  # bpy may crash at exit


if __name__ == "__main__":
    main()
