# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests of the Blender add-on with bpy.

usage: run_tests.py [NAME]...    NAME: as unittest takes it, e.g. test_images.DiffuseLight
"""

import os
import pathlib
import sys
import time
import unittest

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import blender_scenes  # noqa: E402


def main():
    blender_scenes.register()
    loader = unittest.defaultTestLoader
    suite = loader.loadTestsFromNames(sys.argv[1:]) if sys.argv[1:] else loader.discover(str(FOLDER))
    start = time.monotonic()
    result = unittest.TextTestRunner(stream=sys.stderr, verbosity=2).run(suite)
    print(f"{time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)
    blender_scenes.addon.unregister()
    os._exit(0 if result.wasSuccessful() else 1)  # bpy may crash at exit


if __name__ == "__main__":
    main()
