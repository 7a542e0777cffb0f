# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package: scenes from files, dicts and arrays, images as arrays, edits, errors, interruption."""
import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import opaline

BALL = {
    "media": {"stone": {"preset": "marble"}},
    "shapes": [{"name": "ball", "sphere": {"radius": 10}, "medium": "stone"}],
    "lights": [{"name": "key", "type": "point", "position": [20, 30, 40], "intensity": 1000}],
    "camera": {"position": [0, 0, 50]},
    "film": {"resolution": [32, 24], "pixel_type": "float"},
    "settings": {"method": "hierarchical", "samples": 500},
}


def octahedron(size=10.0):
    positions = size * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    triangles = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    return positions, triangles


def test_layers_share_the_image():
    """Claim: layers are views of one array, with the shapes that their docstrings name. Fails if: a layer is a copy."""
    image = opaline.render(BALL)
    assert (image.width, image.height) == (32, 24)
    assert image.color.shape == (24, 32, 3) and image["Z"].shape == (24, 32)
    assert image.array.shape == (24, 32, len(image.channels))
    assert image.color[12, 16].min() > 0 and image["A"][0, 0] == 0
    image["diffuse"][0, 0] = 7
    assert image.array[0, 0, image.channels.index("diffuse.G")] == 7
    view = image["diffuse"]
    del image
    assert view[0, 0, 0] == 7  # the view keeps the image alive
    with pytest.raises(KeyError, match="no layer 'depth'"):
        opaline.render(BALL)["depth"]


def test_same_values_as_the_program(tmp_path):
    """Claim: the image of a session has the values that the program writes for the same scene. Source: one library.
    Fails if: overrides or the frame are taken otherwise."""
    program = os.environ["OPALINE_PROGRAM"]
    scene = tmp_path / "ball.json"
    scene.write_text(json.dumps(BALL))
    subprocess.run([program, "render", scene, "-o", tmp_path / "a.exr", "--set", "lights.key.intensity=[1,2,3]", "--quiet"],
                   check=True)
    image = opaline.render(scene, {"lights.key.intensity": [1, 2, 3]})
    assert np.array_equal(opaline.read_image(str(tmp_path / "a.exr")).color, image.color)
    image.write(str(tmp_path / "b.exr"), half=False)
    assert np.array_equal(opaline.read_image(str(tmp_path / "b.exr"))["diffuse"], image["diffuse"])
    image.write(str(tmp_path / "b.png"), exposure=10, view="srgb")
    shown = opaline.read_image(str(tmp_path / "b.png")).color
    assert shown == pytest.approx(np.clip(1024 * image.color, 0, 1), abs=.01)


def test_edits_reuse_and_accumulate():
    """Claim: edits add up, and the image after them is that of a new session. Fails if: an edit forgets the last one."""
    session = opaline.Session(BALL)
    session.render()
    assert 0 < session.estimated_error < .2
    session.set({"lights.key.intensity": 500})
    session.set({"camera.position": [10, 0, 50]})
    edited = session.render()
    assert any("reused" in line or "kept" in line for line in session.decisions), session.decisions
    anew = opaline.render(BALL, {"lights.key.intensity": 500, "camera.position": [10, 0, 50]})
    assert np.array_equal(edited.array, anew.array)
    assert opaline.compare(edited, anew)["max"] == 0 and opaline.compare(edited, anew)["flip"] == 0
    plan = session.plan()
    assert plan["bodies"][0]["method"] == "hierarchical" and plan["bodies"][0]["area_mm2"] == pytest.approx(1257, rel=.001)
    assert plan["memory_bytes"] > 5e7


def test_arrays_in_place_of_files():
    """Claim: a mesh, texture and environment of arrays render as those of files. By hand: a flat texture of .3 and an even
    environment of 2 give a white furnace of .6 on an octahedron seen by lambert. Tolerance: noise. Fails if: triangles or texels are
    permuted, or equal arrays make new files."""
    positions, triangles = octahedron()
    scene = {
        "shapes": [{"name": "gem", "mesh": (positions, triangles), "reflectance": .3}],
        "lights": [{"name": "room", "type": "environment", "file": np.full((8, 16, 3), 2.0)}],
        "camera": {"position": [5, 8, 40]},
        "film": {"resolution": [24, 24]},
        "settings": {"method": "lambert"},
    }
    session = opaline.Session(scene)
    image = session.render()
    assert image.color[image["A"] == 1].mean(axis=0) == pytest.approx([.6] * 3, rel=.01)
    session.set({"shapes.gem.file": str(session._file(".ply", [positions, triangles], None))})
    assert np.array_equal(session.render().array, image.array)
    before = set(os.listdir(session._folder.name))
    session.edit(scene | {"shapes": [{"name": "gem", "mesh": (2 * positions, triangles)}]})
    assert len(set(os.listdir(session._folder.name)) - before) == 1 and len(os.listdir(session._folder.name)) == 2
    with pytest.raises(ValueError, match="triangles name positions 0 to 5"):
        opaline.write_ply("unused.ply", positions, np.array([[0, 1, 6]]))


def test_exitance_at_points():
    """Claim: the exitance at points of a sphere is that of the image there, over pi. Tolerance: 2 %, for pixels have an extent."""
    session = opaline.Session(BALL, {"media.stone.specular_ior": 1.0})
    values = session.radiant_exitance(0, np.array([[0, 0, 10.0]]), np.array([[0, 0, 1.0]]))
    assert values.shape == (1, 3)
    center = session.render()["diffuse"][11:13, 15:17].mean(axis=(0, 1))
    assert values[0] / np.pi == pytest.approx(center, rel=.02)


def test_errors_name_their_place(tmp_path):
    """Claim: bad input has its file, line, column, expectation and value, and the session keeps its scene. Source: error.h."""
    broken = tmp_path / "broken.json"
    broken.write_text('{"film":\n {"samples_per_pixel": 0}}')
    session = opaline.Session(BALL)
    with pytest.raises(opaline.BadInput) as caught:
        session.edit(broken)
    error = caught.value
    assert (error.file, error.line, error.column) == (str(broken), 2, 24)
    assert "1 to 65536" in error.expected and error.got == "0"
    assert isinstance(error, opaline.Error) and str(broken) in str(error)
    session.set({"film.resolution": [8, 8]})
    assert session.render().width == 8
    with pytest.raises(opaline.BadInput, match="did you mean 'ball'"):
        session.set({"shapes.bal.medium": "stone"})
    with pytest.raises(opaline.RunFailed):
        session.render().write("/nowhere/a.exr")
    for call in ("render", "plan"):
        with pytest.raises(ValueError, match="no scene yet"):
            getattr(opaline.Session(), call)()
    with pytest.raises(ValueError, match="no scene yet"):
        opaline.Session().radiant_exitance(0, np.zeros((1, 3)), np.zeros((1, 3)))
    with pytest.raises(ValueError, match=".exr or .png"):
        session.render().write(str(tmp_path / "a.jpg"))


def test_other_threads_go_on_and_ctrl_c_ends():
    """Claim: a render holds no lock of Python, and SIGINT ends it within a second; the session works afterwards. Fails if: the signal
    waits for the image."""
    session = opaline.Session(BALL, {"film.resolution": [512, 512], "settings.method": "direct",
                                     "settings.until_error": .0001})
    ticks = []

    def interrupt():
        for _ in range(20):
            time.sleep(.02)
            ticks.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
        ticks.append(time.monotonic())

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        session.render()
    assert time.monotonic() - ticks[-1] < 2
    assert len(ticks) == 21
    thread.join()
    session.set({"film.resolution": [8, 8], "settings.method": "lambert", "settings.until_error": .5})
    assert session.render().width == 8


def test_one_thread_at_a_time():
    """Claim: a session that renders in another thread refuses to be used, and works afterwards. Fails if: both go on, and crash."""
    session = opaline.Session(BALL, {"film.resolution": [128, 128], "settings.method": "direct"})
    thread = threading.Thread(target=session.render)
    thread.start()
    time.sleep(.2)
    with pytest.raises(RuntimeError, match="in use by another thread"):
        session.set({"lights.key.intensity": 5})
    thread.join()
    session.set({"film.resolution": [8, 8], "settings.method": "lambert"})
    assert session.render().width == 8


def test_arrays_as_images():
    """Claim: an image of an array has its values, and compare gives errors of hand: 10 % everywhere."""
    ones = np.ones((4, 5, 3), np.float32)
    reference, brighter = opaline.image(ones, ["R", "G", "B"]), opaline.image(1.1 * ones, ["R", "G", "B"])
    result = opaline.compare(brighter, reference)
    assert result["mean"] == pytest.approx(.1, rel=1e-5) and result["signed"] > 0
    assert set(result["channels"]) == {"R", "G", "B"}
    assert "marble" in opaline.presets()
    with pytest.raises(ValueError):
        opaline.image(ones, ["R"])
    for channels in (["B", "G", "R"], ["R", "G", "Z"]):
        with pytest.raises(KeyError):
            opaline.image(ones, channels).color
