# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: F12 and animations."""

import os
import tempfile

import bpy
import numpy as np

from . import passes, program
from .camera import border_of
from .exr_file import read_exr
from .lights import world_light_name
from .materials import is_emitter
from .properties import preferences
from .scene_export import SURFACE_TYPES, ExportError, export_scene, light_names


def render_words(path, scene_file, output, scene, layers, cache):
    """Command for the render of an exported scene."""
    settings = scene.opaline
    words = [path, "render", scene_file, "-o", output, "--log", "json", "--layers", layers]
    if settings.quality == "TARGET_ERROR":
        words += ["--target-error", f"{settings.target_error:g}%"]
    elif settings.quality == "TIME_BUDGET":
        words += ["--time-budget", f"{settings.time_budget:g}s"]
    if settings.use_denoising:
        words.append("--denoise")
    if cache:
        words += ["--cache", cache, "--cache-size", "2GB"]
    if scene.render.threads_mode == "FIXED":
        words += ["--threads", str(scene.render.threads)]
    return words


def cache_folder():
    """Folder for the stages reused by later renders of this session of Blender."""
    return os.path.join(bpy.app.tempdir or tempfile.gettempdir(), "opaline_stages")


class OpalineRenderEngine(bpy.types.RenderEngine):
    """Renders translucent materials with the program opaline."""

    bl_idname = "OPALINE"
    bl_label = "opaline"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_postprocess = True

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        lights = [thing.name_full for thing in scene.objects if thing.type == "LIGHT" and not thing.hide_render]
        for thing in scene.objects:
            if thing.type in SURFACE_TYPES and not thing.hide_render:
                lights += [f"{thing.name_full}/{number}" if number else thing.name_full
                           for number, slot in enumerate(thing.material_slots) if is_emitter(slot.material)]
        world = world_light_name(scene.world)
        for each in passes.wanted_passes(scene, renderlayer, lights + ([world] if world else [])):
            self.register_pass(scene, renderlayer, each.name, len(each.parts), each.parts, each.kind)

    def fail(self, message):
        self.error_set(message)
        self.report({"ERROR"}, f"opaline: {message}")

    def show_progress(self, fraction, text):
        self.update_progress(fraction)
        self.update_stats("opaline", text)

    def warn(self, text):
        self.report({"WARNING"}, f"opaline: {text}")

    def render(self, depsgraph):
        with tempfile.TemporaryDirectory(prefix="opaline_", dir=bpy.app.tempdir or None) as folder:
            try:
                self.render_in(depsgraph, folder)
            except program.Cancelled:
                pass
            except (ExportError, program.ProgramError, OSError, ValueError) as error:
                self.fail(str(error))

    def render_in(self, depsgraph, folder):
        scene, view_layer = depsgraph.scene_eval, depsgraph.view_layer_eval
        path = program.find_program(preferences().program)
        self.show_progress(0, "exporting")
        scene_file, keys, warnings = export_scene(depsgraph, folder, self.camera_override or scene.camera)
        for text in warnings:
            self.warn(text)
        wanted = passes.wanted_passes(scene, view_layer, light_names(keys))
        output = os.path.join(folder, "image.exr")
        cache = cache_folder() if scene.opaline.use_cache else ""
        words = render_words(path, scene_file, output, scene, passes.layers_of(wanted), cache)
        program.run(words, self.test_break, self.show_progress, self.warn)
        self.store(read_exr(output), wanted, passes.view_of(keys, scene.render.film_transparent), scene, view_layer.name)

    def store(self, picture, wanted, view, scene, layer):
        """Copies the image and the passes to the result, from the bottom row."""
        for each in wanted:
            self.add_pass(each.name, len(each.parts), each.parts, layer=layer)
        x0, y0, x1, y1 = border_of(scene.render)
        result = self.begin_result(0, 0, x1 - x0, y1 - y0, layer=layer)
        found = result.layers[0].passes
        self.fill(found, "Combined", passes.combined(picture, view))
        for each in wanted:
            self.fill(found, each.name, each.pixels(picture, view))
        self.end_result(result)
        for field, value in passes.matte_metadata(picture, layer):
            self.get_result().stamp_data_add_field(field, value)

    def fill(self, found, name, pixels):
        target = found.get(name)
        if target is not None and pixels is not None:
            target.rect.foreach_set(np.ascontiguousarray(pixels[::-1], np.float32).ravel())
