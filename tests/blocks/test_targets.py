"""Law: the text of a kernel at one lane compiles for a graphics card and for a browser, and nothing in it is fused."""

import re
from typing import Any

import pytest
from tests.bench import step as bench
from tests.blocks.test_plan import _step

from fddbench.blocks.draws import with_draws
from fddbench.blocks.lower import Spec, lower
from fddbench.blocks.program import Program, trace
from fddbench.blocks.targets.llvm import frame

EVERYTHING = trace(_step, state=6, constants=3, normals=4, sample=0)
PROCESSORS = {"nvptx64-nvidia-cuda": "sm_70", "wasm32-unknown-unknown": ""}


def _assembly(program: Program, triple: str) -> str:
    binding: Any = pytest.importorskip("llvmlite.binding")
    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    try:
        target = binding.Target.from_triple(triple)
    except RuntimeError:
        pytest.skip(f"this llvmlite has no target {triple}")
    streams = ((1, "flight"), (2, "scenario"))
    recorded = ("y",) if "y" in program.outputs else ()
    spec = Spec(program=with_draws(program), streams=streams, recorded=recorded)
    module = binding.parse_assembly(frame.write(lower(spec), 1, rounds=True))
    module.triple = triple
    module.verify()
    machine = target.create_target_machine(cpu=PROCESSORS[triple], opt=2, reloc="default", codemodel="default")
    return str(machine.emit_assembly(module))


@pytest.mark.parametrize("program", [EVERYTHING, bench.noisy_program()], ids=["everything", "bench"])
@pytest.mark.parametrize("triple", sorted(PROCESSORS))
def test_other_machines(triple: str, program: Program) -> None:
    text = _assembly(program, triple)
    words = re.findall(r"^\s+([a-z][\w.]*)", text, re.MULTILINE)
    assert not [word for word in words if re.search(r"fma|mad|fused", word)]
    products = [word for word in words if "f64" in word and re.search(r"mul|add|sub", word)]
    assert len(products) > 50
    if triple.startswith("nvptx"):  # without a rounding in its name NVIDIA's assembler may fuse a product with a sum
        assert not [word for word in products if ".rn." not in word]
    # nothing from a mathematical library, which would have its own bits: only our own function is called
    called = set(re.findall(r"call(?:\.uni)?\s+(\w+)", text))
    assert called == ({"repeat_0"} if program is EVERYTHING else set())
