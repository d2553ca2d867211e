"""Single precision: what it loses is measured, and what is no number any more is refused."""

import re
import subprocess

import numpy as np
import pytest

import fddbench
from fddbench.api import exporting
from fddbench.errors import DesignError
from fddbench.exported.elementary import elementary, with_those_inside
from fddbench.exported.primitives_c import primitives
from fddbench.exported.spelling import SINGLE
from tests.exported.building import require

AT = {
    "sin": np.linspace(-3000.0, 3000.0, 20001),
    "cos": np.linspace(-3000.0, 3000.0, 20001),
    "exp": np.linspace(-1000.0, 1000.0, 20001),
    "log": np.geomspace(2e-38, 1e38, 20001),
    "atan2": np.linspace(-50.0, 50.0, 20001),
    "asin": np.linspace(-1.0, 1.0, 20001),
}


def in_c(op, x, folder):
    """A function of one number (an angle over 1) in single precision, as C computes it."""
    used = with_those_inside({op, "from_bits"})
    texts = [*primitives(used, SINGLE), *elementary(used, SINGLE)]
    call = f"fdd_{op}(x{', 1.0f' if op == 'atan2' else ''})"
    turn = f"x = {call}; (void)fwrite(&x, 4, 1, stdout);"
    main = f"int main(void) {{ float x; while (fread(&x, 4, 1, stdin) == 1U) {{ {turn} }} return 0; }}"
    heads = [f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "stdio", "string")]
    (folder / "one.c").write_text("\n".join([*heads, *texts, main]) + "\n")
    require("gcc")
    subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", "one.c", "-lm", "-o", "one"], cwd=folder, check=True)
    given = x.astype(np.float32)
    done = subprocess.run([folder / "one"], input=given.tobytes(), capture_output=True, check=True)
    return np.frombuffer(done.stdout, np.float32).astype(float)


@pytest.mark.slow
@pytest.mark.parametrize("op", AT)
def test_elementary_functions_are_good_to_a_few_bits_over_their_range(op, tmp_path):
    x = AT[op].astype(np.float32).astype(float)
    with np.errstate(over="ignore"):
        wanted = getattr(np, {"atan2": "arctan", "asin": "arcsin"}.get(op, op))(x).astype(np.float32).astype(float)
    found = in_c(op, x, tmp_path)
    normal = np.isfinite(wanted) & ((np.abs(wanted) > 1.2e-38) | (wanted == 0.0))
    size = np.abs(wanted) if op == "exp" else np.maximum(np.abs(wanted), 1.0)
    assert (np.abs(found[normal] - wanted[normal]) <= 3e-7 * size[normal]).all()
    assert (found[np.isinf(wanted)] == np.inf).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("design", "campaign"), [("voting_monitor", "smoke"), ("sliding_mode_b747", "b747_comparison")]
)
def test_the_loss_is_measured_and_told(design, campaign):
    code = fddbench.export(design, campaign=campaign, precision="single")
    assert set(code.loss) == {member.source for member in code.interface.outputs}
    assert 0.0 < code.loss["residual"] < 1e-3
    told = re.sub(r"\s*\n \*\s*", " ", code.files[f"{design}.h"])
    assert f"residual {code.loss['residual']:.2g}" in told
    assert "It is the same detector as in the campaign" not in told


@pytest.mark.slow
def test_what_is_no_number_in_single_precision_is_refused(monkeypatch):
    measured = exporting._vectors_of

    def spoilt(interface, detector, code, precision):
        vectors = measured(interface, detector, code, precision)
        if precision == "single":
            vectors.outputs[-1, :] = np.nan
        return vectors

    monkeypatch.setattr(exporting, "_vectors_of", spoilt)
    with pytest.raises(DesignError, match=r"single precision makes no numbers of .*residual.*keep to double"):
        fddbench.export("voting_monitor", precision="single")
