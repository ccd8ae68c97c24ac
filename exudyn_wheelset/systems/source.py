"""The description that a system was made from, kept along with results where it can be stored."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Source:
    """Holds a description; a copy by pickle holds None where the description cannot be pickled."""

    description: Any

    def __reduce__(self) -> tuple[Any, ...]:
        try:
            pickle.dumps(self.description)
        except Exception:
            return Source, (None,)
        return Source, (self.description,)
