# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What comes between a command and its files, for test_transactions.py and tests/acceptance/transactions.py: a disk that is full at any of
them, a kill before each of the renames that give them their names. Afterwards all of them are there, or what was there before."""

import collections
import functools
import os
import re
import shutil
import subprocess

from pairs_kept import Bench
from support import PROGRAM, listing, run
from writing import file_size_limit, fill_levels, hidden

RENAMES = "rename,renameat,renameat2,link,linkat"
# Of a command with several recordings each is a transaction of its own, a server ends when it is asked to, and `edit` adds to a file.
LEFT_OUT = {"convert several", "clean several", "ik of several", "serve", "edit"}
SAYS_HOW_IT_RAN = (".json", ".html", ".nwb")  # for how long and by which words
CALLED = re.compile(r"^(?:\d+ +)?((?:rename|link)\w*)\((.*)\) *= (-?\d+)")


def files_below(folder):
    return {name: content for name, content in listing(folder).items() if content is not None and ".kinemark-" not in name}


def parts(after, before, made):
    """(names that are as before, names that are as made, names that are neither) of the files that a command changes."""
    changed = {name for name in made if made[name] != before.get(name)}
    old = {name for name in changed if after.get(name) == before.get(name)}
    new = {name for name in changed - old if after.get(name) == made[name] or (name in after and name.endswith(SAYS_HOW_IT_RAN))}
    return old, new, changed - old - new


@functools.cache
def can_trace():
    """Whether strace may watch programs here."""
    if shutil.which("strace") is None:
        return False
    return subprocess.run(["strace", "-qq", "-o", "/dev/null", "true"], capture_output=True, check=False).returncode == 0


def clear(folder):
    folder.mkdir(exist_ok=True)
    for path in folder.iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()


class Transactions(Bench):
    """The commands of Bench, each with what it writes into an empty `out/`."""

    def names(self):
        return [name for name in self.commands if name not in LEFT_OUT]

    def words(self, name):
        return [*map(str, self.commands[name]), "--quiet"]

    def again(self, *words, **options):
        return run(*words, cwd=self.folder, **options)

    def results(self, name):
        clear(self.outputs)
        ran = self.again(*self.words(name))
        assert ran.status in (0, 1), (name, ran.err)
        return files_below(self.outputs)

    def put_old(self, made):
        """Other files under the names of all that the command writes."""
        clear(self.outputs)
        for name in made:
            path = self.outputs / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(b"old " + name.encode())
        return files_below(self.outputs)

    def replaced(self, name, made):
        self.put_old(made)
        self.again(*self.words(name), "--force")
        return files_below(self.outputs)

    def begin(self, made, replacing):
        """Nothing, or old files: (what is there, words)."""
        if replacing:
            return self.put_old(made), ["--force"]
        clear(self.outputs)
        return {}, []

    def inputs_changed(self):
        return [path.name for path, content in self.contents.items() if path.read_bytes() != content]

    def on_full_disks(self, name, levels=3):
        """(sentences on what is wrong, runs) of a command whose files may not grow beyond some sizes."""
        made, wrong, runs = self.results(name), [], 0
        for level in fill_levels([len(content) for content in made.values()], levels):
            for replacing in (False, True):
                before, force = self.begin(made, replacing)
                ran = self.again(*self.words(name), *force, preexec_fn=file_size_limit(level))
                runs += 1
                where = f"{name}, files of at most {level} bytes{', replacing' if replacing else ''}"
                if ran.status != 4 or "cannot be" not in ran.err:
                    wrong.append(f"{where}: exit status {ran.status}, {ran.err.strip()[-200:]!r}")
                if files_below(self.outputs) != before:
                    wrong.append(f"{where}: left {sorted(files_below(self.outputs))}")
                wrong += [f"{where}: '{left}' is left over" for left in hidden(self.outputs)]
        return wrong + [f"{name}: changed {path}" for path in self.inputs_changed()], runs

    def traced(self, words, *options):
        return subprocess.run(
            ["strace", "-f", "-qq", "-e", f"trace={RENAMES},unlink", *options, PROGRAM, *words],
            cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=120,
        )

    def moments(self, name):
        """(system call, number of that call) for each name that is given in `out/`; strace counts every call by itself."""
        clear(self.outputs)
        log = self.folder / "renames.log"
        self.traced(self.words(name), "-o", log)
        found, count = [], collections.Counter()
        for line in log.read_text(errors="replace").splitlines():
            if match := CALLED.match(line):
                call, arguments, returned = match.groups()
                count[call] += 1
                if returned == "0" and ".kinemark-" not in re.findall(r'"([^"]*)"', arguments)[-1]:
                    found.append((call, count[call]))
        return found

    def kill_at(self, moment, words):
        call, number = moment
        self.traced(words, "-o", "/dev/null", "-e", f"inject={call}:signal=KILL:when={number}")

    def killed_at(self, name, made, moment, replacing):
        """What is wrong after a kill at a system call, once another command has written in each folder of the results."""
        before, force = self.begin(made, replacing)
        self.kill_at(moment, [*self.words(name), *force])
        for folder in sorted({os.path.dirname(path) for path in made}):
            if (self.outputs / folder).is_dir():
                other = self.outputs / folder / "of_another_command.csv"
                ran = self.again("convert", "in/walk.trc", other, "--quiet")
                other.unlink(missing_ok=True)
                if ran.status != 0:
                    return [f"the next run ends with {ran.status}: {ran.err.strip()}"]
        old, new, torn = parts(files_below(self.outputs), before, made)
        wrong = [f"'{left}' is left over" for left in hidden(self.outputs)]
        if torn or (old and new):
            wrong.append(f"{sorted(new)} are new, {sorted(old)} are as they were, {sorted(torn)} neither")
        return wrong

    def killed(self, name, most=None):
        """(sentences on what is wrong, kills) of a command that is killed before each name that it gives (the first and the last ones, where
        `most` says how many), and once all are given."""
        made, wrong, kills = {False: self.results(name)}, [], 0
        made[True] = self.replaced(name, made[False])
        moments = self.moments(name)
        if most is not None and len(moments) > most:
            moments = [moments[0], *moments[-(most - 1) :]]
        for moment in [*moments, ("unlink", 1)] if len(moments) > 1 else moments:
            for replacing in (False, True):
                kills += 1
                where = f"{name}, killed at {moment[0]} {moment[1]}{', replacing' if replacing else ''}"
                wrong += [f"{where}: {sentence}" for sentence in self.killed_at(name, made[replacing], moment, replacing)]
        return wrong + [f"{name}: changed {path}" for path in self.inputs_changed()], kills
