"""Files as instruments and their users write them: synthetic ones of every kind.

They are S1002, UIC60 and arcs with one wart each, written here; they must give the shape back.
"""

import logging
import math
import re

import numpy as np
import pytest

from exudyn_wheelset import Track
from exudyn_wheelset.errors import ProfileError, WheelsetError
from exudyn_wheelset.profiles import load_profile, shapes

WHEEL, RAIL = shapes.s1002().resampled(3e-4), shapes.uic60().resampled(3e-4)
pytestmark = pytest.mark.filterwarnings("ignore::exudyn_wheelset.errors.WheelsetWarning")


def table(profile, columns=2, separator=" "):
    """Rows of MiniProf's X and Y for a wheel (from the flange back) or a rail (gauge at +X)."""
    sign = 1.0 if profile.kind == "wheel" else -1.0
    x = sign * 1e3 * profile.y + (70.0 if profile.kind == "wheel" else 0.0)
    y = -sign * 1e3 * profile.z
    extra = [separator + "0.1", separator + "0.02", separator + "1"][: columns - 2]
    return [f"{a:.4f}{separator}{b:.4f}{''.join(extra)}" for a, b in zip(x, y, strict=True)]


@pytest.fixture
def put(tmp_path):
    def write(lines, name):
        path = tmp_path / name
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path

    return write


def same(found, profile, tolerance=1.5e-7, reach=None):
    """Heights agree to the four decimals that the files have, away from the upright ends."""
    low, high = reach or ((-0.068, 0.058) if profile.kind == "wheel" else (-0.0355, 0.0355))
    y = np.linspace(low, high, 300)
    assert found.kind == profile.kind
    assert np.max(np.abs(found.height(y) - profile.height(y))) < tolerance * 4.0
    assert np.sqrt(np.mean((found.height(y) - profile.height(y)) ** 2)) < tolerance


class TestMiniProf:
    HEAD = ("#MINIWHEELPROF", "Car1_0001_T(L).whl", "MINIPROF 2020", "Stock.......:", "Axle.:")

    @pytest.mark.parametrize(
        "numbers",
        [
            ("31.58 28.11 10.71", "(Sd/Sh/qR)", ""),
            ('" 31.58 28.11 10.71', "(Sd/Sh/qR)", ""),
            ("31.58 28.11 10.71", ""),
            ("31.58 28.11", "(Sd/Sh)", ""),
            ("2014-03-02 10:12", "31.58 28.11 10.71"),
        ],
    )
    def test_numbers_in_an_old_heading(self, put, numbers):
        found = load_profile(put([*self.HEAD, *numbers, *table(WHEEL)], "a.whl"))
        same(found, WHEEL)
        if not numbers[0].startswith('"'):
            assert "taken as header" in " ".join(found.remarks)

    @pytest.mark.parametrize("blank", [(), ("",), ("", "")])
    @pytest.mark.parametrize("separator", [" ", "\t", ", ", ";", "   "])
    def test_columns_separators_blank_lines(self, put, blank, separator):
        head = ["ProgramName=MiniProf", "XYPoints=9999", "ColumnDef=X,Y,A,C,K", "Grade=38.6"]
        rows = table(RAIL, 5, separator)
        head[1] = f"XYPoints={len(rows)}"
        same(load_profile(put([*head, *blank, *rows], "a.ban")), RAIL)

    def test_decimal_commas(self, put):
        rows = [row.replace(".", ",") for row in table(WHEEL, 2, "\t")]
        same(load_profile(put(["XYPoints=1", "ColumnDef=X,Y", "", *rows], "a.whl")), WHEEL)

    def test_tape_line_of_the_header(self, put):
        rows = table(WHEEL.shifted(0.0025, 0.0))
        head = ["XYPoints=1", "ColumnDef=X,Y", "WheelDiameterTaperline=72.5000", ""]
        same(load_profile(put([*head, *rows], "a.whl")), WHEEL)

    def test_words_behind_the_last_point(self, put):
        rows = table(RAIL)
        rows[-1] += "   add point to extend gauge face"
        found = load_profile(
            put(["XYPoints=1", "ColumnDef=X,Y", "", *rows, "End of file"], "a.ban")
        )
        same(found, RAIL)
        assert "words after the points" in " ".join(found.remarks)

    def test_template_of_several_sections(self, put):
        rows = table(RAIL)
        half = len(rows) // 2
        text = ["[FileInfo]", "MPTypeNo=299", "[Profile1Info]", "ColumnDef=X,Y", "[Profile1Points]"]
        text += [*rows[:half], "[Profile2Info]", "ColumnDef=X,Y", "[Profile2Points]", *rows[half:]]
        same(load_profile(put(text, "a.mpt"), kind="rail"), RAIL)

    def test_rail_turned_by_half_a_turn(self, put):
        """Y down and X to the field side; the gauge side is the one that reaches down 14 mm."""
        part = RAIL.y < 0.0345
        rows = [
            f"{1e3 * y:.4f} {-1e3 * z:.4f}" for y, z in zip(RAIL.y[part], RAIL.z[part], strict=True)
        ]
        found = load_profile(put(["XYPoints=1", "ColumnDef=X,Y", "", *rows], "a.ban"))
        same(found, RAIL, reach=(-0.0355, 0.033))
        assert "the gauge is measured" in " ".join(found.remarks)
        back = load_profile(put(["XYPoints=1", "ColumnDef=X,Y", "", *rows], "a.ban"), mirror_y=True)
        assert back.height(0.03) == pytest.approx(RAIL.height(-0.03), abs=1e-6)


class TestTables:
    """CSV as Calipri, spreadsheets and users write it."""

    @pytest.mark.parametrize(
        "head, row, said",
        [
            (
                ["Calipri Profil", "Datum;2021-03-04", "Einheit;mm", "Nr;Quer;Höhe"],
                "{i};{y};{z}",
                "2 and 3",
            ),
            (["x [m],y [m]"], "{ym},{zm}", "commas"),
            (["Lateral (mm)\tVertical (mm)"], "{y}\t{z}", "tabs"),
            (["largeur;hauteur", "mm;mm"], "{y};{z}", "semicolons"),
            (['"X (in)","Y (in)"'], "{yi},{zi}", "commas"),
            (["Type: Rad", "Units: mm", ""], "{y} {z}", "kind|MiniProf|taken|z|flange|read|"),
            (["415", ""], "{y} {z}", "header"),
            (["1.435 0.46 0"], "{y} {z}", "header"),
            ([], "{i} {y} {z}", "2 and 3 of 3"),
            ([], "0.0 {y} {z}", "2 and 3 of 3"),
        ],
    )
    def test_headers(self, put, head, row, said):
        rows = [
            row.format(
                i=i + 1,
                y=f"{1e3 * y:.5f}",
                z=f"{1e3 * z:.5f}",
                ym=f"{y:.8f}",
                zm=f"{z:.8f}",
                yi=f"{y / 0.0254:.7f}",
                zi=f"{z / 0.0254:.7f}",
            )
            for i, (y, z) in enumerate(zip(WHEEL.y, WHEEL.z, strict=True))
        ]
        found = load_profile(put([*head, *rows], "a.csv"))
        same(found, WHEEL)
        assert re.search(said, " ".join(found.remarks))

    def test_decimal_commas_and_a_trailing_semicolon(self, put):
        rows = [
            f"{1e3 * y:.5f};{1e3 * z:.5f};".replace(".", ",")
            for y, z in zip(RAIL.y, RAIL.z, strict=True)
        ]
        same(load_profile(put(["y [mm];z [mm];", *rows], "a.csv")), RAIL)

    def test_left_and_right_in_one_file(self, put):
        worn = WHEEL.z + 1e-4 * np.cos(40.0 * WHEEL.y) - 1e-4
        left = [f"{1e3 * y:.5f} {1e3 * z:.5f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)]
        right = [f"{1e3 * y:.5f} {1e3 * z:.5f}" for y, z in zip(WHEEL.y, worn, strict=True)]
        path = put(["wheel left", *left, "wheel right", *right], "a.txt")
        same(load_profile(path), WHEEL)
        found = load_profile(path, side="right")
        assert found.height(0.02) == pytest.approx(np.interp(0.02, WHEEL.y, worn), abs=1e-7)

    def test_a_piece_of_a_rail_head(self, put):
        """A plateau that falls at both ends is a rail, though it is too narrow for a whole head."""
        y = np.linspace(-9.0, 9.0, 121)
        z = -(np.maximum(np.abs(y) - 8.0, 0.0) ** 2)
        rows = [f"{a - 23.0:.5f},{b:.5f}" for a, b in zip(y, z, strict=True)]
        assert load_profile(put(rows, "a.csv")).kind == "rail"


class TestShapes:
    """What a person sees at a glance, without a word in the file."""

    @pytest.mark.parametrize("y_sign, z_sign", [(1, 1), (-1, 1), (1, -1), (-1, -1)])
    @pytest.mark.parametrize(
        "profile, low, high, kind",
        [
            (RAIL, -1.0, 0.012, "rail"),
            (RAIL, -1.0, 0.030, "rail"),
            (WHEEL, -0.055, 1.0, "wheel"),
            (WHEEL, -1.0, 0.030, "wheel"),
        ],
        ids=["gauge half of a head", "most of a head", "no flange back", "no field side"],
    )
    def test_parts(self, put, profile, low, high, kind, y_sign, z_sign):
        part = (profile.y > low) & (profile.y < high)
        y, z = 1e3 * y_sign * profile.y[part], 1e3 * z_sign * profile.z[part]
        found = load_profile(put([f"{a:.4f} {b:.4f}" for a, b in zip(y, z, strict=True)], "a.txt"))
        assert found.kind == kind
        inside = np.linspace(max(low, found.span[0]), min(high, found.span[1]), 50)[2:-2]
        assert found.height(inside) == pytest.approx(profile.height(inside), abs=1e-6)

    def test_flange_back_far_from_70_mm_is_said(self, put):
        rows = [
            f"{1e3 * y + 30.0:.4f} {1e3 * z:.4f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)
        ]
        back = [f"-40.0000 {z:.3f}" for z in np.linspace(5.0, -9.2, 40)]
        said = " ".join(load_profile(put([*back, *rows], "a.txt")).remarks)
        assert "the flange back lies 40.0 mm from y = 0" in said
        mend = float(re.search(r"shift_y=(-?[\d.]+)", said)[1])
        same(load_profile(put([*back, *rows], "a.txt"), shift_y=mend), WHEEL, 1e-6)


class TestMends:
    def test_lost_ends(self, put):
        rows = [f"{1e3 * y:.4f} {1e3 * z:.4f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)]
        found = load_profile(put(["10.0 -40.0", *rows, "999 999", "999 999"], "a.txt"))
        same(found, WHEEL)
        assert re.search(r"end points off the curve left out: line 1 .*line \d+", found.remarks[0])

    def test_steps_back_of_a_hundredth(self, put):
        """A point repeated with its y 0.01 mm back, as averaged files have it."""
        rows = [[1e3 * y, 1e3 * z] for y, z in zip(RAIL.y, RAIL.z, strict=True)]
        rows.insert(120, [rows[119][0] - 0.01, rows[119][1]])
        found = load_profile(put([f"{y:.4f} {z:.4f}" for y, z in rows], "a.txt"))
        same(found, RAIL, 1e-6)
        assert re.search(r"lines 12[01]", " ".join(found.remarks))

    def test_two_sweeps_joined_with_a_step(self, put):
        """The instrument is lifted and set down again 3 mm behind: both sweeps are on the curve."""
        rows = [f"{1e3 * y:.4f} {1e3 * z:.4f}" for y, z in zip(WHEEL.y, WHEEL.z, strict=True)]
        found = load_profile(put([*rows[:200], *rows[190:]], "a.txt"))
        same(found, WHEEL)

    @pytest.mark.parametrize("undercut", [2.0, 8.0])
    def test_gauge_face_that_undercuts(self, put, undercut):
        """A lip of 2 mm radius, then a face that recedes: cut where it is upright, gauge there.

        The head is an arc of 80 mm radius down to 45 degrees, the lip turns to upright: its
        outermost point is known in closed form.
        """
        head = np.linspace(0.6, -math.pi / 4, 300)
        y, z = 80.0 * np.sin(head), 80.0 * np.cos(head) - 80.0
        lip = np.linspace(-math.pi / 4, -math.pi / 2 - math.radians(undercut), 30)[1:]
        centre = 78.0 * np.array([math.sin(-math.pi / 4), math.cos(-math.pi / 4)])
        ly = centre[0] + 2.0 * np.sin(lip)
        lz = centre[1] + 2.0 * np.cos(lip) - 80.0
        down = np.arange(0.3, 12.0, 0.3)
        fy = ly[-1] + down * math.sin(math.radians(undercut))
        fz = lz[-1] - down * math.cos(math.radians(undercut))
        points = np.column_stack((np.concatenate((y, ly, fy)), np.concatenate((z, lz, fz))))
        path = put([f"{a:.5f} {b:.5f}" for a, b in points], "a.txt")
        found = load_profile(path, kind="rail", shift_y=0.012)
        outermost = 1e-3 * (centre[0] - 2.0) + 0.012
        assert found.ends_at_gauge_face
        assert found.span[0] == pytest.approx(outermost, abs=3e-6)
        assert re.search(r"overhanging ends cut off: .*recede", " ".join(found.remarks))
        track = Track(found, inclination=0.0, gauge=1.435, gauge_depth=0.030)
        face = track.left_placement.coefficients[0, 0]
        assert face == pytest.approx(0.7175, abs=1e-9)

    @pytest.mark.parametrize("offset", [0.75, -0.2, 0.05])
    def test_rail_far_from_its_origin(self, put, offset):
        rows = [
            f"{1e3 * (y + offset):.4f} {1e3 * z:.4f}" for y, z in zip(RAIL.y, RAIL.z, strict=True)
        ]
        found = load_profile(put(rows, "a.txt"))
        same(found, RAIL, 1e-6)
        assert f"origin lay {1e3 * abs(offset):.2f} mm beside it" in " ".join(found.remarks)

    def test_a_missing_part_is_said(self, put):
        keep = (WHEEL.y < 0.01) | (WHEEL.y > 0.018)
        rows = [
            f"{1e3 * y:.4f} {1e3 * z:.4f}"
            for y, z in zip(WHEEL.y[keep], WHEEL.z[keep], strict=True)
        ]
        found = load_profile(put(rows, "a.txt"))
        assert re.search(r"no points for 8\.\d mm", " ".join(found.remarks))

    def test_dense_noise_that_runs_back_everywhere(self, put):
        """Points every 10 micrometres, 20 micrometres off: neighbours are averaged, shape kept."""
        dense = shapes.s1002().resampled(1e-5)
        error = np.random.default_rng(0).normal(0.0, 2e-5, (2, len(dense.y)))
        rows = [
            f"{1e3 * y:.5f} {1e3 * z:.5f}"
            for y, z in zip(dense.y + error[0], dense.z + error[1], strict=True)
        ]
        found = load_profile(put(rows, "a.txt"), smoothing="auto")
        assert "means of" in " ".join(found.remarks)
        y = np.linspace(-0.03, 0.055, 200)
        assert np.max(np.abs(found.height(y) - WHEEL.height(y))) < 1e-5

    def test_remarks_go_to_the_log(self, put, caplog):
        path = put(table(WHEEL), "a.whl")
        with caplog.at_level(logging.INFO, logger="exudyn_wheelset.profiles"):
            found = load_profile(path)
        assert [r.getMessage().split(": ", 1)[1] for r in caplog.records] == list(found.remarks)


class TestPrintedMends:
    """A mend that a message prints opens the file when it is applied."""

    def refusal(self, path, **options):
        with pytest.raises(ProfileError) as caught:
            load_profile(path, **options)
        return str(caught.value)

    def rows(self, profile=WHEEL):
        return [f"{1e3 * y:.4f} {1e3 * z:.4f}" for y, z in zip(profile.y, profile.z, strict=True)]

    def test_delete_the_lines(self, put):
        lines = self.rows()
        lines[50], lines[90], lines[91] = "nan 1.0", "3.0 inf", "x y"
        lines[91] = f"{lines[92].split()[0]} NaN"
        message = self.refusal(put(lines, "a.txt"))
        named = [int(number) for number in re.findall(r"\d+", message.split("line ", 1)[1])]
        assert set(named) >= {51, 91, 92}
        kept = [line for i, line in enumerate(lines, 1) if i not in (51, 91, 92)]
        same(load_profile(put(kept, "a.txt")), WHEEL, 1e-6)

    def test_words_among_the_points(self, put):
        lines = self.rows()
        lines.insert(150, "interrupted here")
        message = self.refusal(put(lines, "a.txt"))
        assert "line 151" in message and "delete the line" in message
        del lines[150]
        same(load_profile(put(lines, "a.txt")), WHEEL)

    def test_far_points(self, put):
        lines = self.rows()
        lines[70], lines[120] = "12.0 5.0e5", "-3e5 1.0"
        message = self.refusal(put(lines, "a.txt"))
        assert "line 71" in message and "121" in message
        kept = [line for i, line in enumerate(lines) if i not in (70, 120)]
        same(load_profile(put(kept, "a.txt")), WHEEL, 1e-6)

    def test_give_the_kind(self, put):
        cone = shapes.cone(0.05).resampled(1e-3)
        path = put(self.rows(cone), "a.txt")
        assert "give kind=" in self.refusal(path)
        assert load_profile(path, kind="wheel").slope(0.01) == pytest.approx(0.05, abs=1e-4)

    def test_shift_to_the_tape_circle(self, put):
        path = put(self.rows(WHEEL.shifted(0.0)), "a.txt")
        moved = put([f"{float(a) + 70:.4f} {b}" for a, b in map(str.split, self.rows())], "b.txt")
        message = self.refusal(moved)
        mend = re.search(r"shift_y=(-?[\d.]+)", message)
        assert mend, message
        same(load_profile(moved, shift_y=float(mend[1])), load_profile(path), 1e-6)

    def test_outlier_tolerance(self, put):
        noise = np.random.default_rng(2).normal(0.0, 3e-4, len(WHEEL.z))
        lines = [
            f"{1e3 * y:.6f} {1e3 * (z + e):.6f}"
            for y, z, e in zip(WHEEL.y, WHEEL.z, noise, strict=True)
        ]
        path = put(lines, "a.txt")
        message = self.refusal(path, outlier_tolerance=1e-6)
        mend = re.search(r"raise outlier_tolerance to ([\d.e-]+)", message)
        assert mend, message
        load_profile(path, outlier_tolerance=float(mend[1]))

    def test_gauge_depth(self, put):
        part = RAIL.z > -0.012
        rows = [
            f"{1e3 * y:.4f} {1e3 * z:.4f}" for y, z in zip(RAIL.y[part], RAIL.z[part], strict=True)
        ]
        rail = load_profile(put(rows, "a.txt"))
        with pytest.raises(WheelsetError) as caught:
            Track(rail).left_placement  # noqa: B018
        mend = re.search(r"give gauge_depth=([\d.]+) or less", str(caught.value))
        assert mend, str(caught.value)
        assert Track(rail, gauge_depth=float(mend[1])).left_placement.datum_y > 0.7
