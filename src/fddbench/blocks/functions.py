"""Elementary functions with the same bits everywhere, built from exact operations only.

NumPy and the C library choose their sine and logarithm by processor and vector width, so a flight would differ in the
last bit from one machine to the next. Here each function is a fixed sequence of ``+ - * /``, rounding, selection and
scaling by powers of two, all exact or correctly rounded by IEEE 754. Accuracy: below 1 ulp on the ranges stated, as
measured in the tests against mpmath-grade references.

References
----------
Polynomials and argument reductions: Sun Microsystems (1993), fdlibm 5.3 (k_sin.c, k_cos.c, e_log.c, e_exp.c); arc
tangent by Moshier (1989), Cephes (atan.c).
"""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.primitives import exponent, fraction, named, power_of_two

__all__ = ["asin", "atan2", "cos", "exp", "interpolate", "interpolate_2d", "log", "pow_", "sin"]

_PI_2 = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
_S = (1.58969099521155010221e-10, -2.50507602534068634195e-08, 2.75573137070700676789e-06,
      -1.98412698298579493134e-04, 8.33333333332248946124e-03, -1.66666666666666324348e-01)  # fmt: skip
_C = (-1.13596475577881948265e-11, 2.08757232129817482790e-09, -2.75573143513906633035e-07,
      2.48015872894767294178e-05, -1.38888888888741095749e-03, 4.16666666666666019037e-02)  # fmt: skip
_LN2_HI, _LN2_LO = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_LG = (1.479819860511658591e-01, 1.531383769920937332e-01, 1.818357216161805012e-01, 2.222219843214978396e-01,
       2.857142874366239149e-01, 3.999999999940941908e-01, 6.666666666666735130e-01)  # fmt: skip
_E = (4.13813679705723846039e-08, -1.65339022054652515390e-06, 6.61375632143793436117e-05,
      -2.77777777770155933842e-03, 1.66666666666666019037e-01)  # fmt: skip
_P = (-8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
      -1.228866684490136173410e2, -6.485021904942025371773e1)  # fmt: skip
_Q = (2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
      4.853903996359136964868e2, 1.945506571482613964425e2)  # fmt: skip
_TAN_3PI_8 = 2.41421356237309504880
_MORE_BITS = 6.123233995736765886130e-17


def _horner(coefficients: tuple[float, ...], x: Rows) -> Rows:
    """Polynomial, highest power first."""
    value: Rows = coefficients[0]
    for coefficient in coefficients[1:]:
        value = value * x + coefficient
    return value


def _sine_and_cosine(x: Rows) -> tuple[Rows, Rows, Rows]:
    """Quadrant 0..3 and the sine and cosine of the reduced argument; |x| below 1e5 rad."""
    turns = np.rint(x * (2.0 / np.pi))
    y = ((x - turns * _PI_2[0]) - turns * _PI_2[1]) - turns * _PI_2[2]
    z = y * y
    sine = y + y * z * _horner(_S, z)
    cosine = 1.0 - (0.5 * z - z * z * _horner(_C, z))
    return turns - 4.0 * np.floor(turns * 0.25), sine, cosine


@named
def sin(x: Rows) -> Rows:
    """Sine of an angle [rad], |x| < 1e5; absolute error below 1.5e-16 for |x| < 100.

    >>> float(sin(np.array([0.5]))[0])
    0.479425538604203
    """
    quadrant, sine, cosine = _sine_and_cosine(x)
    value: Rows = np.where((quadrant == 1.0) | (quadrant == 3.0), cosine, sine)
    return np.where(quadrant >= 2.0, -value, value)


@named
def cos(x: Rows) -> Rows:
    """Cosine of an angle [rad], |x| < 1e5; absolute error below 1.5e-16 for |x| < 100."""
    quadrant, sine, cosine = _sine_and_cosine(x)
    value: Rows = np.where((quadrant == 1.0) | (quadrant == 3.0), sine, cosine)
    return np.where((quadrant == 1.0) | (quadrant == 2.0), -value, value)


@named
def log(x: Rows) -> Rows:
    """Natural logarithm of a positive normal number; error below 1 ulp; nan for negative numbers, zero and nan."""
    mantissa = fraction(x)
    small = mantissa < 0.70710678118654752440
    f = np.where(small, 2.0 * mantissa, mantissa) - 1.0
    k = exponent(x) - np.where(small, 1.0, 0.0)
    s = f / (2.0 + f)
    z = s * s
    half_square = 0.5 * f * f
    r = z * _horner(_LG, z)
    value = k * _LN2_HI - ((half_square - (s * (half_square + r) + k * _LN2_LO)) - f)
    return np.where(x > 0.0, np.where(x < np.inf, value, x), np.nan)


@named
def exp(x: Rows) -> Rows:
    """Exponential of a finite number; error below 1 ulp between -700 and 700."""
    k = np.minimum(np.maximum(np.rint(x * 1.44269504088896338700), -2000.0), 2000.0)
    high, low = x - k * _LN2_HI, k * _LN2_LO
    r = high - low
    t = r * r
    c = r - t * _horner(_E, t)
    half = np.floor(0.5 * k)  # in two steps, because 2^k alone may be out of range
    return (1.0 - ((low - (r * c) / (2.0 - c)) - high)) * power_of_two(half) * power_of_two(k - half)


@named
def pow_(x: Rows, y: float) -> Rows:
    """Positive number to a constant power, ``exp(y log x)``; relative error below ``(1 + |y log x|) 2.2e-16``."""
    return exp(y * log(x))


def _atan_positive(x: Rows) -> Rows:
    """Arc tangent of a non-negative number [rad]; error below 1 ulp."""
    large: Rows = x > _TAN_3PI_8
    middle: Rows = x > 0.66
    reduced = np.where(large, -1.0 / np.where(large, x, 1.0), np.where(middle, (x - 1.0) / (x + 1.0), x))
    base = np.where(large, np.pi / 2.0, np.where(middle, np.pi / 4.0, 0.0))
    more = np.where(large, _MORE_BITS, np.where(middle, 0.5 * _MORE_BITS, 0.0))
    z = reduced * reduced
    value = reduced * (z * _horner(_P, z) / _horner((1.0, *_Q), z)) + reduced
    return base + (value + more)


@named
def atan2(y: Rows, x: Rows) -> Rows:
    """Angle of the point (x, y) [rad], between -pi and pi; 0 at the origin; error below 2 ulp."""
    ay, ax = np.abs(y), np.abs(x)
    steep = ay > ax
    small: Rows = np.where(steep, ax, ay)
    large: Rows = np.where(steep, ay, ax)
    angle = _atan_positive(small / np.where(large > 0.0, large, 1.0))
    angle = np.where(steep, np.pi / 2.0 - angle, angle)
    angle = np.where(x < 0.0, np.pi - angle, angle)
    return np.where(y < 0.0, -angle, angle)


@named
def asin(x: Rows) -> Rows:
    """Arc sine [rad] of a number between -1 and 1; error below 3 ulp."""
    return atan2(x, np.sqrt((1.0 - x) * (1.0 + x)))


def interpolate(x: Rows, knots: Rows, values: Rows) -> Rows:
    """Piecewise linear look-up, (n_cases,), held constant outside the table.

    Parameters
    ----------
    x : (n_cases,) array
        Where to look.
    knots, values : (n_knots, n_cases) arrays
        Breakpoints in rising order and the values there; a repeated breakpoint is a step, taken at its later value.
    """
    left, value, width, rise = knots[0], values[0], np.ones_like(values[0]), np.zeros_like(values[0])
    for j in range(1, len(knots)):
        beyond = x >= knots[j - 1]
        left = np.where(beyond, knots[j - 1], left)
        value = np.where(beyond, values[j - 1], value)
        width = np.where(beyond, knots[j] - knots[j - 1], width)
        rise = np.where(beyond, values[j] - values[j - 1], rise)
    inside = value + np.minimum((x - left) / np.where(width > 0.0, width, 1.0), 1.0) * rise
    return np.where(x >= knots[-1], values[-1], np.where(x >= knots[0], inside, values[0]))


def interpolate_2d(x: Rows, y: Rows, x_knots: Rows, y_knots: Rows, values: Rows) -> Rows:
    """Bilinear look-up, (n_cases,), held constant outside the table.

    Parameters
    ----------
    x, y : (n_cases,) arrays
        Where to look.
    x_knots, y_knots : (n_x, n_cases or 1) and (n_y, n_cases or 1) arrays
        Breakpoints in rising order.
    values : (n_x, n_y, n_cases or 1) array
        Values there.
    """
    return interpolate(x, x_knots, np.stack([interpolate(y, y_knots, row) for row in values]))
