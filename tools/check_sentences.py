#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check that each fixed sentence about a recording or a result has a case in which it is said and one in which it is not.

    tools/check_sentences.py [--propose] [ROOT]

A fixed sentence is a string of four words or more in the sources of data/, io/input/, stages/, workflow/, pipeline/, studies/ and server/ that
is no error (an argument of fail() or check()) and stands in no file that tests/sentences.toml lists under [[texts]] with
the reason why nothing there is a claim (names of measures, drawings, ...). For each of them tests/sentences.toml has a row:

    [[sentence]]
    file = "src/kinemark/data/finding.cc"
    says = "carry each other's label"                  # part of the string in the source
    planted = "finding_test.cc:Finding.NamesBoth"      # a test that expects it: FILE:SUITE.NAME, or FILE.py:METHOD
    opposite = "screen_test.cc:Screen.CleanIsSilent"   # one that expects it not to be said

The test `planted` must hold part of the sentence in an expectation. The test `opposite` must deny it, with Not(...),
EXPECT_FALSE, EXPECT_EQ(..., false) or assertNotIn over part of the sentence; or, with `silent = true` in the row, expect
that nothing at all is said (IsEmpty(), empty(), "" or []). `owed = true` stands for a test that is not there yet;
`owed_at_most` at the head of the table says how many such rows there may be, and is only ever lowered. A row may have `exempt = "reason"` instead of tests where the
string claims nothing about the data. --propose prints rows for sentences without one, with the tests that were found.

Prints a line for each sentence without a row, row without a sentence and test that does not say what the row tells;
exit status 1 when there is one.
"""

import argparse
import ast
import re
import sys
import tomllib
from pathlib import Path

FOLDERS = ("src/kinemark/data", "src/kinemark/io/input", "src/kinemark/stages", "src/kinemark/workflow", "src/kinemark/pipeline", "studies", "server")
NOT_SOURCE = ("_test.cc", "_fuzz.cc", "_benchmark.cc")
TABLE = "tests/sentences.toml"
LEAST_WORDS = 4
LEAST_SHARED = 18  # characters that a test and a sentence must have in common

LITERAL = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
PIECE = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
ERROR = re.compile(r"\b(?:fail|check|Error|Failure)\s*[({][^;{}]*$")
PLACEHOLDER = re.compile(r"\{[^{}]*\}")
GTEST = re.compile(r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\((\w+),\s*(\w+)", re.MULTILINE)
DENIED = (
    re.compile(r"Not\((?:testing::)?(?:HasSubstr|Contains|AnyOf)\("),
    re.compile(r"EXPECT_FALSE\(|ASSERT_FALSE\("),
    re.compile(r"assertNotIn\(|assertFalse\("),
    re.compile(r"\.elsewhere"),
)
MESSAGE = re.compile(r"(\b(?:EXPECT|ASSERT)_\w+\(.*?\))\s*<<.*", re.DOTALL)  # what a failing expectation prints expects nothing
ONE_OPERAND = ("assertTrue", "assertFalse", "assertIsNone", "assertIsNotNone")  # of unittest; the others have two, then a message
SILENT = re.compile(r'IsEmpty\(\)|\.empty\(\)|, ""\)|std::nullopt|assertEqual\([^;\n]*, \[\]\)')


def without_comments(text):
    """The text without its comments; strings stay as they are."""
    parts, last = [], 0
    for match in re.finditer(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', text, re.DOTALL):
        if match[0].startswith("/"):
            parts += [text[last : match.start()], " "]
            last = match.end()
    return "".join(parts) + text[last:]


def sentences_of(text):
    """Fixed sentences of a source file, in order."""
    text = without_comments(text)
    found = []
    for match in LITERAL.finditer(text):
        if text.rfind("#include", 0, match.start()) > text.rfind("\n", 0, match.start()):
            continue
        sentence = "".join(PIECE.findall(match[0]))
        words = re.findall(r"[A-Za-z]{2,}", PLACEHOLDER.sub(" ", sentence))
        if len(words) >= LEAST_WORDS and not ERROR.search(text[max(0, match.start() - 400) : match.start()]):
            found.append(sentence)
    return found


def runs(sentence):
    """Runs of characters of a sentence; none across what is filled in."""
    pieces = [p.strip() for p in PLACEHOLDER.split(sentence.replace('\\"', '"'))]
    size = min(LEAST_SHARED, max(map(len, pieces)))
    return {p[i : i + size] for p in pieces for i in range(len(p) - size + 1)}


def common_runs(sentences):
    """Runs that sentences of several files share, which show of no test which one it is about."""
    files = {}
    for name, sentence in sentences:
        for run in runs(sentence):
            files.setdefault(run, set()).add(name)
    return {run for run, names in files.items() if len(names) > 1}


class Sentence:
    """A fixed sentence, and the runs of it one of which a test must hold to be about it."""

    def __init__(self, file, text, common):
        self.plain, self.stem = text.replace('\\"', '"'), Path(file).stem
        self.runs = runs(text)
        self.distinctive = (self.runs - common) or self.runs

    def wanted(self, test):
        """Of the tests of its own file any run will do."""
        return self.runs if test.startswith(f"{self.stem}_test.cc:") else self.distinctive


def tests_of(text):
    """{name: body} of a test file in C++."""
    found = list(GTEST.finditer(text))
    ends = [m.start() for m in found[1:]] + [len(text)]
    return {f"{m[1]}.{m[2]}": text[m.start() : end] for m, end in zip(found, ends)}


def python_tests_of(text):
    """{name: syntax tree} of a test file in Python."""
    return {n.name: n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.FunctionDef) and n.name.startswith("test_")}


def statements_of(body):
    """(statement, its strings) of a test in C++; strings may stand in a variable of their own."""
    for statement in re.split(r";\s*\n|\n\s*\n", body):
        statement = MESSAGE.sub(r"\1", statement)
        strings = ["".join(PIECE.findall(m[0])).replace('\\"', '"') for m in LITERAL.finditer(statement)]
        if strings:
            yield statement, strings


def without_message(node):
    """A statement of a test in Python without the messages of its assertions."""
    for call in ast.walk(node):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr.startswith("assert"):
            call.args = call.args[: 1 if call.func.attr in ONE_OPERAND else 2]
            call.keywords = [keyword for keyword in call.keywords if keyword.arg != "msg"]
    return node


def python_statements_of(tree):
    """(statement, its strings) of a test in Python, or of a script; of a loop or condition each statement by itself."""
    for node in ast.walk(tree):
        if isinstance(node, ast.stmt) and not hasattr(node, "body"):
            node = without_message(node)
            strings = [c.value for c in ast.walk(node) if isinstance(c, ast.Constant) and isinstance(c.value, str)]
            if strings:
                yield ast.unparse(node), strings


def says(tests, name, sentence, denied=False):
    """True where one of the statements of the test that expect, or that deny, holds part of the sentence."""
    wanted = sentence.wanted(name)
    return any(denied == is_denied and any(run in text for run in wanted) for is_denied, text in tests.expectations[name])


def denies(tests, name, sentence):
    """True where the test expects that the sentence is not said."""
    return says(tests, name, sentence, denied=True)


def expectations_of(statements):
    """[(denied, the strings)] of a test's statements."""
    return [(any(d.search(statement) for d in DENIED), "\0".join(strings)) for statement, strings in statements]


class Tests:
    """All tests of the project, by file name."""

    def __init__(self, root):
        self.bodies, self.expectations = {}, {}
        for folder in ("src", "server", "cli", "studies", "tests"):
            for pattern in ("*_test.cc", "accept_*.cc", "*.py"):
                for path in sorted((root / folder).rglob(pattern)):
                    self.add(path.name, path.read_text(encoding="utf-8"))

    def add(self, file, text):
        python = file.endswith(".py")
        tests = (python_tests_of(text) or {"whole": ast.parse(text)}) if python else (tests_of(text) or {"whole": text})
        for name, test in tests.items():
            self.bodies[f"{file}:{name}"] = ast.unparse(test) if python else test
            self.expectations[f"{file}:{name}"] = expectations_of(python_statements_of(test) if python else statements_of(test))

    def find(self, sentence, judge):
        """FILE:TEST of the first test that `judge` says yes to, or ""."""
        return next((name for name in self.expectations if judge(self, name, sentence)), "")


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.cc")):
            if not path.name.endswith(NOT_SOURCE) and "testing" not in path.parts:
                yield path.relative_to(root).as_posix(), path


def check_row(row, sentence, tests):
    """What is wrong with a row, a line each."""
    place = f"{row['file']}: \"{row['says']}\""
    if "exempt" in row:
        return [] if len(row["exempt"].split()) > 2 else [f"{place}: exempt needs a reason"]
    wrong = []
    for key, judge in (("planted", says), ("opposite", denies)):
        name = row.get(key, "")
        if not name and row.get("owed"):
            continue
        if name not in tests.bodies:
            wrong.append(f"{place}: {key} names no test: '{name}'")
        elif key == "opposite" and row.get("silent"):
            if not SILENT.search(tests.bodies[name]):
                wrong.append(f"{place}: {name} does not expect silence")
        elif not judge(tests, name, sentence):
            wrong.append(f"{place}: {name} does not {'expect' if key == 'planted' else 'deny'} it")
    return wrong


def read_table(root):
    return tomllib.loads((root / TABLE).read_text(encoding="utf-8"))


def owed(table):
    """Number of sentences that lack a test."""
    return sum(1 for row in table.get("sentence", []) if row.get("owed"))


def all_sentences(root, texts):
    """(file, sentence) of all sources but those that are texts."""
    return [(name, sentence) for name, path in sources(root) if name not in texts
            for sentence in dict.fromkeys(sentences_of(path.read_text(encoding="utf-8")))]


def check(root, propose=False):
    """Lines that say what is wrong."""
    table = read_table(root)
    rows, texts = table.get("sentence", []), {row["file"]: row for row in table.get("texts", [])}
    tests, found = Tests(root), all_sentences(root, texts)
    common, wrong, used = common_runs(found), [], set()
    for name, text in found:
        sentence = Sentence(name, text, common)
        matching = [i for i, row in enumerate(rows) if row["file"] == name and row["says"] in sentence.plain]
        used.update(matching)
        if matching:
            wrong += check_row(rows[max(matching, key=lambda i: len(rows[i]["says"]))], sentence, tests)
            continue
        wrong.append(f'{name}: no row for "{text}"')
        if propose:
            print(proposal(name, sentence, tests))
    known = {name for name, _ in sources(root)}
    wrong += [f'{row["file"]}: no sentence holds "{row["says"]}"' for i, row in enumerate(rows) if i not in used]
    wrong += [f"{name}: listed as text, and not there" for name in texts if name not in known]
    if owed(table) > table.get("owed_at_most", 0):
        wrong.append(f"{TABLE}: {owed(table)} sentences owe a test; {table.get('owed_at_most', 0)} at most may")
    return wrong


def quoted(text):
    return "'" + text + "'" if "'" not in text else '"""' + text + '"""'


def proposal(name, sentence, tests):
    """A row for a sentence, with the tests that were found."""
    longest = max(PLACEHOLDER.split(sentence.plain), key=len).strip()
    return (
        f'[[sentence]]\nfile = "{name}"\nsays = {quoted(longest)}\n'
        f'planted = "{tests.find(sentence, says)}"\nopposite = "{tests.find(sentence, denies)}"\n'
    )


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--propose", action="store_true", help="print rows for sentences that have none")
    options = parser.parse_args(arguments)
    wrong = check(options.root, options.propose)
    if not options.propose:
        table = read_table(options.root)
        count = len(table.get("sentence", []))
        print("\n".join(wrong) if wrong else f"sentences: {count}, {owed(table)} of which owe a test ({TABLE})")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
