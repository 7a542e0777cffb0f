# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the engine, and Blender's own panels for it."""

import bpy

from . import live_view
from .engine import OpalineRenderEngine
from .scene_export import mm_per_unit_of

ENGINE = OpalineRenderEngine.bl_idname
# Panels of Blender for other engines with exported values.
BORROWED = {
    "DATA_PT_EEVEE_light", "DATA_PT_light", "DATA_PT_spot", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_context_material", "EEVEE_WORLD_PT_surface",
    "EEVEE_NEXT_MATERIAL_PT_surface", "VIEWLAYER_PT_layer_passes_cryptomatte", "VIEWLAYER_PT_eevee_layer_passes_data",
    "VIEWLAYER_PT_eevee_next_layer_passes_data", "MATERIAL_PT_preview",
}
NOT_SHOWN = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_freestyle", "RENDER_PT_simplify"}


class OpalinePanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class OPALINE_PT_sampling(OpalinePanel, bpy.types.Panel):
    bl_label = "opaline"
    bl_context = "render"

    def draw(self, context):
        settings = context.scene.opaline
        layout = self.layout
        layout.use_property_split = True
        layout.prop(settings, "method")
        layout.prop(settings, "quality")
        if settings.quality == "TARGET_ERROR":
            layout.prop(settings, "target_error")
        elif settings.quality == "TIME_BUDGET":
            layout.prop(settings, "time_budget")
        if settings.method == "volume":
            layout.prop(settings, "until_error")
        layout.prop(settings, "samples")
        layout.prop(settings, "light_samples")
        layout.prop(settings, "max_samples")
        layout.prop(settings, "bounces")
        layout.prop(settings, "use_denoising")
        layout.prop(settings, "seed")
        layout.prop(settings, "use_cache")


class OPALINE_PT_size(OpalinePanel, bpy.types.Panel):
    bl_label = "Size"
    bl_context = "render"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(context.scene.opaline, "mm_per_unit")
        layout.label(text=f"One Blender unit is {mm_per_unit_of(context.scene):g} mm")


class OPALINE_PT_live_view(OpalinePanel, bpy.types.Panel):
    bl_label = "Live View"
    bl_context = "render"

    def draw(self, context):
        del context
        row = self.layout.row()
        row.operator(live_view.OpenLiveView.bl_idname, icon="URL")
        row.operator(live_view.CloseLiveView.bl_idname, text="Close")


class OPALINE_PT_passes(OpalinePanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layer = context.view_layer
        layout = self.layout
        layout.use_property_split = True
        for name in ("use_pass_z", "use_pass_normal", "use_pass_position"):
            layout.prop(layer, name)
        layout.prop(layer, "use_pass_diffuse_color", text="Albedo")
        for name in ("use_pass_parts", "use_pass_error", "use_pass_lights"):
            layout.prop(layer.opaline, name)
        layout.prop(layer, "use_pass_cryptomatte_object", text="Cryptomatte Object")
        layout.prop(layer, "use_pass_cryptomatte_material", text="Cryptomatte Material")
        layout.prop(layer, "pass_cryptomatte_depth", text="Levels")


class OPALINE_PT_medium(OpalinePanel, bpy.types.Panel):
    bl_label = "Medium"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material is not None

    def draw(self, context):
        settings = context.material.opaline
        layout = self.layout
        layout.use_property_split = True
        layout.prop(settings, "medium")
        if settings.medium:
            layout.label(text="A preset, with the roughness of the Principled BSDF")
        else:
            layout.prop(settings, "texture_mix")
            layout.label(text="Subsurface of the Principled BSDF, with Cycles' radius")


CLASSES = (OPALINE_PT_sampling, OPALINE_PT_size, OPALINE_PT_live_view, OPALINE_PT_passes, OPALINE_PT_medium)


def compatible_panels():
    """Blender's panels for the engine."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel in CLASSES or panel.__name__ in NOT_SHOWN:
            continue
        if "BLENDER_RENDER" in engines or panel.__name__ in BORROWED:
            yield panel


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    for panel in compatible_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for panel in bpy.types.Panel.__subclasses__():
        if panel not in CLASSES and hasattr(panel, "COMPAT_ENGINES"):
            panel.COMPAT_ENGINES.discard(ENGINE)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
