# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` of a device on the desk: trials recorded through HTTP, what is refused, and what a signal leaves behind."""

import json
import signal
import time

from serving import Server
from support import PROGRAM, CommandTest, report_data, run


class DeskTest(CommandTest):
    def serve(self, *arguments):
        server = Server(PROGRAM, *arguments, "--no-open", cwd=self.folder)
        self.addCleanup(server.__exit__)
        return server

    def ask(self, server, **request):
        """The state once that is done."""
        status, headers, body = server.request("/api/desk", "POST", json.dumps(request).encode(), Origin=server.origin, Content_Type="application/json")
        self.assertEqual((status, headers["Content-Type"]), (200, "application/json"), body)
        return json.loads(body)

    def state(self, server):
        return json.loads(server.request("/api/desk")[2])

    def until(self, server, true_of):
        for _ in range(3000):
            state = self.state(server)
            if true_of(state):
                return state
            time.sleep(0.01)
        raise AssertionError(f"it did not happen: {state['step']}, {state['message']}")

    def is_closed(self, recording):
        """It ends as a recording does that was closed."""
        info = run("info", recording, cwd=self.folder)
        self.assertEqual(info.status, 0, info.err)
        return "end               closed" in info.out


class Recorded(DeskTest):
    def test_a_folder_that_is_a_session_is_continued(self):
        self.good("acquire", "sim:rig?leds=2&fast", "--session", "day1", "--subject", "S1", "--trial", "01", "--frames", 20)
        server = self.serve("sim:rig?speed=10", "--record", "day1")
        state = self.ask(server, do="start", leds="2", rate_hz="", subject=self.state(server)["wanted"]["subject"], trial="01")
        self.assertEqual((state["step"], state["wanted"]["subject"], state["wanted"]["trial"]), ("live", "S1", "02"))
        self.ask(server, do="record")
        self.until(server, lambda s: s["live"]["acknowledged"] > 10)
        self.ask(server, do="stop")
        self.assertEqual(self.ask(server, do="keep")["kept"], ["day1/raw/02.mcap"])
        listed = [line for line in (self.folder / "day1" / "MANIFEST").read_text().splitlines() if "raw/" in line]
        self.assertEqual(len(listed), 2)

    def test_from_the_source_to_a_trial_that_is_kept_and_one_that_is_not(self):
        server = self.serve("sim:rig?speed=10", "--record", "day one")
        page = json.loads(report_data(server.request("/")[2]))
        self.assertEqual((page["summary"]["schema"], page["summary"]["source"]), ("kinemark.desk", "sim:rig?speed=10"))
        state = self.state(server)
        self.assertEqual((state["step"], state["device"]["cameras"], state["live"]), ("plan", 2, None))
        refused = self.ask(server, do="start", leds="4", rate_hz=5000)
        self.assertEqual(refused["step"], "plan")
        self.assertRegex(refused["message"], r"\d frames per second at most")
        state = self.ask(server, do="start", leds="hand, wrist", rate_hz="", subject="S1", trial="reach_01")
        self.assertEqual((state["step"], state["granted"]["leds"]), ("live", ["hand", "wrist"]))
        self.assertEqual(self.ask(server, do="intensity", led=1, value=0.5)["granted"]["intensity"], [1.0, 0.5])
        state = self.until(server, lambda s: s["live"]["frames"] > 50)
        self.assertEqual([len(led) for led in state["live"]["seen"]], [2, 2])
        self.assertGreater(state["live"]["seen"][0][0]["light_counts"], 0)
        self.assertFalse((self.folder / "day one").exists(), "nothing is recorded yet")
        self.assertEqual(self.ask(server, do="record")["step"], "recording")
        state = self.until(server, lambda s: s["live"]["acknowledged"] > 50)
        self.assertEqual((state["live"]["dropped_by_device"], state["live"]["dropped_here"]), (0, 0))
        state = self.ask(server, do="stop")
        self.assertEqual((state["step"], all(line["text"] for line in state["check"])), ("check", True))
        state = self.ask(server, do="keep")
        self.assertEqual((state["message"], state["kept"], state["wanted"]["trial"]), ("Kept: day one/reach_01.mcap", ["day one/reach_01.mcap"], "reach_02"))
        self.ask(server, do="record")
        self.ask(server, do="stop")
        self.assertTrue((self.folder / "day one/reach_02.mcap").exists())
        self.assertEqual(self.ask(server, do="discard")["message"], "Discarded: reach_02")
        self.assertEqual([path.name for path in (self.folder / "day one").iterdir()], ["reach_01.mcap"])
        self.assertTrue(self.is_closed(self.folder / "day one/reach_01.mcap"))

    def test_a_trial_whose_time_is_up_ends_without_a_page(self):
        server = self.serve("sim:rig?speed=10")
        self.ask(server, do="start", leds=2, duration_s=1, trial="alone")
        self.ask(server, do="record")
        path = self.folder / "alone.mcap"
        for _ in range(600):
            if path.exists() and self.is_closed(path):
                break
            time.sleep(0.05)
        self.assertEqual(self.state(server)["step"], "check")

    def test_a_signal_ends_and_keeps_the_trial(self):
        for step in ("live", "recording", "check"):
            server = self.serve("sim:rig?speed=10", "--record", step)
            self.ask(server, do="start", leds=2)
            if step != "live":
                self.ask(server, do="record")
                self.until(server, lambda s: s["live"]["acknowledged"] > 20)
            if step == "check":
                self.ask(server, do="stop")
            status, out, err = server.end(signal.SIGINT)
            self.assertEqual((status, out), (130, ""), err)
            self.assertIn("stopped", err.splitlines()[-1])
            self.assertEqual("kept " in err, step != "live", err)
            if step != "live":
                self.assertTrue(self.is_closed(self.folder / step / "01.mcap"))


class Refused(DeskTest):
    def test_what_is_no_request_is_a_sentence_and_does_nothing(self):
        server = self.serve("sim:rig")
        for body, kind, status in ((b"{}", "application/json", 400), (b'{"do": "fly"}', "application/json", 400), (b'{"do": "look"}', "text/plain", 415),
                                   (b'{"do": "open", "uri": "replay:/etc/passwd"}', "application/json", 400)):  # fmt: skip
            got, _, answer = server.request("/api/desk", "POST", body, Origin=server.origin, Content_Type=kind)
            self.assertEqual(got, status, answer)
            self.assertTrue(json.loads(answer)["error"])
        for target, method, known, origin, status in (("/api/desk", "POST", True, "http://evil.example", 403), ("/api/desk", "POST", False, server.origin, 401),
                                                      ("/api/desk", "GET", False, None, 401), ("/", "POST", True, server.origin, 405), ("/api/live", "GET", True, None, 404)):  # fmt: skip
            headers = {} if origin is None else {"Origin": origin}
            self.assertEqual(server.request(target, method, b'{"do": "start"}' if method == "POST" else b"", known=known, Content_Type="application/json", **headers)[0], status)
        self.assertEqual(self.state(server)["step"], "plan")

    def test_names_that_are_no_files_are_refused(self):
        server = self.serve("sim:rig?speed=10")
        self.ask(server, do="start", leds=2, trial="../up")
        state = self.ask(server, do="record")
        self.assertEqual(state["step"], "live")
        self.assertIn("/", state["message"])
        self.assertFalse((self.folder.parent / "up.mcap").exists())

    def test_a_device_that_cannot_be_opened_ends_the_command(self):
        for address, status in (("sim:rig?leds=x", 2), ("sim:rig?colour=red", 2)):
            done = run("serve", address, "--no-open", cwd=self.folder)
            self.assertEqual((done.status, done.out), (status, ""), done.err)
            self.assertEqual(len(done.err.splitlines()), 1, done.err)

    def test_what_belongs_to_markers_does_not_go_with_a_device(self):
        self.write("file", "x")
        for words, expected in ((("sim:rig", "sim:rig"), "served alone"), (("sim:rig", "--model=a.osim"), "--model is for markers"), (("sim:rig", "--omega=50"), "--omega are for markers"),
                                (("sim:rig", "--record=file"), "is a file; trials")):  # fmt: skip
            done = run("serve", *words, "--no-open", cwd=self.folder)
            self.assertEqual(done.status, 2, done.err)
            self.assertIn(expected, done.err)
