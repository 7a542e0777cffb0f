# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of USD files: `opaline-usd in.usd -o out.glb`. Needs Pixar's `usd-core`: pip install 'opaline[usd]'."""
from .convert import convert
from .report import UsdError

__all__ = ["UsdError", "convert"]
