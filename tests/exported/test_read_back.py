"""Exported C, read back by a parser that shares nothing with the writer, is the detector node by node."""

import pytest

from fddbench.testing.read_back import prove
from tests.exported.conftest import exported, traceable
from tests.exported.mutants import mutants


@pytest.mark.parametrize(("design", "operations"), [("voting_monitor", 49), ("sliding_mode_published", 1048)])
def test_the_c_is_the_detector(design, operations):
    proof = prove(*exported("smoke", design))
    assert proof.differences == ()
    assert proof.operations == operations


@pytest.mark.parametrize(("design", "number"), [("voting_monitor", 60), ("sliding_mode_published", 12)])
def test_planted_faults_are_found(design, number):
    interface, header, source = exported("smoke", design)
    planted = list(mutants(source, number))
    assert len(planted) == number
    assert [what for what, text in planted if not prove(interface, header, text).differences] == []


def test_a_primitive_that_differs_is_refused(voting_monitor):
    interface, header, source = voting_monitor
    (said,) = prove(interface, header, source.replace("|| (a != a)", "|| (a == a)")).differences
    assert said == "fdd_max is not the primitive that was compared with NumPy"


def test_an_elementary_function_that_differs_is_found():
    interface, header, source = exported("smoke", "sliding_mode_published")
    (said,) = prove(
        interface, header, source.replace("1.66666666666666324348e-01", "1.666666666666664e-01")
    ).differences
    assert said.startswith("fdd_sin is ")


def test_a_start_that_differs_is_found(voting_monitor):
    interface, header, source = voting_monitor
    said = prove(interface, header, source.replace("x->held_samples = 0.0;", "x->held_samples = 1.0;")).differences
    assert said == ("held_samples[0] starts otherwise",)


def test_what_is_no_c_is_said(voting_monitor):
    interface, header, _ = voting_monitor
    (said,) = prove(interface, header, "void broken(").differences
    assert said.startswith("this is no C that can be read")


@pytest.mark.slow
def test_every_design_is_its_c():
    designs = traceable()
    differences = {name: found for name, at in designs.items() if (found := prove(*exported(*at)).differences)}
    assert differences == {}
    assert len(designs) >= 60


@pytest.mark.slow
@pytest.mark.parametrize(
    ("campaign", "design"),
    [
        ("b747_comparison", "hinf_filter_b747"),
        ("yaw_rate_banks_tuning", "multiple_model"),
        ("yaw_rate_best", "yaw_rate_best"),
    ],
)
def test_many_planted_faults_are_found(campaign, design):
    interface, header, source = exported(campaign, design)
    planted = list(mutants(source, 100, seed=1))
    assert len(planted) == 100
    assert [what for what, text in planted if not prove(interface, header, text).differences] == []
