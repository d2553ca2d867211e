"""Numbers that have a name in the design become constants of the file; the others stand where they are used."""

from collections.abc import Sequence

from fddbench.blocks.table import Table
from fddbench.exported.members import Constant, Members
from fddbench.exported.naming import Names, identifier
from fddbench.exported.spelling import Spelling
from fddbench.exported.statements import Statement
from fddbench.units import unit_of_name

__all__ = ["Constants"]

_COLUMNS = 100


class Constants:
    """Constants of a file, those that somebody uses.

    Parameters
    ----------
    members : Members
        Numbers of the detector by name.
    names : Names
        Identifiers of the file.
    spelling : Spelling
        Precision.
    """

    def __init__(self, members: Members, names: Names, spelling: Spelling) -> None:
        self.members, self.names, self.spelling = members, names, spelling
        self._used: dict[str, tuple[str, Constant]] = {}
        self._tables: dict[Table, str] = {}
        self._after: dict[object, int] = {}
        self._known: dict[float, str] = {}

    def text(self, value: float, statement: Statement, beside: Sequence[float] = ()) -> str:
        """How a statement writes a number: by its name where the author named it, else in figures.

        Parameters
        ----------
        beside : sequence of float
            Numbers that the same operation of the statement takes: of several constants that have the number the one that has
            all of them is meant; where none or two have, the number stands in figures, for nobody knows whose it is.
        """
        if not statement.place and value in self._known:
            return self._known[value]
        constant = self._meant(list(self.members.named(value, statement.words, statement.filename)), beside)
        if constant is None:
            return f"({self.spelling.number(value)})" if str(value).startswith("-") else self.spelling.number(value)
        at = (statement, constant.path, tuple(beside))
        place = constant.place_of(value, self._after.get(at, -1)) or 0
        self._after[at] = place
        name, known = self._used.get(constant.path, ("", None))
        if known is None:
            name = self._same(constant) or self.names.new(_capital(constant.name))
            self._used[constant.path] = name, constant
        self._known[value] = name + _subscripts(place, constant.values.shape)
        return self._known[value]

    @staticmethod
    def _meant(found: Sequence[Constant], beside: Sequence[float]) -> Constant | None:
        """The one of some constants that a statement means; None where that cannot be told."""
        different = list(
            {(each.name, each.values.shape, each.values.tobytes()): each for each in reversed(found)}.values()
        )
        if len(different) > 1:
            different = [each for each in different if all(each.place_of(other) is not None for other in beside)]
        return different[0] if len(different) == 1 else None

    def table(self, table: Table) -> str:
        """Name of a look-up table."""
        if table not in self._tables:
            parts = [part for part in self.members.tables.get(table, "table").split(".") if not part.isdigit()]
            self._tables[table] = self.names.new(_capital("_".join(parts[-2:])))
        return self._tables[table]

    def _same(self, constant: Constant) -> str:
        """Name of a constant with the same name and numbers that another part of the detector has as well."""
        for name, other in self._used.values():
            same = other.name == constant.name and other.values.shape == constant.values.shape
            if same and other.values.tobytes() == constant.values.tobytes():
                return name
        return ""

    def definitions(self) -> dict[str, list[str]]:
        """Lines of each constant by its name, a comment first; with its unit where its name tells it."""
        real, found = self.spelling.real, dict[str, list[str]]()
        for name, constant in self._used.values():
            unit = "1/s" if constant.name.endswith("_1_s") else unit_of_name(constant.name)
            shape = "".join(f"[{n}]" for n in constant.values.shape)
            text = f"static const {real} {name}{shape} = {self._numbers(constant.values.tolist(), '')};"
            found.setdefault(
                name, [f"/* {constant.path.rsplit('/', 1)[-1]}{f' [{unit}]' if unit else ''} */", *text.split("\n")]
            )
        for table, name in self._tables.items():
            text = f"static const {real} {name}[{len(table)}] = {self._numbers(table.values.tolist(), '')};"
            found[name] = [f"/* {self.members.tables.get(table, 'table')} */", *text.split("\n")]
        return found

    def _numbers(self, values: object, indent: str) -> str:
        if not isinstance(values, list):
            return self.spelling.number(float(values))  # type: ignore[arg-type]
        inner = indent + "    "
        if values and isinstance(values[0], list):
            rows = ",\n".join(f"{inner}{self._numbers(row, inner)}" for row in values)
            return f"{{\n{rows}\n{indent}}}"
        flat = [self.spelling.number(value) for value in values]
        if len(indent) + sum(map(len, flat)) + 2 * len(flat) <= _COLUMNS - 30:
            return f"{{{', '.join(flat)}}}"
        return "{\n" + ",\n".join(inner + ", ".join(flat[k : k + 4]) for k in range(0, len(flat), 4)) + f"\n{indent}}}"


def _capital(name: str) -> str:
    return identifier(name).upper()


def _subscripts(place: int, shape: tuple[int, ...]) -> str:
    text = ""
    for n in reversed(shape):
        place, own = divmod(place, n)
        text = f"[{own}U]{text}"
    return text
