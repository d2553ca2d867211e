"""Which columns and rows are read: names, and conditions as a list of (column, operator, value)."""

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import ResultsError, did_you_mean

__all__ = ["Condition", "Filter", "filter_of", "listed", "require_columns"]

Condition = tuple[str, str, Any]

_COMPARISONS: Mapping[str, Callable[[Any, Any], Any]] = {
    "=": operator.eq,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_OPERATORS = (*_COMPARISONS, "in", "not in")


@dataclass(frozen=True)
class Filter:
    """Conditions that rows meet, all of them.

    Attributes
    ----------
    names : tuple of str
        Columns that they are about, ``case`` perhaps among them.
    expression : pyarrow.compute.Expression
        The conditions.
    """

    names: tuple[str, ...]
    expression: Any

    def rows_of(self, table: pa.Table) -> pa.Table:
        """Rows of a table that meet the conditions.

        Raises
        ------
        ResultsError
            A value is of another type than its column.
        """
        try:
            return table.filter(self.expression)
        except (pa.ArrowException, TypeError) as error:
            types = ", ".join(f"{name} is {table.schema.field(name).type}" for name in self.names)
            raise ResultsError(f"filters: a value does not compare with its column ({types}): {error}") from error


def require_columns(columns: Sequence[str], known: Sequence[str]) -> None:
    """Refuse names that are none of the columns that there are.

    Raises
    ------
    ResultsError
        All of them are named, with what they may have meant.
    """
    if isinstance(columns, str):
        raise ResultsError(f"columns are a list of names, [{columns!r}]; got {columns!r}")
    strange = [name for name in columns if name not in known]
    if strange:
        told = [" ".join(filter(None, [repr(name) + ".", did_you_mean(str(name), known)])) for name in strange]
        raise ResultsError(f"the rows have no column {' And no '.join(told)} Known: {', '.join(known)}")


def filter_of(conditions: Sequence[Condition] | None, known: Sequence[str]) -> Filter | None:
    """Filter of conditions on columns of a folder; None for no condition.

    Parameters
    ----------
    conditions : sequence of (column, operator, value)
        Operators are ``= == != < <= > >= in``, ``not in``; a null meets none of them but ``("detection_time_s", "=", None)``.
    known : sequence of str
        Columns that there are.

    Raises
    ------
    ResultsError
        A condition is none, or about no column.
    """
    if conditions is None:
        return None
    wrong, parts, names = list[str](), [], list[str]()
    for number, condition in enumerate(listed(conditions), start=1):
        reason = _wrong(condition, known)
        if not reason:
            try:
                parts.append(_expression(*condition))
                names.append(condition[0])
            except (pa.ArrowException, TypeError, ValueError) as error:
                reason = f"{condition[0]} {condition[1]} {condition[2]!r} compares with no column ({error})"
        if reason:
            wrong.append(f"filters, condition {number}: {reason}")
    if wrong:
        raise ResultsError("\n".join(wrong))
    return Filter(tuple(dict.fromkeys(names)), reduce(operator.and_, parts)) if parts else None


def listed(conditions: Any) -> Sequence[Any]:
    """Conditions as a list, of one alone too.

    Raises
    ------
    ResultsError
        They are no list.
    """
    if isinstance(conditions, (str, bytes)) or not isinstance(conditions, Sequence):
        raise ResultsError(f'filters are a list of (column, operator, value), [("run", "<", 10)]; got {conditions!r}')
    return [conditions] if _is_condition(conditions) else conditions


def _is_condition(given: Any) -> bool:
    return isinstance(given, tuple) and len(given) == 3 and all(isinstance(part, str) for part in given[:2])


def _wrong(given: Any, known: Sequence[str]) -> str:
    """What is wrong with a condition, "" for nothing."""
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != 3:
        return f'need (column, operator, value), ("run", "<", 10); got {given!r}'
    name, how, value = given
    if name not in known:
        hint = did_you_mean(str(name), known)
        return " ".join(filter(None, [f"the rows have no column {name!r}.", hint, f"Known: {', '.join(known)}"]))
    if how not in _OPERATORS:
        return f"no operator {how!r}; known: {', '.join(_OPERATORS)}"
    if how in ("in", "not in") and (isinstance(value, str) or not _is_collection(value)):
        return f"{name} {how} needs a list of values, got {value!r}"
    if isinstance(value, float) and value != value:
        return f"{name} {how} nan: no column holds it; what is not there is None"
    if value is None and how not in ("=", "==", "!="):
        return f"{name} {how} None: null is compared with = and != alone"
    return ""


def _is_collection(value: Any) -> bool:
    return isinstance(value, (list, tuple, set, frozenset, range))


def _expression(name: str, how: str, value: Any) -> Any:
    column = pc.field(name)
    if how in ("in", "not in"):
        listed = column.isin(list(value)) if value else pc.scalar(False)
        return listed if how == "in" else column.is_valid() & ~listed
    if value is None:
        return column.is_valid() if how == "!=" else column.is_null()
    return _COMPARISONS[how](column, value)
