"""All flights over time: what is drawn of it, and that a page without bands has none."""

import numpy as np
import pytest

from fddbench.interfaces import Bands, Response
from fddbench.reporting.bands import asked_of, band_sections, names_in
from fddbench.reporting.page.writing import page_html


def bands(onset_s=None):
    time_s = np.linspace(0.0, 10.0, 50)
    seven = np.linspace(-1.0, 1.0, 7)[:, np.newaxis] + np.sin(time_s)
    declared = np.stack([1.0 - time_s / 10.0, time_s / 10.0, 0.0 * time_s])
    return Bands(
        scenario="jam_a", manoeuvre="cruise", flights=3, of=9, case="jam_a/0/0/1", time_s=time_s, onset_s=onset_s,
        signals={"phi_deg": seven, "r_deg_s_1": seven}, one={"phi_deg": seven[3], "limit_deg": seven[6], "r_deg_s_1": seven[2]},
        detectors={"d": {"residual": seven, "reconstruction_deg_s": seven, "threshold_deg_s": np.abs(seven)}},
        declared={"d": declared},
    )  # fmt: skip


RESPONSES = (
    Response(signal="phi_deg", command="not_there_deg", limits=("limit_deg",)),
    Response(signal="not_there_deg"),
)


def test_healthy_flights_show_what_the_plant_says_and_others_what_the_benchmark_does():
    assert [panel.signal for panel in asked_of(RESPONSES, bands(), ("r_deg_s",))] == ["phi_deg"]
    assert [panel.signal for panel in asked_of(RESPONSES, bands(2.0), ("r_deg_s",))] == ["r_deg_s_1"]
    assert [panel.signal for panel in asked_of((), bands(), ("r_deg_s",))] == ["r_deg_s_1"]


def test_names_to_record_are_those_of_panels_commands_and_limits():
    assert names_in((Response(signal="a_deg_2", command="b_deg", limits=("c_deg",)),), ("r_deg_s",)) == {
        "a_deg", "a_deg_2", "b_deg", "c_deg", "r_deg_s",
    }  # fmt: skip


@pytest.mark.parametrize("onset_s", [None, 2.0])
def test_pictures_say_how_many_flights_they_hold(onset_s):
    (picture,) = band_sections([bands(onset_s)], RESPONSES, ("r_deg_s",))
    assert (picture["flights"], picture["of"], picture["onset_s"]) == (3, 9, onset_s)
    assert len(picture["scenes"]) >= 2
    assert all(scene.svg().startswith("<svg") for scene in picture["scenes"])


def test_only_a_page_that_was_given_bands_shows_them(make_report):
    assert "All flights over time" not in page_html(make_report(scenarios=("jam_a",), flights=3, recordings=()))
    page = page_html(
        make_report(scenarios=("jam_a",), flights=3, recordings=(), bands=[bands(2.0)], responses=RESPONSES)
    )
    assert "3 of 9 flown flights; onset 2 s; in black jam_a/0/0/1" in page
