"""Vehicle files spoilt at random, as hands and disks spoil them."""

from __future__ import annotations

import random
import re

WORDS = (
    "true", "-1.0", "0", "1e400", "nan", "inf", '"text"', "[]", "{}", "[1.0, 2.0]", "1979-05-27",
    "{file = 'nowhere.prw'}", '"ground"', '"spring"', '"friction_wedge"', "[[1.0]]", '""', "1e-300",
    '"\\u0000"', "9" * 400, '"front leading"',
)  # fmt: skip
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def mutated(text: str, seed: int) -> str:
    """The text with one to three random changes."""
    chance = random.Random(seed)
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        text = chance.choice(_CHANGES)(text, chance)
    return text


def _scale_a_number(text: str, chance: random.Random) -> str:
    found = list(_NUMBER.finditer(text))
    if not found:
        return text
    one = chance.choice(found)
    factor = chance.choice((1e3, 1e-3, -1.0, 0.0, 1e6, 25.4))
    return f"{text[: one.start()]}{float(one[0]) * factor!r}{text[one.end() :]}"


def _put_a_word(text: str, chance: random.Random) -> str:
    found = list(re.finditer(r"(?<== ).+", text))
    if not found:
        return text
    one = chance.choice(found)
    return text[: one.start()] + chance.choice(WORDS) + text[one.end() :]


def _misspell(text: str, chance: random.Random) -> str:
    found = list(re.finditer(r"[A-Za-z_]{3,}", text))
    if not found:
        return text
    one = chance.choice(found)
    place = chance.randrange(one.start(), one.end())
    return text[:place] + chance.choice(("", "x", "_", "é")) + text[place + 1 :]


def _drop_a_line(text: str, chance: random.Random) -> str:
    lines = text.splitlines(keepends=True)
    if lines:
        del lines[chance.randrange(len(lines))]
    return "".join(lines)


def _repeat_a_line(text: str, chance: random.Random) -> str:
    lines = text.splitlines(keepends=True)
    if lines:
        lines.insert(chance.randrange(len(lines)), chance.choice(lines))
    return "".join(lines)


def _drop_a_table(text: str, chance: random.Random) -> str:
    tables = text.split("\n\n")
    del tables[chance.randrange(len(tables))]
    return "\n\n".join(tables)


def _move_a_table(text: str, chance: random.Random) -> str:
    tables = text.split("\n\n")
    chance.shuffle(tables)
    return "\n\n".join(tables)


def _spoil_a_character(text: str, chance: random.Random) -> str:
    if not text:
        return text
    place = chance.randrange(len(text))
    return text[:place] + chance.choice('[]{}"=#\n\t.,-\0\\é0') + text[place + 1 :]


def _cut_off(text: str, chance: random.Random) -> str:
    return text[: chance.randrange(len(text) + 1)]


_CHANGES = (
    _scale_a_number,
    _scale_a_number,
    _put_a_word,
    _put_a_word,
    _misspell,
    _misspell,
    _drop_a_line,
    _repeat_a_line,
    _drop_a_table,
    _move_a_table,
    _spoil_a_character,
    _cut_off,
)
