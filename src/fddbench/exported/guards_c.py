"""Two questions a flight program may ask: can these inputs be used, and is the state still made of numbers."""

from collections.abc import Iterator, Sequence

from fddbench.exported.interface import Interface, Member
from fddbench.exported.layout_c import banner
from fddbench.exported.spelling import Spelling

__all__ = ["LARGEST_INPUT", "SOUND", "USABLE", "guards_text", "largest_number"]

LARGEST_INPUT = 1e9
"""Inputs above are no signals of an aircraft, whatever their unit: each is compared in its own."""
USABLE = f"Whether all inputs are numbers of at most {LARGEST_INPUT:.0e} in size, each in its own unit"
SOUND = "Whether the state is made of finite numbers; if not, only the init function helps"


def largest_number(spelling: Spelling) -> float:
    """Largest finite number of a precision."""
    return 3.4028234663852886e38 if spelling.suffix else 1.7976931348623157e308


def guards_text(interface: Interface, spelling: Spelling) -> list[str]:
    """Lines of the two functions."""
    name = interface.name
    return [
        *banner(USABLE, []),
        f"bool {name}_usable(const {name}_inputs_t *in)",
        *_every(interface.inputs, "in", spelling.number(LARGEST_INPUT), spelling),
        "",
        *banner(SOUND, []),
        f"bool {name}_sound(const {name}_state_t *x)",
        *_every(interface.state, "x", spelling.number(largest_number(spelling)), spelling),
    ]


def _every(members: Sequence[Member], pointer: str, limit: str, spelling: Spelling) -> Iterator[str]:
    yield "{"
    yield "    bool good = true;"
    if any(member.rows for member in members):
        yield "    uint32_t i;"
    yield ""
    size = f"fabs{spelling.suffix}"
    for member in members:
        if member.rows:
            yield f"    for (i = 0U; i < {member.rows}U; i++)"
            yield "    {"
            yield f"        good = good && ({size}({pointer}->{member.name}[i]) <= {limit});"
            yield "    }"
        else:
            yield f"    good = good && ({size}({pointer}->{member.name}) <= {limit});"
    if not members:
        yield f"    good = ({size}({pointer}->nothing) <= {limit});"
    yield "    return good;"
    yield "}"
