# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of USD files: `opaline-usd in.usd -o out.glb`. Needs Pixar's usd-core: pip install usd-core."""
from __future__ import annotations

import os

from .report import UsdError

__all__ = ["UsdError", "convert"]


def convert(source: str | os.PathLike, target: str | os.PathLike, time: float | None = None,
            camera: str | None = None) -> list[str]:
    """Converts a USD file to a GLB (.glb) or to a scene file with its meshes and images (.json).

    time: a time code; None: the start time of the stage. camera: path of a camera; None: the one of the render settings,
    or the first. Returns a line for each kind of loss. Raises UsdError, with `file` and `prim`, and ModuleNotFoundError
    without usd-core.
    """
    from .conversion import convert_file
    return convert_file(os.fspath(source), os.fspath(target), time, camera)
