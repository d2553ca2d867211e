"""The self-test that travels with the code: a thousand samples of a flight, what must come out, and a main that compares."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fddbench.exported.interface import Interface
from fddbench.exported.layout_c import banner
from fddbench.exported.spelling import Spelling

__all__ = ["Vectors", "selftest_text", "vectors_text"]

Floats = npt.NDArray[np.float64]


class Vectors:
    """Inputs and what must come out, (n_samples, n_numbers) each, in the order of the structs."""

    def __init__(self, inputs: Floats, outputs: Floats) -> None:
        self.inputs, self.outputs = inputs, outputs

    def __len__(self) -> int:
        return len(self.inputs)


def vectors_text(interface: Interface, vectors: Vectors, spelling: Spelling) -> str:
    """Text of the vector file; hexadecimal, so that every compiler reads the same bits."""
    name = interface.name
    lines = [
        *banner(
            f"{len(vectors)} samples of a flight for {name}",
            ["Inputs and what must come out, bit by bit, a sample a row in the order of the structs."],
        ),
        f"#ifndef {name.upper()}_VECTORS_H",
        f"#define {name.upper()}_VECTORS_H",
        "",
        f"#define {name.upper()}_SAMPLES {len(vectors)}U",
        "",
    ]
    for what, rows in (("inputs", vectors.inputs), ("outputs", vectors.outputs)):
        lines.append(f"static const {spelling.real} {name}_{what}[{len(rows)}][{rows.shape[1]}] = {{")
        lines += _rows(rows, spelling)
        lines += ["};", ""]
    return "\n".join([*lines, f"#endif /* {name.upper()}_VECTORS_H */"]) + "\n"


def _rows(rows: Floats, spelling: Spelling) -> Iterator[str]:
    for number, row in enumerate(rows):
        own = ", ".join(_hexadecimal(float(value), spelling) for value in row)
        yield f"    {{{own}}}{',' if number < len(rows) - 1 else ''}"


def _hexadecimal(value: float, spelling: Spelling) -> str:
    if not np.isfinite(value):
        return "NAN" if np.isnan(value) else "INFINITY" if value > 0.0 else "-INFINITY"
    own = float(np.float32(value)) if spelling.suffix else value
    if own == int(own) and abs(own) < 1e6:
        return f"{own!r}{spelling.suffix}"
    return own.hex() + spelling.suffix


def selftest_text(interface: Interface, spelling: Spelling) -> str:
    """Text of the main that compares."""
    name = interface.name
    return _SELFTEST.format(name=name, upper=name.upper(), real=spelling.real, step_s=f"{interface.step_s:g}")


_SELFTEST = """\
/*
 * Self-test of {name}
 *
 * Steps a recorded flight and compares every output with the vector file, bit by bit. Gives 0 and a line where all
 * are equal, 1 and the first difference where one is not. It runs on the target as it is: build it with the flags of
 * the flight program.
 */
#include "{name}.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "{name}_vectors.h"

/* Whether two numbers have the same bits; what a not-a-number carries inside is nobody's business. */
static bool same({real} a, {real} b)
{{
    return ((a != a) && (b != b)) || (memcmp(&a, &b, sizeof(a)) == 0);
}}

int main(void)
{{
    {name}_state_t x;
    {name}_inputs_t in;
    {name}_outputs_t out;
    uint32_t k;

    if ((sizeof(in) != sizeof({name}_inputs[0])) || (sizeof(out) != sizeof({name}_outputs[0])))
    {{
        (void)printf("{name}: the structs are padded, which the vectors are not\\n");
        return 1;
    }}
    {name}_init(&x);
    for (k = 0U; k < {upper}_SAMPLES; k++)
    {{
        {real} found[sizeof({name}_outputs[0]) / sizeof({real})];
        uint32_t j;

        (void)memcpy(&in, {name}_inputs[k], sizeof(in));
        {name}_step(&in, &x, &out);
        (void)memcpy(found, &out, sizeof(out));
        for (j = 0U; j < (uint32_t)(sizeof(found) / sizeof(found[0])); j++)
        {{
            if (!same(found[j], {name}_outputs[k][j]))
            {{
                (void)printf("{name}: sample %u, output %u is %.17g, must be %.17g\\n",
                    (unsigned)k, (unsigned)j, (double)found[j], (double){name}_outputs[k][j]);
                return 1;
            }}
        }}
    }}
    (void)printf("{name}: %u samples of {step_s} s, all outputs equal bit for bit\\n", (unsigned){upper}_SAMPLES);
    return 0;
}}
"""
