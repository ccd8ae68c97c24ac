"""Wheel and rail profiles: points, smooth curves, shapes from formulas, files."""

from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.profiles.curve import ArcTable
from exudyn_wheelset.profiles.files import load_profile, save_profile
from exudyn_wheelset.profiles.mean import mean_profile
from exudyn_wheelset.profiles.profile import Profile

__all__ = ["ArcTable", "Profile", "load_profile", "mean_profile", "save_profile", "shapes"]
