"""The engine's floor: the operations that steps may use, with the same bits on every machine."""
