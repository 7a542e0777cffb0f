# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the tests of the Blender add-on, and their images by Cycles and by opaline."""

import math
import os
import pathlib
import shutil
import sys
import tempfile

import bpy
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src"))
sys.dont_write_bytecode = True

import blender as addon  # noqa: E402
from blender import exr_file, program, properties  # noqa: E402

PROGRAM = os.environ.get("OPALINE_PROGRAM", str(ROOT / "build/src/opaline"))


def register():
    properties.DefaultPreferences.program = PROGRAM
    addon.register()


def new_scene(width=64, height=48):
    """An empty scene with black world and a camera at 5 units in front of the origin, slightly above."""
    for handlers in (bpy.data.objects, bpy.data.meshes, bpy.data.lights, bpy.data.cameras, bpy.data.materials,
                     bpy.data.images, bpy.data.worlds, bpy.data.collections):
        for each in list(handlers):
            handlers.remove(each)
    scene = bpy.context.scene
    scene.unit_settings.scale_length = 1
    scene.frame_set(1)
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.use_border, render.film_transparent = False, True
    render.threads_mode, render.threads = "FIXED", 2
    scene.world = bpy.data.worlds.new("world")
    set_world((0, 0, 0))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0.3, -5, 1.5), (math.radians(73), 0, math.radians(3))
    scene.collection.objects.link(camera)
    scene.camera = camera
    settings = scene.opaline
    for name in settings.bl_rna.properties.keys():
        if name not in {"rna_type", "name"}:
            settings.property_unset(name)
    settings.samples, settings.light_samples, settings.bounces, settings.use_cache = 16, 256, False, False
    layer = scene.view_layers[0]
    for name in ("z", "normal", "position", "diffuse_color", "cryptomatte_object", "cryptomatte_material"):
        setattr(layer, f"use_pass_{name}", False)
    for name in ("parts", "error", "lights"):
        setattr(layer.opaline, f"use_pass_{name}", False)
    return scene


def principled(name, color=(0.6, 0.6, 0.6), specular=0.0, **inputs):
    """A material of a Principled BSDF; inputs by name with _ for spaces."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Specular IOR Level"].default_value = specular
    shader.inputs["Roughness"].default_value = 1
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return material


def shader_of(material):
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def add_sphere(material, radius=1.0, location=(0, 0, 0), name="ball"):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=radius, location=location)
    return dressed(material, name)


def add_floor(material, size=6.0, height=-1.0):
    bpy.ops.mesh.primitive_plane_add(size=size, location=(0, 0, height))
    return dressed(material, "floor")


def dressed(material, name):
    made = bpy.context.object
    made.name = name
    for polygon in made.data.polygons:
        polygon.use_smooth = True
    made.data.materials.append(material)
    return made


def add_light(kind, energy, location=(1.5, -2, 3), target=(0, 0, 0), name="key", **values):
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    if kind in {"POINT", "SPOT"}:
        data.shadow_soft_size = 0
    if kind == "SUN":
        data.angle = 0
    for key, value in values.items():
        setattr(data, key, value)
    made = bpy.data.objects.new(name, data)
    made.location = location
    direction = bpy.context.scene.camera.location.__class__(target) - made.location
    made.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(made)
    return made


def set_world(color, strength=1.0, image=None, turn=0.0):
    """A constant world, or an environment map turned about z by a Mapping node."""
    world = bpy.context.scene.world
    if world.node_tree is None:
        world.use_nodes = True
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    if image is not None:
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        picture.image = image
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Rotation"].default_value = (0, 0, turn)
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
        tree.links.new(picture.outputs["Color"], background.inputs["Color"])


def new_image(name, width, height, texel, is_float=False, is_data=False):
    """An image of texel(u, v), with linear colours if it is a float image."""
    image = bpy.data.images.new(name, width, height, float_buffer=is_float, is_data=is_data)
    texels = [(*texel((x + 0.5) / width, (y + 0.5) / height), 1) for y in range(height) for x in range(width)]
    image.pixels = np.array(texels, np.float32).ravel().tolist()
    return image


class Rendered:
    """Channels of a rendered view layer, from the top row."""

    def __init__(self, path):
        picture = exr_file.read_exr(path)
        self.texts = picture.texts
        self.channels = {}
        for name, values in picture.channels.items():
            if name.count(".") > 1:  # parts of a matte are lower-case in Cycles
                layer, part = name.split(".", 1)[1].rsplit(".", 1)
                self.channels[f"{layer}.{part.upper()}"] = values

    def layer(self, name, parts="RGB"):
        return np.stack([self.channels[f"{name}.{part}"].astype(float) for part in parts], axis=-1)

    @property
    def color(self):
        return self.layer("Combined")

    @property
    def alpha(self):
        return self.channels["Combined.A"].astype(float)


def prepare_output(scene, folder):
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    if hasattr(settings, "use_exr_interleave"):
        settings.use_exr_interleave = True  # one part
    scene.render.filepath = os.path.join(folder, "image")
    return os.path.join(folder, "image.exr")


def f12(scene):
    """The image of the scene's engine, as F12 makes it."""
    folder = tempfile.mkdtemp(prefix="opaline_test_")
    try:
        path = prepare_output(scene, folder)
        bpy.ops.render.render(write_still=True)
        return Rendered(path)
    finally:
        shutil.rmtree(folder)


def by_opaline(scene):
    scene.render.engine = "OPALINE"
    return f12(scene)


def by_cycles(scene, samples=128, bounces=0):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = samples, False, False
    cycles.max_bounces = bounces
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    return f12(scene)


def interior(*images):
    """Pixels whose neighbours are covered in all images."""
    inside = np.all([image.alpha > 0.999 for image in images], axis=0)
    shrunk = inside.copy()
    for axis in (0, 1):
        for step in (-1, 1):
            shrunk &= np.roll(inside, step, axis)
    shrunk[[0, -1]] = shrunk[:, [0, -1]] = False
    return shrunk


def relative_difference(ours, theirs, pixels):
    """Relative difference of the mean, and mean absolute difference over the mean, over some pixels."""
    a, b = ours[pixels], theirs[pixels]
    return abs(a.mean() / b.mean() - 1), np.abs(a - b).mean() / b.mean()
