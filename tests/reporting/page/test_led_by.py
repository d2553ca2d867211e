"""What comes first where a campaign asks for errors one at a time, for quiet flights, for a table in print."""

from types import SimpleNamespace

from fddbench.reporting.beside import Told
from fddbench.reporting.page.alarms_said import Loudest
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.led_by import of_envelope, of_points, of_print, of_quiet

NAMES = ("p_mass_error_percent", "p_delta_c_y_percent")


def text(said):
    return "".join(piece for piece, _ in said)


def points(told, outcome):
    """Point 0 without an error, 1 with one of the mass, 2 with one of a coefficient."""
    rows = told(("jam_a",), ("one", "other"), 30, lambda s, d, run: outcome(d, run % 3))
    point = rows["run"].to_numpy(dtype=int) % 3
    rows["point"], rows[NAMES[0]], rows[NAMES[1]] = point, (point == 1) * 10.0, (point == 2) * 5.0
    return Columns(rows)


def test_the_worst_error_stands_beside_none(told):
    lost = points(told, lambda d, p: "missed" if d == "one" and p == 1 else "right")
    said = text(of_points("What does it cost that the mass is off?", lost, NAMES))
    assert said == (
        "Most is lost with mass error [%] 10: right goes from 100 to 0 % with one; other loses nothing, right in 100 % without "
        "errors. "
    )
    none = points(told, lambda d, p: "right")
    assert text(of_points("What?", none, NAMES)) == "None of the errors costs any detector a fault. "
    assert of_points("What?", none, NAMES[:1]) == []


def test_what_a_grid_varies_besides_is_no_error(told):
    """The first point stood for no error, wherever it lay in the grid: gusts were told as errors, or hid them."""
    rows = told(("jam_a",), ("one",), 36, lambda s, d, run: "missed" if run % 2 else "right")
    number = rows["run"].to_numpy(dtype=int)
    entry = number // 2 % 3
    rows["point"], rows["run"], rows["p_gust_scale_ratio"] = number % 6, number // 6, (number % 2).astype(float)
    rows[NAMES[0]], rows[NAMES[1]] = (entry == 1) * 10.0, (entry == 2) * 5.0
    assert text(of_points("What?", Columns(rows), NAMES)) == "None of the errors costs any detector a fault. "


def test_errors_of_both_signs_are_beside_the_entry_without_any(told):
    rows = told(("jam_a",), ("one",), 36, lambda s, d, run: "missed" if run % 3 == 0 else "right")
    number = rows["run"].to_numpy(dtype=int)
    rows["point"], rows["run"] = number % 3, number // 3
    for name in NAMES:
        rows[name] = (number % 3 - 1) * 5.0
    assert text(of_points("What?", Columns(rows), NAMES)).startswith(
        "Most is lost with mass error [%] -5 and delta c y [%] -5: right goes from 100 to 0 % with one"
    )
    rows[NAMES[0]] += 2.5  # no entry is without an error
    rows[NAMES[1]] += 2.5
    assert of_points("What?", Columns(rows), NAMES) == []


def test_one_run_is_said(told):
    rows = told(("jam_a", "jam_b", "jam_c"), ("one",), 3, lambda *_: "right")
    number = rows["run"].to_numpy(dtype=int)
    rows["point"], rows["run"], rows[NAMES[0]], rows[NAMES[1]] = number, 0, (number == 1) * 10.0, (number == 2) * 5.0
    assert text(of_points("What?", Columns(rows), NAMES)) == (
        "None of the errors costs any detector a fault in these flights. "
    )


def test_the_most_wrong_estimate_where_it_is_asked_for(told):
    columns = points(told, lambda d, p: "right")
    bias = columns.numbers("estimate_bias").copy()
    bias[:] = 0.01
    bias[(columns.whole("point", range(len(columns))) == 2) & (columns.detector == 1)] = -0.4
    columns._known["estimate_bias"] = bias
    said = text(of_points("What do errors do to each estimate?", columns, NAMES))
    assert said.startswith(
        "Estimates are most wrong in jam_a with delta c y [%] 5: bias -0.4 of other, 0.01 where none"
    )


def test_what_looks_like_a_fault_is_said():
    loud = Loudest(detector="one", scenario="descent", alarms=72, flights=200)
    assert text(of_quiet("Does a climb look like a fault?", loud)).startswith(
        "Yes with one: 72 of 200 healthy flights of"
    )
    assert text(of_quiet("Does a climb look like a fault?", None)) == "No healthy flight was taken for a fault. "
    assert of_quiet("Which is best?", loud) == []
    assert of_quiet("Does a climb look like a fault?", None, healthy=False) == []


def test_where_over_the_envelope_is_said_in_the_cells_of_the_map(told):
    rows = told(
        ("jam_a", "jam_b"), ("one",), 120, lambda s, d, run: "missed" if s == "jam_a" and run % 4 == 0 else "right"
    )
    place = rows["run"].to_numpy(dtype=int) % 4
    rows["p_v_cas_kt"], rows["p_altitude_ft"] = 260.0 + 20.0 * (place % 2), 15000.0 + 5000.0 * (place // 2)
    columns, axes = Columns(rows), (("v_cas_kt", "altitude_ft"),)
    said = text(of_envelope("Where over the envelope is it right?", columns, axes, (), 0))
    assert said == (
        "Over the envelope one fails most at v cas [kt] 260, altitude [ft] 15000: 30 of 60 faulty flights; least at "
        "v cas [kt] 280, altitude [ft] 15000: 0 of 60, as often in 2 more cells. "
    )
    assert of_envelope("Which is best, and where over the envelope?", columns, axes, (), 0) == []
    assert of_envelope("Where over the envelope is it right?", columns, axes, (), None) == []
    assert of_envelope("Where over the envelope is it right?", columns, (), (), 0) == []


def test_print_is_counted_for_the_table_that_is_asked_for():
    lines = [("one", True, 0), ("one", False, -3), ("two", False, 0), ("one", True, None)]
    told = [Told(detector=detector, sound=sound, away=away) for detector, sound, away in lines]
    compared = [SimpleNamespace(table=SimpleNamespace(table=8), told=told)]
    said = text(of_print("Do the gains give the published Table 8? Yes.", compared, "one"))
    assert said == (
        "Beside Table 8: one is right or quiet in all decided flights of 2 of 3 scenarios in print; its median time is the "
        "printed one to a sample in 1 of 2. "
    )
    assert of_print("Do the gains hold? Table 8 is beside.", compared, "one") == []
