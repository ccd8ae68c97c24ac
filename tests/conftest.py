"""Every test starts from Exudyn's own defaults and draws without a display."""

import os

# Both are read on import, so they are set before any test module is collected.
os.environ["EXUDYN_NO_USER_SETTINGS"] = "1"
os.environ.setdefault("MPLBACKEND", "Agg")
