# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the EXR files of the program: scan lines, uncompressed or by ZIP, in half or single precision."""

import struct
import zlib

import numpy as np

TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
ROWS_OF_CHUNK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP


class Picture:
    """Channels of an image by name, each height x width, from the top row; and the text attributes of its header."""

    def __init__(self, channels, texts):
        self.channels = channels
        self.texts = texts

    def layer(self, name, parts):
        """Channels NAME.R, NAME.G ... as height x width x parts, or None without them; the empty name is the image."""
        names = [f"{name}.{part}" if name else part for part in parts]
        if any(full not in self.channels for full in names):
            return None
        return np.stack([self.channels[full] for full in names], axis=-1)


def text_at(data, start):
    """The zero-terminated text at an offset, and the offset behind it."""
    end = data.index(b"\0", start)
    return data[start:end].decode("utf-8", "replace"), end + 1


def read_header(data):
    """Attributes as {name: (type, bytes)}, and the offset behind the header."""
    if data[:4] != b"v/1\x01" or data[5] & 0x1A:
        raise ValueError("no EXR file of scan lines")
    attributes, at = {}, 8
    while data[at] != 0:
        name, at = text_at(data, at)
        kind, at = text_at(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def channel_list(data):
    """Names and types of the channels, in the order of the file."""
    channels, at = [], 0
    while data[at] != 0:
        name, at = text_at(data, at)
        channels.append((name, TYPES[struct.unpack_from("<i", data, at)[0]]))
        at += 16
    return channels


def unzip(data):
    """Undoes ZIP compression: inflates, sums the differences and joins the two halves."""
    deltas = np.frombuffer(zlib.decompress(data), np.uint8).astype(np.int64)
    deltas[1:] -= 128
    summed = np.cumsum(deltas).astype(np.uint8)
    half = (len(summed) + 1) // 2
    joined = np.empty_like(summed)
    joined[0::2], joined[1::2] = summed[:half], summed[half:]
    return joined.tobytes()


def read_exr(path):
    """The image in a file, in single precision. Raises ValueError for another kind of EXR."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = read_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][1][0]
    if compression not in ROWS_OF_CHUNK:
        raise ValueError("the compression of the EXR is neither none nor ZIP")
    rows_of_chunk = ROWS_OF_CHUNK[compression]
    names = channel_list(attributes["channels"][1])
    channels = {name: np.empty((height, width), np.float32) for name, _ in names}
    offsets = struct.unpack_from(f"<{(height + rows_of_chunk - 1) // rows_of_chunk}Q", data, at)
    row_bytes = sum(kind.itemsize for _, kind in names) * width
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(rows_of_chunk, y1 + 1 - y)
        chunk = data[offset + 8 : offset + 8 + size]
        if size < rows * row_bytes:
            chunk = unzip(chunk)
        start = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in names:
                channels[name][row] = np.frombuffer(chunk, kind, width, start)
                start += kind.itemsize * width
    texts = {name: value.decode("utf-8", "replace") for name, (kind, value) in attributes.items() if kind == "string"}
    return Picture(channels, texts)
