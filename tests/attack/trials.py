# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The kinds of attack. Each takes a Scene and a Random, and gives (what was done, what is wrong with what happened)."""

import collections
import contextlib
import os
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

import damage
import judge
from commands import COMMANDS

WRITERS = tuple(command for command in COMMANDS if command.writes)
RENAMES = "rename,renameat,renameat2,link,linkat"


def listing(folder):
    """Every path below a folder with its content, so that a change of any kind shows."""
    folder = os.fsencode(folder)
    found = {}
    for root, folders, files in os.walk(folder):
        for name in folders:
            found[name_of(os.path.join(root, name), folder)] = None
        for name in files:
            path = os.path.join(root, name)
            found[name_of(path, folder)] = os.readlink(path) if os.path.islink(path) else Path(os.fsdecode(path)).read_bytes()
    return found


def name_of(path, folder):
    return os.fsdecode(os.path.relpath(path, folder))


def limited(file_bytes=None, memory_bytes=None):
    """Limits of a child: the size of its files, as a full disk sets it, and its memory."""

    def limit():
        if file_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))
        if memory_bytes is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return limit


class Scene:
    """The program, sound files, and an empty folder in which one trial runs."""

    def __init__(self, program, sound, folder, seconds=60, memory_bytes=None):
        self.program, self.sound, self.folder = program, sound, folder
        self.seconds, self.memory_bytes = seconds, memory_bytes
        self.seen = collections.Counter()  # what a trial came upon, where that is not certain
        shutil.copytree(sound, folder, dirs_exist_ok=True)

    def start(self, words, file_bytes=None, wrapper=()):
        return subprocess.Popen(
            [*wrapper, self.program, *words],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            preexec_fn=limited(file_bytes, self.memory_bytes),
        )

    def wait(self, process):
        """(exit status, standard output, standard error) of a run; one that does not end is killed and has no status."""
        try:
            out, err = process.communicate(timeout=self.seconds)
            return process.returncode, out, err
        except subprocess.TimeoutExpired:
            process.kill()
            return None, *process.communicate()

    def end(self, process, before):
        """Waits for a run and gives what it did."""
        return judge.Ran(*self.wait(process), before, listing(self.folder))

    def run(self, *words, **options):
        before = listing(self.folder)
        return self.end(self.start(words, **options), before)

    def results(self, command):
        """What a command writes when nothing goes wrong: (its run, {path: content})."""
        before = listing(self.folder)
        ran = self.run(*command.words)
        made = {name: content for name, content in ran.after.items() if name not in before}
        return ran, made

    def forget(self, made):
        """Takes results away again."""
        for name in sorted(made, reverse=True):
            path = self.folder / name
            path.rmdir() if path.is_dir() else path.unlink()


def broken_file(scene, random):
    """A damaged input."""
    command = random.choice(COMMANDS)
    name = random.choice(command.inputs)
    path = scene.folder / name
    content, ways = damage.damaged(path.read_bytes(), random)
    path.write_bytes(content)
    as_json = random.random() < 0.5
    words = [*command.words, *(["--json"] if as_json else [])]
    ran = scene.run(*words)
    # What is wrong may be that two inputs do not fit together: then the sentence may name the other one.
    named = name if len(command.inputs) == 1 and command.words[1] == name else None
    return f"{' '.join(words)} with {name}: {ways}", judge.findings(ran, named, as_json, answers=command.name == "validate")


def small_disk(scene, random):
    """Files cannot grow beyond a size: everything is written, or nothing."""
    command = random.choice(WRITERS)
    _, made = scene.results(command)
    largest = max((len(content) for content in made.values() if content is not None), default=0)
    scene.forget(made)
    old = random.random() < 0.5  # an older result stands there, and must stay as it is
    if old:
        scene.run(*command.words)
    size = random.randrange(max(2, int(1.1 * largest)))
    words = [*command.words, *(["--force"] if old else [])]
    ran = scene.run(*words, file_bytes=size)
    problems = judge.findings(ran, statuses=(0, 1, 4))
    if ran.status in (0, 1) and size < largest:
        problems.append(f"exit status {ran.status}, although a file of {largest} bytes was to be written")
    return f"{' '.join(words)} with files of at most {size} bytes", problems


def is_whole(scene, name, content, made):
    """Whether a result is complete: one that holds times can be read, any other is as long as the complete one."""
    if name.endswith(".json"):
        return not judge.of_json(content)
    if name.endswith(".nwb"):
        return scene.run("validate", name).status in (0, 1)
    return content is None or len(content) == len(made[name])


def torn(scene, after, before, made):
    """Sentences on files that are neither as they were nor as they were to become (`made`)."""
    changed = {name: content for name, content in after.items() if name in made and content != before.get(name)}
    return [f"'{name}' is half-written" for name, content in changed.items() if not is_whole(scene, name, content, made)]


def after_death(scene, command, before, made):
    """What is wrong in the folder after a program died, and once another one ran there."""
    after = listing(scene.folder)
    problems = torn(scene, after, before, made)
    missing = [name for name in before if name not in after]
    problems += [f"'{name}' is gone" for name in missing if name not in made]
    again = scene.run(*command.words, "--force")
    if again.status not in (0, 1):
        problems.append(f"the next run ends with {again.status}: {again.err.decode(errors='replace').strip()}")
    return problems + judge.leftovers(again.after)


def killed(scene, random):
    """kill -9 at any moment; then the same command again."""
    command = random.choice(WRITERS)
    began = time.monotonic()
    _, made = scene.results(command)
    took = time.monotonic() - began
    if random.random() < 0.5:
        scene.forget(made)
    before = listing(scene.folder)
    process = scene.start([*command.words, "--force"])
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(timeout=random.uniform(0, 1.1 * took))
    process.kill()
    scene.end(process, before)
    return f"{' '.join(command.words)} killed", after_death(scene, command, before, made)


def killed_between_renames(scene, random):
    """kill -9 before the n-th rename of a set of files: a set that is half old and half new is told by `validate`."""
    command = random.choice([command for command in WRITERS if command.other])
    new = [*command.words, "--force"]
    scene.run(*new)
    made = listing(scene.folder)
    scene.run(*new, *command.other)
    before = listing(scene.folder)
    number = random.randint(2, 4)  # the first one leaves all as it was
    inject = f"inject={RENAMES}:signal=KILL:when={number}"
    scene.run(*new, wrapper=("strace", "-f", "-qq", "-o", "/dev/null", "-e", f"trace={RENAMES}", "-e", inject))
    after = listing(scene.folder)
    changed = [name for name in made if made[name] != before.get(name) and ".kinemark-" not in name]
    fresh = [name for name in changed if after.get(name) == made[name]]
    stale = [name for name in changed if after.get(name) == before.get(name)]
    problems = []
    if fresh and stale:
        scene.seen["mixtures"] += 1
        judged = scene.run("validate", command.writes)
        if b"was not written together with" not in judged.err:
            problems.append(f"old ({', '.join(stale)}) beside new files ({', '.join(fresh)}) and no word of it")
    return f"{' '.join(new)} killed at rename {number}", problems + after_death(scene, command, before, made)


def asked_to_end(scene, random):
    """SIGINT, SIGTERM, SIGHUP at any moment: nothing is left, or everything is there."""
    command = random.choice(WRITERS)
    began = time.monotonic()
    _, made = scene.results(command)
    took = time.monotonic() - began
    scene.forget(made)
    before = listing(scene.folder)
    number = random.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
    process = scene.start(command.words)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(timeout=random.uniform(0, 1.1 * took))
    process.send_signal(number)
    ran = scene.end(process, before)
    problems = judge.leftovers(ran.after) + torn(scene, ran.after, before, made)
    if ran.status is None:
        problems.append("does not end")
    elif ran.status not in (0, 1, 128 + number, -number):
        problems.append(f"exit status {ran.status}")
    elif ran.status not in (0, 1) and ran.after != before and set(ran.after) != {*before, *made}:
        problems.append("a part of the results is left")
    return f"{' '.join(command.words)}, {number.name}", problems


def two_writers(scene, random):
    """Two programs write the same output without --force: one wins, the other says so."""
    command = random.choice(WRITERS)
    first, second = scene.start(command.words), scene.start(command.words)
    statuses = sorted(str(scene.wait(process)[0]) for process in (first, second))
    good = [status for status in statuses if status in ("0", "1")]
    problems = [] if len(good) == 1 and "4" in statuses else [f"exit statuses {' and '.join(statuses)}"]
    return f"twice at once: {' '.join(command.words)}", problems + judge.leftovers(listing(scene.folder))


def hostile_name(scene, random):
    """A sound file under a name that files should not have."""
    command = random.choice([c for c in COMMANDS if c.name not in ("report", "calibrate")])
    name = random.choice(command.inputs)
    hostile = os.fsdecode(random.choice(damage.NAMES) + os.path.splitext(name)[1].encode())
    (scene.folder / name).rename(scene.folder / hostile)
    as_json = random.random() < 0.5
    words = [os.path.join(".", hostile) if word == name else word for word in command.words]
    inner = hostile if name not in command.words else None  # named by a setup only: then it is not there
    ran = scene.run(*words, *(["--json"] if as_json else []))
    problems = judge.findings(ran, None, as_json, answers=command.name == "validate")
    if ran.status not in (0, 1) and inner is None:
        problems.append(f"exit status {ran.status} for a sound file")
    return f"{' '.join(words)!r}{' --json' if as_json else ''}", problems


# Kind: its share of the trials.
KINDS = {
    broken_file: 60,
    hostile_name: 10,
    small_disk: 8,
    two_writers: 7,
    killed: 6,
    asked_to_end: 6,
    killed_between_renames: 3,
}
