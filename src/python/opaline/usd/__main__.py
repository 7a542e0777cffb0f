# SPDX-License-Identifier: GPL-3.0-or-later
"""The command opaline-usd."""
import argparse
import sys

from . import UsdError, convert

DESCRIPTION = """Converts a USD file (.usd, .usda, .usdc, .usdz) to a GLB, or to a scene file with its meshes beside it.
A .json scene keeps more than glTF: dome, rectangle and disk lights, sizes of lights, depth of field, and
textures of every format. Prints one line for each kind of loss."""


def main():
    parser = argparse.ArgumentParser(prog="opaline-usd", description=DESCRIPTION)
    parser.add_argument("input", help="USD file")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help=".glb or .json")
    parser.add_argument("--time", type=float, metavar="CODE", help="time code; default: the start of the stage")
    parser.add_argument("--camera", metavar="PATH", help="default: from the render settings, or the first")
    arguments = parser.parse_args()
    try:
        lines = convert(arguments.input, arguments.output, arguments.time, arguments.camera)
    except UsdError as error:
        print(f"opaline-usd: {error}", file=sys.stderr)
        return 2
    except ModuleNotFoundError as error:
        if error.name != "pxr":
            raise
        print("opaline-usd: needs usd-core: pip install usd-core", file=sys.stderr)
        return 2
    for line in lines:
        print(line)
    print(f"wrote {arguments.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
