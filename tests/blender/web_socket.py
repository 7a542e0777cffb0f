# SPDX-License-Identifier: GPL-3.0-or-later
"""A WebSocket client for the text messages of the live view (RFC 6455)."""

import base64
import json
import os
import socket
import struct
from urllib.parse import urlsplit

CONTINUED, TEXT, CLOSE, PING, PONG = 0, 1, 8, 9, 10
FINAL, MASKED = 0x80, 0x80


class WebSocket:
    """A connection to the view at a URL. Raises OSError if it fails or breaks."""

    def __init__(self, url, timeout):
        parts = urlsplit(url)
        host = f"{parts.hostname}:{parts.port}"
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout)
        self.file = self.socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {parts.path}socket HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nOrigin: http://{host}\r\nSec-WebSocket-Key: {key}\r\n"
                             "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        status = self.file.readline()
        while self.file.readline().strip():
            pass
        if b" 101 " not in status:
            self.close()
            raise OSError(f"the live view refuses a connection: {status.decode(errors='replace').strip()}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.file.close()
        self.socket.close()

    def send(self, message):
        """Sends a message as JSON."""
        self.send_frame(TEXT, json.dumps(message).encode())

    def send_frame(self, kind, data):
        size = len(data)
        if size < 126:
            head = struct.pack("!BB", FINAL | kind, MASKED | size)
        elif size < 1 << 16:
            head = struct.pack("!BBH", FINAL | kind, MASKED | 126, size)
        else:
            head = struct.pack("!BBQ", FINAL | kind, MASKED | 127, size)
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))
        self.socket.sendall(head + mask + masked)

    def read(self, size):
        data = self.file.read(size)
        if data is None or len(data) < size:
            raise OSError("the live view closed the connection")
        return data

    def next_frame(self):
        """Kind and bytes of the next frame, and True for the last one of a message."""
        first, second = self.read(2)
        size = second & 0x7F
        if size == 126:
            (size,) = struct.unpack("!H", self.read(2))
        elif size == 127:
            (size,) = struct.unpack("!Q", self.read(8))
        return first & 0x0F, self.read(size), bool(first & FINAL)

    def receive(self):
        """The next text message as a dict; images are skipped."""
        parts, is_text = [], False
        while True:
            kind, data, is_last = self.next_frame()
            if kind == PING:
                self.send_frame(PONG, data)
            elif kind == CLOSE:
                raise OSError("the live view closed the connection")
            elif kind != PONG:
                if kind != CONTINUED:
                    parts, is_text = [], kind == TEXT
                parts.append(data)
                if is_last and is_text:
                    return json.loads(b"".join(parts))
