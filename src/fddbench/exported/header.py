"""The header: three structs with their units, and the two functions that a flight program calls."""

from collections.abc import Iterator, Sequence

from fddbench.exported.guards_c import SOUND, USABLE
from fddbench.exported.interface import Interface, Member
from fddbench.exported.layout_c import COLUMNS, banner, comment, signature
from fddbench.exported.spelling import Spelling

__all__ = ["header_text"]


def header_text(interface: Interface, spelling: Spelling, *, head: Sequence[str]) -> str:
    """Text of the header file of a detector."""
    return "\n".join(_lines(interface, spelling, head)) + "\n"


def _lines(interface: Interface, spelling: Spelling, head: Sequence[str]) -> Iterator[str]:
    name = interface.name
    guard = f"{name.upper()}_H"
    yield from head
    yield from (f"#ifndef {guard}", f"#define {guard}", "", "#include <stdbool.h>", "#include <stdint.h>", "")
    yield from _struct("Measured at this sample", f"{name}_inputs_t", interface.inputs, spelling)
    yield from _struct(
        "Kept from sample to sample; nobody but the two functions writes to it",
        f"{name}_state_t",
        interface.state,
        spelling,
    )
    yield from _struct("Decided at this sample", f"{name}_outputs_t", interface.outputs, spelling)
    yield from banner("State before the first sample", [])
    yield f"void {name}_init({name}_state_t *x);"
    yield ""
    yield from banner(f"One sample; to be called every {interface.step_s:g} s", [])
    *lines, last = signature(
        f"void {name}_step", [f"const {name}_inputs_t *in", f"{name}_state_t *x", f"{name}_outputs_t *out"]
    )
    yield from (*lines, f"{last};")
    yield ""
    yield from banner(USABLE, [])
    yield f"bool {name}_usable(const {name}_inputs_t *in);"
    yield ""
    yield from banner(SOUND, [])
    yield f"bool {name}_sound(const {name}_state_t *x);"
    yield from ("", f"#endif /* {guard} */")


def _struct(about: str, name: str, members: Sequence[Member], spelling: Spelling) -> Iterator[str]:
    yield from banner(about, [])
    yield "typedef struct"
    yield "{"
    for member in members:
        size = f"[{member.rows}]" if member.rows else ""
        line = f"    {spelling.real} {member.name}{size};"
        remark = f" /* {member.comment} */" if member.comment else ""
        if len(line + remark) > COLUMNS:
            yield from comment(member.comment)
            remark = ""
        yield line + remark
    if not members:
        yield f"    {spelling.real} nothing; /* there is none */"
    yield f"}} {name};"
    yield ""
