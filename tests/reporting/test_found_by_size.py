"""A detection curve in words: a number where there is one, and none that nobody has flown near."""

import pytest

from fddbench.metrics.detection_curve import DetectionCurve
from fddbench.reporting.found_by_size import in_words

CURVE = {"flights": 100, "found": 60, "runs": 100, "floor": 0.0, "ceiling": 1.0, "middle": 0.5, "spread": 0.2}


@pytest.mark.parametrize(
    ("size_90", "size_90_95", "said"),
    [
        (0.71, 0.83, "90 % found at 0.71 deg/s, at most 0.83 deg/s at 95 % confidence"),
        (2.5, None, "90 % found at 2.5 deg/s, beyond the largest flown; these flights give it no upper end at 95 % confidence"),
        (3.8, 17.0, "90 % found at 3.8 deg/s, beyond the largest flown; these flights give it no upper end at 95 % confidence"),
        (8.53e4, None, "these flights do not show where 90 % are found: not up to 2 times the largest flown, 2 deg/s"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_curve(size_90, size_90_95, said):
    curve = DetectionCurve(**CURVE, size_50=0.5, size_90=size_90, size_90_95=size_90_95, design_effect=1.0)
    assert in_words(curve, 2.0, "deg/s") == said


def test_a_curve_that_ends_below_90_says_where():
    curve = DetectionCurve(**CURVE | {"ceiling": 0.6}, size_50=0.5, size_90=None, size_90_95=None, design_effect=1.0)
    assert in_words(curve, 2.0, "deg/s") == "90 % are never found: the curve ends at 60 %"
