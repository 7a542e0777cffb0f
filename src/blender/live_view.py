# SPDX-License-Identifier: GPL-3.0-or-later
"""The live view: a page in the browser in step with the scene. Its server follows changes of the exported scene file."""

import json
import os
import queue
import secrets
import shutil
import tempfile
import time
import webbrowser

import bpy

from . import program
from .properties import preferences
from .scene_export import ExportError, export_scene

STEP_SECONDS = 0.1
QUIET_SECONDS = 0.15  # without another change of the scene
START_SECONDS = 60


class LiveView:
    """A server of the program, and the scene it shows."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="opaline_view_", dir=bpy.app.tempdir or None)
        self.token = secrets.token_urlsafe(24)
        self.process, self.url, self.keys, self.warnings = None, "", None, []

    def export(self, depsgraph, camera):
        self.path, keys, self.warnings = export_scene(depsgraph, self.folder, camera)
        return keys

    def open(self, depsgraph, camera):
        """Exports the scene and starts the server. Raises ExportError or ProgramError."""
        self.keys = self.export(depsgraph, camera)
        words = [program.find_program(preferences().program), "view", self.path, "--no-open", "--log", "json",
                 "--token", self.token]
        self.process = program.start(words)
        self.reader = program.Reader(self.process)
        self.url = self.wait_for_url()

    def wait_for_url(self):
        end = time.monotonic() + START_SECONDS
        while time.monotonic() < end:
            try:
                event = self.reader.next_event(STEP_SECONDS)
            except queue.Empty:
                continue
            if event is None:
                break
            if event["event"] == "view":
                return event["url"]
            if event["event"] == "error":
                self.close_process()
                raise program.ProgramError(event.get("message", ""))
        self.close_process()
        raise program.ProgramError(" ".join(self.reader.errors) or "the live view does not start")

    def update(self, depsgraph, camera):
        """Exports the scene again; the server follows its file. Returns True if the scene has changed."""
        before, self.keys = self.keys, self.export(depsgraph, camera)
        self.remove_files_without(before, self.keys)
        return before != self.keys

    def remove_files_without(self, *scenes):
        """Removes meshes and images of scenes before these."""
        text = json.dumps(scenes)
        for name in os.listdir(self.folder):
            if name.endswith((".glb", ".exr", ".png", ".jpg", ".hdr", ".tif")) and name not in text:
                os.remove(os.path.join(self.folder, name))

    def is_running(self):
        return self.process is not None and self.process.poll() is None

    def close_process(self):
        if self.process is not None:
            program.stop(self.process)
            self.process = None

    def close(self):
        self.close_process()
        shutil.rmtree(self.folder, ignore_errors=True)


_view = None
_changed_at = None


def mark_changed(*_):
    """Handler of scene changes and frame changes."""
    global _changed_at
    if _view is not None:
        _changed_at = time.monotonic()


def step():
    """Timer: updates the page once the scene is at rest for a moment."""
    global _changed_at
    if _view is None:
        return None
    if not _view.is_running():
        close_view()
        return None
    if _changed_at is not None and time.monotonic() - _changed_at > QUIET_SECONDS:
        try:
            _view.update(bpy.context.evaluated_depsgraph_get(), bpy.context.scene.camera)
        except (ExportError, program.ProgramError, OSError) as error:
            print(f"opaline: live view: {error}")
        _changed_at = None  # an evaluation during the export is no change
    return STEP_SECONDS


def close_view():
    global _view
    view, _view = _view, None
    for handlers in (bpy.app.handlers.depsgraph_update_post, bpy.app.handlers.frame_change_post):
        if mark_changed in handlers:
            handlers.remove(mark_changed)
    if bpy.app.timers.is_registered(step):
        bpy.app.timers.unregister(step)
    if view is not None:
        view.close()


class OpenLiveView(bpy.types.Operator):
    """Open the scene in the browser; the page follows changes in Blender"""

    bl_idname = "opaline.open_live_view"
    bl_label = "Open Live View"

    def execute(self, context):
        global _view
        if _view is None or not _view.is_running():
            close_view()
            view = LiveView()
            try:
                view.open(context.evaluated_depsgraph_get(), context.scene.camera)
            except (ExportError, program.ProgramError, OSError) as error:
                view.close()
                self.report({"ERROR"}, f"opaline: {error}")
                return {"CANCELLED"}
            for text in view.warnings:
                self.report({"WARNING"}, f"opaline: {text}")
            _view = view
            bpy.app.handlers.depsgraph_update_post.append(mark_changed)
            bpy.app.handlers.frame_change_post.append(mark_changed)
            bpy.app.timers.register(step, first_interval=STEP_SECONDS)
        if not bpy.app.background:
            webbrowser.open(_view.url)
        return {"FINISHED"}


class CloseLiveView(bpy.types.Operator):
    """End the live view"""

    bl_idname = "opaline.close_live_view"
    bl_label = "Close Live View"

    @classmethod
    def poll(cls, context):
        del context
        return _view is not None

    def execute(self, context):
        del context
        close_view()
        return {"FINISHED"}


CLASSES = (OpenLiveView, CloseLiveView)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister():
    close_view()
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
