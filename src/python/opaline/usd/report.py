# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and losses of a conversion."""


class UsdError(Exception):
    """An unusable file or prim: `file`, `prim` (a path, or empty) and the message."""

    def __init__(self, file, prim, message):
        self.file, self.prim = str(file), str(prim)
        super().__init__(": ".join(part for part in (self.file, self.prim, message) if part))


class Losses:
    """Parts of a stage without a counterpart, by kind."""

    def __init__(self):
        self._found = {}

    def add(self, kind, path):
        """kind: a plural, such as 'cylinder lights'."""
        self._found.setdefault(kind, {}).setdefault(str(path))

    def lines(self):
        """A line for each kind: its name, the number of prims and the path of the first."""
        return [f"not carried over: {kind} ({len(paths)}, first {next(iter(paths))})"
                for kind, paths in self._found.items()]
