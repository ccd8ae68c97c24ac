"""Make the README's picture of the freight car.

python docs/figures/make_freight_car_picture.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exudyn_wheelset import catalogue
from exudyn_wheelset.front.animation import Camera, render, write_image
from exudyn_wheelset.front.pictures import on_rails

HERE = Path(__file__).parent
SIZE = (1200, 440)


def main() -> Path:
    """Write freight_car.png beside this script: the whole car, and a truck of it."""
    car = catalogue.freight_car()
    container, mbs = on_rails(car, 20.0, -15.0, 15.0)
    mbs.SendRedrawSignal()
    whole = Camera(azimuth=-0.95, elevation=0.16, centre=(1.0, 0.0, 1.7), zoom=9.8, perspective=0.1)
    near = Camera(azimuth=-1.0, elevation=0.1, centre=(6.6, 0.3, 0.75), zoom=2.3, perspective=0.1)
    wide = SIZE[0] * 5 // 8
    pictures = [
        render(container, camera, (width, SIZE[1]), 2)
        for camera, width in ((whole, wide), (near, SIZE[0] - wide))
    ]
    gap = np.full((SIZE[1], 8, 3), 255, dtype=np.uint8)
    return write_image(HERE / "freight_car.png", np.hstack([pictures[0], gap, pictures[1]]))


if __name__ == "__main__":
    print(main())
