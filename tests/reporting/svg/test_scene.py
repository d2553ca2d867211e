"""Marks as SVG and as files: short, escaped, the same bytes, and with every point where its number is."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.errors import FddbenchError
from fddbench.reporting.labels import label
from fddbench.reporting.svg.axes import Plot, linear, logarithmic
from fddbench.reporting.svg.palette import LOOKS, css
from fddbench.reporting.svg.picture import Picture
from fddbench.reporting.svg.scene import Box, Dot, Path, Scene, Text, path_data
from fddbench.reporting.svg.traces import coarse

SCENE = Scene(100, 50, "a <b>", [Box(0, 0, 10, 10, "o0", title="<i>"), Dot(5, 5, "d1"), Path([(0, 0), (9, 9)], "s1"),
                                 Text(1, 9, "$x_1$ & <y>", anchor="end", bold=True)])  # fmt: skip
POINTS = st.lists(st.tuples(st.floats(-500, 500), st.floats(-500, 500)), min_size=1, max_size=40)


@given(POINTS)
def test_paths_end_where_their_points_do(points):
    at, ends = np.zeros(2), []
    for kind, numbers in re.findall(r"([Mlhv])([^Mlhv]*)", path_data(points)):
        values = [float(v) for v in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", numbers)]
        step = {"M": values, "l": values, "h": [*values, 0.0], "v": [0.0, *values]}[kind]
        at = np.array(step) if kind == "M" else at + step
        ends.append(at)
    np.testing.assert_allclose(at, np.round(points[-1], 1), atol=0.06)


def test_a_point_that_is_no_number_interrupts():
    assert path_data([(0, 0), (1, 0), (float("nan"), 0), (3, 0), (4, 0)]) == "M0 0h1M3 0h1"


def test_text_stays_text_in_both_kinds_of_svg():
    for standalone in (False, True):
        text = SCENE.svg(standalone=standalone)
        assert "<b>" not in text
        assert "<i>" not in text
        assert "&lt;y&gt;" in text
        assert 'aria-label="a &lt;b&gt;"' in text
    assert "class=" not in SCENE.svg(standalone=True)
    assert "xmlns" in SCENE.svg(standalone=True)


@pytest.mark.parametrize(("kind", "magic"), [("svg", b"<svg"), ("pdf", b"%PDF"), ("png", b"\x89PNG")])
def test_pictures_are_saved_with_the_same_bytes(tmp_path, kind, magic):
    path = Picture(SCENE).save(tmp_path / "new" / f"a.{kind}")
    again = Picture(SCENE).save(tmp_path / f"b.{kind}")
    assert path.read_bytes().startswith(magic)
    assert path.read_bytes() == again.read_bytes()


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(FddbenchError, match="let it end in .svg, .pdf, .png"):
        Picture(SCENE).save(tmp_path / "a.gif")


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6))
def test_ticks_lie_on_the_axis_and_are_few(low, width):
    scale = linear(low, low + width)
    room = 1e-6 * width + 1e-9
    assert all(scale.low - room <= tick <= scale.high + room for tick in scale.ticks)
    assert len(scale.ticks) <= 9


@given(st.floats(1e-4, 1e2), st.floats(3.0, 1e6))
def test_decades_have_ticks(low, ratio):
    scale = logarithmic(low, low * ratio)
    assert all(low <= tick <= low * ratio * 1.001 for tick in scale.ticks)
    place = scale.place(np.array([low, low * ratio]))
    np.testing.assert_allclose(place, [0.0, 1.0], atol=1e-9)


def test_numbers_outside_an_axis_stay_at_its_edge():
    plot = Plot(10, 10, 100, 50, linear(0, 1), linear(0, 1))
    assert plot.at(np.array([-5.0, 9.0]), np.array([0.5, 1e300])) == [(10.0, 35.0), (110.0, 10.0)]


def test_thinned_lines_keep_every_extreme():
    values = np.random.default_rng(3).standard_normal(3000)
    time_s, kept = coarse(np.arange(3000.0), values, 100)
    assert len(kept) <= 100
    assert (kept.min(), kept.max()) == (values.min(), values.max())
    assert np.all(np.diff(time_s) >= 0)


def test_every_look_is_in_the_style_sheet():
    sheet = css()
    assert all(f"svg .{name}{{" in sheet for name in LOOKS)
    assert "prefers-color-scheme:dark" in sheet


def test_labels_take_the_unit_from_the_name():
    assert label("reconstruction_deg_s") == "reconstruction [deg/s]"
    assert label("p_x_cg_ratio") == "x cg [-]"
    assert label("f2_loss_percent") == "fault 2 loss [%]"
