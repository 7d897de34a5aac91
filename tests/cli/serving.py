# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` as a process, and raw sockets to it; for test_serve.py and tests/acceptance/serve.py."""

import json
import re
import signal
import socket
import ssl
import subprocess

ADDRESS = re.compile(r"(https?)://(127\.0\.0\.1|\[::1\]|127\.0\.0\.2|localhost):(\d+)/\?token=([0-9a-f]{32})\n")
SECONDS = 60  # of patience


def receive_all(connection):
    """Everything until the other side closes, or resets what it has closed."""
    parts = []
    try:
        while part := connection.recv(65536):
            parts.append(part)
    except ConnectionResetError:
        pass
    return b"".join(parts)


def parse(answer):
    """(status, {header: value}, body) of a response; status 0 where there is none."""
    head, _, body = answer.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").split("\r\n")
    words = lines[0].split(" ", 2)
    headers = dict(line.split(": ", 1) for line in lines[1:] if ": " in line)
    return (int(words[1]) if len(words) > 1 else 0), headers, body.decode("utf-8", "replace")


class Server:
    """A running server, ended at the end of a `with`. With `trusted`, a certificate's file, it is spoken to over TLS."""

    def __init__(self, program, *arguments, cwd, environment=None, trusted=None):
        self.tls = ssl.create_default_context(cafile=trusted) if trusted else None
        self.process = subprocess.Popen(
            [program, "serve", *map(str, arguments)],
            cwd=cwd,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.line = self.process.stdout.readline()
        found = ADDRESS.fullmatch(self.line)
        if found is None:
            self.process.kill()
            raise AssertionError(f"{self.line!r}: {self.process.communicate()[1]}")
        self.host, self.port, self.token = found[2], int(found[3]), found[4]
        self.name = f"{self.host}:{self.port}"
        self.origin = f"{found[1]}://{self.name}"
        self.session = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def end(self, number=signal.SIGTERM):
        """(status, rest of stdout, stderr) after a signal."""
        self.process.send_signal(number)
        out, err = self.process.communicate(timeout=SECONDS)
        return self.process.returncode, out, err

    def connect(self):
        connection = socket.create_connection((self.host.strip("[]"), self.port), timeout=SECONDS)
        return connection if self.tls is None else self.tls.wrap_socket(connection, server_hostname=self.host.strip("[]"))

    def raw(self, data):
        """What comes back for these bytes until the server closes."""
        with self.connect() as connection:
            try:
                connection.sendall(data)
            except (ConnectionResetError, BrokenPipeError):
                pass
            return parse(receive_all(connection))

    def request(self, target="/", method="GET", body=b"", known=True, **headers):
        """One request on a connection of its own, below the session unless not `known`. Headers: Host="...", None leaves
        one out; Content_Length is a name too."""
        all_headers = {"Host": self.name, "Connection": "close"}
        if known:
            target = self.exchanged() + target
        if body:
            all_headers["Content-Length"] = str(len(body))
        all_headers.update({name.replace("_", "-"): value for name, value in headers.items()})
        lines = [f"{method} {target} HTTP/1.1", *(f"{name}: {value}" for name, value in all_headers.items() if value is not None)]
        return self.raw("\r\n".join(lines).encode("latin-1") + b"\r\n\r\n" + body)

    def json(self, what, trial=1):
        """(status, value) of /api/trial/N/edits or data."""
        status, _, body = self.request(f"/api/trial/{trial}/{what}")
        return status, json.loads(body) if body else None

    def edit(self, expected, edit, trial=1):
        """(status, answer) of one operation, on as many as are expected to be there. OSError where no answer comes."""
        body = json.dumps({"expected": expected, "edit": edit}).encode()
        status, _, text = self.request(f"/api/trial/{trial}/edits", method="POST", body=body, Origin=self.origin, Content_Type="application/json")
        if status == 0:
            raise ConnectionResetError("the server gave no answer")
        return status, json.loads(text)

    def exchanged(self):
        """The path that the token is exchanged for, "/SESSION", once."""
        if self.session is None:
            status, headers, _ = self.request(f"/?token={self.token}", known=False)
            if status != 303:
                raise AssertionError(f"the token was answered with {status}")
            self.session = headers["Location"].rstrip("/")
        return self.session
