"""Normal models that take longest to compile, which few runs need: apart from the rest."""

from exudyn_wheelset.apart import Apart
from exudyn_wheelset.contact.energy_side import energy_at
from exudyn_wheelset.contact.ritz_side import ritz_at
from exudyn_wheelset.contact.strip_side import strip_traction_at, strips_at

RITZ_SIDE = Apart(ritz_at, "iiiii" + "fffff")
ENERGY_SIDE = Apart(energy_at, "iiiii" + "fffff")
STRIP_SIDE = Apart(strips_at, "iiiii" + "fffff")
STRIP_TRACTION = Apart(strip_traction_at, "iiii" + "fffffff", results=6)
