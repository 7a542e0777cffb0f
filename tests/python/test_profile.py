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
    names, *rows = [row for row in csv.reader(path.read_text().splitlines()) if not row[0].startswith("#")]
    rows = [dict(zip((name.split()[0] for name in names), row)) for row in rows]
    return lambda channel, face: {name: [row[name] for row in rows if (row["channel"], row["face"]) == (channel, face)]
                                  for name in rows[0]}


def test_same_digits_as_the_program(tmp_path):
    """Claim: a plate has the totals that the program prints, to the last bit, and the rings of its table. Source: one library.
    Tolerance: the table's eight digits. Fails if: a face, seed or thickness is taken otherwise, or a ring's mean is its value in
    the middle."""
    medium = {"sigma_a": 0.1, "sigma_s": 4, "g": 0.5, "specular_ior": 1.4}
    result = opaline.profile(medium, thickness=2, walks=2000, seed=7)
    printed = json.loads(run(json.dumps(medium), "--thickness", "2mm", "--walks", 2000, "--seed", 7, "--json", "-o",
                             tmp_path).splitlines()[-1])
    rings = table(tmp_path / "profile.csv")
    assert (result["thickness"], result["eta"], result["g"]) == (printed["thickness"], printed["eta"], printed["g"]) == (2, 1.4, .5)
    channel, expected = result["channels"]["all"], printed["channels"]["all"]
    assert channel["walks"] == expected["walks"] == 2048
    assert (channel["unfinished"], channel["unfinished_error"]) == (expected["unfinished"]["share"], expected["unfinished"]["error"])
    for face in ("back", "through"):
        ours, theirs, columns = channel[face], expected[face], rings("all", face)
        for entry in ("walks_diffuse", "walks_normal"):
            assert (ours[entry]["share"], ours[entry]["share_error"]) == (theirs[entry]["share"], theirs[entry]["error"])
        assert np.allclose(ours["r"][1:], np.array(columns["r_high"], float), rtol=1e-7) and ours["r"][0] == 0
        for entry in ("diffuse", "normal"):
            for key in ("profile", "profile_error", "within", "within_error"):
                assert np.allclose(ours[f"walks_{entry}"][key], np.array(columns[f"{entry}_{key}"], float), rtol=1e-7,
                                   atol=0), (face, entry, key)
        for model, values in ours["models"].items():
            assert values["share"] == theirs[model]["share"]
            assert values["shape_difference"] == theirs[model]["shape_difference"]
            for key in ("profile", "within"):
                assert np.allclose(values[key], np.array(columns[f"{model}_{key}"], float), rtol=1e-7, atol=0)


def test_shapes_of_arrays():
    """Claim: arrays have the shapes of the docstring, and the fractions of an angular distribution have a mean of 1 weighted by
    cosine. Fails if: ends and intervals are mixed up."""
    channel = opaline.profile({"sigma_a": 0.1, "sigma_s": 0.9}, walks=2000, profiles=["dipole"])["channels"]["all"]
    back = channel["back"]
    count = len(back["r"]) - 1
    assert count == 61 and list(back["models"]) == ["dipole"]
    assert all(back["walks_normal"][key].shape == (count,) for key in ("profile", "profile_error", "within"))
    assert all(model[key].shape == (count,) for model in back["models"].values() for key in ("profile", "within"))
    assert np.all(np.diff(back["r"]) > 0) and "through" not in channel
    cosines = back["walks_diffuse"]["cosine"]
    weights = np.diff(cosines**2)
    assert weights @ back["walks_diffuse"]["angular_exit"] == pytest.approx(1, abs=1e-6)
    assert channel["albedo_by_entry"].shape == (len(channel["cosine"]) - 1,)


def test_radial_profiles_alone():
    """Claim: without walks the models of each channel are those beside walks. Fails if: they use other rings, or walks run."""
    given = {"profiles": ["multipole", "dipole"], "thickness": 5}
    alone = opaline.profile("skin1", walks=0, **given)["channels"]
    beside = opaline.profile("skin1", walks=600, **given)["channels"]
    assert list(alone) == ["R", "G", "B"]
    for name in alone:
        channel = alone[name]
        assert channel["walks"] == 0 and "walks_diffuse" not in channel["back"] and "unfinished" not in channel
        for face in ("back", "through"):
            assert np.array_equal(channel[face]["r"], beside[name][face]["r"])
            assert set(channel[face]["models"]) == {"multipole", "dipole"}
            for model, values in channel[face]["models"].items():
                assert np.array_equal(values["profile"], beside[name][face]["models"][model]["profile"])
                assert values["share"] == beside[name][face]["models"][model]["share"] and "shape_difference" not in values
    dipole, r = alone["G"]["back"]["models"]["dipole"], alone["G"]["back"]["r"]
    assert np.cumsum(np.pi * np.diff(r**2) * dipole["profile"]) == pytest.approx(dipole["within"], rel=1e-9)


def test_layers_of_a_scene(tmp_path):
    """Claim: a layered medium of a dict is that of the same file. Fails if: the dict is read as another scene, or layers are
    dropped."""
    path = tmp_path / "skin.json"
    path.write_text(json.dumps(SKIN))
    given, read = (opaline.profile("skin", scene=scene, walks=1000, profiles=["dipole"])["channels"] for scene in (SKIN, path))
    assert given["B"]["back"]["walks_normal"]["share"] == read["B"]["back"]["walks_normal"]["share"]
    assert given["R"]["back"]["layers_normal"] == pytest.approx(given["R"]["back"]["walks_normal"]["share"], rel=.2)
    plain = opaline.profile("dermis", scene=SKIN, walks=1000, profiles=["dipole"])["channels"]
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
    with pytest.raises(opaline.BadInput, match="unknown radial profile 'dipol'.*'dipole'"):
        opaline.profile("marble", profiles=["dipol"])
    with pytest.raises(ValueError, match="walks"):
        opaline.profile("marble", walks=2_000_000_000)
    timer = threading.Timer(.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        opaline.profile("spectralon", walks=100_000_000, profiles=["dipole"])
    assert time.monotonic() - start < 3
    timer.join()
