"""Identifiers of C: from the names of Python, each once, none that the language has taken."""

import re
import unicodedata

__all__ = ["Names", "identifier", "spoken", "words_of_class"]

_LANGUAGE = (
    "auto bool break case char const continue default do double else enum extern false float for goto if inline int long",
    "register restrict return short signed sizeof static struct switch true typedef union unsigned void volatile while asm",
)
_OTHERS = (
    "i in x s out main memcpy sqrt fabs floor nearbyint sin cos tan exp log pow atan asin acos atan2 y0 y1 yn j0 j1 jn",
    "gamma signal index div abs time exp2 log2 fmin fmax fma rint round trunc hypot remainder",
)
_TAKEN = frozenset(word for line in (*_LANGUAGE, *_OTHERS) for word in line.split(" "))

OPERATION_WORDS = {
    "add": "sum", "sub": "difference", "mul": "product", "div": "ratio", "neg": "negated", "abs": "size", "sqrt": "root",
    "min": "smaller", "max": "larger", "floor": "floor", "rint": "whole", "lt": "below", "le": "not_above", "eq": "equal",
    "ne": "unlike", "and": "both", "or": "either", "not": "opposite", "select": "chosen", "number": "mark",
    "fraction": "fraction", "exponent": "exponent", "power_of_two": "power", "pick": "picked", "locate": "interval",
    "gather": "entry", "sin": "sine", "cos": "cosine", "exp": "exponential", "log": "logarithm", "pow": "power",
    "atan2": "angle", "asin": "angle", "row": "row",
}  # fmt: skip
"""What a step inside a statement is called, where only the whole has a name."""


def identifier(name: str) -> str:
    """A name as an identifier of C; ASCII only.

    >>> identifier("observer.x"), identifier("3rd"), identifier("ρ_mass")
    ('observer_x', 'n3rd', 'rho_mass')
    """
    spelt = "".join(c if c.isascii() else unicodedata.name(c, "").split(" ")[-1].lower() for c in name)
    plain = re.sub(r"\W+", "_", spelt).strip("_") or "value"
    return f"n{plain}" if plain[0].isdigit() else plain


def spoken(name: str) -> str:
    """The name of a class in words.

    >>> spoken("AdaptiveThreshold")
    'Adaptive threshold'
    """
    return words_of_class(name).replace("_", " ").capitalize()


def words_of_class(name: str) -> str:
    """The name of a class in small letters.

    >>> words_of_class("DiscreteLti"), words_of_class("GLRTest")
    ('discrete_lti', 'glr_test')
    """
    return identifier(re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower())


class Names:
    """Gives each name once; the second of a name is ``name_2``.

    >>> names = Names()
    >>> names.new("rate"), names.new("rate"), names.new("sqrt")
    ('rate', 'rate_2', 'sqrt_of')
    """

    def __init__(self) -> None:
        self.given: frozenset[str] = frozenset()

    def new(self, wanted: str) -> str:
        """An identifier near the one that is wanted."""
        base = identifier(wanted)
        if base.lower() in _TAKEN:
            base += "_of"
        name, number = base, 1
        while name.lower() in self.given:
            number += 1
            name = f"{base}_{number}"
        self.given |= {name.lower()}
        return name
