"""Which wheelsets belong together: the trucks of a vehicle, told by the gaps between axles.

Axles of a truck stand close together, trucks far apart: a truck ends where the distance to the
next axle is more than SPLIT times the smallest distance in the vehicle. Axles at equal distances
(a single truck, a wagon on two axles) are one group. Positions x in m, forward.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

# Wheelbases within a truck differ by less than this; pivots of trucks are further apart.
SPLIT = 1.8


def trucks_by_distance(stations: Mapping[str, float]) -> dict[str, tuple[str, ...]]:
    """Labels of the wheelsets of each truck, from their positions x [m]; front truck first.

    The truck's name is what the labels of its wheelsets begin with ("front" of "front leading",
    "front trailing"), otherwise front, middle, rear or a number. Empty for a single group.
    """
    labels = sorted(stations, key=lambda label: -stations[label])
    gaps = [stations[a] - stations[b] for a, b in pairwise(labels)]
    if not gaps or min(gaps) <= 0.0:
        return {}
    groups = [[labels[0]]]
    for label, gap in zip(labels[1:], gaps, strict=True):
        if gap > SPLIT * min(gaps):
            groups.append([])
        groups[-1].append(label)
    if len(groups) < 2:
        return {}
    names = [_common_words(group) for group in groups]
    if len(set(names)) < len(names) or not all(names):
        names = [f"{index + 1}." for index in range(len(groups))]
        names[0], names[-1] = "front", "rear"
        if len(names) == 3:
            names[1] = "middle"
    return {name: tuple(group) for name, group in zip(names, groups, strict=True)}


def _common_words(labels: list[str]) -> str:
    """The words that all labels begin with, unless they are all of one label."""
    words = [label.split() for label in labels]
    common = []
    for at in zip(*words, strict=False):
        if len(set(at)) > 1:
            break
        common.append(at[0])
    if len(labels) == 1:
        common = common[:-1]
    return " ".join(common).removesuffix(" truck")
