"""What the law knows: voted and measured signals, air data, and what differs from flight to flight."""

from fddbench.blocks.layout import Row, record

__all__ = ["Sensed"]


@record
class Sensed:
    """Signals of a sample, (n_cases,) each: angles [rad], rates [rad/s], load factor [g].

    Sideslip, incidence, rates, angles and load factor come from sensors, three of them voted; the pressure of the gain schedule
    and the mass carry the errors of what is known of the flight; altitude, climb, change of track and speeds are true.
    """

    phi_rad: Row
    theta_rad: Row
    alpha_rad: Row
    beta_rad: Row
    p_rad_s: Row
    q_rad_s: Row
    r_rad_s: Row
    n_z_g: Row
    scheduled_pa: Row
    mass_kg: Row
    track_rad: Row
    altitude_m: Row
    climb_m_s: Row
    v_tas_m_s: Row
    v_cas_kt: Row
    v_cas_dot_kt_s: Row
    mach: Row
    pressure_pa: Row
    density_kg_m3: Row
