# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine as a program: animation, cancel, errors, the live view, the extension."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import bpy
import numpy as np

from blender_scenes import (PROGRAM, ROOT, Rendered, add_light, add_sphere, by_opaline, new_scene,
                            prepare_output, principled)
import web_socket
from blender import live_view, program, properties, scene_export


def small_scene(**inputs):
    scene = new_scene(48, 36)
    add_sphere(principled("grey", **inputs), radius=0.7)
    add_light("POINT", 300)
    scene.opaline.samples = 4
    scene.render.engine = "OPALINE"
    return scene


class Animation(unittest.TestCase):
    def test_frames(self):
        # Claim: each frame has the scene at its time. Fails if all frames export the same state.
        scene = small_scene()
        ball = bpy.data.objects["ball"]
        for frame, x in ((1, -0.8), (2, 0.8)):
            ball.location.x = x
            ball.keyframe_insert("location", frame=frame)
        scene.frame_start, scene.frame_end = 1, 2
        with tempfile.TemporaryDirectory() as folder:
            prepare_output(scene, folder)
            scene.render.filepath = os.path.join(folder, "f")
            bpy.ops.render.render(animation=True)
            images = [Rendered(os.path.join(folder, f"f000{frame}.exr")) for frame in (1, 2)]
        columns = [(image.alpha.sum(axis=0) * np.arange(48)).sum() / image.alpha.sum() for image in images]
        self.assertGreater(columns[1] - columns[0], 10)
        scene.frame_set(2)
        self.assertEqual(np.abs(by_opaline(scene).color - images[1].color).max(), 0)


class Cancel(unittest.TestCase):
    def test_cancelled_render(self):
        # Claim: cancel ends a long render within seconds. Fails if the program is left running.
        scene = small_scene(Subsurface_Weight=1, Subsurface_Scale=4, Subsurface_Radius=(1, 1, 1))
        scene.opaline.method, scene.opaline.until_error = "volume", 0.01
        processes, start_program, run_program = [], program.start, program.run
        start = time.monotonic()

        def remember(words):
            processes.append(start_program(words))
            return processes[-1]

        def run(words, is_cancelled, on_progress, on_warning):
            self.assertFalse(is_cancelled())
            return run_program(words, lambda: time.monotonic() - start > 1, on_progress, on_warning)

        program.start, program.run = remember, run
        try:
            bpy.ops.render.render()
        finally:
            program.start, program.run = start_program, run_program
        self.assertLess(time.monotonic() - start, 12)
        self.assertEqual([process.poll() is None for process in processes], [False])

    def test_progress(self):
        # Claim: progress rises to the end. Fails if events are not read.
        scene = small_scene()
        with tempfile.TemporaryDirectory() as folder:
            path, _, _ = scene_export.export_scene(bpy.context.evaluated_depsgraph_get(), folder, scene.camera)
            seen = []
            done = program.run([PROGRAM, "render", path, "-o", os.path.join(folder, "a.exr"), "--log", "json"],
                               lambda: False, lambda fraction, text: seen.append((fraction, text)), lambda text: None)
        self.assertEqual(seen, sorted(seen, key=lambda each: each[0]))
        self.assertGreater(seen[-1][0], 0.8)
        self.assertEqual(done["event"], "done")


class Settings(unittest.TestCase):
    def test_methods_and_qualities(self):
        # Claim: each method and quality renders with all passes. Fails if a method without a pass is asked for it.
        scene = small_scene(Subsurface_Weight=1, Subsurface_Scale=4, Subsurface_Radius=(1, 1, 1))
        scene.render.resolution_percentage = 50
        scene.opaline.until_error = 30
        layer = scene.view_layers[0]
        layer.use_pass_z = layer.use_pass_diffuse_color = layer.use_pass_cryptomatte_object = True
        for name in ("parts", "error", "lights"):
            setattr(layer.opaline, f"use_pass_{name}", True)
        choices = [(method, "SETTINGS") for method, _, _ in properties.METHODS if method != "direct"]
        for method, quality in [*choices, ("auto", "TARGET_ERROR"), ("auto", "TIME_BUDGET")]:
            with self.subTest(method=method, quality=quality):
                scene.opaline.method, scene.opaline.quality = method, quality
                scene.opaline.target_error, scene.opaline.time_budget = 20, 1
                scene.opaline.use_cache = quality == "SETTINGS"
                image = by_opaline(scene)
                self.assertEqual(image.alpha.shape, (18, 24))
                self.assertGreater(image.color[9, 12].min(), 0)


class Errors(unittest.TestCase):
    def failure(self):
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.render.render()
        return str(caught.exception)

    def test_missing_program(self):
        small_scene()
        properties.DefaultPreferences.program = "/nowhere/opaline"
        try:
            self.assertIn("'/nowhere/opaline' is no program", self.failure())
        finally:
            properties.DefaultPreferences.program = PROGRAM

    def test_message_of_program(self):
        # Claim: the program's own message is shown. Fails if only its exit code is read.
        small_scene()
        bpy.data.materials["grey"].opaline.medium = "marbel"
        self.assertIn("did you mean 'marble'", self.failure())

    def test_no_surface(self):
        small_scene()
        bpy.data.objects.remove(bpy.data.objects["ball"])
        self.assertIn("no surface", self.failure())

    def test_panorama(self):
        scene = small_scene()
        scene.camera.data.type = "PANO"
        self.assertIn("perspective", self.failure())


class LiveView(unittest.TestCase):
    def setUp(self):
        self.scene = small_scene()
        self.view = live_view.LiveView()
        self.addCleanup(self.view.close)
        self.view.open(bpy.context.evaluated_depsgraph_get(), self.scene.camera)

    def update(self):
        return self.view.update(bpy.context.evaluated_depsgraph_get(), self.scene.camera)

    def served(self, is_expected):
        """The scene of the server, once it is as expected."""
        with web_socket.WebSocket(self.view.url, 10) as connection:
            while True:
                message = connection.receive()
                if message["is"] == "scene" and is_expected(message["scene"]):
                    return message["scene"]

    def test_steps(self):
        # Claim: the server has the scene of Blender after each change, of numbers and of meshes. Fails if a change is missed.
        self.assertFalse(self.update())
        bpy.data.objects["key"].data.energy = 600
        bpy.data.objects["ball"].location.x = 0.5
        self.scene.camera.location.z = 2
        self.assertTrue(self.update())
        served = self.served(lambda scene: scene["camera"]["position"][1] == 2)
        self.assertAlmostEqual(served["lights"][0]["intensity"][0], 600 / (4 * np.pi) * 1e6, delta=100)
        self.assertAlmostEqual(served["shapes"][0]["transform"][0]["matrix"][0][3], 0.5)
        file = served["shapes"][0]["file"]
        bpy.data.objects["ball"].data.vertices[0].co.z += 0.2
        bpy.data.objects["ball"].data.update()
        self.assertTrue(self.update())
        served = self.served(lambda scene: scene["shapes"][0]["file"] != file)
        self.assertEqual(served["shapes"][0]["file"], self.view.keys["shapes"][0]["file"])

    def test_operator(self):
        # Claim: a change of the scene reaches the page through the timer. Fails without the handler.
        self.assertEqual(bpy.ops.opaline.open_live_view(), {"FINISHED"})
        self.addCleanup(live_view.close_view)
        view = live_view._view
        bpy.data.objects["key"].data.energy = 450
        bpy.context.view_layer.update()
        time.sleep(2 * live_view.QUIET_SECONDS)
        live_view.step()
        self.assertAlmostEqual(view.keys["lights"][0]["intensity"][0], 450 / (4 * np.pi) * 1e6, delta=100)
        process = view.process
        self.assertEqual(bpy.ops.opaline.close_live_view(), {"FINISHED"})
        self.assertIsNotNone(process.poll())


class Panels(unittest.TestCase):
    def test_borrowed_panels(self):
        # Claim: Blender's panels of lights, camera and output apply to the engine. Fails without compatible_panels.
        from bl_ui import properties_data_camera, properties_data_light, properties_output
        for panel in (properties_data_camera.DATA_PT_lens, properties_data_light.DATA_PT_EEVEE_light,
                      properties_output.RENDER_PT_format):
            self.assertIn("OPALINE", panel.COMPAT_ENGINES)

    def test_presets(self):
        # Claim: the measured media are those of the program.
        self.assertIn("skin1", program.presets(PROGRAM))
        self.assertEqual(program.presets("/nowhere"), program.PRESETS)
        self.assertEqual(set(program.presets(PROGRAM)), set(program.PRESETS))


class Extension(unittest.TestCase):
    def test_package(self):
        # Claim: the package has all modules and enables as an add-on. Fails if a module is
        # missing from the list in CMakeLists.txt, or imports the folder by name.
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "opaline_copy"
            names = sorted(path.name for path in (ROOT / "src/blender").glob("*.py"))
            listed = (ROOT / "src/blender/CMakeLists.txt").read_text()
            for name in names:
                self.assertIn(name, listed)
            package.mkdir()
            for name in names:
                shutil.copy(ROOT / "src/blender" / name, package)
            code = (f"import sys; sys.path.insert(0, {folder!r}); sys.dont_write_bytecode = True; import bpy, os\n"
                    "import addon_utils\n"
                    "module = addon_utils.enable('opaline_copy')\n"
                    "assert 'OPALINE' in [getattr(e, 'bl_idname', '') for e in bpy.types.RenderEngine.__subclasses__()]\n"
                    "addon_utils.disable('opaline_copy')\n"
                    "print('enabled', flush=True); os._exit(0)\n")
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertIn("enabled", done.stdout, done.stderr)


if __name__ == "__main__":
    unittest.main()
