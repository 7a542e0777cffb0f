# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a scene as Blender's exporter writes it, asset.glb, and what Blender's own renderer sees of it.

scene_by_blender.py FOLDER WIDTH HEIGHT

A monkey's head and a floor, painted, under a lamp, a spot light and a sun. Cycles renders them three times, by each light
alone, into lamp.exr, spot.exr and sun.exr: what surfaces send on of it, how much of a
pixel they cover, and the paint.
"""

import math
import os
import sys

import bpy

folder, width, height = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])


def painted(name, texel):
    """A matte material of an image of 64 x 64 texels, as texel(u, v) has them, linear."""
    image = bpy.data.images.new(name, 64, 64)
    image.pixels = [c for y in range(64) for x in range(64) for c in (*texel((x + 0.5) / 64, (y + 0.5) / 64), 1)]
    image.filepath_raw = os.path.join(folder, name + ".png")
    image.file_format = "PNG"
    image.save()
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Specular IOR Level"].default_value = 0
    shader.inputs["Roughness"].default_value = 1
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    material.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    return material


def light(name, kind, place, turned, energy):
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler = place, [math.radians(a) for a in turned]
    bpy.context.collection.objects.link(thing)
    return thing


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_monkey_add(size=0.2, calc_uvs=True, location=(0.01, 0.02, 0.1), rotation=(0.2, -0.3, 0.5))
    monkey = bpy.context.object
    monkey.scale = (1, 0.8, 1.2)
    # Fine triangles: where smooth normals turn away from a light renderers differ by the width of one.
    monkey.modifiers.new("fine", "SUBSURF").levels = 3
    bpy.ops.object.modifier_apply(modifier="fine")
    bpy.ops.object.shade_smooth()
    monkey.data.materials.append(painted("skin", lambda u, v: (0.1 + 0.8 * u, 0.1 + 0.8 * v, 0.5)))
    bpy.ops.mesh.primitive_plane_add(size=0.5, calc_uvs=True, location=(0.05, 0, 0))
    bpy.context.object.data.materials.append(painted("floor", lambda u, v: (0.8 - 0.6 * u, 0.4, 0.2 + 0.6 * v)))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(35)
    camera.location, camera.rotation_euler = (0.45, -0.55, 0.4), [math.radians(a) for a in (66, 4, 39)]
    bpy.context.collection.objects.link(camera)
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = width, height
    lamp = light("lamp", "POINT", (0.4, -0.3, 0.5), (0, 0, 0), 5)
    lamp.data.shadow_soft_size = 0
    spot = light("spot", "SPOT", (-0.3, -0.5, 0.4), (60, 0, -30), 20)
    # A soft rim is another function of the angle in glTF than in Blender.
    spot.data.shadow_soft_size, spot.data.spot_size, spot.data.spot_blend = 0, math.radians(40), 0
    sun = light("sun", "SUN", (0, 0, 1), (40, 0, 70), 2)
    sun.data.angle = 0
    return scene, [lamp, spot, sun]


def render(scene, lights):
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 64, False, False
    scene.cycles.max_bounces = 0
    scene.cycles.filter_width = 1
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.film_transparent = True
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.view_layers[0].use_pass_diffuse_color = True
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    for shown in lights:
        for other in lights:
            other.hide_render = other is not shown
        scene.render.filepath = os.path.join(folder, shown.name + ".exr")
        bpy.ops.render.render(write_still=True)


scene, lights = make_scene()
bpy.ops.export_scene.gltf(filepath=os.path.join(folder, "asset.glb"), export_cameras=True, export_lights=True)
render(scene, lights)
