"""Loading profiles by name or from a file, and saving them.

A bare name ("S1002", "UIC60", "AAR_1_20", "knife_edge", "cone_1_20", "cone_0.05" and cones of any
conicity) is one of the profiles that come with the package; anything else is a path. The format of
a file is found from its content and its suffix:

| format | suffix | module |
|---|---|---|
| two columns of text, CSV | any other | formats/two_column.py |
| SIMPACK | .prw .prr | formats/simpack.py |
| MiniProf | .whl .ban .rai .mpt | formats/miniprof.py |
| VAMPIRE | .whe .rai | formats/vampire.py |
| GENSYS | .wheel .rail | formats/gensys.py |
"""

from __future__ import annotations

import importlib.resources
import logging
import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.profiles.finish import Options, check_options, finish
from exudyn_wheelset.profiles.formats import gensys, miniprof, simpack, two_column, vampire
from exudyn_wheelset.profiles.formats.raw import (
    RawProfile,
    decode,
    fault,
    shorten,
    split_lines,
    unit_word,
)
from exudyn_wheelset.profiles.noise import warn_of_noise
from exudyn_wheelset.profiles.profile import Profile
from exudyn_wheelset.results.files import write_atomically
from exudyn_wheelset.spelling import spelt

BUNDLED = ("S1002", "UIC60", "AAR_1_20", "cone_1_20", "knife_edge")
FORMATS = ("two-column", "simpack", "miniprof", "vampire", "gensys")
_SIDES = ("left", "right")
# Largest shift of a profile's points [m]: some frames begin at the middle of the track.
_FARTHEST = 2.0
_SLICE = re.compile(r"\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*,?\s*['\"]([^'\"]+\.\w+)['\"]")
_LOG = logging.getLogger("exudyn_wheelset.profiles")


@spelt
def load_profile(
    name_or_path: str | os.PathLike[str] | Profile,
    *,
    kind: str | None = None,
    unit: str | None = None,
    smoothing: float | str = 0.0,
    side: str = "left",
    format: str | None = None,
    outlier_tolerance: float | None = None,
    shift_y: float = 0.0,
    shift_z: float = 0.0,
    mirror_y: bool = False,
) -> Profile:
    """A wheel or rail profile by its name or from a file; a Profile passes through.

    kind: "wheel" or "rail" where the file does not say; unit: "mm", "m", "cm", "um" or "inch",
    which goes before the file's own; smoothing: rms distance of the points to the curve [m], 0 to
    1e-3, or "auto": as much as the noise of the points calls for (penalised.py); side: "left" or
    "right" where a file holds both; format: one of FORMATS instead of finding it;
    outlier_tolerance: points farther than this [m] from the curve through their neighbours are left
    out and reported;
    mirror_y: the file has its sides the other way round; shift_y, shift_z: added to the points [m]
    in the package's frame, after that.
    What was turned, cut off, shifted or guessed stands in the profile's `remarks` and goes to the
    log "exudyn_wheelset.profiles" (level INFO). WheelsetWarning: noise makes the curvature of an
    unsmoothed curve worthless.

    Raises ProfileError, which names the file, the line and the mend.

    Examples
    --------
    >>> from exudyn_wheelset import load_profile
    >>> wheel = load_profile("S1002")
    >>> wheel.kind, round(1e3 * float(wheel.height(-0.03)), 2)  # [mm], flange side
    ('wheel', -3.92)
    """
    check_options(kind, smoothing)
    if outlier_tolerance is not None:
        positive("outlier_tolerance", outlier_tolerance, "m", 0.01)
    number("shift_y", shift_y, "m", -_FARTHEST, _FARTHEST, "is it given in metres?")
    number("shift_z", shift_z, "m", -_FARTHEST, _FARTHEST, "is it given in metres?")
    if not isinstance(name_or_path, str | os.PathLike | Profile):
        raise ProfileError(
            f"{name_or_path!r} is no profile: give a Profile, a file, or one of the names "
            f"{', '.join(BUNDLED)}"
        )
    if unit is not None and unit_word(unit) is None:
        label = name_or_path.name if isinstance(name_or_path, Profile) else str(name_or_path)
        raise ProfileError(f"{label}: unit={unit!r}; use 'mm', 'm', 'cm', 'um' or 'inch'")
    if side not in _SIDES:
        raise ProfileError(f"side={side!r}; use 'left' or 'right'")
    if format is not None and format not in FORMATS:
        raise ProfileError(f"format={format!r}; use one of {', '.join(FORMATS)}")
    if isinstance(name_or_path, Profile):
        profile: Profile | None = name_or_path
        path = Path()
    else:
        path = Path(name_or_path)
        profile = _bundled(str(name_or_path)) if isinstance(name_or_path, str) else None
    if profile is not None:
        if kind not in (None, profile.kind):
            raise ProfileError(f"{profile.name} is a {profile.kind}, but kind={kind!r} was asked")
        if mirror_y:
            profile = replace(profile, y=-profile.y[::-1], z=profile.z[::-1].copy())
        if shift_y or shift_z:
            profile = profile.shifted(shift_y, shift_z)
        return profile.smoothed(smoothing) if smoothing else profile
    label = str(path)
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise ProfileError(
            f"{label}: no such file, and no profile of that name; names are {', '.join(BUNDLED)} "
            "and cone_<conicity>"
        ) from None
    except (OSError, ValueError) as error:
        raise ProfileError(f"{label}: cannot be read ({error})") from None
    text, remarks = decode(data, label)
    options = Options(kind, unit, smoothing, outlier_tolerance, (shift_y, shift_z), mirror_y)
    raw = _read(split_lines(text), label, path.suffix.lower(), format, options, side)
    raw.remarks[:0] = remarks
    profile = finish(raw, label, path.stem, options)
    for remark in profile.remarks:
        _LOG.info("%s: %s", label, remark)
    warn_of_noise(label, profile.noise, profile.curvature_noise)
    return profile


@spelt
def save_profile(profile: Profile, path: str | os.PathLike[str], format: str | None = None) -> Path:
    """Write the points of a profile to a file and return its path.

    format: "two-column" or "simpack"; without it the suffixes .prw and .prr give SIMPACK and any
    other suffix two columns in millimetres. A mirrored profile is written in the frame of the side
    that is stored (y > 0 to the field side). Raises ProfileError for an unknown format or a suffix
    that belongs to the other kind, FileError where it cannot be written.

    Examples
    --------
    >>> from exudyn_wheelset import load_profile, save_profile
    >>> path = save_profile(load_profile("S1002"), "s1002.prw")
    >>> load_profile(path).kind
    'wheel'
    """
    target = Path(path)
    suffix = target.suffix.lower()
    simpack_suffix = {"wheel": ".prw", "rail": ".prr"}
    if format is None:
        format = "simpack" if suffix in simpack_suffix.values() else "two-column"
    if format not in ("two-column", "simpack"):
        raise ProfileError(f"format={format!r}; profiles are written as 'two-column' or 'simpack'")
    if suffix in simpack_suffix.values() and suffix != simpack_suffix[profile.kind]:
        raise ProfileError(
            f"{target}: {profile.name} is a {profile.kind}; use {simpack_suffix[profile.kind]}"
        )
    stored = profile.mirrored() if profile.is_mirrored else profile
    text = simpack.write(stored) if format == "simpack" else two_column.write(stored)
    return write_atomically(
        target, lambda part: part.write_text(text, encoding="utf-8", newline="\n")
    )


def _profile_files() -> Any:
    """The folder of the profiles that come with the package, installed or in its source tree."""
    try:
        return importlib.resources.files("exudyn_wheelset.profile_files")
    except ModuleNotFoundError:
        return Path(__file__).parents[2] / "profiles"


def _bundled(name: str) -> Profile | None:
    plain = re.sub(r"[\s_:-]+", "", name).lower()
    cone = re.fullmatch(r"cone(?:1/?(\d+)|(\d*\.\d+))", plain, re.ASCII)
    if cone:
        denominator = int(cone[1]) if cone[1] else 0
        if cone[1] and not denominator:
            raise ProfileError(f"{name}: a cone of 1:0; write cone_1_20 or cone_0.05")
        return shapes.cone(1.0 / denominator if denominator else float(cone[2]))
    for stem in BUNDLED:
        if plain == stem.replace("_", "").lower():
            text = (_profile_files() / f"{stem}.txt").read_text(encoding="utf-8")
            raw = two_column.read(split_lines(text), stem)
            return finish(raw, stem, stem, Options())
    return None


def _read(
    lines: list[str], label: str, suffix: str, format: str | None, options: Options, side: str
) -> RawProfile:
    if format is None:
        format = _format_of(lines, suffix)
    if format == "simpack":
        if not simpack.looks_like(lines):
            raise fault(label, 1, "no 'header.begin' or 'spline.begin'; this is no SIMPACK profile")
        raw = simpack.read(lines, label)
        expected = {".prw": "wheel", ".prr": "rail"}.get(suffix)
        if expected and raw.kind != expected:
            raise fault(
                label,
                raw.kind_line,
                f"the type says {raw.kind}, the suffix {suffix} {expected}; mend the one or other",
            )
        return raw
    if format == "vampire":
        if not vampire.looks_like(lines):
            raise fault(label, 1, "the first line is neither WHEELPROFILE nor RAILPROFILE")
        return vampire.read(lines, label, side)
    if format == "miniprof":
        return miniprof.read(lines, label, options.kind, unit_word(options.unit or "mm"))
    if format == "gensys":
        return gensys.read(lines, label)
    _refuse_list_of_slices(lines, label, suffix)
    raw = two_column.read(lines, label, side)
    expected = {".prw": "wheel", ".prr": "rail"}.get(suffix)
    if expected and raw.kind is None:
        raw.kind = expected
        raw.remarks.append(f"no SIMPACK keywords; read as columns, a {expected} by the suffix")
    return raw


def _refuse_list_of_slices(lines: list[str], label: str, suffix: str) -> None:
    """CONTACT's .slcs and .slcw name the files of a profile that varies along rail or wheel."""
    slices = [(n, m[1]) for n, line in enumerate(lines, start=1) if (m := _SLICE.match(line))]
    if suffix in (".slcs", ".slcw") or len(slices) > 2:
        line, name = slices[0] if slices else (1, "")
        raise fault(
            label,
            line,
            f"a list of profiles along the rail or around the wheel, not a profile; "
            f"load one of its files, {shorten(name)!r} for instance",
        )


def _format_of(lines: list[str], suffix: str) -> str:
    """The format by content, then by suffix; .rai belongs to MiniProf and VAMPIRE alike."""
    if vampire.looks_like(lines):
        return "vampire"
    if simpack.looks_like(lines):
        return "simpack"
    if miniprof.looks_like(lines) or suffix in (".whl", ".ban", ".rai", ".mpt"):
        return "miniprof"
    if suffix == ".whe":
        return "vampire"
    return "gensys" if suffix in (".wheel", ".rail") else "two-column"
