"""Hypothesis everywhere: the same examples every time, and no deadline on a shared machine."""

import signal

from hypothesis import settings

# a suite started in the background of a script inherits an ignored Ctrl-C; its tests of Ctrl-C need one that arrives
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("steady", deadline=None, derandomize=True, database=None)
settings.load_profile("steady")
