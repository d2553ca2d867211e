"""The shipped designs of the sliding-mode scheme, with any number replaced."""

import pytest
import yaml

from fddbench import gallery
from fddbench.detection.sliding_mode.gains import SlidingModeGains


@pytest.fixture(scope="session")
def design():
    """Function from the name of a shipped design and replaced numbers to its gains."""

    def read(name="published", **replaced):
        text = (gallery.folder("detectors") / f"sliding_mode_{name}.yaml").read_text(encoding="utf-8")
        return SlidingModeGains(**{**yaml.safe_load(text)["gains"], **replaced})

    return read
