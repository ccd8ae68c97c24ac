"""Files as other programs and settings write them: S1002 and UIC60 in every dress.

The shape that comes back is the one that was written. Conventions as in test_profile_formats.py;
VI-Rail's headings as Adams' TeimOrbit files have them ([MDI_HEADER], [UNITS]), lists of slices as
the open readers of the program CONTACT take them. What is refused names line, value and mend.
"""

import numpy as np
import pytest

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import load_profile, shapes

WHEEL, RAIL = shapes.s1002().resampled(3e-4), shapes.uic60().resampled(3e-4)
pytestmark = pytest.mark.filterwarnings("ignore::exudyn_wheelset.errors.WheelsetWarning")
REACH = {"wheel": np.linspace(-0.068, 0.058, 300), "rail": np.linspace(-0.0355, 0.0355, 300)}
# heights of four decimals in mm, on the 75 degrees of a flange or a rail's flank
ROUNDED = 1e-6


def points(profile):
    """y, z in mm, z up."""
    return 1e3 * np.column_stack([profile.y, profile.z])


def instrument(profile):
    """MiniProf's X and Y."""
    sign = 1.0 if profile.kind == "wheel" else -1.0
    return np.array([sign, -sign]) * points(profile) + [70.0 * (profile.kind == "wheel"), 0.0]


def rows(table, separator=" ", decimals=4):
    return [separator.join(f"{value:.{decimals}f}" for value in row) for row in table]


def commas(lines):
    return [line.replace(".", ",") for line in lines]


def found(tmp_path, lines, name, **options):
    path = tmp_path / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return load_profile(path, **options)


def same(profile, expected, tolerance=ROUNDED):
    y = REACH[expected.kind]
    assert profile.kind == expected.kind
    np.testing.assert_allclose(profile.height(y), expected.height(y), atol=tolerance)


KEYS = ("ProgramName=MiniProf for Windows", "Date=08/07/2015", "XYPoints=9999", "ColumnDef=X,Y")


class TestMiniProf:
    def head(self, profile, *more):
        return [line.replace("9999", str(len(profile.y))) for line in KEYS] + [*more, ""]

    @pytest.mark.parametrize(
        "keys", [("MPTypeNo=131",), ("Sd=32.58", "Sh=28.11", "qR=10.7"), ("Comment=no key at all",)]
    )
    @pytest.mark.parametrize("name", ["a.txt", "a.mpt"])
    def test_a_wheel_without_the_wheels_suffix(self, tmp_path, name, keys):
        """By the instrument's type, by the wheel's wear, by the shape."""
        lines = [*self.head(WHEEL, *keys), *rows(instrument(WHEEL))]
        same(found(tmp_path, lines, name), WHEEL)

    @pytest.mark.parametrize(
        "keys", [("MPTypeNo=211",), ("Rail=left", "W1=0.34"), ("Comment=no key at all",)]
    )
    def test_a_rail_without_the_rails_suffix(self, tmp_path, keys):
        lines = [*self.head(RAIL, *keys), *rows(instrument(RAIL))]
        same(found(tmp_path, lines, "a.txt"), RAIL)

    def test_x_that_falls_from_the_flange_back(self, tmp_path):
        profile = found(
            tmp_path, [*self.head(WHEEL), *rows(instrument(WHEEL) * [-1.0, 1.0])], "a.whl"
        )
        same(profile, WHEEL)
        assert "X falls" in " ".join(profile.remarks)

    def test_inches(self, tmp_path):
        lines = [*self.head(WHEEL), *rows(instrument(WHEEL) / 25.4, decimals=6)]
        same(found(tmp_path, lines, "a.whl", unit="inch"), WHEEL)
        with pytest.raises(ProfileError, match="look like inch"):
            found(tmp_path, lines, "a.whl")

    @pytest.mark.parametrize("mark", ["!", "%", '"'])
    def test_notes_behind_points(self, tmp_path, mark):
        table = [
            f"{row} {mark} a note" if k % 9 == 0 else row
            for k, row in enumerate(rows(instrument(RAIL)))
        ]
        same(found(tmp_path, [*self.head(RAIL), *table], "a.ban"), RAIL)

    @pytest.mark.parametrize("columns", ["X,Y,*", "x,y,a,c", "X Y A C", "N,X,Y"])
    def test_definitions_of_columns(self, tmp_path, columns):
        head = [line.replace("X,Y", columns) for line in self.head(WHEEL)]
        first = [f"{k + 1} " if columns[0] == "N" else "" for k in range(len(WHEEL.y))]
        table = [
            f"{n}{row} 0.1 0.02" for n, row in zip(first, rows(instrument(WHEEL)), strict=True)
        ]
        same(found(tmp_path, head + table, "a.whl"), WHEEL)


class TestTables:
    CALIPRI = ("Messung;12", "Datum;2021-03-04 10:11:12", "Sh;28,1", "Sd;32,5", "", "Profilpunkte")

    @pytest.mark.parametrize(
        "head, table",
        [
            ((*CALIPRI, "X;Y"), commas(rows(points(WHEEL), ";"))),
            (("Y [mm];Z [mm];",), [row + ";" for row in commas(rows(points(WHEEL), ";"))]),
            (("sep=;", "y;z"), commas(rows(points(WHEEL), ";"))),
            (("y;z",), [*rows(points(WHEEL), ";"), ";", ";;"]),
            (("Index;X;Y",), [f"{k};{row}" for k, row in enumerate(rows(points(WHEEL), ";"))]),
            (("Punkt;X;Y",), [f"P{k};{row}" for k, row in enumerate(rows(points(WHEEL), ";"))]),
            (("X,Y,Z",), ["0.000," + row for row in rows(points(WHEEL), ",")]),
            (("x|y",), rows(points(WHEEL), "|")),
            ((), [f"({row})" for row in rows(points(WHEEL), ", ")]),
            (("x;y",), [row.replace("-", "\u2212") for row in rows(points(WHEEL), ";")]),
            (("** measured", "* y z"), rows(points(WHEEL))),
            (("x [µm];y [µm]",), rows(1e3 * points(WHEEL), ";", 1)),
            (
                ("x,y",),
                ['"' + row.replace(";", '","') + '"' for row in commas(rows(points(WHEEL), ";"))],
            ),
        ],
    )
    def test_dresses(self, tmp_path, head, table):
        same(found(tmp_path, [*head, *table], "a.csv"), WHEEL)

    @pytest.mark.parametrize("names", ["YL;ZL;YR;ZR", "Links Y;Links Z;Rechts Y;Rechts Z"])
    @pytest.mark.parametrize("side", ["left", "right"])
    def test_two_sides_in_four_columns(self, tmp_path, names, side):
        other = WHEEL.shifted(0.0, 0.0).height(WHEEL.y) * 1e3 * 0.98
        right = np.column_stack([1e3 * WHEEL.y, other])
        both = np.hstack([points(WHEEL), right])
        profile = found(tmp_path, [names, *rows(both, ";")], "a.csv", side=side)
        scale = 1.0 if side == "left" else 0.98
        assert profile.height(-0.05) == pytest.approx(scale * WHEEL.height(-0.05), abs=1e-6)
        assert f"side={side!r}" in " ".join(profile.remarks)

    def test_unknown_unit_is_guessed_in_the_message(self, tmp_path):
        with pytest.raises(ProfileError, match=r"line 2.*5\.118.*unit='inch'"):
            found(tmp_path, ["x;y", *rows(points(WHEEL) / 25.4, ";", 6)], "a.csv")

    @pytest.mark.parametrize("unit, scale", [("mm", 1.0), ("meter", 1e-3)])
    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    def test_headings_of_vi_rail(self, tmp_path, profile, unit, scale):
        head = ["$----MDI_HEADER", "[MDI_HEADER]", " FILE_TYPE = 'wpr'", " FILE_VERSION = 1.0"]
        head += ["$----UNITS", "[UNITS]", f" LENGTH = '{unit}'", "$----PROFILE", "[PROFILE]"]
        lines = [*head, "{ y z }", *rows(scale * points(profile), decimals=7)]
        same(found(tmp_path, lines, "a.wpr"), profile)


def simpack(profile, *keys, table=None):
    table = rows(points(profile) * [1.0, -1.0]) if table is None else table
    return [
        *("header.begin", f"  type = {int(profile.kind == 'wheel')}", "header.end"),
        *("spline.begin", *keys, "point.begin", *table, "point.end", "spline.end"),
    ]


class TestSimpack:
    MM = "units.len.f = 1000."

    def test_decimal_commas(self, tmp_path):
        lines = simpack(WHEEL, self.MM, table=commas(rows(points(WHEEL) * [1.0, -1.0])))
        same(found(tmp_path, lines, "a.prw"), WHEEL)

    def test_unit_by_its_name_alone(self, tmp_path):
        same(found(tmp_path, simpack(RAIL, "units.len = 'mm'"), "a.prr"), RAIL)

    def test_type_with_a_point(self, tmp_path):
        lines = [line.replace("type = 1", "type = 1.0") for line in simpack(WHEEL, self.MM)]
        same(found(tmp_path, lines, "a.prw"), WHEEL)

    def test_last_line_missing(self, tmp_path):
        profile = found(tmp_path, simpack(RAIL, self.MM)[:-1], "a.prr")
        same(profile, RAIL)
        assert "'spline.end' is missing" in profile.remarks
        with pytest.raises(ProfileError, match=r"line \d+: .*cut off: .*add 'point.end'"):
            found(tmp_path, simpack(RAIL, self.MM)[:-2], "a.prr")

    @pytest.mark.parametrize("profile, name", [(WHEEL, "a.prw"), (RAIL, "a.prr")])
    def test_points_alone(self, tmp_path, profile, name):
        back = found(tmp_path, rows(points(profile) * [1.0, -1.0]), name)
        same(back, profile)
        assert "no SIMPACK keywords" in " ".join(back.remarks)


def test_a_list_of_slices_names_a_file_to_load(tmp_path):
    lines = ["% rail", "0.0 1.0 % S_OFFSET, S_SCALE", "3", "1 0 0", "1"]
    lines += [f"{k}.0 'nose_{k}.prr'" for k in range(3)]
    with pytest.raises(ProfileError, match=r"line 6: a list of profiles.*'nose_0.prr'"):
        found(tmp_path, lines, "a.slcs")


def test_vampire_with_blank_lines(tmp_path):
    wheel = points(WHEEL) * [1.0, -1.0] + [70.0 + 680.0, 0.0]
    both = np.hstack([wheel * [-1.0, 1.0], wheel])
    head = ["WHEELPROFILE S1002", "a title", "", "TREADDATUM=EUROPEAN", "FLANGEBACK=1360.0 mm", ""]
    same(found(tmp_path, [*head, *rows(both, ",")], "a.whe"), WHEEL)
