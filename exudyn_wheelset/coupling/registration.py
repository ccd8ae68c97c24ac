"""What a model knows of itself: its wheelsets and its first-order states, found again in `mbs`.

Nothing is kept beside the Exudyn system. The user functions of loads and objects, which Exudyn
hands back as they were given, carry the description; to register is to mark one, to look up is to
ask all. So a system that was reset has no wheelsets, several systems in one process do not mix, and
an item that was replaced is gone from here as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import exudyn as exu

from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt, spelt_class

_WHEELSET = "registered_wheelset"
_STATES = "first_order_states"


@spelt_class
@dataclass(frozen=True)
class WheelsetItems:
    """Item numbers of a wheelset in an Exudyn system, and its contact.

    node, body: the rigid body; marker: on its centre; force_load, torque_load: contact loads;
    left_sensor, right_sensor: user sensors with SENSOR_VALUES of either wheel (None if not asked
    for); contact: the WheelRailContact behind the loads; name: of the body, the only one in its
    system; moving_frame: whether the model stands in a frame that moves at the forward speed.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn_wheelset import Track, Wheelset, create_wheelset
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> items = create_wheelset(mbs, axle, Track("UIC60"), name="leading")
    >>> items.name, items.moving_frame
    ('leading', False)
    """

    node: int
    body: int
    marker: int
    force_load: int
    torque_load: int
    left_sensor: int | None
    right_sensor: int | None
    contact: WheelRailContact
    name: str = "wheelset"
    moving_frame: bool = True

    @property
    def reference(self) -> tuple[float, float, float]:
        """Centre (x, y, z) [m] in the reference configuration, track frame."""
        x, y, z = self.contact.reference
        return float(x), float(y), float(z)


@dataclass(frozen=True)
class FirstOrderState:
    """A first-order coordinate: its name, its unit ("m", "N", ...) and a typical magnitude."""

    name: str
    unit: str
    scale: float

    def __post_init__(self) -> None:
        if not self.scale > 0.0:
            raise WheelsetError(
                f"first-order state {self.name!r}: scale = {self.scale!r}: give a typical "
                f"magnitude above 0 {self.unit}"
            )


def register_wheelset(function: Callable[..., Any], items: WheelsetItems) -> None:
    """Let `function`, the user function of a wheelset's force load, tell of the wheelset."""
    setattr(function, _WHEELSET, items)


@spelt
def wheelsets_of(mbs: Any) -> tuple[WheelsetItems, ...]:
    """The wheelsets that `create_wheelset` has added to `mbs`, in the order of their creation.

    Raises WheelsetError for what is no Exudyn system.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn_wheelset import Track, Wheelset, create_wheelset, wheelsets_of
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> for name, x in (("leading", 1.2), ("trailing", -1.2)):
    ...     items = create_wheelset(mbs, axle, Track("UIC60"), position=(x, 0), name=name)
    ...
    >>> [items.name for items in wheelsets_of(mbs)]
    ['leading', 'trailing']
    """
    if not isinstance(mbs, exu.MainSystem):
        raise WheelsetError(f"mbs is a {type(mbs).__name__}: give Exudyn's system, SC.AddSystem()")
    found = []
    for load in range(mbs.systemData.NumberOfLoads()):
        function = _function(mbs.GetLoad(load).get("loadVectorUserFunction"))
        items = getattr(function, _WHEELSET, None)
        if items is not None:
            found.append(items)
    return tuple(found)


def name_states(
    function: Callable[..., Any], states: Sequence[FirstOrderState]
) -> Callable[..., Any]:
    """Let `function`, the right-hand side of an ObjectGenericODE1, name its states; return it.

    states: one for each coordinate of the object, in the order of its nodes. ExudynSystem takes
    their names and scales over.
    """
    setattr(function, _STATES, tuple(states))
    return function


def named_states(mbs: Any) -> dict[tuple[int, int], FirstOrderState]:
    """The states that `name_states` has named, by node and coordinate of the node.

    Raises WheelsetError where an object has another number of coordinates than of names.
    """
    found: dict[tuple[int, int], FirstOrderState] = {}
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        states = getattr(_function(item.get("rhsUserFunction")), _STATES, None)
        if states is None:
            continue
        places = [
            (int(node), k)
            for node in item["nodeNumbers"]
            for k in range(mbs.GetNode(int(node))["numberOfODE1Coordinates"])
        ]
        if len(places) != len(states):
            raise WheelsetError(
                f"{item['name']}: {len(states)} first-order states are named, its nodes have "
                f"{len(places)}: name each of them"
            )
        found.update(zip(places, states, strict=True))
    return found


def unused_name(mbs: Any, name: str) -> str:
    """`name`, with a number added if a wheelset of `mbs` is called so already."""
    taken = {items.name for items in wheelsets_of(mbs)}
    number, unused = 1, name
    while unused in taken:
        number += 1
        unused = f"{name} {number}"
    return unused


def _function(entry: Any) -> Any:
    """The Python function behind Exudyn's description of a user function."""
    return entry.get("function") if isinstance(entry, dict) else entry
