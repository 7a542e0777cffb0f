# SPDX-License-Identifier: GPL-3.0-or-later
"""Image files for the textures and environment maps of a scene."""

import hashlib
import os
import struct

import bpy
import numpy as np

READABLE = {"PNG", "JPEG", "OPEN_EXR", "HDR", "TIFF"}
SUFFIXES = {"PNG": ".png", "JPEG": ".jpg", "OPEN_EXR": ".exr", "HDR": ".hdr", "TIFF": ".tif"}
LINEAR_SPACES = {"Non-Color", "Linear", "Linear Rec.709", "Raw", "Generic Data"}


def is_linear(image):
    """True if texels are used without the sRGB curve."""
    return image.is_float or image.colorspace_settings.name in LINEAR_SPACES


def texels_of(image):
    """Linear texels, height x width x 4, from the bottom row."""
    width, height = image.size
    texels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, 4)
    if not is_linear(image):
        encoded = texels[..., :3]
        texels[..., :3] = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return texels


def mean_color(image):
    """Mean linear colour of an image."""
    return texels_of(image)[..., :3].mean(axis=(0, 1)).tolist()


def write_exr(path, texels):
    """Writes linear texels, height x width x 4 from the bottom row, as an uncompressed EXR of half precision."""
    height, width, _ = texels.shape

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = "ABGR"
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"v/1\x01" + struct.pack("<i", 2)
    for name, kind, value in (
        ("channels", "chlist", channels),
        ("compression", "compression", b"\0"),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    ):
        header += attribute(name, kind, value)
    header += b"\0"
    rows = np.clip(texels[::-1, :, ::-1], -65504, 65504).astype("<f2").transpose(0, 2, 1)
    row_bytes = width * len(names) * 2
    start = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header)
        file.write(b"".join(struct.pack("<Q", start + y * (8 + row_bytes)) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, row_bytes) + rows[y].tobytes())


class ImageFiles:
    """Writes each image of a scene once, or refers to its own file."""

    def __init__(self, folder):
        self.folder = folder
        self.paths = {}
        self.means = {}

    def path_of(self, image):
        """Absolute path of a file with the texels of an image, or None if it has none."""
        key = image.name_full
        if key not in self.paths:
            self.paths[key] = self.own_file(image) or self.packed_file(image) or self.written_file(image)
        return self.paths[key]

    def mean_of(self, image):
        """Mean linear colour, computed once."""
        if image.name_full not in self.means:
            self.means[image.name_full] = mean_color(image) if image.size[0] > 0 else [0.8] * 3
        return self.means[image.name_full]

    def own_file(self, image):
        if image.packed_file or image.is_dirty or image.source != "FILE" or image.file_format not in READABLE:
            return None
        path = image.filepath_from_user()
        return os.path.abspath(path) if os.path.isfile(path) else None

    def packed_file(self, image):
        if not image.packed_file or image.is_dirty or image.file_format not in READABLE:
            return None
        data = image.packed_file.data
        path = self.name_of(data, SUFFIXES[image.file_format])
        if not os.path.exists(path):
            with open(path, "wb") as file:
                file.write(data)
        return path

    def written_file(self, image):
        if image.source in {"TILED", "MOVIE", "SEQUENCE"} or image.size[0] == 0:
            return None
        texels = texels_of(image)
        path = self.name_of(texels.tobytes(), ".exr")
        if not os.path.exists(path):
            write_exr(path, texels)
        return path

    def name_of(self, data, suffix):
        """A file name by content: the live view notices changed texels."""
        return os.path.join(self.folder, hashlib.sha1(data).hexdigest()[:16] + suffix)

    def color_space_of(self, image):
        """Value of `color_space` for a texture with this image."""
        path = self.path_of(image)
        if path is not None and path.endswith(".exr"):
            return "linear"
        return "linear" if is_linear(image) else "srgb"
