"""A picture for notebooks and papers."""

from pathlib import Path

from fddbench.errors import FddbenchError
from fddbench.reporting.svg.painting import painted
from fddbench.reporting.svg.scene import Scene

__all__ = ["KINDS", "Picture"]

KINDS = (".svg", ".pdf", ".png")
"""What a picture can be saved as, by the end of the file's name."""


class Picture:
    """A picture that a notebook shows by itself and that can be saved; the same bytes for the same numbers.

    Parameters
    ----------
    scene : Scene
        What is drawn.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def __repr__(self) -> str:
        return f"<picture: {self.scene.label}>"

    def _repr_svg_(self) -> str:
        return self.scene.svg(standalone=True)

    def save(self, path: str | Path) -> Path:
        """Write the picture, ``"x.svg"``, ``"x.pdf"`` or ``"x.png"``; where it was written.

        Raises
        ------
        FddbenchError
            Another ending, or the file cannot be written.
        """
        target = Path(path)
        if target.suffix not in KINDS:
            raise FddbenchError(f"{target}: cannot tell the format from the name; let it end in {', '.join(KINDS)}")
        kind = target.suffix[1:]
        content = self._repr_svg_().encode() if kind == "svg" else painted(self.scene, kind)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        except OSError as error:
            raise FddbenchError(f"cannot write {target}: {error.strerror}; name another file") from error
        return target
