"""How fast the engine is beside others, measured in one process, one after the other in turn: ``make bench``."""
