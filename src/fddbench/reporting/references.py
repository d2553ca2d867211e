"""The literature behind the methods of a page, as BibTeX."""

from collections.abc import Collection

__all__ = ["METHODS", "bibliography"]

METHODS: dict[str, tuple[str, str]] = {
    "share": ("interval of a share of independent flights", """@article{clopper1934, author={Clopper, C. J. and Pearson, E. S.},
  title={The use of confidence or fiducial limits illustrated in the case of the binomial}, journal={Biometrika},
  volume={26}, number={4}, pages={404--413}, year={1934}}"""),
    "pooled": ("interval of a share that pools runs", """@article{korn1998, author={Korn, E. L. and Graubard, B. I.},
  title={Confidence intervals for proportions with small expected number of positive counts estimated from survey data},
  journal={Survey Methodology}, volume={24}, number={2}, pages={193--201}, year={1998}}"""),
    "rate": ("interval of a rate per hour", """@article{garwood1936, author={Garwood, F.},
  title={Fiducial limits for the Poisson distribution}, journal={Biometrika}, volume={28}, number={3/4}, pages={437--442},
  year={1936}}"""),
    "incidence": ("cumulative incidence with competing outcomes", """@article{gooley1999,
  author={Gooley, T. A. and Leisenring, W. and Crowley, J. and Storer, B. E.},
  title={Estimation of failure probabilities in the presence of competing risks}, journal={Statistics in Medicine},
  volume={18}, number={6}, pages={695--706}, year={1999}}"""),
    "association": ("association of parameters with failure", """@article{bergsma2013, author={Bergsma, W.},
  title={A bias-correction for Cram{\\'e}r's V and Tschuprow's T}, journal={Journal of the Korean Statistical Society},
  volume={42}, number={3}, pages={323--328}, year={2013}}"""),
    "paired": ("two detectors on the same flights", """@article{mcnemar1947, author={McNemar, Q.},
  title={Note on the sampling error of the difference between correlated proportions or percentages},
  journal={Psychometrika}, volume={12}, number={2}, pages={153--157}, year={1947}}
@article{bonett2012, author={Bonett, D. G. and Price, R. M.},
  title={Adjusted {W}ald confidence interval for a difference of binomial proportions based on paired data},
  journal={Journal of Educational and Behavioral Statistics}, volume={37}, number={4}, pages={479--488}, year={2012}}
@article{holm1979, author={Holm, S.}, title={A simple sequentially rejective multiple test procedure},
  journal={Scandinavian Journal of Statistics}, volume={6}, number={2}, pages={65--70}, year={1979}}"""),
    "curve": ("probability of detection against size, a90/95", """@techreport{mil1823a,
  title={Nondestructive evaluation system reliability assessment}, institution={Department of Defense},
  number={MIL-HDBK-1823A}, year={2009}}
@article{cheng1988, author={Cheng, R. C. H. and Iles, T. C.},
  title={One-sided confidence bands for cumulative distribution functions}, journal={Technometrics}, volume={30}, number={2},
  pages={155--159}, year={1988}}"""),
    "monotone": ("smallest fault found", """@article{ayer1955,
  author={Ayer, M. and Brunk, H. D. and Ewing, G. M. and Reid, W. T. and Silverman, E.},
  title={An empirical distribution function for sampling with incomplete information},
  journal={Annals of Mathematical Statistics}, volume={26}, number={4}, pages={641--647}, year={1955}}"""),
    "colours": ("colours", """@misc{okabe2008, author={Okabe, M. and Ito, K.},
  title={Color Universal Design ({CUD}): how to make figures and presentations that are friendly to colorblind people},
  year={2008}}"""),
}  # fmt: skip
"""By method what it is for, and its entries."""


def bibliography(used: Collection[str]) -> list[tuple[str, str]]:
    """What each method is for, and its BibTeX; of the methods used, in the order of `METHODS`."""
    return [entry for name, entry in METHODS.items() if name in used]
