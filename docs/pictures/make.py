"""Makes the pictures of the documentation anew: python docs/pictures/make.py, a few seconds."""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
FLIGHTS = {
    "single": ("yaw_rate_single_runs", "figure_5/0/0/0"),
    "smoke": ("smoke", "jam_b/0/0/3"),
    "jet_engine_figures": ("jet_engine_figures", None),
    "b747_figure_1": ("b747_figure_1", None),
}
"""Picture → campaign and flight; None: the first of those to look at."""

WIDTH = 900
"""Of a picture [px], in 32 colours: small enough for version control."""


def fddbench(*arguments):
    """Run a command."""
    return subprocess.run(
        [sys.executable, "-m", "fddbench", *arguments], check=True, capture_output=True, text=True
    ).stdout


with tempfile.TemporaryDirectory() as folder:
    for name, (campaign, case) in FLIGHTS.items():
        out = f"{folder}/{name}"
        fddbench("run", campaign, "--out", out, "--quiet")
        case = case or fddbench("worst", out).splitlines()[1].split()[0]
        fddbench("replay", out, case, "--plot", str(HERE / f"{name}.png"))
        picture = Image.open(HERE / f"{name}.png").convert("RGB")
        height = round(picture.height * WIDTH / picture.width)
        picture.resize((WIDTH, height), Image.Resampling.LANCZOS).quantize(32).save(HERE / f"{name}.png", optimize=True)
