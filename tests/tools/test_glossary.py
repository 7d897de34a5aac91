# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import re
import unittest

from support import PROJECT


def text_of(top, pattern):
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted((PROJECT / top).rglob(pattern)))


CODE = re.sub(r"//.*", "", text_of("src", "*.h") + text_of("studies", "*.h"))
KEYS = text_of("src", "*_json.cc") + text_of("src", "*_job.cc")
COMMANDS = text_of("cli", "*.cc")


def exists(name, before):
    """Whether the code has what the column "in the code" names; `before` stands before the name in its cell."""
    if name.startswith("make "):
        return f"\n{name[5:]}:" in (PROJECT / "Makefile").read_text(encoding="utf-8")
    if name.startswith("kinemark "):
        return re.search(rf'add_subcommand\(\s*"{name[9:]}"', COMMANDS) is not None
    if name.startswith("--"):
        return re.search(rf'add_(option|flag)\(\s*"[^"]*{name.split()[0]}\b', COMMANDS) is not None
    if before.endswith("JSON key is "):
        return f'"{name}"' in KEYS
    scope, _, last = name.removesuffix("()").rpartition("::")
    bodies = re.findall(rf"\b(?:struct|class) {scope}\b[^;{{]*{{(.*?)\n}};", CODE, re.S)
    pattern = r"(?<!\w)" + re.escape(last).replace(r"\.\.\.", r"\w*")  # predicted_...: whatever begins so
    pattern += r" *\(" if name.endswith("()") else r"(?!\w)"
    return re.search(pattern, "".join(bodies) if scope[:1].isupper() else CODE) is not None


# Words that name nothing of the field, and what stands for them. `place` is a verb here (MarkerPlacer), a plural noun never.
NOT_OURS = {
    "bend": "change",
    "bends": "changes",
    "looker": "what it finds",
    "looks": "uses, is, has",
    "places": "positions",
    "pull": "force, residual",
    "pulls": "forces, residuals",
    "told": "reported, asked, judged",
    "twin": "online form",
    "twins": "online forms",
}


# Words of pages and messages, likewise; the standard's or field's word comes second.
NOT_WRITTEN = {
    r"leavings?(?! (\w+ )?out\b)": "foot off",
    r"stretch(es)?(?! them)": "span",
    r"told": "reported, given, distinguished",
}
WRITTEN_ALL_THE_SAME = {"cannot be told"}  # a value in files (data::SkinAnswer)


def sentences(path):
    """Texts of more than one word in a source file."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.lstrip().startswith(("//", "#", "*", "/*"))]
    return [text for line in lines for text in re.findall(r'"((?:\\.|[^"\\\n])*)"', line) if " " in text and text not in WRITTEN_ALL_THE_SAME]


def identifiers(path):
    """All names in a source file, without comments and strings."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        text = re.sub(r'''""".*?"""|\bplaces=|#[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'''', " ", text, flags=re.DOTALL)
    else:
        text = re.sub(r'''R"\(.*?\)"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"''', " ", text, flags=re.DOTALL)
    return set(re.findall(r"[A-Za-z_]\w*", text))


def parts_of(name):
    return {part.lower() for part in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)}


class Glossary(unittest.TestCase):
    def test_identifiers_are_words_of_the_field(self):
        self.assertEqual(parts_of("AFileIsToldOnce_kLooks_m"), {"a", "file", "is", "told", "once", "k", "looks", "m"})
        wrong = []
        for top in ("src", "cli", "server", "studies", "tests"):
            for path in sorted((PROJECT / top).rglob("*")):
                if path.suffix in (".h", ".cc", ".py") and "corpus" not in path.parts and path.name != "test_glossary.py":
                    for name in sorted(identifiers(path)):
                        wrong += [f"{path.relative_to(PROJECT)}: {name}: {NOT_OURS[part]}" for part in parts_of(name) & NOT_OURS.keys()]
        self.assertEqual(wrong, [])

    def test_pages_and_messages_have_the_words_of_the_field(self):
        texts = [(path, path.read_text(encoding="utf-8").splitlines()) for path in sorted((PROJECT / "docs").rglob("*.md")) if "decisions" not in path.parts]
        texts.append((PROJECT / "README.md", (PROJECT / "README.md").read_text(encoding="utf-8").splitlines()))
        for top in ("src", "cli", "server", "studies"):
            sources = (path for path in sorted((PROJECT / top).rglob("*")) if path.suffix in (".h", ".cc"))
            texts += [(path, sentences(path)) for path in sources if not path.stem.endswith("_test")]
        self.assertGreater(sum(len(found) for _, found in texts), 8000)
        wrong = [
            f"{path.relative_to(PROJECT)}: {line}: {instead}"
            for path, found in texts for line in found for word, instead in NOT_WRITTEN.items() if re.search(rf"\b{word}\b", line)
        ]
        self.assertEqual(wrong, [])

    def test_the_code_has_every_name_in_the_column_of_the_code(self):
        lines = (PROJECT / "docs/concepts/glossary.md").read_text(encoding="utf-8").splitlines()
        cells = [line.split("|")[4] for line in lines if line.count("|") == 6 and "---" not in line]
        names = [(m[1], cell[: m.start()]) for cell in cells for m in re.finditer(r"`([^`]+)`", cell)]
        self.assertGreater(len(names), 80)
        self.assertEqual([name for name, before in names if not exists(name, before)], [])
