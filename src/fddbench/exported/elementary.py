"""Sine and its kin as functions of C; a reader that shares no code with this file compares them with `blocks.functions`.

Each does what the function of the same name there does, operation by operation; so the bits are the same.
"""

import re
from collections.abc import Iterable

from fddbench.exported.spelling import Spelling

__all__ = ["USES", "elementary"]

USES = {
    "sin": {"rint", "floor", "quadrant"}, "cos": {"rint", "floor", "quadrant"}, "exp": {"min", "max", "power_of_two"},
    "log": {"fraction", "exponent", "from_bits"}, "pow": {"exp", "log"}, "asin": {"atan2"}, "atan2": set[str](),
}  # fmt: skip
"""Operations inside each."""

_IN_SINGLE = {
    "{1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21}":
        "{1.5703125, 4.837512969970703125e-4, 7.54978995489188216e-8}",
    "LN2_HIGH = 6.93147180369123816490e-01": "LN2_HIGH = 0.693359375",
    "LN2_LOW = 1.90821492927058770002e-10": "LN2_LOW = -2.12194440e-4",
    "fdd_min(2000.0, fdd_max(-2000.0,": "fdd_min(250.0, fdd_max(-250.0,",
    "below 1e5": "below 8e3",
    "k_sin.c and k_cos.c.": "k_sin.c and k_cos.c; parts of the right angle: Moshier, Cephes, sinf.c.",
    "e_log.c.": "e_log.c; parts of ln 2: Moshier, Cephes, logf.c.",
    "e_exp.c.": "e_exp.c; parts of ln 2: Moshier, Cephes, expf.c.",
}  # fmt: skip
"""What single precision needs instead: parts so short that multiples are exact, halves of 2^k within a float's range."""

_TEXTS = {
    "quadrant": """
/* Sine and cosine of an angle [rad] less the nearest multiple of a right angle, and which quadrant it lies in, 0 to 3.
 * Polynomials and reduction: Sun Microsystems, fdlibm 5.3, k_sin.c and k_cos.c. */
static double fdd_quadrant(double x, double *sine, double *cosine)
{
    /* a right angle [rad] in three parts, so that whole multiples of the first are exact */
    static const double RIGHT_ANGLE[3] = {1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21};
    static const double S[6] = {
        1.58969099521155010221e-10, -2.50507602534068634195e-08, 2.75573137070700676789e-06,
        -1.98412698298579493134e-04, 8.33333333332248946124e-03, -1.66666666666666324348e-01
    };
    static const double C[6] = {
        -1.13596475577881948265e-11, 2.08757232129817482790e-09, -2.75573143513906633035e-07,
        2.48015872894767294178e-05, -1.38888888888741095749e-03, 4.16666666666666019037e-02
    };
    const double turns = nearbyint(x * 0.6366197723675814);
    const double y = ((x - (turns * RIGHT_ANGLE[0U])) - (turns * RIGHT_ANGLE[1U])) - (turns * RIGHT_ANGLE[2U]);
    const double z = y * y;
    const double p = (((((((((S[0U] * z) + S[1U]) * z) + S[2U]) * z) + S[3U]) * z) + S[4U]) * z) + S[5U];
    const double q = (((((((((C[0U] * z) + C[1U]) * z) + C[2U]) * z) + C[3U]) * z) + C[4U]) * z) + C[5U];
    *sine = y + ((y * z) * p);
    *cosine = 1.0 - ((0.5 * z) - ((z * z) * q));
    return turns - (4.0 * floor(turns * 0.25));
}
""",
    "sin": """
/* Sine of an angle [rad] below 1e5. */
static double fdd_sin(double x)
{
    double sine;
    double cosine;
    const double quadrant = fdd_quadrant(x, &sine, &cosine);
    const double value = ((quadrant == 1.0) || (quadrant == 3.0)) ? cosine : sine;
    return (quadrant >= 2.0) ? (-value) : value;
}
""",
    "cos": """
/* Cosine of an angle [rad] below 1e5. */
static double fdd_cos(double x)
{
    double sine;
    double cosine;
    const double quadrant = fdd_quadrant(x, &sine, &cosine);
    const double value = ((quadrant == 1.0) || (quadrant == 3.0)) ? sine : cosine;
    return ((quadrant == 1.0) || (quadrant == 2.0)) ? (-value) : value;
}
""",
    "log": """
/* Natural logarithm of a positive normal number; not-a-number for others. Polynomial: fdlibm 5.3, e_log.c. */
static double fdd_log(double x)
{
    static const double LN2_HIGH = 6.93147180369123816490e-01;
    static const double LN2_LOW = 1.90821492927058770002e-10;
    static const double G[7] = {
        1.479819860511658591e-01, 1.531383769920937332e-01, 1.818357216161805012e-01, 2.222219843214978396e-01,
        2.857142874366239149e-01, 3.999999999940941908e-01, 6.666666666666735130e-01
    };
    const double mantissa = fdd_fraction(x);
    const bool small = mantissa < 0.70710678118654752440;
    const double twice = 2.0 * mantissa;
    const double f = (small ? twice : mantissa) - 1.0;
    const double k = fdd_exponent(x) - (small ? 1.0 : 0.0);
    const double s = f / (2.0 + f);
    const double z = s * s;
    const double half_square = (0.5 * f) * f;
    const double p = (((((((((((G[0U] * z) + G[1U]) * z) + G[2U]) * z) + G[3U]) * z) + G[4U]) * z) + G[5U]) * z) + G[6U];
    const double r = z * p;
    const double value = (k * LN2_HIGH) - ((half_square - ((s * (half_square + r)) + (k * LN2_LOW))) - f);
    return (x > 0.0) ? ((x < fdd_from_bits(@INFINITY@)) ? value : x) : fdd_from_bits(@NAN@);
}
""",
    "exp": """
/* Exponential of a finite number. Polynomial: fdlibm 5.3, e_exp.c. */
static double fdd_exp(double x)
{
    static const double LN2_HIGH = 6.93147180369123816490e-01;
    static const double LN2_LOW = 1.90821492927058770002e-10;
    static const double E[5] = {
        4.13813679705723846039e-08, -1.65339022054652515390e-06, 6.61375632143793436117e-05,
        -2.77777777770155933842e-03, 1.66666666666666019037e-01
    };
    const double k = fdd_min(2000.0, fdd_max(-2000.0, nearbyint(x * 1.44269504088896338700)));
    const double high = x - (k * LN2_HIGH);
    const double low = k * LN2_LOW;
    const double r = high - low;
    const double t = r * r;
    const double c = r - (t * ((((((((E[0U] * t) + E[1U]) * t) + E[2U]) * t) + E[3U]) * t) + E[4U]));
    const double half = floor(0.5 * k); /* in two steps, because 2^k alone may be out of range */
    return ((1.0 - ((low - ((r * c) / (2.0 - c))) - high)) * fdd_power_of_two(half)) * fdd_power_of_two(k - half);
}
""",
    "pow": """
/* Positive number to a power. */
static double fdd_pow(double x, double y)
{
    return fdd_exp(y * fdd_log(x));
}
""",
    "atan2": """
/* Angle of the point (x, y) [rad], between -pi and pi, 0 at the origin. Polynomials: Moshier, Cephes, atan.c. */
static double fdd_atan2(double y, double x)
{
    static const double P[5] = {
        -8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
        -1.228866684490136173410e2, -6.485021904942025371773e1
    };
    static const double Q[5] = {
        2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
        4.853903996359136964868e2, 1.945506571482613964425e2
    };
    const double ay = fabs(y);
    const double ax = fabs(x);
    const bool steep = ay > ax;
    const double less = steep ? ax : ay;
    const double more = steep ? ay : ax;
    const double t = less / ((more > 0.0) ? more : 1.0);
    const bool large = t > 2.41421356237309504880;
    const bool middle = t > 0.66;
    const double reduced = large ? (-1.0 / (large ? t : 1.0)) : (middle ? ((t - 1.0) / (t + 1.0)) : t);
    const double base = large ? 1.5707963267948966 : (middle ? 0.7853981633974483 : 0.0);
    const double bits = large ? 6.123233995736765886130e-17 : (middle ? 3.061616997868383e-17 : 0.0);
    const double z = reduced * reduced;
    const double p = (((((((P[0U] * z) + P[1U]) * z) + P[2U]) * z) + P[3U]) * z) + P[4U];
    const double q = ((((((((z + Q[0U]) * z) + Q[1U]) * z) + Q[2U]) * z) + Q[3U]) * z) + Q[4U];
    const double flat = base + (((reduced * ((z * p) / q)) + reduced) + bits);
    const double right = steep ? (1.5707963267948966 - flat) : flat;
    const double above = (x < 0.0) ? (3.141592653589793 - right) : right;
    return (y < 0.0) ? (-above) : above;
}
""",
    "asin": """
/* Arc sine [rad] of a number between -1 and 1. */
static double fdd_asin(double x)
{
    return fdd_atan2(x, sqrt((1.0 - x) * (1.0 + x)));
}
""",
}


def elementary(used: Iterable[str], spelling: Spelling) -> list[str]:
    """Text of the functions behind some operations, those inside them included, in the order in which they must stand."""
    needed = with_those_inside(used)
    return [_spelt(text, spelling).strip("\n") for op, text in _TEXTS.items() if op in needed]


def with_those_inside(used: Iterable[str]) -> set[str]:
    """Operations, and those that their functions need."""
    left, found = list(used), set[str]()
    while left:
        op = left.pop()
        if op not in found:
            found.add(op)
            left += USES.get(op, ())
    return found


def _spelt(text: str, spelling: Spelling) -> str:
    single = bool(spelling.suffix)
    text = text.replace("@INFINITY@", "0x7F800000U" if single else "0x7FF0000000000000ULL")
    text = text.replace("@NAN@", "0x7FC00000U" if single else "0x7FF8000000000000ULL")
    if not single:
        return text
    for double, own in _IN_SINGLE.items():
        text = text.replace(double, own)
    text = re.sub(r"(?<![\w.])(\d+\.\d+(?:e[-+]?\d+)?)(?![\w.])", r"\1f", text).replace("double", spelling.real)
    return re.sub(r"\b(fabs|sqrt|floor|nearbyint)\(", r"\1f(", text)
