"""A campaign of healthy flights and of flights with a jam that ends, drawn as often as a test asks."""


def jammed(
    name: str, *, runs: int = 40, duration_s: float = 2.0, seed: int = 7, detectors: str = "voting_monitor"
) -> str:
    """Text of it."""
    return f"""\
name: {name}
benchmark: yaw_rate
seed: {seed}
duration_s: {duration_s}
dispersions:
  monte_carlo: {{runs: {runs}, mass_kg: {{uniform: [180000, 220000]}}}}
scenarios:
  - {{name: healthy, manoeuvre: cruise}}
  - name: jam_a
    manoeuvre: cruise
    faults: [{{kind: jam, mode: replace, freeze: true, sites: [r1], onset_s: 1.0, end_s: 1.8}}]
detectors: [{detectors}]
"""
