"""Random numbers inside a kernel: normals made of uniform numbers, which a target draws."""

import numpy as np

from fddbench.blocks.graph import Graph
from fddbench.blocks.philox import PER_DRAW, box_muller
from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import expand
from fddbench.blocks.traced import Traced

__all__ = ["with_draws"]


def with_draws(program: Program) -> Program:
    """The program in primitives, its ``normals`` made of ``uniforms`` as `philox.box_muller` does it."""

    def normal(graph: Graph, name: str, row: int) -> int | None:
        if name != "normals":
            return None
        first = row // PER_DRAW * PER_DRAW
        ids = np.array([[graph.input("uniforms", first + j)] for j in range(PER_DRAW)], dtype=np.int64)
        return int(box_muller(Traced(graph, ids)).ids[row - first, 0])

    return expand(program, normal)
