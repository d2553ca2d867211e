"""Linear algebra in rational numbers, without rounding and without a line of the package: lists of rows of Fractions."""

from fractions import Fraction


def rational(M):
    return [[Fraction(int(value)) for value in row] for row in M]


def product(A, B):
    return [
        [sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in zip(*B, strict=True)]
        for row in A
    ]


def transposed(A):
    return [list(column) for column in zip(*A, strict=True)]


def reduced(rows):
    """Reduced echelon form without zero rows, and its pivot columns."""
    rows, pivots = [list(row) for row in rows], []
    width = len(rows[0]) if rows else 0
    for column in range(width):
        k = len(pivots)
        found = next((i for i in range(k, len(rows)) if rows[i][column]), None)
        if found is None:
            continue
        rows[k], rows[found] = rows[found], rows[k]
        rows[k] = [value / rows[k][column] for value in rows[k]]
        rows = [
            row if i == k else [a - row[column] * b for a, b in zip(row, rows[k], strict=True)]
            for i, row in enumerate(rows)
        ]
        pivots.append(column)
    return rows[: len(pivots)], pivots


def null_rows(rows, width):
    """Basis of all x with ``rows x = 0``, as rows."""
    basis, pivots = reduced(rows) if rows else ([], [])
    found = []
    for free in (column for column in range(width) if column not in pivots):
        x = [Fraction(0)] * width
        x[free] = Fraction(1)
        for row, pivot in zip(basis, pivots, strict=True):
            x[pivot] = -row[free]
        found.append(x)
    return found
