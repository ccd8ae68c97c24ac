"""Rails that change along the track: from which station on there is which profile."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.spelling import spelt_class

ProfileSource = Profile | str | PathLike


def profile_of_kind(source: ProfileSource, kind: str) -> Profile:
    """A wheel or a rail from a profile, a name or a path; raises WheelsetError for the other."""
    profile = load_profile(source)
    if profile.kind != kind:
        raise WheelsetError(
            f"profile {profile.name!r} is a {profile.kind}, but a {kind} profile is needed here: "
            f"give a {kind} profile"
        )
    return profile


@spelt_class
@dataclass(frozen=True)
class RailSection:
    """From the station `start` [m] on the rails have other profiles.

    rail: profile, name or path, right_rail defaults to it. They are placed as the track's own.
    Raises WheelsetError for what is no rail and for a station that is no number.

    Examples
    --------
    >>> from exudyn_wheelset import RailSection, Track
    >>> track = Track("UIC60", sections=[RailSection(100.0, "UIC60")], blend=10.0)
    >>> track.sections[0].start
    100.0
    """

    start: float
    rail: Profile
    right_rail: Profile | None = None

    def __init__(
        self, start: float, rail: ProfileSource, right_rail: ProfileSource | None = None
    ) -> None:
        put = object.__setattr__
        put(self, "start", number("section of rails: start", start, "m"))
        put(self, "rail", profile_of_kind(rail, "rail"))
        right = None if right_rail is None else profile_of_kind(right_rail, "rail")
        put(self, "right_rail", right)
