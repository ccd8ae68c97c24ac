"""Errors and warnings of exudyn_wheelset.

All errors derive from `WheelsetError`, so one `except` catches them; all warnings are
`WheelsetWarning`, so one filter silences them or turns them into errors.
"""


class WheelsetError(ValueError):
    """Base of every error this package raises on purpose.

    Examples
    --------
    >>> from exudyn_wheelset import Contact, WheelsetError
    >>> try:
    ...     Contact(friction=-0.3)
    ... except WheelsetError as error:
    ...     print(error)
    ...
    friction = -0.3: give a number from 0 to 5
    """


class ProfileError(WheelsetError):
    """A wheel or rail profile that cannot be used; names the file, the line and the mend.

    Examples
    --------
    >>> from exudyn_wheelset import ProfileError, load_profile
    >>> try:
    ...     load_profile("S1002", kind="rail")
    ... except ProfileError as error:
    ...     print(error)
    ...
    S1002 is a wheel, but kind='rail' was asked
    """


class ContactError(WheelsetError):
    """A wheelset position for which no contact of wheel and rail exists.

    Examples
    --------
    >>> from exudyn_wheelset import ContactError, Track, Wheelset, contact_geometry
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> try:
    ...     contact_geometry(axle, Track("UIC60"), y=0.09)
    ... except ContactError as error:
    ...     print(str(error)[:39])
    ...
    no rigid contact at y = 90.000 mm, yaw
    """


class SettingsError(WheelsetError):
    """An entry of a solver settings file that Exudyn does not know or that has a wrong type.

    Examples
    --------
    >>> from exudyn_wheelset import SettingsError, load_settings
    >>> try:
    ...     load_settings({"timeIntegration.endtime": 2.0})
    ... except SettingsError as error:
    ...     print(str(error).partition(";")[0])
    ...
    settings: Exudyn has no setting 'timeIntegration.endtime'
    """


class AnalysisError(WheelsetError):
    """An analysis that cannot give a result; says how far it came and why it ended.

    Examples
    --------
    >>> from exudyn_wheelset import AnalysisError, linear_critical_speed
    >>> try:
    ...     linear_critical_speed("cooperrider", 20, 40)
    ... except AnalysisError as error:
    ...     print("none between 20 and 40 m/s")
    ...
    none between 20 and 40 m/s
    """


class WheelsetWarning(UserWarning):
    """A result that is given but not to be trusted; has the number, its limit and the mend.

    Examples
    --------
    >>> import warnings
    >>> from exudyn_wheelset import Wheelset, WheelsetWarning
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always", WheelsetWarning)
    ...     axle = Wheelset(1.5, (800, 110, 800), 0.46, "S1002")  # tonnes
    ...
    >>> len(caught)
    1
    """


class VehicleError(WheelsetError):
    """A vehicle file that gives no vehicle; names the file, the line, the value and the mend.

    Examples
    --------
    >>> from exudyn_wheelset import VehicleError, load_vehicle
    >>> try:
    ...     load_vehicle("nowhere.toml")
    ... except VehicleError as error:
    ...     print(error)
    ...
    nowhere.toml: no such file: give the path of a vehicle file (TOML)
    """


class FileError(WheelsetError):
    """A result that cannot be written: the file and the reason."""
