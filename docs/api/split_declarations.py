#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What Doxygen reads in place of a header: declarations of several names taken apart, so that all have the one description.

    docs/api/split_declarations.py HEADER

`double a = 0.0, b = 0.0;  ///< m` becomes `double a = 0.0; /**< m */ double b = 0.0; /**< m */`, and a description above such a
declaration stands above each. Line numbers stay. Doxygen calls this as its INPUT_FILTER; without it only one of the names is described.
"""

import re
import sys

# What begins a line and is no declaration of variables.
OTHER = re.compile(
    r"\s*(?:#|//|\*|\[\[|:|using\b|template\b|friend\b|enum\b|class\b|struct\b|union\b|namespace\b|return\b|public\b|private\b"
    r"|protected\b|typedef\b|static_assert\b|if\b|for\b|while\b|else\b|case\b|switch\b|explicit\b|virtual\b|~|\}|\{|$)"
)
NAME = re.compile(r"(.*?[\s>&*])([A-Za-z_]\w*)(\s*(?:\[[^\]]*\])*\s*(?:=.*|\{.*)?)$", re.DOTALL)
PAIRS = {")": "(", "]": "[", "}": "{", ">": "<"}


def split_statement(text):
    """Parts between commas that stand in no bracket, and what follows the `;`; None when this is no such declaration."""
    parts, start, open_brackets, function = [], 0, [], False
    for i, c in enumerate(text):
        if c in "([<":
            function |= c == "(" and not open_brackets and "=" not in text[start:i]
            open_brackets.append(c)
        elif c == "{":
            if function:
                return None
            open_brackets.append(c)
        elif c in PAIRS:
            if not open_brackets or open_brackets.pop() != PAIRS[c]:
                return None
        elif c == "," and not open_brackets:
            parts.append(text[start:i])
            start = i + 1
        elif c == ";" and not open_brackets:
            return [*parts, text[start:i]], text[i + 1:]
        elif c == "/" and text[i:i + 2] == "//":
            return None
    return None


def several(lines, i):
    """(number of lines, names with type and value, comment) of a declaration of several names that begins at line i, or None."""
    if OTHER.match(lines[i]):
        return None
    for count in range(1, 5):
        text = "\n".join(lines[i:i + count])
        found = split_statement(text)
        if found:
            break
    else:
        return None
    parts, rest = found
    comment = re.fullmatch(r"\s*(?:///<\s*(.*))?", rest)
    first = NAME.match(parts[0].strip())
    if len(parts) < 2 or not comment or not first:
        return None
    kind = first.group(1).strip()
    return count, [parts[0].strip(), *(f"{kind} {part.strip()}" for part in parts[1:])], comment.group(1)


def split(text):
    """The header with each name in a declaration of its own."""
    lines, out, above, i = text.split("\n"), [], [], 0
    while i < len(lines):
        if lines[i].strip().startswith("///") and not lines[i].strip().startswith("///<"):
            above.append(lines[i].strip()[3:].strip())
            out.append(lines[i])
            i += 1
            continue
        found = several(lines, i)
        if found:
            count, names, comment = found
            # A comment behind may go on below.
            words, extra = [comment] if comment else [], 0
            while comment and i + count + extra < len(lines) and lines[i + count + extra].strip().startswith("///<"):
                words.append(lines[i + count + extra].strip()[4:].strip())
                extra += 1
            if words:
                line = " ".join(f"{' '.join(name.split())}; /**< {' '.join(words)} */" for name in names)
            else:
                each = f"/** {' '.join(above)} */ " if above else ""
                line = " ".join(f"{each if k else ''}{' '.join(name.split())};" for k, name in enumerate(names))
            out += [line] + [""] * (count + extra - 1)
            i += count + extra
        else:
            out.append(lines[i])
            i += 1
        above = []
    return "\n".join(out)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as header:
        sys.stdout.write(split(header.read()))
