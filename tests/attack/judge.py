# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What the program may do whatever it is given: sentences for everything that it did and should not have done."""

import dataclasses
import json
import unicodedata

STATUSES = (0, 1, 2, 3, 4)
UNPRINTABLE = ("Cc", "Cf", "Cs", "Co", "Cn")  # categories of characters that a terminal does not show as a letter
ALLOWED = "\n\t\u200c\u200d"  # words of some languages need the joiners
LONGEST_LINE = 2000  # letters that a person may be asked to read in one line


@dataclasses.dataclass
class Ran:
    """One run: its exit status (negative: ended by that signal; None: it did not end), what it wrote, and the content of
    the folder that it ran in, before and after ({path: bytes, None for a folder})."""

    status: int | None
    out: bytes
    err: bytes
    before: dict
    after: dict


def of_text(name, raw, allowed=()):
    """Of what was written to the terminal; `allowed` are categories of characters that need not be letters."""
    try:
        text = raw.decode()
    except UnicodeDecodeError as error:
        return [f"{name} is no UTF-8 (byte {error.start})"]
    wrong = set(UNPRINTABLE) - set(allowed)
    found = next((c for c in text if c not in ALLOWED and unicodedata.category(c) in wrong), None)
    problems = [] if found is None else [f"{name} has the control character U+{ord(found):04X}"]
    if any(len(line) > LONGEST_LINE for line in text.splitlines()):
        problems.append(f"{name} has a line of more than {LONGEST_LINE} letters")
    return problems


def of_sanitizers(raw):
    return [word.decode() for word in (b"AddressSanitizer", b"LeakSanitizer", b"runtime error:", b"terminate called") if word in raw]


def of_json(raw):
    try:
        json.loads(raw)
    except ValueError as error:
        return [f"--json printed no JSON ({error})"]
    return []


def leftovers(folder):
    return [f"'{name}' is left over" for name in folder if ".kinemark-" in name]


def of_refusal(ran, named, answers):
    """Of a run that ended with 2, 3 or 4: one sentence, which names `named` if bad input was found, and nothing written;
    `answers`: what is wrong is the answer, and may stand on standard output, too."""
    lines = ran.err.decode(errors="replace").splitlines()
    sentences = [line for line in lines if line.startswith("kinemark: ")]
    problems = []
    if len(sentences) != 1 or lines[-1:] != sentences:
        problems.append(f"{len(sentences)} sentences, where one at the end was expected")
    elif ran.status == 3 and named is not None and named not in sentences[0]:
        problems.append(f"the sentence does not name {named}")
    if ran.out and not answers:
        problems.append("something on standard output although it failed")
    if ran.after != ran.before:
        problems.append("the folder is not as it was although it failed")
    return problems


def findings(ran, named=None, as_json=False, statuses=STATUSES, answers=False):
    """Everything that is wrong with a run; `named`: a word that must stand in the sentence about bad input; `answers`: the
    command answers the question whether its input is bad, on standard output."""
    if ran.status is None:
        return ["does not end"]
    problems = of_sanitizers(ran.err)
    if ran.status not in statuses:
        problems.append(f"ended by signal {-ran.status}" if ran.status < 0 else f"exit status {ran.status}")
    # JSON is for programs: it carries names as they are, as long as they are text.
    problems += of_text("standard error", ran.err) + of_text("standard output", ran.out, ("Cf", "Co", "Cn") if as_json else ())
    problems += leftovers(ran.after)
    if ran.status in (2, 3, 4):
        problems += of_refusal(ran, named, answers)
    if as_json and (ran.status in (0, 1) or (answers and ran.out)):
        problems += of_json(ran.out)
    return problems
