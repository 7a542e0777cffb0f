# SPDX-License-Identifier: GPL-3.0-or-later
"""The laboratory as a function: the numbers of `opaline profile`."""
import csv
import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import opaline

SKIN = {
    "media": {
        "epidermis": {"sigma_a": 0.8, "sigma_s_prime": 4, "specular_ior": 1.4},
        "dermis": {"sigma_a": [0.2, 0.3, 0.4], "sigma_s_prime": 2},
        "skin": {"layers": [{"medium": "epidermis", "thickness": 0.1}, {"medium": "dermis"}]},
    },
    "shapes": [{"sphere": {"radius": 9}, "medium": "skin"}],
    "lights": [],
}


def run(*arguments):
    result = subprocess.run([os.environ["OPALINE_PROGRAM"], "profile", *map(str, arguments)], check=True, capture_output=True,
                            text=True)
    return result.stdout


def table(path):
    """Rows of a CSV file of a report by channel and face, as columns by name."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return lambda channel, face: {name: [row[name] for row in rows if (row["channel"], row["face"]) == (channel, face)]
                                  for name in rows[0]}


def test_same_digits_as_the_program(tmp_path):
    """Claim: a plate of skin has the totals that the program prints, to the last bit, and the rings of its table. Source: one
    library. Tolerance: the table's eight digits. Fails if: a channel, face, seed or thickness is taken otherwise, or a ring's
    mean is its value in the middle."""
    result = opaline.profile("skin1", thickness=2, walks=2000, seed=7)
    run("skin1", "--thickness", "2mm", "--walks", 2000, "--seed", 7, "-o", tmp_path)
    printed = json.loads(run("skin1", "--thickness", "2mm", "--walks", 2000, "--seed", 7, "--json").splitlines()[-1])
    rings = table(tmp_path / "profile.csv")
    assert list(result["channels"]) == ["R", "G", "B"] and result["thickness"] == 2
    for name, channel in result["channels"].items():
        assert channel["walks"] == printed["channels"][name]["walks"] == 2048
        for face in ("back", "through"):
            ours, theirs = channel[face], printed["channels"][name][face]
            for entry in ("walks_diffuse", "walks_normal"):
                assert (ours[entry]["share"], ours[entry]["share_error"]) == (theirs[entry]["share"], theirs[entry]["error"])
            columns = rings(name, face)
            assert np.allclose(ours["r"][1:], np.array(columns["r_high"], float), rtol=1e-7) and ours["r"][0] == 0
            for entry in ("diffuse", "normal"):
                for key in ("profile", "profile_error", "within", "within_error"):
                    expected = np.array(columns[f"{entry}_{key}"], float)
                    assert np.allclose(ours[f"walks_{entry}"][key], expected, rtol=1e-7, atol=0), (name, face, entry, key)
            for model, values in ours["models"].items():
                assert values["share"] == theirs[model]["share"]
                assert values["shape_difference"] == theirs[model]["shape_difference"]
                for key in ("profile", "within"):
                    assert np.allclose(values[key], np.array(columns[f"{model}_{key}"], float), rtol=1e-7, atol=0)


def test_shapes_of_arrays():
    """Claim: arrays have the shapes of the docstring, and the fractions of an angular distribution have a mean of 1 weighted by
    cosine. Fails if: ends and intervals are mixed up."""
    channel = opaline.profile({"sigma_a": 0.1, "sigma_s": 0.9}, walks=2000)["channels"]["all"]
    back = channel["back"]
    count = len(back["r"]) - 1
    assert count == 60 or count > 30
    assert all(back["walks_normal"][key].shape == (count,) for key in ("profile", "profile_error", "within"))
    assert all(model[key].shape == (count,) for model in back["models"].values() for key in ("profile", "within"))
    assert np.all(np.diff(back["r"]) > 0) and "through" not in channel
    cosines = back["walks_diffuse"]["cosine"]
    weights = np.diff(cosines**2)
    assert weights @ back["walks_diffuse"]["angular_exit"] == pytest.approx(1, abs=1e-6)
    assert channel["albedo_by_entry"].shape == (len(channel["cosine"]) - 1,)


def test_radial_profiles_alone():
    """Claim: without walks the models are those beside walks, at once. Fails if: they use other rings, or walks run."""
    start = time.monotonic()
    alone = opaline.profile("marble", walks=0)["channels"]["G"]
    assert time.monotonic() - start < 2
    beside = opaline.profile("marble", walks=600)["channels"]["G"]
    assert alone["walks"] == 0 and "walks_diffuse" not in alone["back"] and "unfinished" not in alone
    assert np.array_equal(alone["back"]["r"], beside["back"]["r"])
    for name, model in alone["back"]["models"].items():
        assert np.array_equal(model["profile"], beside["back"]["models"][name]["profile"])
        assert "shape_difference" not in model
    dipole = alone["back"]["models"]["dipole"]
    areas = np.pi * np.diff(alone["back"]["r"] ** 2)
    assert np.cumsum(areas * dipole["profile"]) == pytest.approx(dipole["within"], rel=1e-9)


def test_layers_of_a_scene(tmp_path):
    """Claim: a layered medium of a dict is that of the same file. Fails if: the dict is read as another scene, or layers are
    dropped."""
    path = tmp_path / "skin.json"
    path.write_text(json.dumps(SKIN))
    given, read = (opaline.profile("skin", scene=scene, walks=1000)["channels"] for scene in (SKIN, path))
    assert given["B"]["back"]["walks_normal"]["share"] == read["B"]["back"]["walks_normal"]["share"]
    assert given["R"]["back"]["layers_normal"] == pytest.approx(given["R"]["back"]["walks_normal"]["share"], rel=.2)
    plain = opaline.profile("dermis", scene=SKIN, walks=1000)["channels"]
    assert "layers_normal" not in plain["R"]["back"]
    assert plain["R"]["back"]["walks_diffuse"]["share"] > 1.2 * given["R"]["back"]["walks_diffuse"]["share"]


def test_errors_and_interruption():
    """Claim: mistakes name the value and the expectation, and SIGINT ends long walks. Fails if: the signal waits for the walks."""
    with pytest.raises(opaline.BadInput, match="did you mean marble|did you mean 'marble'"):
        opaline.profile("marbel")
    with pytest.raises(opaline.BadInput, match="eta.*0.1 to 10"):
        opaline.profile("marble", eta=20)
    with pytest.raises(opaline.BadInput, match="thickness"):
        opaline.profile("skin", scene=SKIN, thickness=0.05, walks=10)
    with pytest.raises(opaline.BadInput, match="sigma_a and sigma_s"):
        opaline.profile({"subsurface_color": 0.5, "subsurface_radius": 1})
    with pytest.raises(ValueError, match="walks"):
        opaline.profile("marble", walks=2_000_000_000)
    timer = threading.Timer(.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        opaline.profile("spectralon", walks=100_000_000)
    assert time.monotonic() - start < 3
    timer.join()
