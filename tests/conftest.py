"""Every test starts from Exudyn's own defaults, draws without a display and takes one core."""

import os

import hypothesis

# All are read on import, so they are set before any test module is collected.
os.environ["EXUDYN_NO_USER_SETTINGS"] = "1"
os.environ.setdefault("MPLBACKEND", "Agg")
# Tests run one process a core: threads of linear algebra beside them only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A shared machine may stall for a while: no example is failed for its time. In continuous
# integration the examples are always the same; elsewhere every run tries new ones.
hypothesis.settings.register_profile("anywhere", deadline=None)
hypothesis.settings.register_profile("ci", deadline=None, derandomize=True)
hypothesis.settings.load_profile("ci" if os.environ.get("CI") else "anywhere")
