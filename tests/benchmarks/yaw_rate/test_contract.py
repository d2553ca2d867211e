"""Contract: the benchmark with every option of its choices, both plants in all their manoeuvres, the same bits everywhere."""

from fddbench.testing import check_benchmark


def test_benchmark_keeps_the_contract():
    check_benchmark("yaw_rate", duration_s=0.2)
