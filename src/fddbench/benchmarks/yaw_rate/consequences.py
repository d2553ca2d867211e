"""What a fault does to the aircraft, as columns of the rows: how far it banks and slips, and where it ends up instead."""

from fddbench.interfaces import Consequence

__all__ = ["CONSEQUENCES", "LATERAL_CONSEQUENCES"]

LATERAL_CONSEQUENCES = (
    Consequence(name="peak_bank_deg", signal="phi_true_deg", how="peak", about="bank angle"),
    Consequence(name="peak_sideslip_deg", signal="beta_true_deg", how="peak", about="sideslip angle"),
    Consequence(name="heading_error_deg", signal="psi_deg", how="error", about="heading"),
    Consequence(name="track_error_m", signal="y_m", how="error", about="lateral position, across the first heading,"),
)
"""Of every aircraft of this benchmark."""

CONSEQUENCES = (
    *LATERAL_CONSEQUENCES,
    Consequence(name="peak_load_factor_g", signal="n_z_true_g", how="peak", about="load factor"),
    Consequence(name="altitude_error_ft", signal="altitude_true_ft", how="error", about="altitude"),
    Consequence(name="drag_rise_percent", signal="drag_n", how="rise", about="drag"),
)
"""Of those with six degrees of freedom."""
