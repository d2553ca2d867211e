"""Exported C as compilers make it: no warning, the vectors of a flight at every optimisation and on other processors."""

import subprocess
from functools import cache

import numpy as np
import pytest

from fddbench import gallery
from fddbench.blocks import functions, primitives
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.table import Table
from fddbench.exported.code import code_of
from fddbench.exported.elementary import elementary, with_those_inside
from fddbench.exported.primitives_c import primitives as primitives_c
from fddbench.exported.spelling import DOUBLE
from fddbench.runner.vectors import flown_samples
from tests.exported.building import object_of, ran, require
from tests.exported.conftest import assembled, exported, traceable

pytestmark = pytest.mark.slow

OTHERS = [
    ("smoke", "sliding_mode_published"),  # sine
    ("b747_comparison", "sliding_mode_b747"),  # power, exponential, logarithm
    ("yaw_rate_banks_tuning", "multiple_model"),
    ("yaw_rate_best", "yaw_rate_best"),
]


@cache
def signals(campaign, every, samples):
    return flown_samples(assembled(campaign), every, samples)


def written(folder, campaign, name, samples):
    """Files of a detector in a folder; their names."""
    interface, *_ = exported(campaign, name)
    own = assembled(campaign).detectors[name]
    code = code_of(interface, own.detector, signals(campaign, own.every, samples), about=["A detector."])
    for file, text in code.files.items():
        (folder / file).write_text(text)
    return [f"{interface.name}.c", f"{interface.name}_selftest.c"]


LEVELS = (["-O0"], ["-O2"], ["-O3", "-march=native", "-fno-tree-slp-vectorize"])
"""The last flag is for GCC 12, which contracts in spite of -ffp-contract=off: sliding_mode_p_and_r has other bits without."""


def test_every_shipped_design_can_be_exported():
    shipped = {path.stem for path in gallery.folder("detectors").glob("*.yaml")}
    assert set(traceable()) == shipped


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_every_design_compiles_and_passes_its_vectors(compiler, tmp_path):
    """120 samples of a flight around its first fault; at full length they travel with the code."""
    for design, (campaign, name) in traceable().items():
        files = written(tmp_path, campaign, name, 120)
        for flags in LEVELS:
            assert "120 samples" in ran(tmp_path, compiler, *flags, files=files), (design, flags)


def test_every_kind_keeps_the_rules_that_cppcheck_judges(tmp_path):
    require("cppcheck")
    one_a_kind = {type(assembled(at[0]).detectors[at[1]].detector).__name__: at for at in traceable().values()}
    for at in one_a_kind.values():
        interface, header, source = exported(*at)
        (tmp_path / f"{interface.name}.h").write_text(header)
        (tmp_path / f"{interface.name}.c").write_text(source)
    said = {}
    for path in sorted(tmp_path.glob("*.c")):  # each by itself: a flight program has one detector
        command = ["cppcheck", "--addon=misra", "--std=c99", "--quiet", path.name]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        said[path.name] = done.stdout + done.stderr  # a missing addon is told on the one, a broken rule on the other
    assert len(said) == len(one_a_kind) >= 18
    assert {name: text for name, text in said.items() if text} == {}


@pytest.mark.parametrize("at", OTHERS, ids=lambda at: at[1])
def test_other_processors_give_the_same_bits(at, tmp_path):
    files = written(tmp_path, *at, 1000)
    for compiler, emulator in (("aarch64-linux-gnu-gcc", "qemu-aarch64"), ("powerpc64-linux-gnu-gcc", "qemu-ppc64")):
        said = ran(tmp_path, compiler, "-O2", "-static", files=files, wrapper=(emulator,))
        assert "1000 samples of 0.01 s, all outputs equal bit for bit" in said


def test_vectors_find_contraction(tmp_path):
    """AArch64 has fused multiply-add: a compiler that may contract gives other bits, and the self-test says so."""
    require("aarch64-linux-gnu-gcc", "qemu-aarch64")
    files = written(tmp_path, *OTHERS[0], 1000)
    command = ["aarch64-linux-gnu-gcc", "-O2", "-ffp-contract=fast", "-static", "-o", "program", *files, "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run(["qemu-aarch64", "./program"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "must be" in done.stdout


@pytest.mark.parametrize("flag", ["-ffast-math", "-D__FLT_EVAL_METHOD__=2"])
def test_a_compiler_with_another_arithmetic_refuses_the_source(flag, tmp_path):
    require("gcc")
    interface, header, source = exported("smoke", "voting_monitor")
    (tmp_path / f"{interface.name}.h").write_text(header)
    (tmp_path / "own.c").write_text(source)
    done = subprocess.run(
        ["gcc", "-std=c99", flag, "-c", "own.c"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "#error this file needs" in done.stderr


def test_single_precision_compiles_without_a_warning(tmp_path):
    from fddbench.exported.code import sources

    for at in OTHERS:
        own = assembled(at[0]).detectors[at[1]]
        interface, *_ = exported(*at)
        for file, text in sources(interface, own.detector, precision="single").items():
            (tmp_path / file).write_text(text)
        for compiler in ("gcc", "clang"):
            object_of(tmp_path, compiler, "-Wdouble-promotion", "-Wfloat-conversion", file=f"{interface.name}.c")


SPECIAL = np.array(
    [0.0, -0.0, 1.0, -1.0, 0.5, 1.5, 2.5, -2.5, 3.0, 0.7, 1e-310, 5e-324, 2.2250738585072014e-308, 1e308, -1e308, 1e5,
     4503599627370497.5, np.pi, 700.0, -745.2, np.inf, -np.inf, np.nan]
)  # fmt: skip
TABLE = Table.of([-1.0, 0.5, 0.5, 2.0])
COMPOSITES = {
    name: getattr(functions, "pow_" if name == "pow" else name) for name, op in OPERATIONS.items() if op.composite
}


def reference(op):
    """Operation on every pair of special values, by NumPy, (n, n)."""
    a, b = np.meshgrid(SPECIAL, SPECIAL, indexing="ij")
    with np.errstate(all="ignore"):
        if op in COMPOSITES:
            return COMPOSITES[op](a, b) if op in {"pow", "atan2"} else COMPOSITES[op](a)
        if op in {"locate", "gather"}:
            return getattr(primitives, op)(TABLE, a.ravel()).reshape(a.shape)
        if op == "pick":
            return primitives.pick(a, b, b + 1.0, b + 2.0)
        return np.asarray(OPERATIONS[op].numpy(*(a, b, b + 1.0)[: OPERATIONS[op].arity]), dtype=float)


def expression(op):
    """The same in C, of a and b."""
    if op in {"locate", "gather"}:
        return f"fdd_{op}(TABLE, 4U, a)"
    if op == "pick":
        return "fdd_pick((const double[3]){b, b + 1.0, b + 2.0}, 3U, a)"
    return OPERATIONS[op].c.format("a", "b")


def numbers_only(op):
    operation = OPERATIONS[op]
    return operation.result == "f" and set(operation.arguments) == {"f"}


def test_each_operation_has_the_bits_of_numpy_on_special_values(tmp_path):
    compared = sorted(op for op in OPERATIONS if numbers_only(op) or op in {"lt", "le", "eq", "ne", "pick"})
    assert len(compared) >= 24
    used = with_those_inside(compared)
    lines = [
        "#include <math.h>",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "#include <stdio.h>",
        "#include <string.h>",
    ]
    lines += [
        "static const double TABLE[4] = {-1.0, 0.5, 0.5, 2.0};",
        *primitives_c(used, DOUBLE),
        *elementary(used, DOUBLE),
    ]
    for op in compared:
        lines.append(
            f"static double run_{op}(double a, double b) {{ (void)a; (void)b; return (double)({expression(op)}); }}"
        )
    lines.append(
        f"static const uint64_t BITS[{len(SPECIAL)}] = {{{', '.join(f'{bits}ULL' for bits in SPECIAL.view(np.uint64))}}};"
    )
    lines.append("int main(void) { uint32_t j; uint32_t k; double r;")
    n = len(SPECIAL)
    for op in compared:
        lines.append(f"for (j = 0U; j < {n}U; j++) {{ for (k = 0U; k < {n}U; k++) {{")
        lines.append(
            f"r = run_{op}(fdd_from_bits(BITS[j]), fdd_from_bits(BITS[k])); (void)fwrite(&r, sizeof(r), 1, stdout); }} }}"
        )
    (tmp_path / "special.c").write_text("\n".join([*lines, "return 0; }"]) + "\n")
    subprocess.run(
        ["gcc", "-std=c99", "-O2", "-Wall", "-Werror", "-ffp-contract=off", "special.c", "-lm", "-o", "special"],
        cwd=tmp_path,
        check=True,
    )
    out = np.frombuffer(subprocess.run([tmp_path / "special"], capture_output=True, check=True).stdout).reshape(
        -1, n, n
    )
    for op, found in zip(compared, out, strict=True):
        wanted = np.array(np.broadcast_to(reference(op), (n, n)), dtype=float)
        same = (found.view(np.uint64) == wanted.view(np.uint64)) | (np.isnan(found) & np.isnan(wanted))
        assert same.all(), (
            op,
            [(SPECIAL[j], SPECIAL[k], found[j, k], wanted[j, k]) for j, k in np.argwhere(~same)[:4]],
        )
