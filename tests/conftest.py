"""Every test starts from Exudyn's own defaults and draws without a display."""

import os

import hypothesis

# Both are read on import, so they are set before any test module is collected.
os.environ["EXUDYN_NO_USER_SETTINGS"] = "1"
os.environ.setdefault("MPLBACKEND", "Agg")

# A shared machine may stall for a while: no example is failed for its time. In continuous
# integration the examples are always the same; elsewhere every run tries new ones.
hypothesis.settings.register_profile("anywhere", deadline=None)
hypothesis.settings.register_profile("ci", deadline=None, derandomize=True)
hypothesis.settings.load_profile("ci" if os.environ.get("CI") else "anywhere")
