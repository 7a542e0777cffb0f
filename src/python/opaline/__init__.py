# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders translucent assets, and reports how accurate each image is.

    import opaline
    session = opaline.Session("bunny.json", {"film.resolution": [256, 256]})
    image = session.render()
    session.set({"media.marble.specular_ior": 1.4})
    print(opaline.compare(session.render(), image)["mean"])

A scene is a path of a scene file or asset, or a dict as in a scene file (scenes/README.md). In a dict, numpy
arrays may stand for files: `"mesh": (positions, triangles)` in a shape (float N x 3, int M x 3), and height x
width x 3 for the `file` of an environment or the `texture` of a value.
"""
from __future__ import annotations  # Session.set is no type

import hashlib
import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ._opaline import BadInput, Error, Image, RunFailed, __version__, compare, image, presets, read_image, set_threads
from . import _opaline

__all__ = ["BadInput", "Error", "Image", "RunFailed", "Session", "__version__", "compare", "image", "presets",
           "profile", "read_image", "render", "set_threads", "write_ply"]


def write_ply(path: str, positions: np.ndarray, triangles: np.ndarray) -> None:
    """Writes a mesh as binary PLY: positions N x 3, triangles M x 3 (counter-clockwise from outside)."""
    places = np.ascontiguousarray(positions, np.dtype("<f8"))
    corners = np.asarray(triangles)
    if places.ndim != 2 or places.shape[1] != 3 or corners.ndim != 2 or corners.shape[1] != 3:
        raise ValueError("a mesh is (positions N x 3, triangles M x 3)")
    if not np.issubdtype(corners.dtype, np.integer):
        raise ValueError("triangles are integers")
    if corners.size and (corners.min() < 0 or corners.max() >= len(places)):
        raise ValueError(f"triangles name positions 0 to {len(places) - 1}")
    faces = np.empty(len(corners), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"] = 3
    faces["corners"] = corners
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\n"
              "property double x\nproperty double y\nproperty double z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(f"{path}.part", "wb") as file:
        file.write(header.encode() + places.tobytes() + faces.tobytes())
    os.replace(f"{path}.part", path)


class Session:
    """A scene that is edited and rendered repeatedly; each image reuses what the edits left valid."""

    def __init__(self, scene: str | os.PathLike | Mapping[str, Any] | None = None, overrides: Mapping[str, Any] = {},
                 frame: int = 1):
        """scene, overrides: see edit. Without a scene, call edit before anything else."""
        self._session = _opaline.Session()
        self._folder = tempfile.TemporaryDirectory(prefix="opaline-")
        self._scene: tuple[str, str | None] | None = None
        self._overrides: dict[str, Any] = {}
        self._frame = frame
        self._files: set[str] = set()  # of arrays in the scene, and while walking
        self._scene_files: set[str] = set()
        if scene is not None:
            self.edit(scene, overrides, frame)

    def edit(self, scene: str | os.PathLike | Mapping[str, Any], overrides: Mapping[str, Any] = {},
             frame: int = 1) -> None:
        """Replaces the scene. overrides: values by path, as `opaline --set`: {"film.resolution": [64, 64]}.

        Raises BadInput, with the place in the file and the expected value; the session then keeps its scene.
        """
        self._files = set()
        if isinstance(scene, Mapping):
            given = ("scene.json", json.dumps(self._with_files(scene)))
        else:
            given = (os.fspath(scene), None)
        self._apply(given, set(self._files), dict(overrides), frame)

    def set(self, overrides: Mapping[str, Any], frame: int | None = None) -> None:
        """Changes values of the scene, beside the changes before. Raises as edit."""
        self._require_scene()
        values = {key: value for key, value in self._overrides.items() if key not in overrides}
        self._apply(self._scene, self._scene_files, values | dict(overrides),
                    self._frame if frame is None else frame)

    def render(self) -> Image:
        """The image. Ctrl-C ends it with KeyboardInterrupt; other threads of Python go on meanwhile."""
        self._require_scene()
        return self._session.render()

    @property
    def estimated_error(self) -> float | None:
        """Estimated mean relative error of the last image's diffuse light, worst channel; None: unknown."""
        return self._session.estimated_error

    def plan(self) -> dict[str, Any]:
        """Stages, samples, memory, warnings and expected model error; for each body its method."""
        self._require_scene()
        return self._session.plan()

    @property
    def decisions(self) -> list[str]:
        """Which stages were reused or computed for the last image, a line each."""
        return self._session.decisions

    def radiant_exitance(self, body: int, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """W/mm^2 at points on a translucent body's surface: N x 3. points in mm, unit normals outwards."""
        self._require_scene()
        return self._session.radiant_exitance(body, np.ascontiguousarray(points, np.float64),
                                              np.ascontiguousarray(normals, np.float32))

    def hold_view(self, hold: bool) -> None:
        """Keeps camera rays and their light, so that edits of colours and media trace none; takes memory."""
        self._session.hold_view(hold)

    def _require_scene(self) -> None:
        if self._scene is None:
            raise ValueError("the session has no scene yet")

    def _apply(self, scene: tuple[str, str | None], scene_files: set[str], overrides: dict[str, Any],
               frame: int) -> None:
        self._files = set(scene_files)
        texts = [f"{key}={json.dumps(self._with_files(value))}" for key, value in overrides.items()]
        self._session.edit(scene[0], scene[1], texts, frame)
        self._scene, self._scene_files, self._overrides, self._frame = scene, scene_files, overrides, frame
        for name in set(os.listdir(self._folder.name)) - {os.path.basename(path) for path in self._files}:
            os.remove(os.path.join(self._folder.name, name))  # of arrays replaced since

    def _with_files(self, value: Any) -> Any:
        """The value with files for its arrays, named by their content, so that equal arrays change nothing."""
        if isinstance(value, Mapping):
            return dict(self._members(value))
        if isinstance(value, np.ndarray) and value.ndim == 3:
            return self._file(".exr", [value], lambda path: image(
                np.ascontiguousarray(value, np.float32), _channels(value)).write(path, half=False))
        if isinstance(value, np.ndarray | np.generic):
            return value.tolist()
        if isinstance(value, list | tuple):
            return [self._with_files(item) for item in value]
        return value

    def _members(self, owner: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        for key, value in owner.items():
            if key == "mesh":
                positions, triangles = (np.asarray(array) for array in value)
                yield "file", self._file(".ply", [positions, triangles],
                                         lambda path: write_ply(path, positions, triangles))
            else:
                yield key, self._with_files(value)

    def _file(self, ending: str, arrays: list[np.ndarray], write: Any) -> str:
        content = hashlib.sha256()
        for array in arrays:
            content.update(repr((array.shape, array.dtype.str)).encode() + np.ascontiguousarray(array).tobytes())
        path = os.path.join(self._folder.name, content.hexdigest()[:32] + ending)
        if not os.path.exists(path):
            write(path)
        self._files.add(path)
        return path


def _channels(pixels: np.ndarray) -> list[str]:
    names = {1: ["Y"], 3: ["R", "G", "B"], 4: ["R", "G", "B", "A"]}
    if pixels.shape[2] not in names:
        raise ValueError("an image has 1, 3 or 4 channels")
    return names[pixels.shape[2]]


def render(scene: str | os.PathLike | Mapping[str, Any], overrides: Mapping[str, Any] = {}) -> Image:
    """One image of a scene, see Session."""
    return Session(scene, overrides).render()


def profile(medium: str | Mapping[str, Any], *, scene: str | os.PathLike | Mapping[str, Any] | None = None,
            thickness: float | None = None, eta: float | None = None, g: float | None = None, walks: int | None = None,
            seed: int = 1, profiles: Sequence[str] = ()) -> dict[str, Any]:
    """Radial profiles of a medium beside random walks in it, with the numbers of `opaline profile`.

    medium: a preset, coefficients as in a scene file ({"sigma_a": 0.01, "sigma_s": 2}, in 1/mm), or the name of a medium of
    the scene, perhaps of layers. thickness: of a slab in mm; None: a half space. eta: index of refraction, inside over
    outside, and g: mean cosine of the scattering angle at the same reduced scattering; None: the medium's. walks: per
    channel and angle of incidence; None: as many as some seconds allow; 0: radial profiles alone.
    profiles: names of the radial profiles, such as "dipole"; none: all of them. "tabulated" takes a second.

    Returns the keys medium, eta, g, thickness (inf: a half space) and channels: R, G and B, wavelengths such as "620 nm", or
    "all" for three equal ones. A channel has the number of `walks`, the fraction `unfinished`, and its faces: `back`, and for
    a slab `through`. Fractions are of the transmitted flux. Estimates by walks have their standard error beside them, as
    share and share_error. A face has

    r               N + 1 distances from the beam in mm, the ends of N rings
    models          by the name of the radial profile: share, the fraction leaving through the face; profile, N means of
                    R(r) over the rings in 1/mm^2; within, N fractions nearer than the outer end; shape_difference, the
                    largest difference of within / share from the walks in diffuse light
    walks_diffuse   of light from all sides: share, uncollided, profile, within; angular_exit, M radiances over those of a
                    Lambert emitter of the same flux, between the M + 1 cosines of `cosine`
    walks_normal    the same of a beam along the normal
    layers_normal   of layers: fraction by the diffusion equation in the stack

    With walks, a channel has albedo_by_entry too: M reflected fractions of diffuse light by its cosine of incidence.

    Raises BadInput for an unknown medium or profile, a medium without coefficients (subsurface_color), and values out of range. Other
    threads of Python go on meanwhile; Ctrl-C ends it with KeyboardInterrupt. The same seed gives the same bits.
    """
    files = Session()  # of arrays in the scene
    text = json.dumps(files._with_files(scene)) if isinstance(scene, Mapping) else None
    path = "" if scene is None else "scene.json" if text is not None else os.fspath(scene)
    given = json.dumps(files._with_files(medium)) if isinstance(medium, Mapping) else medium
    return _opaline.profile(given, path, text, thickness, eta, g, walks, seed, list(profiles))
