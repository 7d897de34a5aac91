# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Commands in the documentation: every one is understood by the program; those of docs/start are run, in their order."""

import re
import shlex
import shutil

from support import PROJECT, CommandTest, real_file, run

PAGES = [PROJECT / "README.md", *sorted((PROJECT / "docs").rglob("*.md"))]
RUNS_LONG = ("serve", "ik --markers sim:", "study")  # other tests run them


def commands_of(page):
    """The words of each command in the code of a page, without comments, redirections and placeholders for lists."""
    for block in re.findall(r"^```[a-z]*\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
        for line in block.splitlines():
            found = re.match(r"^(?:\$ )?(?:build/release/bin/)?kinemark (.*)$", line)
            if not found:
                continue
            text = re.split(r"\s+#", found[1])[0].split(" > ")[0].split(" | ")[0]
            words = shlex.split(text)
            if words and "..." not in words and words[0].islower():
                yield words


class DocsTest(CommandTest):
    def test_every_command_is_understood(self):
        count = 0
        for page in PAGES:
            if "decisions" in page.parts:
                continue
            for words in commands_of(page):
                if " ".join(words).startswith(RUNS_LONG):
                    words = [*words, "--help"]
                count += 1
                with self.subTest(page=page.relative_to(PROJECT).as_posix(), command=" ".join(words)):
                    ran = run(*words, cwd=self.folder)
                    if words[1] not in ("day1/", "cleaned/"):  # folders that are not here
                        self.assertNotEqual(ran.status, 2, ran.err)
                    for refusal in ("unknown option", "one argument too many", "is an option for", "is required"):
                        self.assertNotIn(refusal, ran.err)
                shutil.rmtree(self.folder)
                self.folder.mkdir()
        self.assertGreater(count, 150)

    def inputs(self):
        """What the pages of docs/start call their files."""
        folder = self.folder
        for name, source in (("walk.c3d", "btk-others/PiG_Motion3_FF.c3d"), ("standing.c3d", "btk-others/PiG_Calibration3_FF.c3d")):
            shutil.copy(real_file(source), folder / name)
        (folder / "adults").mkdir()
        for name in "abc":
            shutil.copy(folder / "walk.c3d", folder / "adults" / f"{name}.c3d")
        shutil.copy(self.model, folder / "subject.osim")
        shutil.copy(self.c3d, folder / "subject_walk.c3d")
        (folder / "session").mkdir()
        for seed in range(6):
            self.good("simulate", "macaque", "-o", "made", "--duration", 3, "--seed", seed + 1, "--force", "--quiet")
            shutil.copy(folder / "made/markers.c3d", folder / "session" / f"sub-{seed // 2 + 1:02}_ses-{seed % 2 + 1}_reach.c3d")

    def test_the_pages_for_a_start_run_as_they_stand(self):
        self.inputs()
        for name in ("gait-report", "reaching", "neural-data", "from-plug-in-gait"):
            commands = list(commands_of(PROJECT / f"docs/start/{name}.md"))
            self.assertGreater(len(commands), 2)
            for words in commands:
                with self.subTest(page=name, command=" ".join(words)):
                    only_prints = words[0] == "groups" and "-o" not in words
                    ran = run(*words, *([] if only_prints else ["--force"]), cwd=self.folder)
                    self.assertIn(ran.status, (0, 1), ran.err)
                    for option, name in zip(words, words[1:]):
                        if option in ("-o", "--output", "--report", "--write-events", "--write-cycles"):
                            self.assertTrue((self.folder / name).exists(), name)
