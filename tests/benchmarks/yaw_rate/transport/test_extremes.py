"""The kept table of attained extremes is within the limits of the protections, and of the manoeuvres that there are."""

import yaml

from fddbench import gallery
from fddbench.benchmarks.yaw_rate.transport.profiles import MANOEUVRES

TABLE = yaml.safe_load((gallery.folder("reports") / "transport_6dof" / "extremes.yaml").read_text(encoding="utf-8"))


def test_kept_extremes_are_within_the_limits():
    assert [len(part) for part in TABLE.values()] == [len(MANOEUVRES)] * 2
    for part in TABLE.values():
        assert set(part) == set(MANOEUVRES)
        assert all(found["departed"] == 0 for found in part.values())
        assert part["cruise"]["flights"] == 81
        assert part["pitch_protection_1"]["theta_deg"][1] <= 31.5
        assert part["roll_protection"]["phi_deg"][1] <= 74.0
        assert part["n_z_limitation_1"]["n_z_g"][0] >= -0.25
        assert part["n_z_limitation_1"]["n_z_g"][1] <= 2.8
        assert part["speed_mach_protection"]["mach_most"] <= 0.88
