# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes, Cryptomatte and light groups."""

import json
import unittest

import numpy as np

from blender_scenes import (add_floor, add_light, add_sphere, by_cycles, by_opaline, interior, new_scene, principled,
                            set_world)
from blender.passes import ALBEDO_PASS


class Passes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = scene = new_scene()
        translucent = principled("wax.001", Subsurface_Weight=1, Subsurface_Scale=4, Subsurface_Radius=(1, 1, 1))
        add_sphere(translucent, name="ball.é")
        add_floor(principled("brown", (0.5, 0.3, 0.2)))
        add_light("AREA", 200, size=1, name="key.001")
        add_light("POINT", 100, location=(-2, -2, 1), name="fill")
        set_world((0.1, 0.1, 0.2))
        scene.opaline.samples = 4
        layer = scene.view_layers[0]
        for name in ("z", "normal", "position", "diffuse_color", "cryptomatte_object", "cryptomatte_material"):
            setattr(layer, f"use_pass_{name}", True)
        for name in ("parts", "error", "lights"):
            setattr(layer.opaline, f"use_pass_{name}", True)
        cls.ours = by_opaline(scene)
        cls.theirs = by_cycles(scene, 8)
        cls.pixels = interior(cls.ours, cls.theirs)

    def difference(self, name, parts):
        return np.abs(self.ours.layer(name, parts) - self.theirs.layer(name, parts))[self.pixels]

    def test_geometry(self):
        # Claim: depth, normals and positions are those of Cycles, in Blender's axes and units. Tolerance: half a pixel on the
        # floor, as Cycles' passes are a single ray of each pixel; a distance in place of a depth is 0.08 more. Fails if the depth
        # is a distance or in mm, or if axes are exchanged.
        for name, parts, most in (("Depth", "Z", 0.02), ("Normal", "XYZ", 0.005), ("Position", "XYZ", 0.02)):
            with self.subTest(name=name):
                difference = (self.ours.layer(name, parts) - self.theirs.layer(name, parts))[self.pixels]
                self.assertLess(np.median(np.abs(difference)), most)
                self.assertLess(np.abs(np.median(difference, axis=0)).max(), most)
        empty = self.ours.alpha == 0
        self.assertTrue((self.ours.channels["Depth.Z"][empty] == 1e10).all())

    def test_albedo(self):
        self.assertLess(np.median(self.difference(ALBEDO_PASS, "RGB")), 0.01)

    def test_light_groups(self):
        # Claim: the passes of all lights sum to the image. Fails if a light is missing.
        names = {name.split(".R")[0] for name in self.ours.channels if name.startswith("Light ") and name.endswith(".R")}
        self.assertEqual(names, {"Light key.001", "Light fill", "Light surroundings"})
        total = sum(self.ours.layer(name) for name in names)
        covered = self.ours.alpha == 1
        self.assertLess(np.abs(total - self.ours.color)[covered].max(), 1e-4 * self.ours.color.max())

    def test_emitting_surface(self):
        # Claim: an emitting surface has a light pass. Fails if it is not among the lights.
        scene = new_scene(32, 24)
        add_floor(principled("brown"))
        add_sphere(principled("lamp", Emission_Strength=2), radius=0.3, name="lamp")
        scene.view_layers[0].opaline.use_pass_lights = True
        image = by_opaline(scene)
        np.testing.assert_allclose(image.layer("Light lamp"), image.color, atol=1e-4)
        self.assertGreater(image.color.max(), 1.9)

    def test_parts(self):
        total = self.ours.layer("Diffuse") + self.ours.layer("Specular")
        covered = self.ours.alpha == 1
        self.assertLess(np.abs(total - self.ours.color)[covered].max(), 1e-4 * self.ours.color.max())

    def test_error(self):
        # Claim: the error is positive on the translucent ball. Fails if the pass is empty.
        middle = self.ours.layer("Error")[24, 32]
        self.assertTrue((middle > 0).all() and (middle < 0.2 * self.ours.color[24, 32]).all())

    def test_mattes(self):
        # Claim: the compositor finds objects by the attributes and ids of Cycles, and a matte covers the object as
        # in Cycles within 1 %. Fails if a name or a hash differs.
        for kind, name in (("CryptoObject", "ball.é"), ("CryptoMaterial", "wax.001")):
            with self.subTest(kind=kind):
                key = next(field.rsplit("/", 1)[0] for field, value in self.theirs.texts.items()
                           if value == f"ViewLayer.{kind}")
                ours = json.loads(self.ours.texts[key + "/manifest"])
                theirs = json.loads(self.theirs.texts[key + "/manifest"])
                self.assertEqual(ours[name], theirs[name])
                self.assertEqual(self.ours.texts[key + "/conversion"], self.theirs.texts[key + "/conversion"])
                mattes = [self.matte(image, kind, ours[name]) for image in (self.ours, self.theirs)]
                area = mattes[1].sum()
                self.assertGreater(area, 100)
                self.assertLess(abs(mattes[0].sum() / area - 1), 0.01)

    def matte(self, image, kind, identity):
        """Coverage of an id, by its ranks."""
        wanted = np.array([int(identity, 16)], np.uint32).view(np.float32)[0]
        total = 0
        for level in range(3):
            for part, weight in ("RG", "BA"):
                ids = image.channels[f"{kind}{level:02d}.{part}"].astype(np.float32)
                total = total + np.where(ids == wanted, image.channels[f"{kind}{level:02d}.{weight}"], 0)
        return total


if __name__ == "__main__":
    unittest.main()
