# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights and cameras of USD files."""
import json
import os
import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip("pxr", reason="usd-core is not installed")

import opaline
from usd_stages import CAMERA, CUBE_POINTS, converted, keys_of, mesh, rendered, write_stage

FLOOR = mesh("Floor", [(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [(0, 1, 2, 3)],
             "color3f[] primvars:displayColor = [(1, 1, 1)]")
CENTER = (18, 24)


def light(kind, inputs="", name="Light", place=(0, 0, 2), more=""):
    return f"""
def {kind} "{name}" (prepend apiSchemas = ["ShapingAPI"])
{{
    {inputs}
    double3 xformOp:translate = {place}
    uniform token[] xformOpOrder = ["xformOp:translate"{more}]
}}
"""


@pytest.mark.parametrize("kind, inputs, expected", [
    # Irradiance at 2 below, times 1 / pi. A sphere: pi L r^2 / d^2. A spot and a point: intensity / d^2.
    ("SphereLight", "float inputs:radius = 0.2\nfloat inputs:intensity = 10\nfloat inputs:exposure = 1", 20 * 0.04 / 4),
    ("SphereLight", "float inputs:radius = 0.2\nbool inputs:normalize = 1\nfloat inputs:intensity = 30",
     30 / (4 * np.pi * 0.04) * 0.04 / 4),
    ("SphereLight", "float inputs:radius = 0.2\nfloat inputs:intensity = 10\nbool treatAsPoint = 1", 10 * 0.04 / 4),
    ("SphereLight", "float inputs:radius = 0.2\nfloat inputs:intensity = 10\nfloat inputs:shaping:cone:angle = 30",
     10 * 0.04 / 4),
    # A distant light's irradiance is its radiance times pi sin^2 of half its angle; normalized, its intensity.
    ("DistantLight", "float inputs:intensity = 100\nfloat inputs:angle = 4", 100 * np.sin(np.radians(2)) ** 2),
    ("DistantLight", "float inputs:intensity = 3\nfloat inputs:angle = 4\nbool inputs:normalize = 1", 3 / np.pi),
    # A small rectangle facing the floor: L A / d^2; within 0.1 %.
    ("RectLight", "float inputs:width = 0.1\nfloat inputs:height = 0.05\nfloat inputs:intensity = 500", 500 * 0.005 / 4 / np.pi),
    ("RectLight", "float inputs:width = 0.1\nfloat inputs:height = 0.05\nfloat inputs:intensity = 5\nbool inputs:normalize = 1",
     5 / 4 / np.pi),
    ("RectLight", "float inputs:width = 0.1\nfloat inputs:height = 0.05\nfloat inputs:intensity = 500\n"
     "float3 xformOp:scale = (-1, 1, 1)", 500 * 0.005 / 4 / np.pi),
    ("DiskLight", "float inputs:radius = 0.05\nfloat inputs:intensity = 500", 500 * np.pi * 0.0025 / 4 / np.pi),
    ("DomeLight", "float inputs:intensity = 0.7", 0.7),
])
def test_light_on_a_floor(tmp_path, kind, inputs, expected):
    """Claim: the middle of a white floor has the radiance of UsdLux's formulas, worked by hand beside each light. Tolerance: 1 %.
    Fails if: a light misses an area, a factor of pi, a unit, or faces away."""
    camera = CAMERA.replace("(0, 0, 10)", "(0, -8, 8)").replace("double3", "float xformOp:rotateX = 45\n    double3").replace(
        '["xformOp:translate"]', '["xformOp:translate", "xformOp:rotateX"]')
    more = ', "xformOp:scale"' if "scale" in inputs else ""
    path, losses = converted(tmp_path, FLOOR + camera + light(kind, inputs, more=more), head='metersPerUnit = 0.5\n    upAxis = "Z"')
    found = rendered(path, **{"settings.light_samples": 64})[CENTER]
    assert found[:3] == pytest.approx([expected] * 3, rel=.01)
    assert [line.split(" (")[0].removeprefix("not carried over: ") for line in losses] == {
        "DiskLight": ["round outlines of disk lights"]}.get(kind, ["radii of spot lights"] if "cone" in inputs else [])


def test_punctual_lights_in_a_glb(tmp_path):
    """Claim: in a GLB a point, a spot and a distant light have the light of the scene file, and a sphere that of its centre.
    Tolerance: 2e-3. Fails if: candela count millimetres."""
    for kind, inputs in (("SphereLight", "float inputs:radius = 0.2\nfloat inputs:intensity = 10\nbool treatAsPoint = 1"),
                         ("SphereLight", "float inputs:intensity = 10\nfloat inputs:radius = 0.2\n"
                          "float inputs:shaping:cone:angle = 30\nfloat inputs:shaping:cone:softness = 0.5"),
                         ("DistantLight", "float inputs:intensity = 3\nbool inputs:normalize = 1\nfloat inputs:angle = 0"),
                         ("SphereLight", "float inputs:radius = 0.2\nfloat inputs:intensity = 10")):
        camera = CAMERA.replace("(0, 0, 10)", "(0, 0, 5)")
        body = FLOOR + camera + light(kind, inputs, place=(1, 0.5, 2))
        glb, losses = converted(tmp_path, body, ".glb")
        scene, _ = converted(tmp_path, body)
        hidden = {"lights.0.visible": False} if "radius" in inputs and "cone" not in inputs and "Point" not in inputs else {}
        images = rendered(glb), rendered(scene, **hidden)
        tolerance = 2e-3 if not hidden else 2e-2
        assert np.abs(images[0] - images[1])[..., :3].max() < tolerance * images[1][..., :3].max(), (kind, inputs)
        assert bool(losses) == bool(hidden or "cone" in inputs), losses


def test_a_dome_with_an_image(tmp_path):
    """Claim: the centre of a dome's image is at +z and its left quarter at +x, y up; a turn about y by 90 degrees moves the centre
    to +x. Source: UsdLux's DomeLight, latitude and longitude as OpenEXR's. Fails if: the image is mirrored or turned."""
    ball = 'def Sphere "Ball"\n{\n    color3f[] primvars:displayColor = [(1, 1, 1)]\n}\n'

    def brightest(column, turn):
        """Direction in the image of the side of a ball that is lit by one column of the dome."""
        pixels = np.zeros((32, 64, 3), np.float32)
        pixels[14:18, column:column + 2] = 100
        opaline.image(pixels, ["R", "G", "B"]).write(str(tmp_path / "dome.exr"))
        dome = (f'def DomeLight "Dome"\n{{\n    asset inputs:texture:file = @dome.exr@\n    float xformOp:rotateY = {turn}\n'
                '    uniform token[] xformOpOrder = ["xformOp:rotateY"]\n}\n')
        path, losses = converted(tmp_path, ball + CAMERA + dome)
        assert losses == []
        image = rendered(path, **{"lights.Dome.visible": False})
        shade = np.minimum(image[..., 0], 3)  # a few pixels of the rim are noisy
        rows, columns = np.mgrid[:36, :48]
        return (shade * (columns - 23.5)).sum() / shade.sum(), (shade * (rows - 17.5)).sum() / shade.sum()

    assert np.abs(brightest(31, 0)).max() < 0.5  # from the camera
    assert brightest(15, 0)[0] > 1.5  # from +x, the right
    assert brightest(31, 90)[0] > 1.5


def test_domes_with_z_up(tmp_path):
    """Claim: on a stage with z up, DomeLight_1 and a DomeLight turned by UsdLux's orientToStageUpAxis stand upright with the centre of
    the image at -y, which becomes +z; another DomeLight lies, and is named. Source: UsdLux. Fails if: the pole is taken from the
    stage for all, or for none."""
    opaline.image(np.ones((4, 8, 3), np.float32), ["R", "G", "B"]).write(str(tmp_path / "dome.exr"))
    turned = ('float xformOp:rotateX:orientToStageUpAxis = 90\n'
              'uniform token[] xformOpOrder = ["xformOp:rotateX:orientToStageUpAxis"]')
    for kind, rest, is_upright in (("DomeLight_1", "", True), ("DomeLight", turned, True), ("DomeLight", "", False)):
        dome = f'def {kind} "Dome"\n{{\n    asset inputs:texture:file = @dome.exr@\n    {rest}\n}}\n'
        path, losses = converted(tmp_path, FLOOR + CAMERA + dome, head='metersPerUnit = 1\n    upAxis = "Z"')
        assert losses == ([] if is_upright else ["not carried over: tilts of dome lights (1, first /Dome)"])
        assert json.loads(path.read_text())["lights"][0]["rotation"] == pytest.approx(0, abs=1e-9)


def test_even_domes_and_temperatures(tmp_path):
    """Claim: domes without images add up to `surroundings`; a colour temperature tints a light as UsdLux's table. Fails if: the last
    dome wins, or the temperature counts while it is off."""
    body = FLOOR + CAMERA + light("DomeLight", "float inputs:intensity = 0.5", "A") + light(
        "DomeLight", "color3f inputs:color = (1, 0, 0)", "B")
    assert keys_of(tmp_path, body)["surroundings"] == pytest.approx([1.5, .5, .5])
    warm = "float inputs:colorTemperature = 3000\nbool inputs:enableColorTemperature = {}\nfloat inputs:radius = 1"
    for is_used, expected in ((1, [1.7710284, 0.84429353, 0.27203175]), (0, [1, 1, 1])):
        keys = keys_of(tmp_path, FLOOR + CAMERA + light("SphereLight", warm.format(is_used)))
        assert keys["lights"][0]["radiance"] == pytest.approx(expected)


def test_a_camera(tmp_path):
    """Claim: focal length, apertures, offsets, f-stop and focus have USD's units: tenths of a stage unit. By hand: 24 / 50 wide at
    a distance of 1; the lens is 5 / 2 units / 10. Fails if: the angle is that of the width, or the lens is in mm."""
    body = mesh() + """
def Camera "A"
{
    float focalLength = 50
    float horizontalAperture = 24
    float verticalAperture = 12
    float horizontalApertureOffset = 6
    float fStop = 2
    float focusDistance = 8
    double3 xformOp:translate = (0, 0, 8)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
def Camera "B"
{
    token projection = "orthographic"
    float horizontalAperture = 60
    float verticalAperture = 60
    double3 xformOp:translate = (0, 0, 8)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
"""
    keys = keys_of(tmp_path, body)
    camera, film = keys["camera"], keys["film"]
    assert camera["field_of_view"] == pytest.approx(np.degrees(2 * np.arctan(6 / 50))) and film["resolution"] == [512, 256]
    assert camera["shift"] == [0.25, 0] and camera["look_at"] == pytest.approx([0, 0, 0])
    assert (camera["aperture"], camera["focus_distance"]) == pytest.approx((2.5, 8))
    path, losses = converted(tmp_path, body, camera="/B")
    assert losses == ["not carried over: other cameras (1, first /A)"]
    image = rendered(path, **{"film.resolution": [60, 60], "film.samples_per_pixel": 16})
    assert image[..., 3].sum() == pytest.approx(20 * 20, rel=.01)  # an edge of 2 in a view of 6
    with pytest.raises(Exception, match="/C: is no visible camera, expected /A, /B"):
        converted(tmp_path, body, camera="/C")
    settings = """
def Scope "Render"
{
    def RenderSettings "Main"
    {
        int2 resolution = (300, 100)
        rel camera = </B>
    }
}
"""
    keys = keys_of(tmp_path, body + settings, head='metersPerUnit = 1\n    upAxis = "Y"\n    renderSettingsPrimPath = "/Render/Main"')
    assert keys["film"]["resolution"] == [300, 100] and keys["camera"]["orthographic_height"] == pytest.approx(6)


@pytest.mark.parametrize("camera", ["", CAMERA])
def test_a_lone_mesh(tmp_path, camera):
    """Claim: a stage without lights has the camera, the lights and the grey backdrop of an asset without, as the program adds
    them to the GLB. Tolerance: in a GLB, every opaque surface is glossy, here of weight 0, by tables. Fails if: a light is
    elsewhere or of another brightness, or the image is black or cut off."""
    body = mesh(points=[(x + .5, y, z) for x, y, z in CUBE_POINTS]) + camera
    images = []
    for ending in (".json", ".glb"):
        path, losses = converted(tmp_path, body, ending)
        assert losses == []
        images.append(rendered(path))
    assert np.abs(images[0] - images[1]).max() < 2e-3
    edge = np.concatenate([images[0][0], images[0][-1], images[0][:, 0], images[0][:, -1]])
    assert edge[:, 3].max() == 0 and images[0][..., :3].max() > 2 * edge[0, 0] > 0


def test_the_command(tmp_path):
    """Claim: opaline-usd writes the file, prints losses, and the program renders it without a word; a mistake is one line and exit
    code 2, also without usd-core. Fails if: the command needs another name, writes to the wrong stream, or imports too early."""
    source = write_stage(tmp_path / "stage.usda", FLOOR + CAMERA + light("SphereLight", "float inputs:intensity = 9", place=(0, 0, 7)))
    command = [sys.executable, "-m", "opaline.usd", source, "-o", tmp_path / "a.glb"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == ["not carried over: sizes of lights and their soft shadows, except in a .json scene "
                                        "(1, first /Light)", f"wrote {tmp_path / 'a.glb'}"]
    program = [os.environ["OPALINE_PROGRAM"], "render", tmp_path / "a.glb", "-o", tmp_path / "a.exr", "--quiet",
               "--set", "film.resolution=[16,16]"]
    render = subprocess.run(program, capture_output=True, text=True)
    assert (render.returncode, render.stdout, render.stderr) == (0, "", "")
    without = subprocess.run([sys.executable, "-c", "import sys; sys.modules['pxr'] = None; from opaline.usd.__main__ import main; "
                              "sys.exit(main())", *command[3:]], capture_output=True, text=True)
    assert (without.returncode, without.stdout) == (2, "")
    assert without.stderr == "opaline-usd: needs usd-core: pip install usd-core\n"
    wrong = subprocess.run([*command[:3], tmp_path / "none.usd", "-o", tmp_path / "b.glb"], capture_output=True, text=True)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr == f"opaline-usd: {tmp_path / 'none.usd'}: no such file\n"
