# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A viewer of a live source over a WebSocket, by the words of RFC 6455 and of server/live_viewer.h; for test_live.py and tests/acceptance/live.py."""

import os
import struct

HEAD = struct.Struct("<BBHIdddfI")
KEY = "dGhlIHNhbXBsZSBub25jZQ=="


class Ended(Exception):
    """The server ended the connection: code and reason of its close frame; 0 without one."""

    def __init__(self, code, reason):
        super().__init__(f"{code} {reason}")
        self.code, self.reason = code, reason


class Viewer:
    """The client's side of one WebSocket. `status` is that of the answer; 101 is an open one."""

    def __init__(self, server, known=True, target="/live/socket", **headers):
        asked = {"Host": server.name, "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": KEY}
        asked["Origin"] = server.origin
        if known:
            target = server.exchanged() + target
        asked.update({name.replace("_", "-"): value for name, value in headers.items()})
        lines = [f"GET {target} HTTP/1.1", *(f"{name}: {value}" for name, value in asked.items() if value is not None)]
        self.connection = server.connect()
        self.connection.sendall("\r\n".join(lines).encode("latin-1") + b"\r\n\r\n")
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            letter = self.connection.recv(1)
            if not letter:
                break
            head += letter
        self.status = int(head.split(b" ", 2)[1]) if head else 0
        self.taken = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()

    def say(self, kind, data):
        mask = os.urandom(4)
        length = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self.connection.sendall(bytes([0x80 | kind]) + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def drawn(self):
        """All that was taken so far is drawn."""
        self.say(2, struct.pack("<d", self.taken))

    def read(self, count):
        data = b""
        while len(data) < count:
            part = self.connection.recv(count - len(data))
            if not part:
                raise Ended(0, "")
            data += part
        return data

    def hear(self):
        """(kind, {count, dropped, frame, time_s, due_s, answer_s}, body) of the next message."""
        while True:
            first, size = self.read(2)
            if size == 126:
                size = struct.unpack(">H", self.read(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.read(8))[0]
            data = self.read(size)
            kind = first & 0x0F
            if kind == 8:
                raise Ended(struct.unpack(">H", data[:2])[0] if len(data) >= 2 else 0, data[2:].decode())
            if kind == 9:
                self.say(10, data)
            if kind == 2:
                self.taken += 1
                what, version, count, dropped, frame, time_s, due_s, answer_s, _ = HEAD.unpack_from(data)
                assert version == 1, version
                head = {"count": count, "dropped": dropped, "frame": int(frame), "time_s": time_s, "due_s": due_s, "answer_s": answer_s}
                return what, head, data[HEAD.size :]
