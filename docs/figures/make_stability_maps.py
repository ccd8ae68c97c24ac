"""Figures of docs/stability-maps.md: maps of the bogie and the S1002 wheelset, a tornado diagram.

Some ten minutes of one core. `python docs/figures/make_stability_maps.py`
"""

from pathlib import Path

from exudyn_wheelset import nonlinear_critical_speed, stability_map
from exudyn_wheelset.catalogue import vehicle
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.plots import new_figure

PLACE = Path(__file__).parent


def draw_maps(conicity, friction, gauge) -> None:
    """Three maps side by side."""
    figure, axes = new_figure(13.0, 4.2, 1, 3)
    for ax, found, title in zip(
        axes[0],
        (conicity, friction, gauge),
        ("Cooperrider's bogie", "Cooperrider's bogie", "S1002 wheelset on UIC60 1:40"),
        strict=True,
    ):
        found.plot(ax)
        ax.set_title(title, fontsize=10)
    axes[0, 0].set_ylim(25.0, 120.0)
    axes[0, 2].set_ylim(38.0, 90.0)
    write_figure(PLACE / "stability_maps.png", figure)


def draw_friction_and_guidance(friction, spring, car) -> None:
    """The S1002 wheelset over friction and stiffness, a car over that of its axle guidance."""
    figure, axes = new_figure(13.0, 4.2, 1, 3)
    friction.plot(axes[0, 0])
    axes[0, 0].set_title("S1002 wheelset on UIC60 1:40", fontsize=10)
    spring.plot(axes[0, 1])
    axes[0, 1].set_title("S1002 wheelset on UIC60 1:40", fontsize=10)
    axes[0, 1].set_xlabel("longitudinal stiffness of a spring [N/m]")
    car.plot(axes[0, 2])
    axes[0, 2].set_title("DTU car", fontsize=10)
    axes[0, 2].set_xlabel("longitudinal stiffness of the primary springs [N/m]")
    for ax in axes[0, 1:]:
        ax.get_legend().remove()
    write_figure(PLACE / "stability_maps_friction_stiffness.png", figure)


def draw_tornado(gradient) -> None:
    """What moves the fold of the bogie."""
    figure, axes = new_figure(7.5, 4.2)
    gradient.plot(axes[0, 0], most=12)
    write_figure(PLACE / "tornado_bogie.png", figure)


def main() -> None:
    """Make all figures."""
    draw_maps(
        stability_map("cooperrider", "speed", "conicity", (0.02, 0.2)),
        stability_map("cooperrider", "speed", "friction", (0.05, 0.4)),
        stability_map(
            vehicle("s1002", normal="hertz"),
            "speed",
            "gauge",
            (1.432, 1.437),
            points=20,
            most=80,
        ),
    )
    draw_friction_and_guidance(
        stability_map(
            vehicle("s1002", normal="hertz"), "speed", "friction", (0.1, 0.5), starts=2, points=12
        ),
        stability_map(
            vehicle("s1002", normal="hertz"),
            "speed",
            "connections.spring.stiffness.x",
            (0.8e6, 3.2e6),
            starts=2,
            points=12,
            most=60,
        ),
        stability_map(
            vehicle("dtu_car", normal="hertz"),
            "speed",
            "connections.primary.stiffness.x",
            (1e6, 8e6),
            speeds=(15.0, 120.0),
            folds=False,
            points=20,
        ),
    )
    draw_tornado(nonlinear_critical_speed("cooperrider", check=False).gradient())


if __name__ == "__main__":
    main()
