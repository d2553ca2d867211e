"""Whether exported C is its detector, node by node, and so for all inputs; every difference in words."""

from dataclasses import dataclass
from typing import Any

from fddbench.blocks import functions
from fddbench.blocks.program import trace
from fddbench.exported.interface import Interface
from fddbench.testing.read_back.audited import require_audited
from fddbench.testing.read_back.parsed import ReadBackError, parsed
from fddbench.testing.read_back.reader import Reader
from fddbench.testing.read_back.values import Value, Values, of_program

__all__ = ["Proof", "prove"]

_FUNCTIONS: dict[str, Any] = {
    "sin": functions.sin, "cos": functions.cos, "exp": functions.exp, "log": functions.log, "pow": functions.pow_,
    "atan2": functions.atan2, "asin": functions.asin,
}  # fmt: skip
_ARGUMENTS = {"atan2": ("y", "x"), "pow": ("x", "y")}


@dataclass(frozen=True)
class Proof:
    """What came out.

    Attributes
    ----------
    operations : int
        Different operations that both have.
    differences : tuple of str
        Where the C is something else; none: it is the detector, for all inputs.
    """

    operations: int
    differences: tuple[str, ...]


def prove(interface: Interface, header: str, source: str) -> Proof:
    """Compare exported C in double precision with the program that it must be.

    Parameters
    ----------
    interface : Interface
        Of the detector, with its program.
    header, source : str
        Texts of the two files.
    """
    values = Values()
    wanted = of_program(interface.program, values)
    known = len(values.entries)
    try:
        reader = Reader(parsed(header, source), values)
        require_audited(reader.functions)
        found = _elementary(reader, values) + _start(reader, interface) + _step(reader, interface, wanted)
        found += _guards(reader, interface)
    except ReadBackError as error:
        found = [str(error)]
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, RecursionError) as error:
        found = [f"C that an export never has: {error!r}"]
    return Proof(known, tuple(found))


def _start(reader: Reader, interface: Interface) -> list[str]:
    """Differences of the state before the first sample."""
    state = reader.blank(f"{interface.name}_state_t", lambda *_: None)
    reader.call(f"{interface.name}_init", state)
    numbers = iter(interface.start.tolist())
    wanted = [(m.name, row, next(numbers)) for m in interface.state for row in range(m.size)]
    return [
        f"{name}[{row}] starts otherwise"
        for name, row, number in wanted
        if _row(state, name, row) != reader.values.literal(number)
    ]


def _step(reader: Reader, interface: Interface, wanted: dict[str, list[Value]]) -> list[str]:
    """Differences of a step."""
    values, name = reader.values, interface.name
    first = {}
    for member in interface.state:
        first[member.name] = sum(each.size for each in interface.state[: interface.state.index(member)])
    sources = {member.name: member.source for member in interface.inputs}
    state = reader.blank(f"{name}_state_t", lambda m, row: values.new("input", value=("state", first.get(m, 0) + row)))
    seen = reader.blank(f"{name}_inputs_t", lambda m, row: values.new("input", value=(sources.get(m, m), row)))
    given = reader.blank(f"{name}_outputs_t", lambda *_: None)
    reader.call(f"{name}_step", seen, state, given)
    found = []
    rows = [
        (state, m.name, row, wanted["state"][first[m.name] + row]) for m in interface.state for row in range(m.size)
    ]
    rows += [(given, m.name, row, wanted[m.source][row]) for m in interface.outputs for row in range(m.size)]
    for struct, name, row, value in rows:
        own = _row(struct, name, row)
        if own != value:
            said = "nothing" if own is None else values.said(own)
            found.append(f"{name}[{row}] is {said}, must be {values.said(value)}")
    return found


def _guards(reader: Reader, interface: Interface) -> list[str]:
    """Differences of the two questions a flight program may ask."""
    values, found = reader.values, []
    largest = {"usable": (interface.inputs, "inputs", 1e9), "sound": (interface.state, "state", 1.7976931348623157e308)}
    for name, (members, struct_name, limit) in largest.items():
        struct = reader.blank(f"{interface.name}_{struct_name}_t", lambda m, row: values.new("input", value=(m, row)))
        wanted = values.new("flag", value=True)
        for member, row in ((m, row) for m in members for row in range(m.size)):
            size = values.new("abs", values.new("input", value=(member.name, row)))
            wanted = values.new("and", wanted, values.new("le", size, values.literal(limit)))
        if members and reader.call(f"{interface.name}_{name}", struct) != wanted:
            found.append(f"{interface.name}_{name} does not ask for every number")
    return found


def _row(struct: dict[str, Any], member: str, row: int) -> Value | None:
    held = struct[member]
    found: Value | None = held[row] if isinstance(held, list) else held
    return found


def _elementary(reader: Reader, values: Values) -> list[str]:
    """Differences of the functions of the language that C lacks, each against its definition."""
    found = []
    for op, function in _FUNCTIONS.items():
        if f"fdd_{op}" not in reader.functions:
            continue
        names = _ARGUMENTS.get(op, ("x",))
        program = trace(
            lambda f=function, **given: {"value": f.__wrapped__(*given.values())}, **dict.fromkeys(names, 0)
        )
        (wanted,) = of_program(program, values)["value"]
        own = reader.call(f"fdd_{op}", *(values.new("input", value=(name, 0)) for name in names))
        if own != wanted:
            found.append(f"fdd_{op} is {values.said(own)}, must be {values.said(wanted)}")
    return found
