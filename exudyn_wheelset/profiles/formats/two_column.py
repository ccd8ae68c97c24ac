"""Two columns of text, y and z, with an optional header.

The header consists of lines "# key: value" with the keys name, kind (wheel or rail), unit (mm, m,
cm, inch) and source; other comment lines (#, %, ! or //) are skipped. The project's own files are
of this kind, in millimetres, in the frames of `exudyn_wheelset.profiles.profile`.
"""

from __future__ import annotations

from exudyn_wheelset.profiles.profile import Profile

HEADER_KEYS = ("name", "kind", "unit", "source")


def write(profile: Profile) -> str:
    """The profile as text in millimetres with eight decimals (1e-11 m)."""
    lines = [
        f"# name: {_one_line(profile.name)}",
        f"# kind: {profile.kind}",
        "# unit: mm",
        f"# source: {_one_line(profile.source)}",
        "# y [mm]  z [mm]",
    ]
    lines += [f"{1e3 * y:.8f} {1e3 * z:.8f}" for y, z in zip(profile.y, profile.z, strict=True)]
    return "\n".join(lines) + "\n"


def _one_line(text: str) -> str:
    return " ".join(text.split())
