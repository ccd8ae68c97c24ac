"""Profile formats against their conventions, on files written here from S1002 and UIC60.

Sources of the conventions: the comments that SIMPACK writes into .prw and .prr files and the open
readers of these files in the program CONTACT (units, order of processing, MiniProf keywords,
VAMPIRE headings); the manual of GENSYS' program KPF (y to the track centre, z down). Each file
below is written by the test from the convention, not by the package.
"""

import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import Profile, load_profile, save_profile, shapes

WHEEL = shapes.s1002().resampled(5e-4)
RAIL = shapes.uic60().resampled(5e-4)
INSIDE = {"wheel": np.linspace(-0.069, 0.059, 300), "rail": np.linspace(-0.0365, 0.0365, 300)}
# No point lies on the very top of RAIL: half a spacing beside it R300 has fallen by 1.04e-7 m,
# which a reader that puts z = 0 at the highest point cannot know.
TOP = 1.1e-7


def same(found, profile, tolerance=1e-9, low=None, high=None):
    """The curves agree; the points need not, where a format drops or cuts some."""
    y = INSIDE[profile.kind]
    y = y[(y > (low if low is not None else -1)) & (y < (high if high is not None else 1))]
    assert found.kind == profile.kind
    assert found.height(y) == pytest.approx(profile.height(y), abs=tolerance)


def simpack(profile, units=1000.0, angles=1.0, kind=None, tail="", **keywords):
    """A SIMPACK file: y to the field side, z down, in units of 1/units m."""
    dotted = {key.replace("_", "."): value for key, value in keywords.items()}
    y, z = units * profile.y, -units * profile.z
    return "\n".join(
        [
            "! SIMPACK",
            "  header.begin",
            "    version = 1   ! flag",
            f"    type    = {int(profile.kind == 'wheel') if kind is None else kind}",
            "  header.end",
            "  spline.begin",
            "    comment = 'a test'",
            *(f"    {key} = {value}  ! keyword" for key, value in dotted.items()),
            "!   units.len = 'mm'",
            f"    units.len.f = {units:+.15e}",
            f"    units.ang.f = {angles:+.15e}",
            "    point.begin",
            *(f"{a:.12e} {b:.12e}{tail}" for a, b in zip(y, z, strict=True)),
            "    point.end",
            "  spline.end",
            "! End",
            "",
        ]
    )


def put(folder, text, name):
    path = folder / name
    path.write_text(text)
    return path


@pytest.mark.parametrize("profile, name", [(WHEEL, "a.prw"), (RAIL, "a.prr")])
class TestSimpack:
    @pytest.mark.parametrize("units", [1000.0, 1.0, 100.0, 1 / 0.0254])
    def test_units(self, tmp_path, profile, name, units):
        found = load_profile(put(tmp_path, simpack(profile, units), name))
        same(found, profile)
        assert found.source == "a test"
        assert "z turned up" in found.remarks[-1]

    def test_mirror_shift_rotate_inversion(self, tmp_path, profile, name):
        """Each keyword undoes what was done to the points; in the order the format states."""
        y, z = 1e3 * profile.y, -1e3 * profile.z
        y, z = y[::-1], z[::-1]
        y = -y
        angle = 0.02
        turned_y = np.cos(angle) * y + np.sin(angle) * z
        turned_z = -np.sin(angle) * y + np.cos(angle) * z
        moved = (turned_y - 3.0, turned_z + 2.0)
        text = simpack(
            profile, shift_y=3.0, shift_z=-2.0, rotate=20.0, mirror_y=1, inversion=1, angles=1000.0
        )
        head, rest = text.split("    point.begin\n")
        tail = rest[rest.index("    point.end") :]
        points = "".join(f"{a:.12e} {b:.12e}\n" for a, b in zip(*moved, strict=True))
        found = load_profile(put(tmp_path, head + "    point.begin\n" + points + tail, name))
        same(found, profile)
        said = " ".join(found.remarks)
        for word in ("shift.y", "rotated by 0.02 rad", "mirrored in y", "inverted"):
            assert word in said

    def test_mirror_z_and_weights(self, tmp_path, profile, name):
        up = Profile(profile.name, profile.kind, profile.y, profile.z)
        text = simpack(up, mirror_z=1, tail=" 1.0")
        text = re.sub(
            r"^(-?\d\.\d+e\S+) (\S+) 1.0$",
            lambda m: f"{m[1]} {-float(m[2]):.12e} 1.0",
            text,
            flags=re.MULTILINE,
        )
        found = load_profile(put(tmp_path, text, name))
        same(found, profile)
        assert "weights of the points not used" in found.remarks

    def test_bounds_and_closest_distance(self, tmp_path, profile, name):
        text = simpack(
            profile,
            bound_y_min=-30.0,
            bound_y_max=25.0,
            bound_z_min=1.0,
            bound_z_max=0.0,
            point_dist_min=0.9,
            approx_smooth=0.5,
        )
        found = load_profile(put(tmp_path, text, name))
        assert found.y[0] >= -0.030 and found.y[-1] <= 0.025
        assert np.min(np.hypot(np.diff(found.y), np.diff(found.z))) >= 0.9e-3
        same(found, profile, 1e-6, -0.028, 0.023)
        said = " ".join(found.remarks)
        assert "outside bound.y" in said and "point.dist.min" in said and "approx.smooth" in said

    def test_round_trip_of_the_writer(self, tmp_path, profile, name):
        back = load_profile(save_profile(profile, tmp_path / name))
        assert back.y == pytest.approx(profile.y, abs=6e-12)
        assert back.z == pytest.approx(profile.z, abs=6e-12)
        assert back.kind == profile.kind and profile.name in back.source

    def test_written_wheel_begins_on_the_field_side(self, tmp_path, profile, name):
        """SIMPACK's own wheel files, after inversion, run from the field side to the flange."""
        text = save_profile(profile, tmp_path / name).read_text()
        numbers = text.split("point.begin\n")[1].split("point.end")[0].split()
        first, last = float(numbers[0]), float(numbers[-2])
        assert (first > last) == (profile.kind == "wheel")

    def test_suffix_and_type_disagree(self, tmp_path, profile, name):
        other = {"a.prw": "b.prr", "a.prr": "b.prw"}[name]
        with pytest.raises(ProfileError, match=r"line 4.*mend"):
            load_profile(put(tmp_path, simpack(profile), other))
        with pytest.raises(ProfileError, match=r"use \.pr"):
            save_profile(profile, tmp_path / other)

    def test_rail_points_said_to_be_a_wheel(self, tmp_path, profile, name):
        text = simpack(profile, kind=int(profile.kind == "rail"))
        with pytest.raises(ProfileError, match=f"line 4.*say kind='{profile.kind}'"):
            load_profile(put(tmp_path, text, "x.txt"))

    @pytest.mark.parametrize(
        "old, new, line, mend",
        [
            ("    point.end\n  spline.end\n", "", None, "cut off"),
            ("  header.end\n", "", 5, "close the open section"),
            ("  header.begin\n", "", 2, "outside a section"),
            ("point.begin", "points.begin", None, "unknown section"),
            ("units.len.f = ", "units.len.f = 0 !", 9, "1000 for mm"),
            ("units.len.f = ", "units.len.f = metre !", 9, "not a number"),
            ("    type    = ", "    type    = 7 !", 4, "0 .rail. or 1 .wheel."),
            ("    comment = 'a test'", "    mirror.y = 2", 7, "0 or 1"),
        ],
    )
    def test_faults(self, tmp_path, profile, name, old, new, line, mend):
        text = simpack(profile)
        assert old in text
        with pytest.raises(ProfileError, match=mend) as caught:
            load_profile(put(tmp_path, text.replace(old, new, 1), name))
        if line:
            assert f"line {line}:" in str(caught.value)


def miniprof(profile, columns="X,Y", offset=(0.0, 0.0), keys=()):
    """A MiniProf file: wheel X from the flange back, Y to the tip; rail X to gauge, Y up."""
    if profile.kind == "wheel":
        x, y = 1e3 * profile.y + 70.0, -1e3 * profile.z
    else:
        x, y = -1e3 * profile.y[::-1], 1e3 * profile.z[::-1]
    x, y = x - offset[0], y - offset[1]
    cells = {"X": x, "Y": y, "A": np.zeros_like(x), "C": np.ones_like(x)}
    rows = zip(*(cells[name] for name in columns.split(",")), strict=True)
    return "\n".join(
        [
            "Filename=measured",
            "ProgramName=MiniProf",
            f"XYPoints={len(x)}",
            f"XOffset={offset[0]:.4f}",
            f"YOffset={offset[1]:.4f}",
            '"Commented=1"',
            *keys,
            f"ColumnDef={columns}",
            "",
            *("\t".join(f"{v:.9f}" for v in row) for row in rows),
            "",
        ]
    )


class TestMiniProf:
    @pytest.mark.parametrize("profile, name", [(WHEEL, "a.whl"), (RAIL, "a.ban"), (RAIL, "a.rai")])
    @pytest.mark.parametrize("columns", ["X,Y", "X,Y,A,C", "A,Y,X"])
    def test_columns(self, tmp_path, profile, name, columns):
        found = load_profile(put(tmp_path, miniprof(profile, columns), name))
        same(found, profile)
        assert found.name == "measured"
        assert "MiniProf" in " ".join(found.remarks)

    def test_offsets(self, tmp_path):
        found = load_profile(put(tmp_path, miniprof(RAIL, offset=(1.5, -2.25)), "a.ban"))
        same(found, RAIL)

    def test_a_rail_with_y_down(self, tmp_path):
        down = re.sub(
            r"^(-?\d+\.\d+)\t(-?\d+\.\d+)$",
            lambda m: f"{m[1]}\t{-float(m[2]):.9f}",
            miniprof(RAIL),
            flags=re.MULTILINE,
        )
        found = load_profile(put(tmp_path, down, "a.ban"))
        same(found, RAIL)
        assert "z turned up, as the shape shows" in found.remarks

    def test_asymmetric_rail_keeps_its_gauge_side(self, tmp_path):
        worn = RAIL.rotated(0.05)
        found = load_profile(put(tmp_path, miniprof(worn), "a.ban"))
        y = np.linspace(-0.03, 0.03, 50)
        assert found.height(y) == pytest.approx(worn.height(y), abs=1e-8)

    def test_old_heading(self, tmp_path):
        table = miniprof(WHEEL).split("\n\n", 1)[1]
        text = "#MINIWHEELPROF\ncar 1(R)\nMINIPROF 2020\nStock.......:\n(Sd/Sh/qR)\n\n" + table
        same(load_profile(put(tmp_path, text, "a.whl")), WHEEL)

    def test_flange_back_that_wavers(self, tmp_path):
        """Measured flange backs are upright and run to and fro by some hundredths of mm."""
        depth = np.arange(-9.0, 9.0, 0.3)
        back = [f"{0.05 * np.sin(5 * d):.5f}\t{d:.5f}" for d in depth]
        head, table = miniprof(WHEEL).split("\n\n", 1)
        text = head.replace("XYPoints", "Points") + "\n\n" + "\n".join(back) + "\n" + table
        found = load_profile(put(tmp_path, text, "a.whl"))
        same(found, WHEEL, 1e-6, low=-0.068)
        assert "overhanging" in " ".join(found.remarks)

    def test_template(self, tmp_path):
        x, y = -1e3 * RAIL.y[::-1], 1e3 * RAIL.z[::-1]
        pieces = [
            f"MPD{i}=L {x[i - 1]:.9f} {y[i - 1]:.9f} {x[i]:.9f} {y[i]:.9f}"
            for i in range(1, len(x))
        ]
        text = "[FileInfo]\nProgramName=MiniProf\n\n[Profile1Info]\nMPDN=UIC60\n"
        path = put(tmp_path, text + f"MPDC={len(pieces)}\n" + "\n".join(pieces) + "\n", "a.mpt")
        same(load_profile(path, kind="rail"), RAIL)

    def test_faults(self, tmp_path):
        text = miniprof(WHEEL)
        cut = put(tmp_path, text[: len(text) // 3], "cut.whl")
        with pytest.raises(ProfileError, match=r"cut.whl, line 3.*cut off"):
            load_profile(cut)
        with pytest.raises(ProfileError, match=r"line 7.*no X and Y"):
            load_profile(put(tmp_path, text.replace("ColumnDef=X,Y", "ColumnDef=A,C"), "a.whl"))
        with pytest.raises(ProfileError, match=r"line 4.*not a number"):
            load_profile(put(tmp_path, text.replace("XOffset=0.0000", "XOffset=east"), "a.whl"))
        with pytest.raises(ProfileError, match="only straight pieces"):
            load_profile(put(tmp_path, "MPDC=1\nMPTypeNo=1\nMPD1=A 1 2 3\n", "a.mpt"), kind="rail")


def vampire(left, right, datum="EUROPEAN", inclination=0.0):
    """A VAMPIRE file: y from the centre line to the right, left and right side by side."""
    if left.kind == "wheel":
        from_back = {"EUROPEAN": 70.0, "US1": 2.84375 * 25.4, "CUSTOM 71.5": 71.5}[datum]
        distance = 1360.0
        offset = distance / 2 + from_back
        z_sign, words = -1.0, ("WHEELPROFILE", f"TREADDATUM {datum}", f"FLANGEBACK {distance}")
    else:
        distance = 1435.0
        offset = distance / 2 + 35.97
        z_sign, words = 1.0, ("RAILPROFILE", "GAUGEPOINT EUROPEAN", f"GAUGE {distance}")
    rows = [
        f"{-(1e3 * a + offset):.8f}, {z_sign * 1e3 * b:.8f} {1e3 * c + offset:.8f} "
        f"{z_sign * 1e3 * d:.8f}"
        for a, b, c, d in zip(left.y, left.z, right.y, right.z, strict=True)
    ]
    return "\n".join([words[0], "a title", *words[1:], *rows, ""])


class TestVampire:
    @pytest.mark.parametrize("datum", ["EUROPEAN", "US1", "CUSTOM 71.5"])
    @pytest.mark.parametrize("side", ["left", "right"])
    def test_wheel(self, tmp_path, datum, side):
        found = load_profile(put(tmp_path, vampire(WHEEL, WHEEL, datum), "a.whe"), side=side)
        same(found, WHEEL)
        assert found.name == "a title"
        assert "differ" not in " ".join(found.remarks)

    def test_left_and_right_differ(self, tmp_path):
        worn = Profile("worn", "wheel", WHEEL.y, WHEEL.z + 1e-4 * np.cos(40.0 * WHEEL.y) - 1e-4)
        path = put(tmp_path, vampire(WHEEL, worn), "a.whe")
        same(load_profile(path, side="left"), WHEEL)
        found = load_profile(path, side="right")
        same(found, worn)
        assert "left and right differ; this is the right one" in found.remarks

    @pytest.mark.parametrize("side", ["left", "right"])
    def test_rail_is_centred_between_its_flanks(self, tmp_path, side):
        found = load_profile(put(tmp_path, vampire(RAIL, RAIL), "a.rai"), side=side)
        same(found, RAIL, TOP)
        assert "midway between the flanks" in " ".join(found.remarks)

    def test_rai_of_miniprof_and_of_vampire(self, tmp_path):
        same(load_profile(put(tmp_path, miniprof(RAIL), "m.rai")), RAIL)
        same(load_profile(put(tmp_path, vampire(RAIL, RAIL), "v.rai")), RAIL, TOP)

    @pytest.mark.parametrize(
        "old, new, line, mend",
        [
            ("TREADDATUM EUROPEAN", "TREADDATUM MARTIAN", 3, "use EUROPEAN"),
            ("TREADDATUM EUROPEAN", "GAUGE 1435", 3, "gives TREADDATUM"),
            ("FLANGEBACK 1360.0", "FLANGEBACK wide", 4, "give millimetres"),
        ],
    )
    def test_faults(self, tmp_path, old, new, line, mend):
        text = vampire(WHEEL, WHEEL).replace(old, new)
        with pytest.raises(ProfileError, match=f"line {line}: .*{mend}"):
            load_profile(put(tmp_path, text, "a.whe"))

    def test_one_side_only(self, tmp_path):
        lines = vampire(WHEEL, WHEEL).split("\n")
        lines[10] = " ".join(lines[10].split()[:2])
        with pytest.raises(ProfileError, match=r"line 11: .*both sides"):
            load_profile(put(tmp_path, "\n".join(lines), "a.whe"))

    def test_no_heading(self, tmp_path):
        with pytest.raises(ProfileError, match="neither WHEELPROFILE nor RAILPROFILE"):
            load_profile(put(tmp_path, "1 2 3 4\n" * 20, "a.whe"))


class TestGensys:
    @pytest.mark.parametrize("profile, name", [(WHEEL, "a.wheel"), (RAIL, "a.rail")])
    def test_turned_both_ways(self, tmp_path, profile, name):
        rows = [
            f"{-1e3 * y:.9f} {-1e3 * z:.9f}  # point"
            for y, z in zip(profile.y[::-1], profile.z[::-1], strict=True)
        ]
        found = load_profile(put(tmp_path, "\n".join(rows), name))
        same(found, profile)
        assert "GENSYS" in " ".join(found.remarks)

    def test_asymmetric_rail_keeps_its_gauge_side(self, tmp_path):
        worn = RAIL.rotated(0.05)
        rows = [f"{-1e3 * y:.9f} {-1e3 * z:.9f}" for y, z in zip(worn.y, worn.z, strict=True)]
        found = load_profile(put(tmp_path, "\n".join(rows), "a.rail"))
        y = np.linspace(-0.03, 0.03, 50)
        assert found.height(y) == pytest.approx(worn.height(y), abs=1e-8)


def test_format_may_be_named(tmp_path):
    path = put(tmp_path, vampire(RAIL, RAIL), "odd.dat")
    same(load_profile(path, format="vampire"), RAIL, TOP)
    path = put(tmp_path, miniprof(WHEEL), "odd.dat")
    same(load_profile(path, format="miniprof", kind="wheel"), WHEEL)
    with pytest.raises(ProfileError, match="no SIMPACK"):
        load_profile(path, format="simpack")


@settings(
    deadline=None, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    amplitude=st.floats(-3e-4, 3e-4),
    wavelength=st.floats(0.01, 0.1),
    shift=st.floats(-2e-3, 2e-3),
    spacing=st.floats(3e-4, 2e-3),
    suffix=st.sampled_from([".prw", ".txt", ".csv"]),
)
def test_any_worn_wheel_survives_a_round_trip(
    tmp_path, amplitude, wavelength, shift, spacing, suffix
):
    """What is written is read back to the last digit written, for wheels worn in any way."""
    base = WHEEL.resampled(spacing)
    worn = base.z + amplitude * np.sin(2 * np.pi * base.y / wavelength)
    profile = Profile("worn", "wheel", base.y + shift, worn)
    back = load_profile(save_profile(profile, tmp_path / f"worn{suffix}"))
    assert back.y == pytest.approx(profile.y, abs=6e-12)
    offset = 0.0 if suffix != ".prw" else float(np.interp(0.0, profile.y, profile.z))
    offset = offset if abs(offset) > 1e-6 else 0.0
    assert back.z == pytest.approx(profile.z - offset, abs=1e-10)
