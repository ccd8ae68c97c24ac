"""Errors of exudyn_wheelset; all derive from `WheelsetError`, so one `except` catches them."""


class WheelsetError(ValueError):
    """Base of every error this package raises on purpose."""


class ProfileError(WheelsetError):
    """A wheel or rail profile that cannot be used; names the file, the line and the mend."""


class ContactError(WheelsetError):
    """A wheelset position for which no contact of wheel and rail exists."""


class SettingsError(WheelsetError):
    """An entry of a solver settings file that Exudyn does not know or that has a wrong type."""


class AnalysisError(WheelsetError):
    """An analysis that cannot give a result; says how far it came and why it ended."""
