"""The primitives as they must stand, word by word: those that look at the bits of a number are read by people.

Each was compared with NumPy on special values; a function that differs from this page is refused.
"""

from typing import Any

from fddbench.testing.read_back.parsed import ReadBackError, functions_of, parsed

__all__ = ["PRIMITIVES", "require_audited"]

_PAGE = """
static uint64_t fdd_bits(double a)
{ uint64_t bits = 0U; (void)memcpy((void *)&bits, (const void *)&a, sizeof(bits)); return bits; }
static double fdd_from_bits(uint64_t bits)
{ double a = 0.0; (void)memcpy((void *)&a, (const void *)&bits, sizeof(a)); return a; }
static double fdd_min(double a, double b) { return ((a < b) || (a != a)) ? a : b; }
static double fdd_max(double a, double b) { return ((a > b) || (a != a)) ? a : b; }
static double fdd_fraction(double a)
{ return fdd_from_bits((fdd_bits(a) & 0x800FFFFFFFFFFFFFULL) | 0x3FE0000000000000ULL); }
static double fdd_exponent(double a)
{ uint32_t biased = (uint32_t)((fdd_bits(a) >> 52U) & 0x7FFU); return (double)biased - 1022.0; }
static double fdd_power_of_two(double a) { return fdd_from_bits(fdd_bits(a + 6755399441056767.0) << 52U); }
static uint32_t fdd_index(double place, uint32_t n)
{
    double last = (double)n - 1.0;
    double inside = (place > 0.0) ? place : 0.0;
    return (uint32_t)((inside < last) ? inside : last);
}
static double fdd_gather(const double table[], uint32_t n, double place) { return table[fdd_index(place, n)]; }
static double fdd_locate(const double knots[], uint32_t n, double a)
{
    double count = 0.0;
    uint32_t i;
    for (i = 0U; i < n; i++) { count = count + ((knots[i] <= a) ? 1.0 : 0.0); }
    return count;
}
static double fdd_pick(const double rows[], uint32_t n, double index)
{
    double chosen = rows[0];
    uint32_t i;
    for (i = 1U; i < n; i++) { chosen = (index >= (double)i) ? rows[i] : chosen; }
    return chosen;
}
"""

PRIMITIVES = frozenset({"min", "max", "fraction", "exponent", "power_of_two", "gather", "locate", "pick"})
"""Operations that are functions of the page."""


def require_audited(functions: dict[str, Any]) -> None:
    """Refuse primitives that do not stand as on the page.

    Raises
    ------
    ReadBackError
        Which one differs.
    """
    page = functions_of(parsed(_PAGE))
    for name, function in functions.items():
        if name in page and _tree(function) != _tree(page[name]):
            raise ReadBackError(f"{name} is not the primitive that was compared with NumPy")


def _tree(node: Any) -> Any:
    """A tree as nested tuples, without places in the file."""
    own = tuple(getattr(node, name) for name in node.attr_names)
    return type(node).__name__, own, tuple((name, _tree(child)) for name, child in node.children())
