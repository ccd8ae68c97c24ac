"""`Vehicle.replace`: one entry in a tree of frozen descriptions, by a path of names."""

from __future__ import annotations

import dataclasses
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.errors import WheelsetError

_Parts = tuple[Any, ...]

_AXES = {"x": 0, "y": 1, "z": 2}


def replaced(tree: Any, path: str, value: Any) -> Any:
    """`tree` with the entry at `path` exchanged; see Vehicle.replace."""
    steps = path.split(".") if isinstance(path, str) else []
    if not steps or not all(steps):
        raise WheelsetError(
            f"path = {path!r}: give names with dots between, such as 'connections.spring.damping'"
        )
    if steps[0] == "wheelsets" and len(steps) > 1:
        axles = _replaced(tree.wheelsets, steps[1:], value, path)
        connections = _moved_along(tree.connections, tree.wheelsets, axles)
        return dataclasses.replace(tree, wheelsets=axles, connections=connections)
    return _replaced(tree, steps, value, path)


def _moved_along(connections: _Parts, before: _Parts, after: _Parts) -> _Parts:
    """Connections at an axle whose place or radius has changed, moved along with it."""
    moves = {
        new.name: [b - a for a, b in zip(old.centre, new.centre, strict=True)]
        for old, new in zip(before, after, strict=True)
        if old.centre != new.centre
    }
    moved = []
    for one in connections:
        move = moves.get(one.lower) or moves.get(one.upper)
        if move is not None:
            at = tuple(place + way for place, way in zip(one.at, move, strict=True))
            one = dataclasses.replace(one, at=at)
        moved.append(one)
    return tuple(moved)


def _replaced(node: Any, steps: list[str], value: Any, path: str) -> Any:
    if not steps:
        return value
    step, rest = steps[0], steps[1:]
    if isinstance(node, tuple):
        if step == "xz" and len(node) == 3:
            # A body that spins has the same inertia about all axes across it.
            return tuple(
                _replaced(entry, rest, value, path) if place != 1 else entry
                for place, entry in enumerate(node)
            )
        if node and all(dataclasses.is_dataclass(entry) for entry in node):
            return _in_named(node, step, rest, value, path)
        place = _AXES.get(step, int(step) if step.isdigit() else len(node))
        if place >= len(node):
            raise WheelsetError(
                f"{path!r}: {step!r} is no place in the {len(node)} numbers {node}: give 0 to "
                f"{len(node) - 1}, or x, y, z"
            )
        return (
            *node[:place],
            _replaced(node[place], rest, value, path),
            *node[place + 1 :],
        )
    if not dataclasses.is_dataclass(node):
        raise WheelsetError(f"{path!r}: there is nothing below {node!r}: end the path before it")
    names = [entry.name for entry in dataclasses.fields(node) if not entry.name.startswith("_")]
    if step not in names:
        # What stands one level deeper may be named without it.
        for holder in ("wheelset", "element"):
            inner = getattr(node, holder, None)
            if holder in names and inner is not None and hasattr(inner, step):
                return dataclasses.replace(
                    node,  # type: ignore[type-var]
                    **{holder: _replaced(inner, steps, value, path)},
                )
        inner_names = [
            entry.name
            for holder in ("wheelset", "element")
            if dataclasses.is_dataclass(getattr(node, holder, None))
            for entry in dataclasses.fields(getattr(node, holder))
        ]
        raise unknown(f"entry of {path!r}:", step, [*names, *inner_names])
    changed = _replaced(getattr(node, step), rest, value, path)
    return dataclasses.replace(node, **{step: changed})  # type: ignore[type-var]


def _in_named(node: _Parts, step: str, rest: list[str], value: Any, path: str) -> _Parts:
    """The entries of a tuple that a name means, changed."""
    names = [getattr(entry, "name", getattr(entry, "body", "")) for entry in node]
    chosen = [name == step or step == "*" for name in names]
    if not any(chosen):
        chosen = [name.startswith(f"{step} ") or name.endswith(f" {step}") for name in names]
    if not any(chosen):
        raise unknown(f"name in {path!r}:", step, names)
    if not rest:
        raise WheelsetError(f"{path!r} ends at a whole part: name one of its entries")
    return tuple(
        _replaced(entry, rest, value, path) if is_meant else entry
        for entry, is_meant in zip(node, chosen, strict=True)
    )
