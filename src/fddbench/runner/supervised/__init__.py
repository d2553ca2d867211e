"""Detectors of ordinary Python in processes of their own, which know nothing but what is measured and may die.

Three generations, each forked from the one before: the `server` has imported what all need and is started once a process that
flies; a *stage* has built one detector and says READY; a *flight process* steps the flights of a batch and is all that a wrong
step can harm. No truth, no onset and no later sample is in any of them, so there is nothing to find in frames of a caller or in
its memory. Whoever loses its parent ends at once (on Linux by a signal of the kernel, elsewhere when its socket closes).
"""
