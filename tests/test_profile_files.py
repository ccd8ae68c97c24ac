"""Two-column files: what is read, what is detected, and the errors of bad files.

Every bad file is a good one with one fault at a known line; the message must name the file, that
line and a mend.
"""

import re

import numpy as np
import pytest

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import load_profile, save_profile, shapes

WHEEL = shapes.s1002().resampled(1e-3)
RAIL = shapes.uic60().resampled(1e-3)


def rows(profile, factor=1e3, separator=" "):
    return [
        f"{factor * y:.8g}{separator}{factor * z:.8g}"
        for y, z in zip(profile.y, profile.z, strict=True)
    ]


@pytest.fixture
def put(tmp_path):
    def write(lines, name="profile.txt", encoding="utf-8"):
        path = tmp_path / name
        text = lines if isinstance(lines, str) else "\n".join(lines) + "\n"
        path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return path

    return write


def headed(profile, unit="mm", factor=1e3):
    return [f"# kind: {profile.kind}", f"# unit: {unit}", *rows(profile, factor)]


def refused(path, line, mend, **options):
    with pytest.raises(ProfileError) as caught:
        load_profile(path, **options)
    message = str(caught.value)
    assert str(path) in message
    if line is not None:
        assert re.search(rf"line {line}\b", message), message
    assert re.search(mend, message), message
    return message


class TestGoodFiles:
    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    def test_round_trip(self, profile, tmp_path):
        back = load_profile(save_profile(profile, tmp_path / "saved.txt"))
        assert back.name == profile.name and back.kind == profile.kind
        assert back.source == profile.source and back.remarks == ()
        assert back.y == pytest.approx(profile.y, abs=6e-12)
        assert back.z == pytest.approx(profile.z, abs=6e-12)

    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    @pytest.mark.parametrize("y_sign", [1, -1])
    @pytest.mark.parametrize("z_sign", [1, -1])
    @pytest.mark.parametrize("factor", [1.0, 1e3])
    @pytest.mark.parametrize("order", [1, -1])
    def test_without_header(self, put, profile, y_sign, z_sign, factor, order):
        table = factor * np.column_stack((y_sign * profile.y, z_sign * profile.z))[::order]
        found = load_profile(put([f"{y:.12g} {z:.12g}" for y, z in table]))
        assert found.kind == profile.kind
        assert found.height(profile.y[5:-5]) == pytest.approx(profile.z[5:-5], abs=1e-9)
        said = " ".join(found.remarks)
        assert ("taken as mm" if factor == 1e3 else "taken as m,") in said
        assert ("z turned up" in said) == (z_sign < 0)
        assert ("y turned" in said) == (y_sign < 0 and profile.kind == "wheel")
        assert f"taken as a {profile.kind}" in said

    def test_kind_unit_and_smoothing_from_the_caller(self, put):
        cone = shapes.cone(0.05).resampled(2e-3)
        path = put(rows(cone, 1.0 / 0.0254))
        found = load_profile(path, kind="wheel", unit="inch", smoothing=1e-6)
        assert found.slope(0.01) == pytest.approx(0.05, abs=1e-6)
        assert found.smoothing == 1e-6

    @pytest.mark.parametrize(
        "line, separator, said",
        [
            ("{y:.6f},{z:.6f}", ".", "commas"),
            ("{y:.6f}, {z:.6f}", ".", "commas"),
            ("{y:.6f};{z:.6f}", ".", "semicolons"),
            ("{y:.6f};{z:.6f}", ",", "decimal commas"),
            ("{y:.6f}\t{z:.6f}", ",", "decimal commas"),
            ("{y:.6f}   {z:.6f}", ",", "decimal commas"),
            ("{y:.6f}\t{z:.6f}\t0.5", ".", "first 2 of 3 columns"),
            ('"{y:.6f}","{z:.6f}"', ".", "commas"),
            ("{y:.6E} {z:.6E}", ".", "taken as mm"),
        ],
    )
    def test_separators(self, put, line, separator, said):
        lines = [
            line.format(y=1e3 * y, z=1e3 * z).replace(".", separator)
            for y, z in zip(WHEEL.y, WHEEL.z, strict=True)
        ]
        found = load_profile(put(lines, "table.csv"))
        assert said in " ".join(found.remarks)
        assert found.z == pytest.approx(WHEEL.z, abs=1e-8)

    def test_column_names_and_unit_in_brackets(self, put):
        lines = ["No;y [m];z [m]"]
        lines += [
            f"{i};{y:.9f};{z:.9f}" for i, (y, z) in enumerate(zip(WHEEL.y, WHEEL.z, strict=True))
        ]
        found = load_profile(put(lines, "table.csv"))
        assert found.z == pytest.approx(WHEEL.z, abs=1e-9)
        assert "columns 2 and 3 of 3" in " ".join(found.remarks)

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
    @pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
    def test_encodings_and_line_ends(self, put, encoding, end):
        text = end.join(["# name: Räder", *headed(WHEEL)]) + end
        assert load_profile(put(text, encoding=encoding)).name == "Räder"

    def test_fortran_exponents_and_trailing_comments(self, put):
        lines = [
            f"{y:.8E} {z:.8E} ! point".replace("E", "D")
            for y, z in zip(WHEEL.y, WHEEL.z, strict=True)
        ]
        assert load_profile(put(lines)).z == pytest.approx(WHEEL.z, abs=1e-9)

    def test_overhanging_ends_are_cut_off_and_said(self, put):
        back = [f"-70.{i % 3} {z}" for i, z in enumerate(np.linspace(0.0, -9.4, 20))]
        found = load_profile(put(["# kind: wheel", "# unit: mm", *back, *rows(WHEEL)]))
        assert "overhanging ends cut off" in " ".join(found.remarks)
        assert found.height(0.03) == pytest.approx(WHEEL.height(0.03), abs=1e-9)

    def test_small_datum_error_is_taken_off_and_said(self, put):
        shifted = WHEEL.shifted(0.0, 3e-4)
        found = load_profile(put(rows(shifted)))
        # The datum is found between the neighbouring points by a straight line: 1 mm apart on a
        # tread of 3.1 1/m, its sagitta is up to 4e-7 m; so 0.2997 for 0.3 mm.
        assert found.height(0.0) == pytest.approx(0.0, abs=4e-7)
        assert "z lowered by 0.2997 mm" in " ".join(found.remarks)

    def test_shift_from_the_caller_mends_a_foreign_datum(self, put):
        far = [
            f"{1e3 * y + 70:.6f} {1e3 * z + 40:.6f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)
        ]
        refused(put(far), None, "tape circle")
        found = load_profile(put(far), shift_y=-0.070, shift_z=-0.040)
        assert found.z == pytest.approx(WHEEL.z, abs=1e-8)


class TestMendedFiles:
    """What can be put right without a guess is, and the remarks name the lines."""

    def test_doubled_point(self, put):
        lines = headed(RAIL)
        lines.insert(33, lines[32])
        found = load_profile(put(lines))
        assert found.remarks == ("1 doubled points left out, lines 34",)
        assert found.y == pytest.approx(RAIL.y, abs=1e-9)

    def test_doubled_y_on_the_tread(self, put):
        lines = headed(WHEEL)
        y, z = lines[100].split()
        lines.insert(101, f"{y} {float(z) + 0.01}")
        found = load_profile(put(lines))
        assert len(found.y) == len(WHEEL.y)
        assert re.search(r"1 points left out .* lines 10[12]", found.remarks[0])

    def test_exchanged_lines(self, put):
        lines = headed(WHEEL)
        lines[90], lines[91] = lines[91], lines[90]
        found = load_profile(put(lines))
        assert re.search(r"1 points put in order, lines 9[12]", found.remarks[0])
        assert found.y == pytest.approx(WHEEL.y, abs=1e-9)

    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    def test_shuffled_points(self, put, profile):
        lines = rows(profile)
        np.random.default_rng(1).shuffle(lines)
        found = load_profile(put(lines))
        assert "points out of order: sorted by y" in found.remarks
        assert found.height(profile.y[5:-5]) == pytest.approx(profile.z[5:-5], abs=1e-8)

    def test_pieces_exchanged(self, put):
        lines = rows(WHEEL)
        third = len(lines) // 3
        found = load_profile(put(lines[third:] + lines[:third][::-1]))
        assert "2 pieces of the curve put in order" in found.remarks
        assert found.height(WHEEL.y[5:-5]) == pytest.approx(WHEEL.z[5:-5], abs=1e-8)


class TestBadFiles:
    def test_missing_column(self, put):
        lines = headed(WHEEL)
        lines[57] = lines[57].split()[0]
        refused(put(lines), 58, "add the missing value or delete")

    def test_one_column_throughout(self, put):
        refused(put([line.split()[0] for line in rows(WHEEL)]), 1, "give y and z")

    @pytest.mark.parametrize("token", ["NaN", "nan", "inf", "-Infinity"])
    @pytest.mark.parametrize("column", [0, 1])
    def test_not_a_number(self, put, token, column):
        lines = headed(WHEEL)
        cells = lines[40].split()
        cells[column] = token
        lines[40] = " ".join(cells)
        refused(put(lines), 41, "delete the line or mend")

    def test_word_among_numbers(self, put):
        lines = headed(WHEEL)
        lines[30] = "12.0 1.2.3"
        refused(put(lines), 31, "not a number")

    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    def test_metres_said_to_be_millimetres(self, put, profile):
        refused(put(headed(profile, "mm", 1.0)), 2, "look like metres")

    @pytest.mark.parametrize("profile", [WHEEL, RAIL], ids=["wheel", "rail"])
    def test_millimetres_said_to_be_metres(self, put, profile):
        refused(put(headed(profile, "m", 1e3)), 2, "look like mm")

    def test_inches_said_to_be_metres(self, put):
        refused(put(headed(WHEEL, "m", 1 / 0.0254)), 2, "look like inch")

    def test_micrometres_without_a_unit(self, put):
        refused(put(rows(WHEEL, 1e6)), 1, "give unit=")

    def test_unknown_unit(self, put):
        refused(put(headed(WHEEL, "furlong")), 2, "use mm, m, cm or inch")
        refused(put(rows(WHEEL)), None, "use 'mm'", unit="furlong")

    def test_rail_said_to_be_a_wheel(self, put):
        lines = headed(RAIL)
        lines[0] = "# kind: wheel"
        refused(put(lines), 1, "say kind='rail'")
        refused(put(rows(RAIL)), 1, "say kind='rail'", kind="wheel")

    def test_wheel_said_to_be_a_rail(self, put):
        lines = headed(WHEEL)
        lines[0] = "# kind: rail"
        refused(put(lines), 1, "say kind='wheel'")
        refused(put(headed(WHEEL)), 1, "holds a wheel", kind="rail")

    def test_unknown_kind(self, put):
        refused(put(["# kind: tram", *rows(WHEEL)]), 1, "wheel")

    def test_headed_wheel_turned_the_wrong_way(self, put):
        mirrored = [f"{-1e3 * y:.6f} {1e3 * z:.6f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)]
        refused(put(["# kind: wheel", "# unit: mm", *mirrored]), 1, "mirror y")
        upside = [f"{1e3 * y:.6f} {-1e3 * z:.6f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)]
        refused(put(["# kind: wheel", "# unit: mm", *upside]), 1, "turn the sign of z")

    def test_shape_that_tells_nothing(self, put):
        refused(put(rows(shapes.cone(0.05).resampled(1e-3))), 1, "give kind=")

    def test_lost_point(self, put):
        lines = headed(WHEEL)
        lines[77] = "12.0 5.0e5"
        refused(put(lines), 78, "mend or delete")

    def test_ambiguous_commas(self, put):
        lines = [
            f"{1e3 * y:.3f},{1e3 * z:.3f}".replace(".", ",")
            for y, z in zip(RAIL.y, RAIL.z, strict=True)
        ]
        refused(put(lines), 1, "semicolons")

    def test_too_few_points(self, put):
        refused(put(headed(WHEEL)[:9]), None, "at least 8")

    def test_empty(self, put):
        refused(put(""), None, "empty")
        refused(put("\n \n\t\n"), None, "empty")
        refused(put("# name: x\n# kind: wheel\n"), None, "give lines with y and z")

    def test_binary(self, put, tmp_path):
        path = tmp_path / "picture.png"
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 20)
        refused(path, r"\d+", "export the profile as a text file")

    def test_no_such_file_or_name(self):
        with pytest.raises(ProfileError, match="S1002, UIC60"):
            load_profile("S1003")
        with pytest.raises(ProfileError):
            load_profile("a\0b")

    def test_a_folder(self, tmp_path):
        refused(tmp_path, None, "cannot be read")

    @pytest.mark.parametrize(
        "options, mend",
        [
            ({"kind": "tram"}, "'wheel' or 'rail'"),
            ({"smoothing": 10.0}, "1e-5"),
            ({"smoothing": float("nan")}, "1e-5"),
            ({"side": "top"}, "'left' or 'right'"),
            ({"format": "dxf"}, "simpack"),
            ({"kind": "rail"}, "is a wheel"),
        ],
    )
    def test_options(self, options, mend):
        with pytest.raises(ProfileError, match=mend):
            load_profile("S1002", **options)


class TestOutliers:
    def test_left_out_and_reported_by_line(self, put):
        lines = headed(WHEEL)
        for i in (60, 90, 120):
            y, z = lines[i].split()
            lines[i] = f"{y} {float(z) + 0.4}"
        found = load_profile(put(lines), outlier_tolerance=1e-4)
        assert "3 outliers beyond 100 micrometres left out, lines 61, 91, 121" in found.remarks
        y = np.linspace(-0.03, 0.058, 200)
        assert found.height(y) == pytest.approx(shapes.s1002_height(y), abs=2e-6)

    def test_backsteps_count_as_outliers(self, put):
        lines = headed(WHEEL)
        lines[80], lines[81] = lines[81], lines[80]
        found = load_profile(put(lines), outlier_tolerance=1e-4)
        assert "outliers" in found.remarks[0]

    def test_too_many(self, put):
        noise = np.random.default_rng(2).normal(0.0, 3e-4, len(WHEEL.z))
        lines = [
            f"{1e3 * y:.6f} {1e3 * (z + e):.6f}"
            for y, z, e in zip(WHEEL.y, WHEEL.z, noise, strict=True)
        ]
        refused(put(lines), r"\d+", "raise outlier_tolerance", outlier_tolerance=1e-6)

    def test_on_a_profile(self):
        z = RAIL.z.copy()
        z[64] += 2e-4
        bumped = type(RAIL)("bumped", "rail", RAIL.y, z)
        cleaned = bumped.with_outliers_removed(5e-5)
        assert len(cleaned.y) == len(RAIL.y) - 1
        assert "1 outliers beyond 50 micrometres" in cleaned.remarks[-1]
        assert RAIL.with_outliers_removed(5e-5) is RAIL
