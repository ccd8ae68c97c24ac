"""What every model script shares: --json, --out, --settings, profile options, plain errors."""

from __future__ import annotations

import argparse
import json
import logging
import os
import re
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.contact.descriptions import Track
from exudyn_wheelset.errors import WheelsetError, WheelsetWarning
from exudyn_wheelset.front.settings import load_settings
from exudyn_wheelset.front.warming import warm_up
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.results.files import plain
from exudyn_wheelset.results.motion import Motion

_LOG = logging.getLogger(__name__)
DEFAULT_OUT = Path("runs") / "out"


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in a run whose results so far are kept; `numbers` are those of the script."""

    def __init__(self, numbers: dict[str, Any]) -> None:
        super().__init__("interrupted by the user")
        self.numbers = numbers


def finished(numbers: dict[str, Any], motions: Sequence[Motion]) -> dict[str, Any]:
    """The numbers of a script, once all is kept; raises Interrupted if Ctrl-C ended a motion."""
    if motions and motions[-1].outcome.ending is Ending.INTERRUPTED:
        raise Interrupted(numbers)
    return numbers


def script_parser(description: str, *, settings: bool | Path = True) -> argparse.ArgumentParser:
    """Argument parser with the options common to all model scripts.

    settings: a file of solver settings to take by default; False for a script that needs none.
    """
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    add_common_options(parser, settings=settings, out=DEFAULT_OUT)
    return parser


def add_common_options(
    parser: argparse.ArgumentParser, *, settings: bool | Path = True, out: Path | None = None
) -> None:
    """Add --json, --out and, unless `settings` is False, --settings; out: default of --out."""
    parser.add_argument("--json", action="store_true", help="print only the numbers, as JSON")
    words = "tell remarks as well: what profile readers have done, how long kernels took"
    parser.add_argument("--verbose", action="store_true", help=words)
    where = "directory for figures and data" + ("" if out else "; nothing is written without it")
    parser.add_argument("--out", type=Path, default=out, metavar="FOLDER", help=where)
    if settings:
        default = settings if isinstance(settings, Path) else None
        parser.add_argument(
            "--settings",
            type=Path,
            default=default,
            metavar="FILE",
            help="Exudyn solver settings file (JSON)",
        )


def own_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Values of a script's own options by name, --json and --verbose left out."""
    return {name: v for name, v in vars(arguments).items() if name not in ("json", "verbose")}


def get_ready(arguments: argparse.Namespace) -> exu.SimulationSettings | None:
    """Load the settings of --settings, None where it names no file, and compile the kernels.

    With --verbose it says how long the kernels took. Raises SettingsError for a file that is wrong.
    """
    path = getattr(arguments, "settings", None)
    settings = None if path is None else load_settings(path)
    seconds = warm_up()
    _LOG.info("kernels ready in %.1f s", seconds)
    return settings


@dataclass(frozen=True)
class ScriptProfiles:
    """The profiles and the track that a script's options name.

    wheel, rail: loaded profiles; gauge, gauge_depth [m]; inclination [-]. None where neither the
    command line nor the script's defaults say anything.
    """

    wheel: Profile | None
    rail: Profile | None
    gauge: float | None
    gauge_depth: float | None
    inclination: float | None

    @property
    def changes(self) -> dict[str, Any]:
        """Those that are given, by name: what `catalogue.Changes` and the makers of pairs take."""
        return {name: value for name, value in vars(self).items() if value is not None}

    @property
    def track(self) -> Track:
        """The track of these options; what is None has the default of `Track` (rail: UIC60)."""
        given = {name: value for name, value in self.changes.items() if name != "wheel"}
        return Track(**{"rail": "UIC60", **given})


def add_profile_options(
    parser: argparse.ArgumentParser,
    *,
    wheel: str | None = "S1002",
    rail: str | None = "UIC60",
    gauge: float | None = 1.435,
    gauge_depth: float | None = 0.014,
    inclination: float | None = 1.0 / 40.0,
    defaults: bool = True,
) -> None:
    """Add --wheel, --rail, --gauge, --gauge-depth, --inclination and --smoothing to a script.

    The arguments are the options' defaults; None, or defaults=False for all of them, where the
    script itself knows what to take.
    """
    if not defaults:
        wheel = rail = gauge = gauge_depth = inclination = None
    group = parser.add_argument_group("profiles and track")
    group.add_argument("--wheel", default=wheel, help="wheel profile, name or file")
    group.add_argument("--rail", default=rail, help="rail profile, name or file")
    group.add_argument("--gauge", type=float, default=gauge, help="[m]")
    group.add_argument(
        "--gauge-depth", type=float, default=gauge_depth, help="below the rail's top [m]"
    )
    group.add_argument(
        "--inclination",
        type=inclination_of,
        default=inclination,
        help="of the rails, 1:40 or 0.025",
    )
    group.add_argument(
        "--smoothing",
        type=smoothing_of,
        default=0.0,
        help="of profiles from files: 'auto', or the rms distance of points to curve [m]",
    )


def profiles_from(arguments: argparse.Namespace) -> ScriptProfiles:
    """Load the profiles of the options that `add_profile_options` has added.

    --smoothing holds for profiles from files; those that come with the package are exact.
    Raises ProfileError for a profile that cannot be read.
    """

    return ScriptProfiles(
        script_profile(arguments.wheel, "wheel", arguments.smoothing),
        script_profile(arguments.rail, "rail", arguments.smoothing),
        arguments.gauge,
        arguments.gauge_depth,
        arguments.inclination,
    )


def script_profile(source: str | None, kind: str, smoothing: float | str) -> Profile | None:
    """Load one profile, name or file, as `profiles_from` does; None where none is named."""
    if source is None:
        return None
    return load_profile(source, kind=kind, smoothing=smoothing if Path(source).is_file() else 0.0)


def inclination_of(text: str) -> float:
    """An inclination from "1:40", "1/40", "0.025" or "0"."""
    match = re.fullmatch(r"1\s*[:/]\s*(\d+(?:\.\d*)?)", text.strip())
    try:
        return 1.0 / float(match[1]) if match else float(text)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r}; give 1:40, 1/40, 0.025 or 0") from None


def smoothing_of(text: str) -> float | str:
    """A smoothing from "auto" or a length in metres."""
    if text == "auto":
        return text
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give 'auto' or metres, such as 1e-5") from None


def _shown_by(prog: str, others: Callable[..., None]) -> Callable[..., None]:
    """What shows a warning of this package as one line of the script, and `others` as they do.

    What was warned of once, at another speed or by a later analysis, is not said again.
    """
    heard = set()

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, WheelsetWarning):
            about = getattr(message, "about", "") or place
            if about not in heard:
                heard.add(about)
                print(f"{prog}: {message}", file=sys.stderr)
        else:
            others(message, category, *place, **more)

    return show


def run_script(
    run: Callable[[argparse.Namespace], dict[str, Any]],
    parser: argparse.ArgumentParser,
    argv: Sequence[str] | None = None,
    show: Callable[[dict[str, Any]], None] | None = None,
) -> int:
    """Run a script's `run`, print its numbers, turn errors and warnings into one line each.

    Returns the exit status: 0, 2 after an error, 130 after Ctrl-C. show prints the numbers for
    people; with --json they are printed as one JSON object, null for what is not a finite number.
    """
    return run_parsed(run, parser.parse_args(argv), parser.prog, show)


def run_parsed(
    run: Callable[[argparse.Namespace], dict[str, Any]],
    arguments: argparse.Namespace,
    prog: str,
    show: Callable[[dict[str, Any]], None] | None = None,
) -> int:
    """As `run_script`, with the command line already parsed; prog: name of the script.

    With --json nothing is written but where --out says: `arguments.out` is None without it.
    """
    if arguments.json and getattr(arguments, "out", None) is DEFAULT_OUT:
        arguments.out = None
    # With --json only numbers on one stream and errors on the other: no word of kernels compiled.
    quiet = logging.ERROR if arguments.json else logging.WARNING
    with _remarks_of(prog, logging.INFO if arguments.verbose else quiet):
        return _run_parsed(run, arguments, prog, show)


@contextmanager
def _remarks_of(prog: str, level: int) -> Iterator[None]:
    """Let the package's log speak on standard error as lines of a script, from `level` on."""
    log = logging.getLogger("exudyn_wheelset")
    before, passed_on = log.level, log.propagate
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter(f"{prog}: %(message)s"))
    log.addHandler(handler)
    log.setLevel(level)
    log.propagate = False
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.setLevel(before)
        log.propagate = passed_on


def _run_parsed(
    run: Callable[[argparse.Namespace], dict[str, Any]],
    arguments: argparse.Namespace,
    prog: str,
    show: Callable[[dict[str, Any]], None] | None,
) -> int:
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _shown_by(prog, warnings.showwarning)
            numbers = run(arguments)
        _tell(numbers, arguments.json, show)
    except WheelsetError as error:
        print(f"{prog}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as interrupt:
        if isinstance(interrupt, Interrupted) and show is not None and not arguments.json:
            show(interrupt.numbers)
        print(f"{prog}: interrupted; finished results are kept", file=sys.stderr)
        return 130
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        print(f"{prog}: {where}{error.strerror or error}", file=sys.stderr)
        _forget_output()
        return 2
    except MemoryError:
        print(f"{prog}: not enough memory for so many numbers", file=sys.stderr)
        return 2
    return 0


def _tell(
    numbers: dict[str, Any], as_json: bool, show: Callable[[dict[str, Any]], None] | None
) -> None:
    """Print numbers; who reads may have heard enough before the end (`... | head`)."""
    try:
        if as_json:
            print(json.dumps(_finite(numbers), default=plain, allow_nan=False))
        elif show is not None:
            show(numbers)
        sys.stdout.flush()
    except BrokenPipeError:
        _forget_output()


def _finite(value: Any) -> Any:
    """Numbers as JSON knows them: None in place of infinities and what is no number."""
    if isinstance(value, dict):
        return {str(name): _finite(entry) for name, entry in value.items()}
    if isinstance(value, np.ndarray):
        return _finite(value.tolist())
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else None
    return value


def _forget_output() -> None:
    """Let what could not be printed go, which Python would try again on its way out."""
    try:
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, sys.stdout.fileno())
        os.close(nothing)
    except (OSError, ValueError):
        pass
