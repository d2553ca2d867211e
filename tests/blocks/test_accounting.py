"""Golden: the cost of a small observer, counted by hand."""

from typing import Any

import numpy as np

from fddbench.blocks import functions
from fddbench.blocks.accounting import cost
from fddbench.blocks.linear import column, product
from fddbench.blocks.program import trace


def _observer(state: Any, y: Any) -> dict[str, Any]:
    r = y - product(column([[1.0, 0.0]]), state)
    return {"state": product(column([[0.9, 0.1], [0.0, 0.8]]), state) + column([0.5, 0.25]) * r, "ratio": np.abs(r)}


def test_an_observer() -> None:
    found = cost(trace(_observer, state=2, y=1))
    assert dict(found.operations) == {"mul": 5, "add": 3, "sub": 1, "abs": 1}
    assert (found.flops, found.multiply_adds, found.state_bytes, found.table_bytes) == (10, 3, 16, 40)


def test_a_sine_is_one_operation_and_many_flops() -> None:
    found = cost(trace(lambda state: {"state": functions.sin(state)}, state=1))
    assert dict(found.operations) == {"sin": 1}
    assert 25 < found.flops < 60


class _Filter:
    def step(self, x: Any, u: Any) -> Any:
        return 0.9 * x + 0.1 * u


class _Loop:
    inner = _Filter()

    def step(self, state: Any, u: Any) -> dict[str, Any]:
        return {"state": self._limited(self.inner.step(state, u))}

    def _limited(self, x: Any) -> Any:
        return np.minimum(x, 1.0)


class _SlowLoop(_Loop):
    def step(self, state: Any, u: Any) -> dict[str, Any]:
        return super().step(state * 0.5, u)


def test_operations_belong_to_the_blocks_that_were_stepping() -> None:
    found = cost(trace(_SlowLoop().step, state=1, u=1))
    assert found.by_block == {"_SlowLoop": {"mul": 1, "min": 1}, "_SlowLoop._Filter": {"mul": 2, "add": 1}}
    assert sum(sum(counted.values()) for counted in found.by_block.values()) == sum(found.operations.values())


def test_a_product_that_is_used_twice_is_no_multiply_add() -> None:
    """A signal processor adds a product that nobody else needs in the same cycle; one used twice it has to keep."""

    def twice(state: Any) -> dict[str, Any]:
        product_ = 0.9 * state
        return {"state": product_ + 1.0, "other": product_ + 2.0}

    assert cost(trace(twice, state=1)).multiply_adds == 0
    assert cost(trace(lambda state: {"state": 0.9 * state + 1.0}, state=1)).multiply_adds == 1
