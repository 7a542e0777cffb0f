# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the scene, of view layers and of materials, and the preferences of the add-on."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import program

METHODS = (
    ("auto", "Automatic", "Volume diffusion for closed bodies of suitable size, hierarchical for the others"),
    ("volume_diffusion", "Volume diffusion", "The diffusion equation inside the bodies: close to the reference"),
    ("hierarchical", "Hierarchical", "Radial profile, for open meshes and flat, thick shapes"),
    ("image_space", "Image space", "Hierarchical, with samples seen from the lights: for objects in motion"),
    ("preintegrated", "Preintegrated", "By curvature and thickness: fast, for objects in motion"),
    ("lambert", "Lambert", "Opaque previews"),
    ("direct", "Direct", "Monte Carlo reference of the radial profile: slow and noisy"),
    ("volume", "Volume", "Random walks inside the bodies: the reference, slow and noisy"),
)
QUALITIES = (
    ("SETTINGS", "Settings", "Settings of the scene file"),
    ("TARGET_ERROR", "Target error", "Chooses the settings for this error at the lowest cost"),
    ("TIME_BUDGET", "Time budget", "Chooses the settings for the lowest error within this CPU time"),
)
MIXES = (
    ("split", "Split", "Half of the texture before scattering, half after it"),
    ("pre", "Before", "Before scattering: blurred"),
    ("post", "After", "After scattering: sharp"),
    ("medium", "Medium", "The medium itself varies inside the body"),
)
_presets = {}


def preferences():
    """Preferences of the add-on; the defaults if it is registered as a plain module."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon is not None and addon.preferences is not None else DefaultPreferences


class DefaultPreferences:
    program = ""


def preset_names():
    """Measured media of the program, asked once per path."""
    path = preferences().program
    if path not in _presets:
        try:
            _presets[path] = program.presets(program.find_program(path))
        except program.ProgramError:
            return program.PRESETS
    return _presets[path]


def search_presets(self, context, edit_text):
    del self, context
    return [name for name in preset_names() if edit_text.lower() in name]


class OpalinePreferences(bpy.types.AddonPreferences):
    """Path of the program."""

    bl_idname = __package__

    program: StringProperty(name="Program", subtype="FILE_PATH", description="Path of opaline; empty: found on PATH")

    def draw(self, context):
        del context
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=program.find_program(self.program))
        except program.ProgramError as error:
            self.layout.label(text=str(error), icon="ERROR")


class OpalineSceneSettings(bpy.types.PropertyGroup):
    """Settings of a render."""

    method: EnumProperty(name="Method", items=METHODS, default="auto")
    quality: EnumProperty(name="Quality", items=QUALITIES, default="SETTINGS")
    target_error: FloatProperty(name="Error", default=2, min=0.01, max=100, subtype="PERCENTAGE",
                                description="Mean relative error of the diffuse light of translucent surfaces")
    time_budget: FloatProperty(name="CPU Time", default=5, min=0.1, description="CPU seconds of all threads together")
    until_error: FloatProperty(name="Noise", default=2, min=0.01, max=100, subtype="PERCENTAGE",
                               description="The reference stops at this noise")
    samples: IntProperty(name="Samples", default=16, min=1, max=65536, description="Camera rays per pixel")
    light_samples: IntProperty(name="Shadow Rays", default=64, min=1, max=65536,
                               description="Shadow rays per sample to each area light and to the environment")
    max_samples: IntProperty(name="Surface Samples", default=500000, min=1000, max=1000000000,
                             description="Maximum number of samples per body; a small radius on a large body takes many")
    bounces: BoolProperty(name="Light between surfaces", default=True)
    use_denoising: BoolProperty(name="Denoise", default=False, description="Open Image Denoise, if it is installed")
    seed: IntProperty(name="Seed", default=0, min=0)
    use_cache: BoolProperty(name="Reuse stages", default=True, description="Later frames reuse unchanged stages")
    mm_per_unit: FloatProperty(name="Millimetres per Unit", default=0, min=0, soft_max=1e6,
                               description="Length of one Blender unit; 0: from the unit scale of the scene, in metres")


class OpalineLayerSettings(bpy.types.PropertyGroup):
    """Passes of a view layer."""

    use_pass_parts: BoolProperty(name="Diffuse and Specular", default=False)
    use_pass_error: BoolProperty(name="Error", default=False, description="Estimated error of the diffuse light")
    use_pass_lights: BoolProperty(name="Light Groups", default=False, description="The light of each light source")


class OpalineMaterialSettings(bpy.types.PropertyGroup):
    """A measured medium in place of the nodes."""

    medium: StringProperty(name="Preset", search=search_presets, description="Preset; empty: from the nodes")
    texture_mix: EnumProperty(name="Texture", items=MIXES, default="split",
                              description="Application of a textured colour to a translucent surface")


CLASSES = (OpalinePreferences, OpalineSceneSettings, OpalineLayerSettings, OpalineMaterialSettings)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.opaline = PointerProperty(type=OpalineSceneSettings)
    bpy.types.ViewLayer.opaline = PointerProperty(type=OpalineLayerSettings)
    bpy.types.Material.opaline = PointerProperty(type=OpalineMaterialSettings)


def unregister():
    del bpy.types.Material.opaline, bpy.types.ViewLayer.opaline, bpy.types.Scene.opaline
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
