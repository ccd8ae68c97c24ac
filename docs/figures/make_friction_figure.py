"""Make the figure of friction in docs/vehicles.md: what models/freight_car.py draws.

    python docs/figures/make_friction_figure.py

Critical speed over the friction of the wedges, a hunt of the empty and of the loaded car, and the
lateral friction of one wedge over its sliding. Takes half a minute.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "models"))
import freight_car  # noqa: E402


def main() -> None:
    """Run the script's own numbers and keep its figure."""
    with TemporaryDirectory() as folder:
        freight_car.run(out=folder)
        shutil.copy(Path(folder) / "freight_car.png", HERE / "friction_freight_car.png")


if __name__ == "__main__":
    main()
