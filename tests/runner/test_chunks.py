"""Law: the chunks cover every missing case once, whatever their size."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fddbench.runner.chunks import cut, expand, missing, spans


@given(st.sets(st.integers(0, 200)))
def test_spans_and_back(cases):
    numbers = np.array(sorted(cases), dtype=np.int64)
    np.testing.assert_array_equal(expand(spans(numbers)), numbers)


@given(size=st.integers(1, 50), jobs=st.integers(1, 5), done=st.sets(st.integers(0, 39)))
def test_every_missing_case_is_in_one_chunk(assembly, size, jobs, done):
    n_cases = assembly.plan.n_cases
    left = missing(n_cases, [spans(np.array(sorted(done), dtype=np.int64))])
    chunks = cut(assembly.plan, left, size=size, jobs=jobs)
    together = np.sort(np.concatenate([*chunks, np.empty(0, dtype=np.int64)]))
    np.testing.assert_array_equal(together, left)
    assert set(left) | done == set(range(n_cases))
    assert all(len(chunk) <= size for chunk in chunks)
    for chunk in chunks:
        assert len(set(assembly.plan.n_samples(chunk))) == 1
