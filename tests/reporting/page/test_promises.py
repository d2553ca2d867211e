"""What is drawn as the promise of a design is the reference that its filter was made for."""

import numpy as np
import pytest

from fddbench.reporting.page.promises import lost_reference, promise_of

START, FOUND = {"a": [-1.0], "b": [1.0], "c": [0.5], "d": [1.4]}, {"D": [[3.0]]}


def design(method, estimates=False, **recipe):
    gains = {"C": [[1.0]], "window_s": 0.5, "estimates_faults": estimates}
    return {"kind": "hinf_filter", "recipe": {"method": method, **recipe}, "gains": gains}


def test_a_fixed_reference_is_promised_as_it_is_written():
    own = promise_of(design("fixed_reference", reference=START))
    assert (own.A.item(), own.C.item(), own.D.item(), own.window_s) == (-1.0, 0.5, 1.4, 0.5)


@pytest.mark.parametrize("method", ["free_reference", "fixed_poles", "two_step"])
def test_of_a_search_its_result_is_promised_and_not_its_start(method):
    assert promise_of(design(method, reference=START, found={"reference": FOUND})).D.item() == 3.0
    assert promise_of(design(method, reference=START, found={"gamma": 0.3})) is None
    assert lost_reference(design(method, reference=START, found={"gamma": 0.3}))
    assert not lost_reference(design(method, found={"reference": FOUND}))
    assert not lost_reference(design("fixed_reference", reference=START))


def test_what_estimates_the_faults_promises_them():
    assert np.array_equal(promise_of(design("exact_inverse", estimates=True)).D, np.eye(1))
    assert promise_of(design("exact_inverse")) is None
