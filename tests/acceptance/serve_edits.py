#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Edits through `kinemark serve`: nothing acknowledged is lost, undo and redo are exact, `kinemark run` gives the same, strangers change nothing.

    serve_edits.py history    100 edits from a fixed seed: undo all, redo all, reload; `kinemark run`
    serve_edits.py kills      the server killed by kill -9 while it is edited
    serve_edits.py strangers  who may not edit, and what is no edit
    serve_edits.py angles     joint angles of what was edited, and the command's
    serve_edits.py hour       memory while an hour of 16 markers at 240 Hz is edited

Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "cli"), str(HERE)]

import serving
from serve import make_hour
from serving import Server
from support import PROGRAM, run
from rows import exit_status, row

serving.SECONDS = 600  # an hour is edited on a busy machine, too
EDITS = 100
KILLS = 50
MOST_HOUR_MB = 4000
HOSTILE = "</script><img onerror=alert(1) src=x>"


def good(*arguments, cwd):
    ran = run(*arguments, cwd=cwd)
    if ran.status != 0:
        raise RuntimeError(f"kinemark {' '.join(map(str, arguments))}: {ran.err}")
    return ran


def serve(recording):
    return Server(PROGRAM, recording, "--no-open", cwd=recording.parent)


def record(scratch, seconds):
    good("simulate", "subject", "-o", "in", "--duration", seconds, "--dropout-random", 0.05, cwd=scratch)
    recording = scratch / "walk.c3d"
    shutil.copy(scratch / "in" / "markers.c3d", recording)
    return recording


# History


def random_edit(moments, labels, filled, first, last):
    """An operation that may or may not apply."""
    a, b = moments.sample(labels, 2)
    start = moments.randint(first, last)
    where = {"first": start, "last": min(last, start + moments.randint(0, 20))}
    event = {"label": "Foot Strike", "context": "Left", "time_s": moments.choice([0.05, 0.08])}
    return moments.choice([
        {"do": "swap", "marker": a, "with": b, **where}, {"do": "swap", "marker": a, "with": b, "first": start},
        {"do": "cut", "marker": a, **where}, {"do": "cut", "marker": a, **where},
        {"do": "fill", "marker": a, "method": moments.choice(["linear", "cubic", "pchip", "rigid"])}, {"do": "unfill", "marker": moments.choice(filled or [a])},
        {"do": "relabel", "marker": a, "to": f"new{moments.randint(0, 9)}", **where}, {"do": "relabel", "marker": a, "to": f"whole{moments.randint(0, 99)}"},
        {"do": "mark", **event}, {"do": "mark", **event}, {"do": "delete", **event}, {"do": "move", **event, "to_s": moments.choice([0.05, 0.08, 0.12])},
        {"do": "region", "name": moments.choice(["gait", "turn"]), **where}, {"do": "crop", "first": first + moments.randint(0, 2)},
    ])  # fmt: skip


def state_of(server):
    """What a page that is loaded anew holds, apart from how it came to it."""
    _, data = server.json("data")
    return {"summary": data["summary"], "scene": data["scene"], "digest": data["editing"]["digest"], "regions": data["editing"]["regions"],
            "changes": data["editing"]["changes"]["all"]}  # fmt: skip


def history(scratch):
    recording = record(scratch, 1)
    original = recording.read_bytes()
    facts = json.loads(good("info", recording, "--json", cwd=scratch).out)
    labels, first = facts["labels"], facts["first_frame"]
    last = first + facts["frames"] - 1
    moments = random.Random(17)
    kinds, filled, tried, state = set(), [], 0, None
    with serve(recording) as server:
        recorded = state_of(server)
        made = 0
        while made < EDITS and tried < 20 * EDITS:
            tried += 1
            edit = random_edit(moments, labels, filled, first, last)
            status, answer = server.edit(made, edit)
            if status == 200:
                made, state = made + 1, answer
                kinds.add(edit["do"])
                if edit["do"] == "fill":
                    filled.append(edit["marker"])
                if edit["do"] == "relabel":
                    labels = sorted({*labels, edit["to"]})
            elif status != 422 or not answer["error"]:
                raise RuntimeError(f"{status}: {answer}")
        row(made == EDITS and len(kinds) == 10, f"edits through the server, and operations among them, of {tried} tried", f"{EDITS} and 10", f"{made} and {len(kinds)}")
        after = state_of(server)
        undone = [server.edit(EDITS + i, {"do": "undo"})[0] for i in range(EDITS)]
        row(undone == [200] * EDITS and state_of(server) == recorded, "all undone one by one: the page's data", "as recorded", "as recorded" if state_of(server) == recorded else "others")
        redone = [server.edit(2 * EDITS + i, {"do": "redo"})[0] for i in range(EDITS)]
        row(redone == [200] * EDITS and state_of(server) == after, "all redone one by one: the page's data", "the same", "the same" if state_of(server) == after else "others")
        row(after["scene"] != recorded["scene"], "edits changed something", "yes", "yes" if after["scene"] != recorded["scene"] else "no")
    with serve(recording) as server:
        again = state_of(server)
    row(again == after, "another server reads all anew: the page's data", "the same", "the same" if again == after else "others")
    row(recording.read_bytes() == original, "the recording's own bytes", "unchanged", "unchanged" if recording.read_bytes() == original else "changed")
    shown = json.loads(good("edit", recording, "--list", "--json", cwd=scratch).out)
    row(shown["digest"] == state["digest"] and len(shown["edits"]) == 3 * EDITS, "`kinemark edit --list`: the state, and lines in the journal",
        f"the same and {3 * EDITS}", f"{'the same' if shown['digest'] == state['digest'] else 'another'} and {len(shown['edits'])}")
    good("clean", recording, "clean.c3d", "--edits", "walk_edits.jsonl", "--gaps", "cubic", cwd=scratch)
    (scratch / "study.toml").write_text(
        'steps = ["clean"]\n[clean]\nedits = "beside"\ngaps = "cubic"\n[[subject]]\nname = "S"\ntrials = ["walk.c3d"]\n', encoding="utf-8"
    )
    good("run", "study.toml", cwd=scratch)
    same = (scratch / "results/S/walk/clean.c3d").read_bytes() == (scratch / "clean.c3d").read_bytes()
    row(same, "`kinemark run` and `clean --edits`", "same bytes", "same bytes" if same else "other bytes")
    good("convert", recording, "edited.c3d", "--edits", "beside", cwd=scratch)
    counts = {m["name"]: sum(n for s, n in m["states"].items() if s not in ("missing", "rejected")) for m in after["summary"]["markers"]}
    edited = json.loads(good("info", "edited.c3d", "--json", cwd=scratch).out)
    row(edited["labels"] == list(counts) and edited["frames"] == after["summary"]["frames"], "`convert --edits`: markers and frames as on the page",
        f"{len(counts)} and {after['summary']['frames']}", f"{len(edited['labels'])} and {edited['frames']}")


# Kills


def kills(scratch):
    recording = record(scratch, 0.2)
    original = recording.read_bytes()
    moments = random.Random(18)
    acknowledged, lost, odd, unready = [], 0, 0, 0
    for _ in range(KILLS):
        with serve(recording) as server:
            status, state = server.json("edits")
            if status != 200:
                unready += 1
                break
            there = [edit["name"] for edit in state["edits"]]
            lost += len(set(acknowledged) - set(there))
            odd += len(there) - len(set(there)) + (len(there) > len(acknowledged) + 1)
            acknowledged = there
            alive, timer = len(acknowledged) + moments.randint(0, 8), None
            while True:
                if timer is None and len(acknowledged) >= alive:
                    timer = threading.Timer(moments.uniform(0.0, 0.015), lambda process=server.process: process.send_signal(signal.SIGKILL))
                    timer.start()
                name = f"r{len(acknowledged)}"
                try:
                    status, _ = server.edit(len(acknowledged), {"do": "region", "name": name, "first": 1, "last": 2})
                except OSError:
                    break
                if status != 200:
                    break
                acknowledged.append(name)
            timer.join()
    listed = [edit["name"] for edit in json.loads(good("edit", recording, "--list", "--json", cwd=scratch).out)["edits"]]
    lost += len(set(acknowledged) - set(listed))
    row(lost == 0 and unready == 0 and len(acknowledged) > 2 * KILLS, f"kill -9 of the server while editing, {KILLS} moments: acknowledged edits lost", "0",
        f"{lost} of {len(acknowledged)}")
    row(odd == 0, "journals with an edit twice, or more than one beyond the acknowledged", "0", f"{odd}")
    row(recording.read_bytes() == original, "the recording's own bytes", "unchanged", "unchanged" if recording.read_bytes() == original else "changed")


# Angles


def ask_angles(server, what, trial=1):
    body = json.dumps({"do": what}).encode()
    status, _, text = server.request(f"/api/trial/{trial}/angles", method="POST", body=body, Origin=f"http://{server.name}", Content_Type="application/json")
    return status, json.loads(text)


def settled(server):
    """The state once nothing is under way."""
    while True:
        state = server.json("angles")[1]
        if state["state"] not in ("waiting", "solving"):
            return state
        time.sleep(0.02)


def page_data(html):
    text = re.search(r'<script type="application/json" id="kinemark-data">(.*?)</script>', html, re.DOTALL)[1]
    return json.loads(text)


def angles(scratch):
    recording = record(scratch, 2)
    original = recording.read_bytes()
    model = scratch / "subject.osim"
    with serve(recording) as server:
        row(ask_angles(server, "solve")[0] == 422 and server.json("angles")[1]["model"] is None, "no body model: solving", "422, a sentence", server.json("angles")[1]["said"][:60])
        shutil.copy(scratch / "in" / "model.osim", model)
        labels = json.loads(good("info", recording, "--json", cwd=scratch).out)["labels"]
        for i, edit in enumerate(({"do": "swap", "marker": labels[0], "with": labels[1], "first": 30, "last": 60},
                                  {"do": "cut", "marker": labels[2], "first": 80, "last": 90}, {"do": "crop", "first": 5})):  # fmt: skip
            server.edit(i, edit)
        begun, state = ask_angles(server, "solve")[0], settled(server)
        row(begun == 202 and state["state"] == "solved", "solving the edited recording", "202, then solved", f"{begun}, then {state['state']}")
        shown = {which: page_data(server.request(f"/trial/1/angles/{which}")[2]) for which in ("now", "recorded")}
        row(shown["now"]["series"]["coordinates"] != shown["recorded"]["series"]["coordinates"], "the edits change angles", "yes", "yes" if shown["now"] != shown["recorded"] else "no")
        for what, edits in (("now", ()), ("recorded", ("--edits", "none"))):
            good("ik", "-m", model, "-t", recording, *edits, "-o", f"{what}.mot", "--report", f"{what}.html", cwd=scratch)
            same = json.loads((scratch / f"{what}_report.json").read_text())["kinemark_set"] == state["solutions"][what]["set"]
            drawn = page_data((scratch / f"{what}.html").read_text())["series"] == shown[what]["series"]
            row(same and drawn, f"`kinemark ik {' '.join(edits)}` ({what})", "same set, same curves", f"{'same' if same else 'another'} set, {'same' if drawn else 'other'} curves")
        good("convert", recording, "edited.c3d", "--edits", "beside", cwd=scratch)
        good("ik", "-m", model, "-t", "edited.c3d", "-o", "file.mot", cwd=scratch)
        (scratch / "study.toml").write_text(
            f'steps = ["ik"]\n[ik]\nmodel = "{model.name}"\nedits = "beside"\n[[subject]]\nname = "S"\ntrials = ["{recording.name}"]\n', encoding="utf-8"
        )
        good("run", "study.toml", cwd=scratch)
        numbers = [table(scratch / name) for name in ("now.mot", "file.mot", "results/S/walk/ik.mot")]
        for name, other in zip(("`convert --edits`, then `ik`", "`kinemark run` with edits under [ik]"), numbers[1:], strict=True):
            apart = max(abs(a - b) for a, b in zip(numbers[0], other, strict=True))
            row(apart <= 1e-9, f"{name}: largest difference of angles and positions", "<= 1e-9", f"{apart:.1e} of {len(other)}")
        ask_angles(server, "solve")
        stopped, again = ask_angles(server, "stop")[0], settled(server)
        row(stopped == 202 and again["state"] in ("stopped", "solved") and again["solutions"]["now"]["set"] == state["solutions"]["now"]["set"], "stopped: the solution from before", "still there",
            "still there" if again["solutions"]["now"] else "gone")
        ours, target = f"http://{server.name}", "/api/trial/1/angles"
        asked = {"method": "POST", "body": b'{"do":"solve"}', "Content_Type": "application/json"}
        refused = [server.request(target, **{**asked, "Origin": "http://evil.example"})[0], server.request(target, known=False, Origin=ours, **asked)[0],
                   server.request("/trial/1/angles/now", known=False)[0], server.request(target, **{**asked, "Content_Type": "text/plain"}, Origin=ours)[0]]  # fmt: skip
        row(refused == [403, 401, 401, 415], "foreign Origin, no token, no token, a form's content type", "403, 401, 401, 415", ", ".join(map(str, refused)))
    left = sorted(p.name for p in scratch.iterdir())
    row(recording.read_bytes() == original and not [n for n in left if n.startswith("walk") and n not in ("walk.c3d", "walk_edits.jsonl")], "what the server wrote", "the journal alone", "the journal alone")


def table(path):
    """All numbers of a motion file."""
    lines = path.read_text().split("endheader\n")[1].splitlines()[1:]
    return [float(cell) for line in lines for cell in line.split()]


# An hour


def memory_mb(pid, what):
    return int(re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def hour(scratch):
    recording = scratch / "hour.trc"
    make_hour(recording)
    with serve(recording) as server:
        pid = server.process.pid
        server.request("/trial/1")
        shown, peaks, made = memory_mb(pid, "VmHWM"), [], 0
        swap = {"do": "swap", "marker": "M5", "with": "M6", "first": 1000}
        for edit in ({"do": "swap", "marker": "M1", "with": "M2", "first": 400_000}, {"do": "cut", "marker": "M3", "first": 1000, "last": 2000},
                     {"do": "fill", "marker": "M3", "method": "linear"}, {"do": "relabel", "marker": "M4", "to": "KNEE"}, {"do": "undo"}, {"do": "redo"},
                     swap, {"do": "undo"}, swap, {"do": "undo"}, swap, {"do": "undo", "count": 2}):  # fmt: skip
            status, answer = server.edit(made, edit)
            if status != 200:
                row(False, f"{edit['do']} of an hour", 200, f"{status}: {answer['error']}")
                return
            made += 1
            peaks.append(memory_mb(pid, "VmHWM"))
        server.json("data")
        edited = memory_mb(pid, "VmHWM")
        row(edited <= MOST_HOUR_MB, f"an hour of 16 markers at 240 Hz, {made} operations, data fetched: most memory", f"<= {MOST_HOUR_MB} MB",
            f"{edited:.0f} MB ({shown:.0f} for its page alone)")
        half = len(peaks) // 2
        row(peaks[-1] <= 1.05 * peaks[half - 1], f"the last {len(peaks) - half} operations: most memory against the first {half}", "<= 1.05 times", f"{peaks[-1] / peaks[half - 1]:.2f} times")


# Strangers


def strangers(scratch):
    recording = record(scratch, 0.2)
    journal = scratch / "walk_edits.jsonl"
    body = json.dumps({"expected": 0, "edit": {"do": "region", "name": "r", "first": 1, "last": 2}}).encode()
    with serve(recording) as server:
        ours, target = f"http://{server.name}", "/api/trial/1/edits"

        def status(**changes):
            asked = {"method": "POST", "body": body, "Origin": ours, "Content_Type": "application/json", **changes}
            return server.request(asked.pop("target", target), **asked)[0]

        for check, asked, measured in (
            ("foreign Origin", 403, status(Origin="http://evil.example")),
            ("Origin null, as of a sandboxed page", 403, status(Origin="null")),
            ("no Origin", 403, status(Origin=None)),
            ("foreign Host", 421, status(Host="evil.example")),
            ("no token", 401, status(known=False)),
            ("wrong token", 401, status(known=False, Authorization=f"Bearer {'0' * 32}")),
            ("the content type that a form of a foreign page can send", 415, status(Content_Type="text/plain")),
            ("body of 1 MB", 413, status(body=bytes(1_000_000))),
            ("body of 10 kB", 413, status(body=b" " * 10_000)),
            ("length told as 10 GB", 413, status(body=b"", Content_Length=10_000_000_000)),
            ("no JSON", 400, status(body=b"\xff\xfe{")),
            ("4,000 brackets", 400, status(body=b"[" * 4000)),
            ("no operation", 400, status(body=b'{"expected":0,"edit":{"do":"explode"}}')),
            ("a marker that is not there", 422, status(body=b'{"expected":0,"edit":{"do":"cut","marker":"NOSE"}}')),
            ("operations that are not there", 409, status(body=body.replace(b'"expected": 0', b'"expected": 7'))),
            ("another trial", 404, status(target="/api/trial/2/edits")),
            ("a path", 404, status(target="/api/trial/../edits")),
            ("PUT", 405, status(method="PUT")),
            ("the list", 405, status(target="/")),
        ):
            row(asked == measured, f"POST: {check}", asked, measured)
        row(not journal.exists(), "the journal after all that", "none", "there" if journal.exists() else "none")
        label = json.loads(good("info", recording, "--json", cwd=scratch).out)["labels"][0]
        made, state = server.edit(0, {"do": "relabel", "marker": label, "to": HOSTILE})
        page = server.request("/trial/1")[2]
        types = server.request(target)[1]["Content-Type"]
        text = made == 200 and state["edits"][0]["to"] == HOSTILE and types == "application/json" and "<img onerror" not in page and "\\u003cimg onerror" in page
        row(text, f"a marker named {HOSTILE}", "shown as text", "shown as text" if text else "not")
        row(status(body=body.replace(b'"expected": 0', b'"expected": 1')) == 200, "the rightful page afterwards", 200, "200" if journal.exists() else "none")


def main():
    what = {"history": history, "kills": kills, "strangers": strangers, "angles": angles, "hour": hour}.get(sys.argv[1] if len(sys.argv) > 1 else "")
    if what is None:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as folder:
        what(Path(folder))
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
