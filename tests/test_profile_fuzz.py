"""Damaged files of every format give a Profile or a ProfileError, nothing else, within a second.

The damage is drawn from a seeded generator, so a failure names the case that repeats it.
"""

import random
import time
import warnings

import numpy as np
import pytest
from test_profile_formats import miniprof, simpack, vampire

from exudyn_wheelset.errors import ProfileError, WheelsetWarning
from exudyn_wheelset.profiles import Profile, load_profile, shapes
from exudyn_wheelset.profiles.formats import two_column

WHEEL = shapes.s1002().resampled(1.5e-3)
RAIL = shapes.uic60().resampled(1.5e-3)


def gensys(profile):
    return "\n".join(
        f"{-1e3 * y:.6f} {-1e3 * z:.6f}" for y, z in zip(profile.y, profile.z, strict=True)
    )


def csv(profile):
    rows = [f"{1e3 * y:.6f};{1e3 * z:.6f}" for y, z in zip(profile.y, profile.z, strict=True)]
    return "y [mm];z [mm]\n" + "\n".join(rows).replace(".", ",")


def numbered(profile):
    return "\n".join(
        f"{i};{1e3 * y:.5f};{1e3 * z:.5f}".replace(".", ",")
        for i, (y, z) in enumerate(zip(profile.y, profile.z, strict=True))
    )


def template(profile):
    x, y = -1e3 * profile.y[::-1], 1e3 * profile.z[::-1]
    pieces = [
        f"MPD{i}=L {x[i - 1]:.6f} {y[i - 1]:.6f} {x[i]:.6f} {y[i]:.6f}" for i in range(1, len(x))
    ]
    return "[FileInfo]\nProgramName=MiniProf\nMPDC=1\n" + "\n".join(pieces)


FILES = [
    ("a.txt", two_column.write(WHEEL)),
    ("b.txt", two_column.write(RAIL)),
    ("c.dat", "\n".join(two_column.write(WHEEL).split("\n")[5:])),
    ("d.csv", csv(RAIL)),
    ("e.csv", csv(WHEEL)),
    ("f.prw", simpack(WHEEL, shift_y=0.0, rotate=0.0, mirror_z=0, bound_y_min=1.0)),
    ("g.prr", simpack(RAIL, point_dist_min=0.0, inversion=0)),
    ("h.whl", miniprof(WHEEL, "X,Y,A,C")),
    ("i.ban", miniprof(RAIL)),
    ("j.rai", vampire(RAIL, RAIL)),
    ("k.whe", vampire(WHEEL, WHEEL)),
    ("l.wheel", gensys(WHEEL)),
    ("m.rail", gensys(RAIL)),
    ("n.mpt", template(RAIL)),
    (
        "o.whl",
        "#MINIWHEELPROF\ncar\n 31.2 28.1 10.5\n(Sd/Sh/qR)\n\n" + miniprof(WHEEL).split("\n\n")[1],
    ),
    ("p.csv", "Calipri;1\nDatum;2021-03-04\nEinheit;mm\nNr;Quer;Höhe\n" + numbered(WHEEL)),
    ("q.txt", f"left\n{gensys(WHEEL)}\nright\n{gensys(WHEEL)}\n"),
]
NASTY = [
    *("nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "1e999", "9" * 30, "0", "-0.0"),
    *(
        "1_000",
        "0x1F",
        "١٢",
        "1,5",
        "1e",
        ".5.",
        "--",
        "−1",
        ";",
        ",",
        "\t",
        "#",
        "!",
        "%",
        "=",
        "==",
    ),
    *("kind:", "unit:m", "mm", "\x00", "\ufeff", "é", "€", "point.begin", "spline.end", "CUSTOM"),
]


def damaged(chance, data):
    """One to four kinds of damage to the bytes of a file."""
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        kind = chance.randrange(12)
        if not data:
            return data
        if kind == 0:
            data = data[: chance.randrange(len(data))]
        elif kind == 1:
            flipped = bytearray(data)
            for _ in range(chance.choice((1, 3, 30))):
                flipped[chance.randrange(len(flipped))] ^= 1 << chance.randrange(8)
            data = bytes(flipped)
        elif kind == 2:
            position = chance.randrange(len(data))
            data = data[:position] + chance.randbytes(chance.choice((1, 5, 200))) + data[position:]
        elif kind == 3:
            source, target = chance.sample(["utf-8", "latin-1", "utf-16", "utf-32", "cp037"], 2)
            data = data.decode(source, errors="replace").encode(target, errors="replace")
        elif kind == 4:
            data = data[chance.randrange(len(data)) :]
        elif kind == 5:
            data = data.replace(
                *chance.choice([(b".", b","), (b" ", b";"), (b"-", b""), (b"\n", b" ")])
            )
        else:
            lines = data.split(b"\n")
            i = chance.randrange(len(lines))
            cells = lines[i].split(b" ")
            if kind == 6:
                lines = [b" ".join(line.split()[: chance.choice((0, 1, 1, 3))]) for line in lines]
            elif kind == 7:
                cells[chance.randrange(len(cells))] = chance.choice(NASTY).encode()
                lines[i] = b" ".join(cells)
            elif kind == 8:
                lines.insert(chance.randrange(len(lines)), lines[i])
            elif kind == 9:
                del lines[i : i + chance.choice((1, 3, 50))]
            elif kind == 10:
                chance.shuffle(lines)
            else:
                j = chance.randrange(len(lines))
                lines[i], lines[j] = lines[j], lines[i]
            data = b"\n".join(lines)
    return data


def options_of(chance):
    options = {}
    if chance.random() < 0.3:
        options["kind"] = chance.choice(("wheel", "rail"))
    if chance.random() < 0.2:
        options["unit"] = chance.choice(("mm", "m", "cm", "inch"))
    if chance.random() < 0.2:
        options["smoothing"] = chance.choice((1e-9, 1e-6, 1e-4, 1e-3, "auto"))
    if chance.random() < 0.2:
        options["outlier_tolerance"] = chance.choice((1e-12, 1e-6, 1e-4, 1e-2))
    if chance.random() < 0.2:
        options["side"] = "right"
    if chance.random() < 0.1:
        options["format"] = chance.choice(
            ("two-column", "simpack", "miniprof", "vampire", "gensys")
        )
    return options


def attack(folder, seeds):
    """Number of files read in spite of their damage; raises for any other outcome."""
    survivors = 0
    for seed in seeds:
        chance = random.Random(seed)
        name, text = FILES[seed % len(FILES)]
        path = folder / name
        path.write_bytes(damaged(chance, text.encode()))
        options = options_of(chance)
        begin = time.process_time()
        try:
            profile = load_profile(path, **options)
        except ProfileError as error:
            assert str(path) in str(error) or "kind=" in str(error), f"seed {seed}: {error}"
        except BaseException as error:
            raise AssertionError(f"seed {seed}: {type(error).__name__}: {error}") from error
        else:
            assert isinstance(profile, Profile)
            table = profile.arc_table(1e-3)
            assert np.all(np.isfinite(table.coefficients)), f"seed {seed}"
            assert np.all(np.isfinite(profile.height(np.linspace(*profile.span, 50))))
            survivors += 1
        assert time.process_time() - begin < 1.0, f"seed {seed} takes too long"
    return survivors


def test_500_damaged_files(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", WheelsetWarning)
        assert attack(tmp_path, range(500)) > 20


@pytest.mark.slow
def test_10000_damaged_files(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", WheelsetWarning)
        assert attack(tmp_path, range(500, 10_500)) > 500
