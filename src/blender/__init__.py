# SPDX-License-Identifier: GPL-3.0-or-later
"""opaline in Blender: a render engine, a live view, and measured media."""

import bpy

from . import engine, live_view, panels, properties


def register():
    properties.register()
    bpy.utils.register_class(engine.OpalineRenderEngine)
    live_view.register()
    panels.register()


def unregister():
    panels.unregister()
    live_view.unregister()
    bpy.utils.unregister_class(engine.OpalineRenderEngine)
    properties.unregister()
