# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve`: who is let in, what they see, and what nobody gets. Loopback only; times are a matter of acceptance."""

import http.cookiejar
import http.server
import json
import os
import re
import signal
import socket
import threading
import time
import urllib.request
from pathlib import Path

from serving import Server, parse, receive_all
from support import PROGRAM, CommandTest, listing, report_data, run

HOSTILE = "</script><img src=x onerror=alert(1)>"


class ServeTest(CommandTest):
    """`study` holds a recording and a trial solved from it; made once."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.study = Path(cls.shared.name) / "study"
        cls.study.mkdir()
        (cls.study / "a walk.c3d").write_bytes(cls.c3d.read_bytes())
        solved = run("ik", "-m", cls.model, "-t", cls.study / "a walk.c3d", "-o", cls.study / "q.mot", cwd=cls.study)
        assert solved.status in (0, 1), solved.err

    def serve(self, *arguments, **options):
        server = Server(PROGRAM, *arguments, "--no-open", cwd=self.folder, **options)
        self.addCleanup(server.__exit__)
        return server

    def trials(self, server):
        """The list as JSON once every trial in it is read."""
        for _ in range(3000):
            status, headers, body = server.request("/api/trials")
            self.assertEqual((status, headers["Content-Type"]), (200, "application/json"))
            rows = json.loads(body)["trials"]
            if all(row["state"] != "reading" for row in rows):
                return rows
            time.sleep(0.01)
        raise AssertionError(f"still being read: {rows}")


class Shown(ServeTest):
    def test_the_address_is_the_only_line_and_a_signal_ends_it(self):
        for number, status in ((signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129)):
            if signal.getsignal(number) == signal.SIG_IGN:  # as nohup asks for: children then ignore it too
                continue
            server = self.serve(self.study)
            ended, out, err = server.end(number)
            self.assertEqual((ended, out), (status, ""))
            self.assertIn("stopped", err.splitlines()[-1])
            with self.assertRaises(ConnectionRefusedError):
                server.connect()
        quiet = self.serve(self.study, "--quiet")
        self.assertEqual(len(quiet.end()[2].splitlines()), 1, "nothing but what ended it")

    def test_the_list_says_what_there_is(self):
        server = self.serve(self.study)
        rows = self.trials(server)
        self.assertEqual([row["name"] for row in rows], ["a walk.c3d", "q.mot"], "companions are no trials")
        markers, solved = rows
        self.assertEqual((markers["kind"], markers["markers"], markers["frames"], markers["rate_hz"], markers["verdict"]),
                         ("markers", 40, 100, 100.0, None))  # fmt: skip
        self.assertTrue(0.93 < markers["measured"] < 0.97)
        self.assertEqual((solved["kind"], solved["frames"]), ("solved trial", 100))
        report = json.loads((self.study / "q_report.json").read_text())
        self.assertEqual(solved["verdict"], report["verdict"])
        status, headers, page = server.request("/")
        self.assertEqual(status, 200)
        shown = json.loads(report_data(page))
        self.assertEqual(shown["summary"]["root"], server.exchanged() + "/")
        self.assertEqual([(row["page"], row["name"]) for row in shown["list"]["trials"]], [("/trial/1", "a walk.c3d"), ("/trial/2", "q.mot")])

    def test_pages_of_trials(self):
        server = self.serve(self.study / "q.mot", self.study / "a walk.c3d")
        self.trials(server)
        status, headers, page = server.request("/trial/1")
        self.assertEqual(status, 200)
        self.assertEqual(json.loads(report_data(page))["summary"]["frames"], 100)
        nonce = re.search(r"script-src 'nonce-([0-9a-f]{32})'", headers["Content-Security-Policy"])[1]
        self.assertEqual(re.findall(r"<(\w+) nonce=\"([^\"]*)\"", page), [("style", nonce), ("script", nonce)])
        self.assertNotIn("unsafe", headers["Content-Security-Policy"])
        status, headers, page = server.request("/trial/2")
        self.assertEqual(status, 200)
        self.assertIn("a walk.c3d", page)

    def test_every_answer_has_the_headers_that_protect(self):
        server = self.serve(self.study)
        for target in ("/", "/api/trials", "/trial/1", "/style.css", "/list.js", "/nothing"):
            for known in (True, False):
                _, headers, _ = server.request(target, known=known)
                self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
                self.assertEqual(headers["Referrer-Policy"], "no-referrer")
                self.assertEqual(headers["Cache-Control"], "no-store")
                self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
                self.assertIn("frame-ancestors 'none'", headers["Content-Security-Policy"])

    def test_a_folder_is_listed_again_and_files_may_come_change_and_go(self):
        day = self.folder / "day"
        day.mkdir()
        self.write("day/b.trc", self.trc.read_bytes())
        server = self.serve("day")
        self.assertEqual([(row["number"], row["name"]) for row in self.trials(server)], [(1, "b.trc")])
        self.write("day/a.trc", "nothing")
        rows = self.trials(server)
        self.assertEqual([(row["number"], row["name"], row["state"]) for row in rows],
                         [(2, "a.trc", "unreadable"), (1, "b.trc", "read")])  # fmt: skip
        status, _, page = server.request("/trial/2")
        self.assertEqual(status, 422)
        self.assertIn("begins with PathFileType", page)
        self.write("day/a.trc", self.trc.read_bytes())
        self.assertEqual(self.trials(server)[0]["state"], "read")
        self.assertEqual(server.request("/trial/2")[0], 200)
        (day / "b.trc").unlink()
        status, _, page = server.request("/trial/1")
        self.assertEqual(status, 404)
        self.assertIn("b.trc: the file is no longer there", page)
        (day / "a.trc").unlink()
        self.assertIn("holds no file that can be read", server.request("/")[2])
        day.rmdir()
        self.assertEqual(server.request("/")[0], 200)

    def test_names_are_text(self):
        lines = self.trc.read_text().split("\n")
        cells = lines[3].split("\t")
        cells[2] = HOSTILE
        lines[3] = "\t".join(cells)
        name = "<img src=x onerror=alert(2)>&quot;.trc"
        self.write(name, "\n".join(lines))
        self.write("<b>.mot", "<i>not a table</i>")
        server = self.serve(name, "<b>.mot")
        self.trials(server)
        for target in ("/", "/trial/1", "/trial/2"):
            _, _, page = server.request(target)
            for never in ("<img", "<b>.mot", "<i>"):
                self.assertNotIn(never, page, target)
        page = server.request("/trial/1")[2]
        self.assertIn(r"\u003c/script>\u003cimg src=x onerror=alert(1)>", page)
        self.assertIn(r"\u003cimg src=x onerror=alert(2)>", page)

    def test_kept_connections_and_head(self):
        server = self.serve(self.study)
        session = server.exchanged()
        with server.connect() as connection:
            ask = f"GET {session}/style.css HTTP/1.1\r\nHost: {server.name}\r\n\r\n".encode()
            connection.sendall(ask * 3 + ask.replace(b"\r\n\r\n", b"\r\nConnection: close\r\n\r\n"))
            everything = receive_all(connection)
        self.assertEqual(everything.count(b"HTTP/1.1 200 OK"), 4)
        status, headers, body = server.request("/style.css", method="HEAD")
        self.assertEqual((status, body), (200, ""))
        self.assertEqual(int(headers["Content-Length"]), len(server.request("/style.css")[2].encode()))

    def test_the_other_loopback_address(self):
        try:
            with socket.socket(socket.AF_INET6) as probe:
                probe.bind(("::1", 0))
        except OSError:
            self.skipTest("this machine has no ::1")
        server = self.serve(self.study, "--bind", "::1")
        self.assertTrue(server.line.startswith("http://[::1]:"))
        self.assertEqual(server.request("/")[0], 200)
        self.assertEqual(server.request("/", Host=f"127.0.0.1:{server.port}")[0], 421)


class Refused(ServeTest):
    def setUp(self):
        super().setUp()
        self.server = self.serve(self.study)

    def status(self, *arguments, **options):
        return self.server.request(*arguments, **options)[0]

    def test_a_foreign_host_is_421(self):
        for host in ("evil.example", f"evil.example:{self.server.port}", "127.0.0.1", "127.0.0.1:1", "", None, f"{self.server.name}.evil.example"):
            self.assertEqual(self.status(Host=host), 421, host)
            self.assertEqual(self.status(f"/?token={self.server.token}", known=False, Host=host), 421, host)
        self.assertEqual(self.status(Host=f"LOCALHOST:{self.server.port}"), 200)

    def test_two_hosts_are_400(self):
        ask = f"GET {self.server.exchanged()}/ HTTP/1.1\r\nHost: {self.server.name}\r\nHost: evil.example\r\n\r\n"
        self.assertEqual(self.server.raw(ask.encode())[0], 400)

    def test_without_the_token_is_401(self):
        for target in ("/", "/api/trials", "/trial/1", "/style.css", "/nothing", "/?token=", "/?token=" + "0" * 32,
                       f"/?token={self.server.token[:-1]}", f"/trial/1?token={self.server.token}"):  # fmt: skip
            status, headers, body = self.server.request(target, known=False)
            self.assertEqual(status, 401, target)
            self.assertNotIn("walk", body)
            self.assertNotIn("Set-Cookie", headers)
        for path in (f"/{self.server.token}/", "/" + "0" * 32 + "/", self.server.exchanged()):
            self.assertEqual(self.status(path, known=False), 401, path)

    def test_the_token_is_exchanged_for_a_path_that_is_not_the_token(self):
        _, headers, _ = self.server.request(f"/?token={self.server.token}", known=False)
        self.assertRegex(headers["Location"], r"^/[0-9a-f]{32}/$")
        self.assertNotIn(self.server.token, headers["Location"])
        self.assertNotIn("Set-Cookie", headers)
        self.assertEqual(headers["Referrer-Policy"], "no-referrer")

    def test_a_page_on_another_port_reads_nothing_and_writes_nothing(self):
        """A program on another port, and what it gets from the browser that has our pages open: nothing that lets it in."""
        got = {}

        class Other(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                got.update(self.headers)
                self.send_response(200)
                self.end_headers()

            def log_message(self, *_):
                pass

        before = listing(self.study)
        opened = http.cookiejar.CookieJar()
        browser = urllib.request.build_opener(urllib.request.ProxyHandler({}), urllib.request.HTTPCookieProcessor(opened))
        ours = browser.open(f"{self.server.origin}/?token={self.server.token}")
        self.assertIn("kinemark.trials", ours.read().decode())
        with http.server.HTTPServer(("127.0.0.1", 0), Other) as other:
            thread = threading.Thread(target=other.handle_request)
            thread.start()
            browser.open(f"http://127.0.0.1:{other.server_port}/").read()
            thread.join()
            theirs = f"http://127.0.0.1:{other.server_port}"
        self.assertEqual(list(opened), [], "no cookie, which would go to every port")
        stolen = {name: value for name, value in got.items() if name not in ("Host", "Connection")}
        for value in stolen.values():
            self.assertNotIn(self.server.token, value)
            self.assertNotIn(self.server.exchanged().strip("/"), value)
        edit = b'{"expected": 0, "edit": {"do": "crop", "first": 1}}'
        for origin in (theirs, self.server.origin, None):
            for target in ("/", "/trial/1", "/api/trials", "/api/trial/1/edits", "/api/trial/1/data", "/live/socket"):
                status, headers, body = self.server.request(target, known=False, Origin=origin, **stolen)
                self.assertEqual(status, 401, (target, origin))
                self.assertNotIn("Access-Control-Allow-Origin", headers)
                self.assertNotIn("walk", body)
                status, _, _ = self.server.request(target, "POST", edit, known=False, Origin=origin, Content_Type="application/json", **stolen)
                self.assertIn(status, (401, 403), (target, origin))
        # Even one that knows the path is not let in to write from a page of its own.
        for target in ("/api/trial/1/edits", "/api/trial/1/angles"):
            self.assertEqual(self.status(target, "POST", edit, Origin=theirs, Content_Type="application/json"), 403)
        self.assertEqual(listing(self.study), before)

    def test_programs_send_the_token_themselves(self):
        self.assertEqual(self.status("/api/trials", known=False, Authorization=f"Bearer {self.server.token}"), 200)
        self.assertEqual(self.status("/api/trials", known=False, Authorization="Bearer " + "0" * 32), 401)

    def test_what_changes_something_needs_our_origin(self):
        ours = f"http://{self.server.name}"
        for method in ("POST", "PUT", "DELETE", "OPTIONS"):
            for origin in (None, "null", "http://evil.example", f"http://evil.example:{self.server.port}", ours + "/"):
                self.assertEqual(self.status(method=method, Origin=origin), 403, (method, origin))
            self.assertEqual(self.status(method=method, Origin=ours), 405)
        socket_asked = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
                        "Sec_WebSocket_Version": "13"}  # fmt: skip
        for origin in (None, "null", "http://evil.example"):
            with self.server.connect() as connection:
                lines = {"Host": self.server.name, **socket_asked}
                if origin:
                    lines["Origin"] = origin
                text = f"GET {self.server.exchanged()}/trial/1 HTTP/1.1\r\n" + "".join(f"{k.replace('_', '-')}: {v}\r\n" for k, v in lines.items()) + "\r\n"
                connection.sendall(text.encode())
                self.assertTrue(connection.recv(65536).startswith(b"HTTP/1.1 403"), origin)

    def test_paths_lead_nowhere(self):
        for target in ("/../../etc/passwd", "/..%2f..%2fetc%2fpasswd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/etc/passwd",
                       "/trial/../../etc/passwd", "/trial/1/..", "/trial/0", "/trial/-1", "/trial/01", "/trial/1e0", "/trial/%31",
                       "/trial/99999999999999999999", "/a%20walk.c3d", "/q.mot", "/trial/a%20walk.c3d", "/style.css/", "/./style.css",
                       "/style.css%00", "/style.css?x", "*", "/\\..\\..\\etc\\passwd", "file:///etc/passwd"):  # fmt: skip
            bearer = {"known": False, "Authorization": f"Bearer {self.server.token}"}
            for options in ({}, bearer) if target.startswith("/") else (bearer,):
                status, _, body = self.server.request(target, **options)
                self.assertEqual(status, 404, target)
                self.assertNotIn("root:", body)

    def test_links_out_of_the_folder_and_files_of_other_kinds_show_nothing(self):
        day = self.folder / "day"
        day.mkdir()
        secret = self.write("secret.txt", "root:x:0:0:topsecret\nalice,hunter2,3\n")
        for ending in ("trc", "csv", "tsv", "mot", "sto", "v3d", "c3d", "nwb", "mcap"):
            (day / f"link.{ending}").symlink_to(secret)
            (day / f"copy.{ending}").write_bytes(secret.read_bytes())
        (day / "walk.c3d").write_bytes(self.c3d.read_bytes())
        (day / "walk_edits.jsonl").symlink_to(secret)
        server = self.serve(day)
        seen = [server.request("/")[2], json.dumps(self.trials(server))]
        seen += [server.request(f"/trial/{n}")[2] + server.request(f"/api/trial/{n}/edits")[2] for n in range(1, 25)]
        self.assertIn("link.trc: a link leads out of the folder", seen[0])
        for text in seen:
            for word in ("topsecret", "hunter2", "alice", "root:"):
                self.assertNotIn(word, text)
        self.assertEqual(secret.read_text(), "root:x:0:0:topsecret\nalice,hunter2,3\n")

    def test_what_is_too_long_is_refused(self):
        self.assertEqual(self.status(X="a" * 20_000), 431)
        self.assertEqual(self.status("/" + "a" * 1_000_000), 431)
        self.assertEqual(self.status(**{f"X{i}": "a" for i in range(5000)}), 431)
        self.assertEqual(self.status(method="POST", body=b"a" * 1_000_000, Origin=f"http://{self.server.name}"), 413)
        self.assertEqual(self.status(method="POST", Content_Length="99999999999999999999999"), 400)
        self.assertEqual(self.status(), 200)

    def test_what_is_no_http_is_refused(self):
        for data in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200), b"\r\n\r\nnothing\r\n\r\n", os.urandom(64).replace(b"\n", b"") + b"\r\n\r\n"):
            with self.server.connect() as connection:
                connection.sendall(data)
                connection.shutdown(socket.SHUT_WR)
                self.assertIn(parse(receive_all(connection))[0], (0, 400), data)
        self.assertEqual(self.status(), 200)

    def test_a_thousand_connections_and_slow_ones_keep_nobody_out(self):
        held = []
        try:
            for n in range(1000):
                connection = self.server.connect()
                held.append(connection)
                if n % 2:
                    connection.sendall(b"GET / HTTP/1.1\r\nX-")
                if len(held) > 400:  # as many descriptors as this process may have
                    held.pop(0).close()
                if n % 100 == 99:
                    self.assertEqual(self.status(), 200)
            for connection in held[::7]:
                try:
                    connection.sendall(b"a")
                except OSError:
                    pass
            self.assertEqual(self.status("/trial/1"), 200)
        finally:
            for connection in held:
                connection.close()
        self.assertLess(len(list(Path(f"/proc/{self.server.process.pid}/fd").iterdir())), 400)


class Started(ServeTest):
    def test_what_cannot_be_served_is_one_sentence(self):
        (self.folder / "empty").mkdir()
        self.refused(2, "FILE", "serve")
        self.refused(4, ["absent.c3d", "cannot be opened"], "serve", "absent.c3d")
        self.refused(3, ["empty", "holds no file"], "serve", "empty")
        self.refused(2, "--port", "serve", self.c3d, "--port", 70000)
        self.refused(4, "absent.osim", "serve", self.c3d, "--model", "absent.osim")
        self.refused(3, "markers.c3d", "serve", self.c3d, "--model", self.c3d)
        for address in ("0.0.0.0", "192.168.0.1", "::"):
            self.refused(2, ["--bind", address, "TLS", "ssh -L"], "serve", self.c3d, "--bind", address)
        self.refused(2, ["--bind", "'localhost'", "127.0.0.1"], "serve", self.c3d, "--bind", "localhost")
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            self.refused(4, [f"127.0.0.1 port {port}", "--port 0"], "serve", self.c3d, "--port", port)

    def test_an_address_that_nobody_reads_ends_it(self):
        with open("/dev/full", "w") as full:
            ran = self.run_in("serve", self.c3d, "--no-open", stdout=full)
        self.assertEqual(ran.status, 4)
        self.assertIn("standard output", ran.err)

    def test_edits_are_saved_beside_the_recording(self):
        recording = self.write("walk.trc", self.trc.read_bytes())
        original = recording.read_bytes()
        server = self.serve(recording)
        status, state = server.json("edits")
        self.assertEqual((status, state["edits"], state["journal"]), (200, [], "walk_edits.jsonl"))
        label = json.loads(run("info", recording, "--json", cwd=self.folder).out)["labels"][0]
        page = server.request("/trial/1")[2]
        status, state = server.edit(0, {"do": "relabel", "marker": label, "to": HOSTILE})
        self.assertEqual((status, state["undo"], state["edits"][0]["to"]), (200, 1, HOSTILE))
        self.assertRegex(state["edits"][0]["made"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        changed = server.request("/trial/1")[2]
        self.assertNotEqual(changed, page)
        self.assertEqual(json.loads(report_data(changed))["summary"]["markers"][0]["name"], HOSTILE)
        self.assertNotIn("<img src=x", changed)
        self.assertEqual(server.json("data")[1]["scene"]["names"][0], HOSTILE)
        listed = json.loads(run("edit", recording, "--list", "--json", cwd=self.folder).out)
        self.assertEqual(listed["digest"], state["digest"])
        self.assertEqual(run("edit", recording, "--undo", 1, cwd=self.folder).status, 0)
        status, answer = server.edit(1, {"do": "undo"})
        self.assertEqual((status, len(answer["editing"]["edits"])), (409, 2))
        self.assertIn("Somebody else has edited this recording: 2 operations are there and not 1", answer["error"])
        status, answer = server.edit(2, {"do": "cut", "marker": "NOSE"})
        self.assertEqual(status, 422)
        self.assertIn("'NOSE'", answer["error"])
        self.assertEqual(recording.read_bytes(), original)
        self.assertEqual(server.end(signal.SIGKILL)[0], -signal.SIGKILL)
        self.assertEqual(sorted(listing(self.folder)), ["walk.trc", "walk_edits.jsonl"])

    def test_angles_are_solved_with_the_edits_and_nothing_is_written(self):
        (self.folder / "walk.c3d").write_bytes(self.c3d.read_bytes())
        server = self.serve("walk.c3d")
        post = {"method": "POST", "Origin": server.origin, "Content_Type": "application/json"}
        status, _, body = server.request("/api/trial/1/angles", body=b'{"do": "solve"}', **post)
        self.assertEqual(status, 422)
        self.assertIn("No body model is known for walk.c3d", json.loads(body)["error"])
        server = self.serve("walk.c3d", "--model", self.model)
        labels = json.loads(self.good("info", "walk.c3d", "--json").out)["labels"]
        self.assertEqual(server.edit(0, {"do": "swap", "marker": labels[0], "with": labels[1], "first": 20})[0], 200)
        self.assertEqual(server.request("/trial/1/angles/now")[0], 404)
        post["Origin"] = server.origin
        self.assertEqual(server.request("/api/trial/1/angles", body=b'{"do": "solve"}', **post)[0], 202)
        state = {"state": "waiting"}
        while state["state"] in ("waiting", "solving"):
            state = server.json("angles")[1]
        self.assertEqual((state["state"], state["said"], state["solutions"]["now"]["edits"]), ("solved", None, 1))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["walk.c3d", "walk_edits.jsonl"])
        for which, edits in (("now", ()), ("recorded", ("--edits", "none"))):
            self.assertIn("kinemark.ik_report", server.request(f"/trial/1/angles/{which}")[2])
            self.good("ik", "-m", self.model, "-t", "walk.c3d", "-o", f"{which}.mot", *edits)
            self.assertEqual(json.loads((self.folder / f"{which}_report.json").read_text())["kinemark_set"], state["solutions"][which]["set"])

    def test_angles_are_solved_with_weights_and_tasks(self):
        (self.folder / "walk.c3d").write_bytes(self.c3d.read_bytes())
        labels = json.loads(self.good("info", "walk.c3d", "--json").out)["labels"]
        tasks = "".join(f'<IKMarkerTask name="{name}"><apply>true</apply><weight>{1 + i}</weight></IKMarkerTask>' for i, name in enumerate(labels))
        self.write("tasks.xml", f"<OpenSimDocument><IKTaskSet><objects>{tasks}</objects></IKTaskSet></OpenSimDocument>".encode())
        weights = ("--tasks", "tasks.xml", "--weight", f"{labels[0]}=9")
        server = self.serve("walk.c3d", "--model", self.model, *weights)
        post = {"method": "POST", "Origin": server.origin, "Content_Type": "application/json"}
        self.assertEqual(server.request("/api/trial/1/angles", body=b'{"do": "solve"}', **post)[0], 202)
        state = {"state": "waiting"}
        while state["state"] in ("waiting", "solving"):
            state = server.json("angles")[1]
        self.good("ik", "-m", self.model, "-t", "walk.c3d", "-o", "Q.mot", *weights)
        self.assertEqual(json.loads((self.folder / "Q_report.json").read_text())["kinemark_set"], state["solutions"]["now"]["set"])
        self.refused(3, "walk.c3d", "serve", "walk.c3d", "--tasks", "walk.c3d")
        self.refused(2, "WEIGHT", "serve", "walk.c3d", "--weight", "A")
        self.refused(4, "there is no folder none", "serve", "walk.c3d", "--geometry", "none")

    def test_what_is_no_recording_of_markers_has_no_edits(self):
        server = self.serve(self.study / "q.mot", self.write("bad.trc", b"nothing"))
        for trial in (1, 2):
            status, answer = server.json("edits", trial)
            self.assertEqual(status, 422)
            self.assertTrue(answer["error"])
        self.assertNotIn("\"editing\":", server.request("/trial/1")[2])

    def test_a_journal_that_is_damaged_is_a_sentence_on_the_page(self):
        recording = self.write("walk.trc", self.trc.read_bytes())
        self.write("walk_edits.jsonl", b"nonsense\n")
        server = self.serve(recording)
        data = json.loads(report_data(server.request("/trial/1")[2]))
        self.assertIn("walk_edits.jsonl: line 1", data["editing"]["refused"])
        self.assertEqual(server.edit(0, {"do": "undo"})[0], 422)

    def test_kill_9_leaves_nothing_behind(self):
        self.write("b.trc", self.trc.read_bytes())
        before = listing(self.folder)
        server = self.serve(self.folder)
        self.trials(server)
        self.assertEqual(server.request("/trial/1")[0], 200)
        children = Path(f"/proc/{server.process.pid}/task/{server.process.pid}/children")
        self.assertEqual(children.read_text() if children.exists() else "", "")
        self.assertEqual(server.end(signal.SIGKILL)[0], -signal.SIGKILL)
        self.assertEqual(listing(self.folder), before)
        again = self.serve(self.folder, "--port", server.port)
        self.assertEqual(again.request("/")[0], 200)
        self.assertEqual(again.request(server.session + "/", known=False)[0], 401, "of another run")

    def desktop(self, *options):
        """(the server, what the browser got) in a session with a display."""
        self.write("xdg-open", f'#!/bin/sh\nprintf %s "$1" > "{self.folder}/part"\nmv "{self.folder}/part" "{self.folder}/opened"\n').chmod(0o700)
        environment = {**os.environ, "DISPLAY": ":0", "PATH": f"{self.folder}:{os.environ['PATH']}"}
        server = Server(PROGRAM, self.c3d, *options, cwd=self.folder, environment=environment)
        self.addCleanup(server.__exit__)
        return server, self.folder / "opened"

    def test_a_browser_is_opened_with_a_token_that_is_good_once(self):
        server, opened = self.desktop()
        for _ in range(3000):
            if opened.exists():
                break
            time.sleep(0.01)
        address = opened.read_text()
        token = address.partition("token=")[2]
        self.assertEqual(address, f"http://{server.name}/?token={token}")
        self.assertNotEqual(token, server.token, "others see what programs are run with")
        self.assertEqual(server.request(f"/?token={token}", known=False)[0], 303)
        self.assertEqual(server.request(f"/?token={token}", known=False)[0], 401)
        self.assertEqual(server.request("/")[0], 200)

    def test_no_browser_is_opened_when_none_is_wanted(self):
        server, opened = self.desktop("--no-open")
        self.assertEqual(server.request("/")[0], 200)
        self.assertEqual(server.end()[0], 143)
        self.assertFalse(opened.exists())
