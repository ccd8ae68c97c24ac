"""Behind NODE_SPACING of contact/tables.py: what a coarser scan of the wheel changes.

S1002 on UIC60, 1:40 and 1:20, the wheelset lowered by 0.08 mm from its rigid position at 1000
shifts from 0 to 8.5 mm: change of the vertical force against a scan every 0.5 mm, in 99 % of the
shifts and at worst, and how often the number of patches differs. The worst shift is where contact
runs along the flange throat: the fine scan sees three lobes within a few millimetres, of which
only pairs merge. Run `python benchmarks/scan_spacing.py`.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset import Track, Wheelset, contact_geometry
from exudyn_wheelset.contact import layout, tables
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.wheelset_contact import contact_parameters

SPACINGS = (0.5e-3, 1.0e-3, 1.5e-3, 2.0e-3)


def forces(wheelset: Wheelset, track: Track, spacing: float, y: np.ndarray) -> np.ndarray:
    """Vertical force [N] and numbers of patches (n, 3) with nodes at a spacing [m]."""
    geometry = contact_geometry(wheelset, track, y)
    known = tables.NODE_SPACING
    tables.NODE_SPACING = spacing
    tables._contact_tables.cache_clear()
    table = tables.contact_tables(wheelset, track)
    tables.NODE_SPACING = known
    tables._contact_tables.cache_clear()
    parameters, result, motion = contact_parameters(), layout.new_result(), np.zeros(12)
    rows = []
    for shift, z, roll in zip(y, geometry.z, geometry.roll, strict=True):
        axle = layout.Axle(shift, z - 8e-5, 0.0, np.cos(roll), np.sin(roll))
        velocity = layout.Velocity(20.0, 0.0, 0.0, 0.0, 43.5, 0.0)
        wheelset_forces(table, axle, velocity, motion, parameters, result)
        record = result.view(layout.RESULT)[0]
        rows.append([record["force"][2], *record["count"]])
    return np.array(rows)


def main() -> None:
    wheelset = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    y = np.linspace(0.0, 8.5e-3, 1000)
    print("inclination  spacing [mm]  change in 99 % [%]  at worst [%]  other patch count [%]")
    for inclination in (1 / 40, 1 / 20):
        track = Track(rail="UIC60", inclination=inclination)
        finest = forces(wheelset, track, SPACINGS[0], y)
        for spacing in SPACINGS[1:]:
            found = forces(wheelset, track, spacing, y)
            change = 100.0 * np.abs(found[:, 0] / finest[:, 0] - 1.0)
            counts = np.mean(np.any(found[:, 1:] != finest[:, 1:], axis=1))
            print(
                f"1:{1 / inclination:<10.0f}{1e3 * spacing:12.1f}"
                f"{np.quantile(change, 0.99):20.3f}{change.max():14.3f}{100 * counts:28.1f}"
            )


if __name__ == "__main__":
    main()
