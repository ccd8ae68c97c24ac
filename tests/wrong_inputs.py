"""A row of wrong input: a call, and words that its message has to hold.

The words are the value or name that is wrong, and what is right. A message that holds neither the
reader's own word nor a way out does not pass; nor does a bare Python error, nor a silent number.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from exudyn_wheelset import WheelsetError, WheelsetWarning

Row = tuple[Callable[[], Any], Sequence[str]]


def rows(**areas: Mapping[str, Row]) -> dict[str, Row]:
    """All rows, by area and name."""
    return {f"{area}: {name}": row for area, table in areas.items() for name, row in table.items()}


def check(row: Row) -> None:
    """Fail unless the call of a row is refused, or warned of, in its words."""
    call, words = row
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            result = call()
        except WheelsetError as error:
            said = [str(error)]
        else:
            said = [str(w.message) for w in caught if issubclass(w.category, WheelsetWarning)]
            assert said, f"silent: {result!r:.80}"
    assert any(all(word in line for word in words) for line in said), said
