"""The jet-engine benchmark: a linear engine with an uncertainty of norm one, three disturbances and three additive faults."""

from fddbench.benchmarks.jet_engine.benchmark import JetEngine

__all__ = ["JetEngine"]
