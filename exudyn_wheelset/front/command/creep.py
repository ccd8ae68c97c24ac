"""`exudyn-wheelset creep`: creep forces of laws beside each other, over creepage or spin.

The patch is an ellipse; forces act on the wheel, as `creep_force` has them (docs/conventions.md).
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from exudyn_wheelset.creep import creep_force
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import own_options
from exudyn_wheelset.front.values import values_of
from exudyn_wheelset.front.vehicle_options import CreepWord, law_and_parameters
from exudyn_wheelset.results.files import write_columns

ABOUT = (
    "Longitudinal and lateral force and spin moment on the wheel, for an elliptic patch with\n"
    "semi-axes a along rolling and b across. One of the creepages may be a range LOW:HIGH:COUNT."
)
EXAMPLES = (
    "creep --creep polach --creep fastsim --creep exact-table --creep-x 0:0.01:21",
    "creep --creep polach-2005:friction_ratio=0.3 --creep-y 0:0.02:11 --normal-force 100e3 --json",
    "creep --creep exact-table --spin 0:1:11 --a 6e-3 --b 4e-3 --friction 0.4 --out figures",
)
SETTINGS = False
SWEPT = ("creep_x", "creep_y", "spin")
_LABELS = {"creep_x": "creepage x [-]", "creep_y": "creepage y [-]", "spin": "spin [1/m]"}
_COLUMNS = {"creep_x": "creep_x [-]", "creep_y": "creep_y [-]", "spin": "spin [1/m]"}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Laws, creepages and the patch."""
    add = parser.add_argument
    add(
        "--creep",
        action="append",
        type=law_and_parameters,
        metavar="LAW[:NAME=VALUE,...]",
        help="a law, with its parameters; may be given several times; default exact-table. "
        "`exudyn-wheelset info` lists them",
    )
    add("--creep-x", type=values_of, metavar="X", help="longitudinal creepage [-]")
    add("--creep-y", type=values_of, metavar="Y", help="lateral creepage [-]")
    add("--spin", type=values_of, metavar="PHI", help="spin [1/m]")
    add("--a", type=float, default=5.5e-3, metavar="M", help="semi-axis along rolling, 5.5e-3 m")
    add("--b", type=float, default=5.5e-3, metavar="M", help="semi-axis across, 5.5e-3 m")
    add("--normal-force", type=float, default=80e3, metavar="N", help="80e3 N")
    add("--friction", type=float, default=0.3, help="coefficient, 0.3")
    add("--shear-modulus", type=float, default=82e9, metavar="PA", help="82e9 Pa")
    add("--poisson", type=float, default=0.28, help="0.28")


def run(
    laws: list[CreepWord],
    creep_x: Any = 0.0,
    creep_y: Any = 0.0,
    spin: Any = 0.0,
    a: float = 5.5e-3,
    b: float = 5.5e-3,
    normal_force: float = 80e3,
    friction: float = 0.3,
    shear_modulus: float = 82e9,
    poisson: float = 0.28,
) -> dict[str, Any]:
    """Creepages, and force_x, force_y [N], moment [N m] on the wheel by law, each (n,)."""
    given = [np.atleast_1d(np.asarray(values, dtype=float)) for values in (creep_x, creep_y, spin)]
    several = [name for name, values in zip(SWEPT, given, strict=True) if len(values) > 1]
    if len(several) > 1:
        raise WheelsetError(f"{' and '.join(several)} are ranges: give one range, numbers else")
    creepages = np.broadcast_arrays(*given)
    patch = (a, b, normal_force, friction, shear_modulus, poisson)
    numbers: dict[str, Any] = {
        "over": several[0] if several else SWEPT[0],
        **{name: values.tolist() for name, values in zip(SWEPT, creepages, strict=True)},
        "laws": {},
    }
    for word in laws:
        along, across, turning = creepages
        forces = creep_force(word.law, along, across, turning, *patch, **word.parameters)
        numbers["laws"][str(word)] = {
            name: np.asarray(values).tolist()
            for name, values in zip(("force_x", "force_y", "moment"), forces, strict=True)
        }
    return numbers


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """The numbers of the options; with --out, a figure and a table of each law."""
    values = {name: v for name, v in own_options(arguments).items() if v is not None}
    out, laws = values.pop("out", None), values.pop("creep", [law_and_parameters("exact-table")])
    if not any(name in values for name in SWEPT):
        values["creep_x"] = np.linspace(0.0, 0.01, 11)
    numbers = run(laws, **values)
    if out is None:
        return numbers
    over = numbers["over"]
    figure, axes = new_figure(9.0, 3.6, 1, 2)
    files = []
    for law, forces in numbers["laws"].items():
        for panel, name in zip(axes[0], ("force_x", "force_y"), strict=True):
            panel.plot(numbers[over], 1e-3 * np.array(forces[name]), label=law)
            panel.set(xlabel=_LABELS[over], ylabel=f"{name.replace('_', ' ')} on the wheel [kN]")
        columns = {_COLUMNS[name]: numbers[name] for name in SWEPT}
        columns |= {f"{name} [N]": forces[name] for name in ("force_x", "force_y")}
        columns["moment [N m]"] = forces["moment"]
        name = law.replace(":", "_").replace(",", "_").replace("=", "_")
        files.append(write_columns(out / f"creep_{name}.csv", columns))
    axes[0, 0].legend(fontsize=8, frameon=False)
    files.append(write_figure(out / "creep.png", figure))
    files.append(
        write_json(out / "creep.json", numbers, patch=values | {"creep": list(map(str, laws))})
    )
    numbers["files"] = [str(file) for file in files]
    return numbers


def show(numbers: dict[str, Any]) -> None:
    """Print a table of each law."""
    over = numbers["over"]
    for law, forces in numbers["laws"].items():
        print(f"{law}\n{_LABELS[over]:>16s}{'Fx [N]':>12s}{'Fy [N]':>12s}{'Mz [N m]':>12s}")
        rows = zip(numbers[over], *forces.values(), strict=True)
        for at, *values in rows:
            print(f"{at:16.5g}" + "".join(f"{value:12.2f}" for value in values))
    print(*numbers.get("files", ()), sep="\n")
