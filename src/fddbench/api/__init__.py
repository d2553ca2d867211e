"""What a notebook uses and what commands are thin over: read, plan, run, load, summary, signals, score, tune, report."""
