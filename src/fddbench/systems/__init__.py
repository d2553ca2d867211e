"""The algebra of linear systems: what the papers write as one letter is one value here.

`StateSpace` is continuous time for designs, `DiscreteLti` the same on the clock and stepped in flight, `AffineLpv` a family
that depends on scheduling parameters, `UncertainPlant` a plant with a channel for what is not known about it.
"""

from fddbench.systems.affine_lpv import AffineLpv
from fddbench.systems.discrete_lti import DiscreteLti
from fddbench.systems.errors import MisfitError
from fddbench.systems.interconnection import append, feedback, lower_lft, series, star, upper_lft
from fddbench.systems.state_space import StateSpace
from fddbench.systems.uncertain_plant import UncertainPlant

__all__ = [
    "AffineLpv",
    "DiscreteLti",
    "MisfitError",
    "StateSpace",
    "UncertainPlant",
    "append",
    "feedback",
    "lower_lft",
    "series",
    "star",
    "upper_lft",
]
