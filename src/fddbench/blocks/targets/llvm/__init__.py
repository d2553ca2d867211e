"""LLVM text of a plan: one case a lane, exact, no fast-math flag, nothing fused."""
