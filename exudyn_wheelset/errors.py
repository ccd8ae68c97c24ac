"""Errors and warnings of exudyn_wheelset.

All errors derive from `WheelsetError`, so one `except` catches them; all warnings are
`WheelsetWarning`, so one filter silences them or turns them into errors.
"""


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


class WheelsetWarning(UserWarning):
    """A result that is given but not to be trusted; has the number, its limit and the mend."""


class VehicleError(WheelsetError):
    """A vehicle file that gives no vehicle; names the file, the line, the value and the mend."""


class FileError(WheelsetError):
    """A result that cannot be written: the file and the reason."""
