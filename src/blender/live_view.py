# SPDX-License-Identifier: GPL-3.0-or-later
"""The live view: a page in the browser in step with the scene.

Changed numbers and colours of the exported scene are sent to the running server. Other changes, such as those of meshes or
images, restart it at the same URL, and the page reconnects.
"""

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
from .web_socket import WebSocket

STEP_SECONDS = 0.1
QUIET_SECONDS = 0.15  # without another change of the scene
START_SECONDS = 60
ANSWER_SECONDS = 5
LONGEST_MESSAGE = 60000  # bytes; the server accepts 64 kB
FILE_KEYS = {"file", "part", "texture", "name", "medium", "group"}


class StructureChange(Exception):
    """The scenes differ in more than values."""


def path_step(key):
    return f'"{key}"' if isinstance(key, str) and "." in key else str(key)


def changed_values(old, new, path=()):
    """Changed values as {path: value}, with paths as in --set. Raises StructureChange."""
    if isinstance(old, dict) and isinstance(new, dict):
        if old.keys() != new.keys():
            raise StructureChange
        pairs = [(key, old[key], new[key]) for key in new]
    elif isinstance(old, list) and isinstance(new, list) and any(isinstance(part, dict) for part in old + new):
        if len(old) != len(new):
            raise StructureChange
        pairs = list(zip(range(len(new)), old, new))
    elif old == new:
        return {}
    elif type(old) is not type(new) and not all(isinstance(part, (int, float)) for part in (old, new)):
        raise StructureChange
    elif path[-1] in FILE_KEYS:
        raise StructureChange
    else:
        return {".".join(path_step(key) for key in path): new}
    changes = {}
    for key, before, after in pairs:
        changes |= changed_values(before, after, (*path, key))
    return changes


class LiveView:
    """A server of the program, and the scene it shows."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="opaline_view_", dir=bpy.app.tempdir or None)
        self.token = secrets.token_urlsafe(24)
        self.process, self.url, self.keys, self.warnings = None, "", None, []
        self.starts = 0

    def export(self, depsgraph, camera):
        self.path, keys, self.warnings = export_scene(depsgraph, self.folder, camera)
        return keys

    def open(self, depsgraph, camera):
        """Exports the scene and starts the server. Raises ExportError or ProgramError."""
        self.keys = self.export(depsgraph, camera)
        self.start(port=0)

    def start(self, port):
        words = [program.find_program(preferences().program), "view", self.path, "--no-open", "--log", "json",
                 "--token", self.token]
        if port:
            words += ["--port", str(port)]
        self.process = program.start(words)
        self.reader = program.Reader(self.process)
        self.url = self.wait_for_url()
        self.starts += 1

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
        """Brings the page in step. Returns "same", "sent" or "restarted"."""
        keys = self.export(depsgraph, camera)
        try:
            changes = changed_values(self.keys, keys)
        except StructureChange:
            changes = None
        self.keys = keys
        if changes == {}:
            return "same"
        if changes is not None and self.send(changes):
            return "sent"
        self.restart()
        return "restarted"

    def send(self, values):
        """Sends values as one edit; False if the server does not accept them."""
        message = {"do": "set", "values": values, "stroke": 0}
        if len(json.dumps(message)) > LONGEST_MESSAGE:
            return False
        try:
            with WebSocket(self.url, ANSWER_SECONDS) as connection:
                revision = next_of(connection, "scene")["revision"]
                connection.send(message)
                while True:
                    answer = connection.receive()
                    if answer["is"] == "told" and not answer["good"]:
                        return False
                    if answer["is"] == "scene" and answer["revision"] > revision:
                        return True
        except (OSError, ValueError, KeyError):
            return False

    def restart(self):
        """Starts another server at the same URL. Edits made in the page are dropped: Blender has the scene."""
        try:
            with WebSocket(self.url, ANSWER_SECONDS) as connection:
                if next_of(connection, "scene")["edits"]:
                    connection.send({"do": "reset"})
                    next_of(connection, "scene")
        except (OSError, ValueError, KeyError):
            pass
        port = int(self.url.split(":")[2].split("/")[0])
        self.close_process()
        self.start(port)
        self.remove_unused_files()

    def remove_unused_files(self):
        """Removes meshes and images of earlier states."""
        text = json.dumps(self.keys)
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


def next_of(connection, kind):
    """The next message of a kind."""
    while True:
        message = connection.receive()
        if message["is"] == kind:
            return message


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
