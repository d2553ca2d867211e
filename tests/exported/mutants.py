"""Faults planted in C: a sign, a comparison, a number, an index, a name or a statement is another one."""

import random
import re

_SIGNS = {"+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
_SIGN = re.compile(r" (\+|-|\*|/|<|<=|==|!=|&&|\|\|) ")
_FIGURE = re.compile(r"(?<![\w.\[])\d+\.\d+(?:e-?\d+)?(?![\w.])")
_INDEX = re.compile(r"\[(\d+)U\]")
_MEMBER = re.compile(r"\b(s|x|in)->(\w+)")
_CALL = re.compile(r"\b(fdd_max|fdd_min|fabs|sqrt)\(")


def mutants(source, number, seed=0):
    """So many different faulty texts, each with what was done; only in statements, and none that computes the same."""
    draw = random.Random(seed)
    body = source.index("static void ")
    head, text = source[:body], source[body:]
    spots = [spot for spot in _spots(text) if not _in_comment(text, spot[0]) and not _in_table(text, spot[0])]
    draw.shuffle(spots)
    for at, end, new in spots[:number]:
        line = text.count("\n", 0, at) + head.count("\n") + 1
        yield f"line {line}: {text[at:end]!r} became {new!r}", head + text[:at] + new + text[end:]


def _spots(text):
    for found in _SIGN.finditer(text):
        yield found.start(1), found.end(1), _SIGNS[found[1]]
    for found in _FIGURE.finditer(text):
        yield *found.span(), repr(float(found[0]) + 1.0)
    for found in _INDEX.finditer(text):
        yield *found.span(), f"[{int(found[1]) + 1}U]"
    for found in _CALL.finditer(text):
        yield (
            found.start(1),
            found.end(1),
            {"fdd_max": "fdd_min", "fdd_min": "fdd_max", "fabs": "sqrt", "sqrt": "fabs"}[found[1]],
        )
    members = sorted({found[0] for found in _MEMBER.finditer(text)})
    for found in _MEMBER.finditer(text):
        others = [other for other in members if other != found[0] and other.split("->")[0] == found[1]]
        if others:
            yield *found.span(), others[len(found[0]) % len(others)]
    for found in re.finditer(r"^    \S+ = [^;]+;\n", text, flags=re.MULTILINE):
        yield *found.span(), ""


def _in_comment(text, at):
    return text.rfind("/*", 0, at) > text.rfind("*/", 0, at)


def _in_table(text, at):
    """In a constant table, not every entry of which is used, or in the length of a declared array."""
    statement = text[max(text.rfind(";", 0, at), text.rfind("{\n", 0, at)) + 1 : at]
    start = text.rfind("static const", 0, at)
    return (start >= 0 and ";" not in text[start:at]) or re.match(r"\s*(double|bool) \w+$", statement) is not None
