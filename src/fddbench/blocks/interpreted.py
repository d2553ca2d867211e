"""The kernel that needs no compiler: NumPy, operation by operation, sample by sample."""

import numpy as np

from fddbench.blocks.flown import Addresses, Floats, Flown, Integers, Streams, by_output
from fddbench.blocks.interpreter import Interpreter
from fddbench.blocks.philox import normals
from fddbench.blocks.program import Program

__all__ = ["Interpreted"]


class Interpreted:
    """Kernel that runs on NumPy alone."""

    def __init__(self, program: Program, streams: Streams, recorded: tuple[str, ...]) -> None:
        self._interpreter = Interpreter(program, fixed=("constants",))
        self._program, self._streams, self._recorded = program, streams, recorded

    def fly(
        self, state: Floats, constants: Floats, samples: Integers, addresses: Addresses, *, first: int, end: int
    ) -> Flown:
        """As `Kernel.fly`."""
        state, samples = np.array(state, dtype=float), np.array(samples, dtype=np.int64)
        self._interpreter.fix(constants=constants)
        n_rows = sum(len(self._program.outputs[name]) for name in self._recorded)
        tile = np.full((end - first, n_rows, state.shape[1]), np.nan)
        for k in range(first, end):
            active = k < samples
            if not active.any():
                break
            drawn = self._normals(k, addresses, state.shape[1])
            outputs = self._interpreter.run(state=state, normals=drawn, sample=np.float64(k))
            state = np.where(active, outputs["state"], state)
            if n_rows:
                rows = np.concatenate([outputs[name] for name in self._recorded])
                tile[k - first] = np.where(active, rows, np.nan)
            if "finished" in outputs:
                samples = np.where(active & (outputs["finished"][0] != 0.0), k + 1, samples)
        return Flown(state=state, samples=samples, recorded=by_output(tile, self._program, self._recorded))

    def _normals(self, k: int, addresses: Addresses, n_cases: int) -> Floats:
        words = {"flight": np.asarray(addresses.flight), "scenario": np.asarray(addresses.scenario)}
        run = np.asarray(addresses.run)
        drawn = [normals((k, consumer, run, words[stream]), addresses.key) for consumer, stream in self._streams]
        return np.concatenate([np.broadcast_to(d, (4, n_cases)) for d in drawn]) if drawn else np.zeros((0, n_cases))
