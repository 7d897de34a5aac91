# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Ways to damage the bytes of a file, and names that a file should not have. Each takes a random.Random."""

# What a reader of numbers, names, lengths and markup may not expect.
TOKENS = (
    *(b"nan", b"-inf", b"1e400", b"-1e308", b"1e-320", b"0x1p9", b"-0", b"99999999999999999999", b"-1", b"+", b".", b"1,5"),
    *(b"", b"\0", b"\xff\xfe", b"\xc3\x28", b"\xed\xa0\x80", b"\x1b[2J", b"\xe2\x80\xae", b"\r", b"\n\n", b"\t\t\t", b'"', b"'"),
    *(b"<", b"</", b"<!--", b"<![CDATA[", b"&#0;", b"&lol;", b"]]>", b"[[", b"a.b.c.d.", b"= {", b"\\u0000", b"#", b"../" * 9),
    *(b"A" * 3000, b"9" * 400, b"\x00\x00\x00\x00", b"\xff\xff\xff\xff", b"\x7f\xff", b"\x80\x00", b"\x00\x00\xc0\x7f"),
)


def flip_bit(content, random):
    if not content:
        return content
    place, bit = random.randrange(len(content)), random.randrange(8)
    return content[:place] + bytes([content[place] ^ 1 << bit]) + content[place + 1 :]


def flip_bits(content, random):
    for _ in range(random.randint(2, 40)):
        content = flip_bit(content, random)
    return content


def cut(content, random):
    return content[: random.randrange(len(content) + 1)]


def span(content, random):
    """Where a piece of the content begins and ends; short ones more often than long ones."""
    begin = random.randrange(len(content) + 1)
    return begin, min(len(content), begin + int(2 ** random.uniform(0, 14)))


def leave_out(content, random):
    begin, end = span(content, random)
    return content[:begin] + content[end:]


def repeat(content, random):
    begin, end = span(content, random)
    return content[:end] + content[begin:end] * random.randint(1, 9) + content[end:]


def move(content, random):
    begin, end = span(content, random)
    rest = content[:begin] + content[end:]
    place = random.randrange(len(rest) + 1)
    return rest[:place] + content[begin:end] + rest[place:]


def zero(content, random):
    begin, end = span(content, random)
    return content[:begin] + bytes(end - begin) + content[end:]


def noise(content, random):
    begin, end = span(content, random)
    return content[:begin] + random.randbytes(end - begin) + content[end:]


def insert_token(content, random):
    place = random.randrange(len(content) + 1)
    return content[:place] + random.choice(TOKENS) + content[place:]


def replace_word(content, random):
    """A token in place of what stands between two separators, as text files have them."""
    place = random.randrange(len(content) + 1)
    separators = b" \t\r\n,<>=\""
    begin, end = place, place
    while begin > 0 and content[begin - 1] not in separators and place - begin < 64:
        begin -= 1
    while end < len(content) and content[end] not in separators and end - place < 64:
        end += 1
    return content[:begin] + random.choice(TOKENS) + content[end:]


def in_header(content, random):
    """Damage within the first 2,048 bytes, where formats say how the rest is to be read."""
    way = random.choice((flip_bit, insert_token, replace_word, zero, noise))
    return way(content[:2048], random) + content[2048:]


WAYS = (flip_bit, flip_bits, cut, leave_out, repeat, move, zero, noise, insert_token, replace_word, in_header)


def damaged(content, random):
    """The content, damaged in one to three ways, and the names of the ways."""
    ways = random.choices(WAYS, k=random.choice((1, 1, 1, 2, 3)))
    for way in ways:
        content = way(content, random)
    return content, "+".join(way.__name__ for way in ways)


# Names of files, without their ending, as bytes.
NAMES = (
    *(b"caf\xe9", b"\xff\xfe", b"\xc3\x28", b"\xed\xa0\x80", b"tab\there", b"line\nbreak", b"esc\x1b[31mred", b"bell\x07"),
    *(b" ", b"-o", b"--force", b"a'b", b'a"b', b"$(id)", b"<script><img src=x>", b"%s%n%d", b"{}{0}", b"a\\b", b"."),
    *("日本語".encode(), "\u202egpj".encode(), "naïve".encode("latin-1"), "ヒト".encode("shift_jis"), b"n" * 240),
)
