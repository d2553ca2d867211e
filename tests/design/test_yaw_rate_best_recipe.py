"""`fddbench design` makes the shipped designs of yaw_rate_best anew, and says what is wrong with others."""

import numpy as np
import pytest

from fddbench import gallery
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.design.recipe import cook
from fddbench.errors import FddbenchError


def numbers(nest):
    """All numbers of a nest in order."""
    if isinstance(nest, dict):
        return [x for value in nest.values() for x in numbers(value)]
    return [x for value in nest for x in numbers(value)] if isinstance(nest, list | tuple) else [float(nest)]


@pytest.mark.parametrize("name", ["yaw_rate_best", "yaw_rate_best_6dof"])
def test_the_shipped_design_comes_of_its_recipe(name):
    path = gallery.folder("detectors") / f"{name}.yaml"
    cooked = cook(path)
    kept = read_yaml(path).data["gains"]
    assert list(cooked.gains) == list(kept)
    np.testing.assert_allclose(numbers(dict(cooked.gains)), numbers(kept), rtol=1e-4, atol=1e-9)


def changed(tmp_path, old, new, name="yaw_rate_best"):
    text = (gallery.folder("detectors") / f"{name}.yaml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "mine.yaml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


def test_the_published_model_takes_no_envelope(tmp_path):
    with pytest.raises(
        FddbenchError, match="lateral_lpv has a box of its own and takes none; every other aircraft needs one"
    ):
        cook(changed(tmp_path, "aircraft: lateral_lpv", "aircraft: transport_6dof"))


def test_an_aircraft_that_is_not_there_is_named(tmp_path):
    with pytest.raises(
        FddbenchError, match="'mine_too.yaml' is neither lateral_lpv nor transport_6dof, and there is no file"
    ):
        cook(changed(tmp_path, "aircraft: transport_6dof", "aircraft: mine_too.yaml", "yaw_rate_best_6dof"))


def test_a_copy_of_the_twin_jet_beside_the_design_is_an_aircraft_of_its_own(tmp_path):
    source = gallery.folder("detectors").parent / "src/fddbench/flight/transport/data/twin_jet.yaml"
    text = source.read_text(encoding="utf-8") if source.exists() else pytest.skip("no source tree")
    tail = text.replace("c_n_beta: {value: 0.09929", "c_n_beta: {value: 0.19858")
    assert tail != text
    (tmp_path / "larger_tail.yaml").write_text(tail, encoding="utf-8")
    path = changed(tmp_path, "aircraft: transport_6dof", "aircraft: larger_tail.yaml", "yaw_rate_best_6dof")
    mine = cook(path).gains["table"]["yaw"][0][0]
    shipped = cook(gallery.folder("detectors") / "yaw_rate_best_6dof.yaml").gains["table"]["yaw"][0][0]
    assert mine > 1.7 * shipped
