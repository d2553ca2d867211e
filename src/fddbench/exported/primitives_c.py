"""The primitives that C does not have, written by hand; the tests compare each with NumPy on special values."""

from collections.abc import Iterable

from fddbench.exported.spelling import Spelling

__all__ = ["primitives"]

_NEEDS = {
    "fraction": ("bits", "from_bits"), "exponent": ("bits",), "power_of_two": ("bits", "from_bits"), "gather": ("index",),
}  # fmt: skip
_TEXTS = {
    "bits": """
/* Bits of a number. */
static {word} fdd_bits({real} a)
{{
    {word} bits = 0U;
    (void)memcpy((void *)&bits, (const void *)&a, sizeof(bits));
    return bits;
}}
""",
    "from_bits": """
/* Number of some bits. */
static {real} fdd_from_bits({word} bits)
{{
    {real} a = {zero};
    (void)memcpy((void *)&a, (const void *)&bits, sizeof(a));
    return a;
}}
""",
    "min": """
/* Smaller of two numbers; not-a-number where either is. */
static {real} fdd_min({real} a, {real} b)
{{
    return ((a < b) || (a != a)) ? a : b;
}}
""",
    "max": """
/* Larger of two numbers; not-a-number where either is. */
static {real} fdd_max({real} a, {real} b)
{{
    return ((a > b) || (a != a)) ? a : b;
}}
""",
    "fraction": """
/* Significand of a normal number with its sign, 0.5 to 1. */
static {real} fdd_fraction({real} a)
{{
    return fdd_from_bits((fdd_bits(a) & {keep}) | {half});
}}
""",
    "exponent": """
/* Power of two that belongs to the significand of a normal number. */
static {real} fdd_exponent({real} a)
{{
    uint32_t biased = (uint32_t)((fdd_bits(a) >> {digits}U) & {most}U);
    return ({real})biased - {bias};
}}
""",
    "power_of_two": """
/* Two to a whole power within the range of normal numbers: the sum leaves it in the low bits. */
static {real} fdd_power_of_two({real} a)
{{
    return fdd_from_bits(fdd_bits(a + {magic}) << {digits}U);
}}
""",
    "index": """
/* Place in a table of n entries: the nearest one outside, the first one for not-a-number. */
static uint32_t fdd_index({real} place, uint32_t n)
{{
    {real} last = ({real})n - {one};
    {real} inside = (place > {zero}) ? place : {zero};
    return (uint32_t)((inside < last) ? inside : last);
}}
""",
    "gather": """
/* Entry of a table of n numbers. */
static {real} fdd_gather(const {real} table[], uint32_t n, {real} place)
{{
    return table[fdd_index(place, n)];
}}
""",
    "locate": """
/* How many of n rising knots lie at or below a; all are looked at, so that every path is the longest. */
static {real} fdd_locate(const {real} knots[], uint32_t n, {real} a)
{{
    {real} count = {zero};
    uint32_t i;
    for (i = 0U; i < n; i++)
    {{
        count = count + ((knots[i] <= a) ? {one} : {zero});
    }}
    return count;
}}
""",
    "pick": """
/* Row number `index` of n rows, the first or the last one outside; all are looked at. */
static {real} fdd_pick(const {real} rows[], uint32_t n, {real} index)
{{
    {real} chosen = rows[0];
    uint32_t i;
    for (i = 1U; i < n; i++)
    {{
        chosen = (index >= ({real})i) ? rows[i] : chosen;
    }}
    return chosen;
}}
""",
}
_DOUBLE = {
    "word": "uint64_t", "keep": "0x800FFFFFFFFFFFFFULL", "half": "0x3FE0000000000000ULL", "digits": "52",
    "most": "0x7FF", "bias": "1022.0", "magic": "6755399441056767.0", "zero": "0.0", "one": "1.0",
}  # fmt: skip
_SINGLE = {
    "word": "uint32_t", "keep": "0x807FFFFFU", "half": "0x3F000000U", "digits": "23",
    "most": "0xFF", "bias": "126.0f", "magic": "12583039.0f", "zero": "0.0f", "one": "1.0f",
}  # fmt: skip


def primitives(used: Iterable[str], spelling: Spelling) -> list[str]:
    """Text of the functions behind some operations, in the order in which they must stand."""
    needed = set(used)
    for op in tuple(needed):
        needed.update(_NEEDS.get(op, ()))
    words = {"real": spelling.real, **(_SINGLE if spelling.suffix else _DOUBLE)}
    return [text.format(**words).strip("\n") for op, text in _TEXTS.items() if op in needed]
