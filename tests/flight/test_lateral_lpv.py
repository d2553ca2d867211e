"""The published lateral model: printed numbers, modes, and the scaling of its aerodynamic part."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.lateral_lpv import SCHEDULING, derivatives, lateral_lpv

MODEL = lateral_lpv()
CENTRE = np.zeros((4, 1))
# the grid of Table 5 of the paper: mass, X_cg, altitude, calibrated airspeed
TABLE_5 = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T
rhos = st.tuples(*[st.floats(-2.0, 2.0)] * 4).map(lambda values: np.array(values)[:, np.newaxis])
small = st.floats(-0.5, 0.5)
deltas = st.tuples(small, small, small)


def at(rho):
    return (matrix[:, :, 0] for matrix in MODEL.matrices(rho))


# appendix of the paper: (table, row, column, printed number)
PRINTED_A = (
    (0, 0, 2, 1.0),
    (0, 0, 3, 0.0465),
    (0, 1, 0, 9.7981),
    (0, 1, 1, -0.117),
    (0, 1, 2, 8.3767),
    (0, 1, 3, -197.8845),
    (0, 2, 1, -0.0285),
    (0, 2, 2, -1.7405),
    (0, 2, 3, 0.2744),
    (0, 3, 1, 0.0044),
    (0, 3, 2, -0.1349),
    (0, 3, 3, -0.2246),
    (1, 1, 2, 1.6744),
    (1, 3, 3, 0.0115),
    (2, 1, 2, -0.0963),
    (2, 1, 3, 0.0),
    (2, 3, 1, -0.0002),
    (3, 1, 3, -15.0464),
    (3, 3, 3, 0.0274),
    (4, 1, 3, -19.5283),
    (4, 1, 1, -0.0142),
    (4, 2, 2, -0.1236),
    (4, 0, 3, -0.0146),
)
PRINTED_B = (
    (0, 1, 0, 0.0863),
    (0, 2, 0, 0.0045),
    (0, 3, 0, -0.0148),
    (0, 2, 1, 0.0113),
    (0, 2, 4, -0.0054),
    (0, 3, 4, 0.0001),
    (0, 3, 3, -0.0001),
    (0, 2, 5, -0.0074),
    (0, 2, 12, 0.0074),
    (1, 3, 0, 0.0008),
    (2, 1, 0, 7.2e-5),
    (2, 2, 1, 6.5e-5),
    (2, 3, 5, -4e-6),
    (3, 2, 2, 0.0013),
    (3, 3, 0, 0.0001),
    (4, 3, 0, -0.0028),
    (4, 1, 0, 0.0156),
    (4, 3, 12, 0.0002),
)


@pytest.mark.parametrize(
    ("tables", "printed"), [(MODEL.tables["A"], PRINTED_A), (MODEL.tables["B"], PRINTED_B)], ids=("A", "B")
)
def test_literature_printed_numbers(tables, printed):
    for table, row, column, value in printed:
        assert tables[table, row, column, 0] == value, (table, row, column)


def test_literature_checksums_of_the_printed_tables():
    """Sums over all entries of each table, computed from the paper: no entry can be mistyped alone."""
    sums = [float(np.abs(MODEL.tables["A"][j]).sum()) for j in range(5)]
    assert sums == pytest.approx([219.6301, 1.9034, 0.1049, 16.2968, 21.868], abs=1e-9)
    sums = [float(np.abs(MODEL.tables["B"][j]).sum()) for j in range(5)]
    assert sums == pytest.approx([0.2354, 0.0169, 0.000561, 0.0081, 0.0369], abs=1e-9)


def test_literature_trim_scale_and_order():
    assert SCHEDULING == ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
    assert MODEL.trim.ravel().tolist() == [200e3, 0.3, 20e3, 290.0]
    assert MODEL.scale.ravel().tolist() == [20e3, 0.03, 5e3, 30.0]
    assert len(MODEL.surfaces) == 13
    assert MODEL.surfaces[0] == "rudder"


def test_literature_modes_at_the_centre():
    A, _ = at(CENTRE)
    modes = np.linalg.eigvals(A)
    dutch = modes[modes.imag > 0]
    real = sorted(modes[modes.imag == 0].real)
    assert abs(dutch[0]) == pytest.approx(1.179, abs=1e-3)  # natural frequency [rad/s]
    assert -dutch[0].real / abs(dutch[0]) == pytest.approx(0.0770, abs=1e-3)
    assert real == pytest.approx([-1.883, -0.0174], abs=1e-3)  # roll and spiral


def test_literature_kinematics_hide_in_the_printed_side_force_row():
    """A0(2,3) = W0 + Y_p and A0(2,4) = Y_r - U0, with U0, W0 from TAS 199.28 m/s and tan alpha = 0.0465."""
    u0, w0 = MODEL.trim_speeds_m_s(CENTRE, np.array([199.28]))
    assert (u0[0], w0[0]) == (pytest.approx(199.07, abs=6e-3), pytest.approx(9.257, abs=2e-3))
    A, _ = at(CENTRE)
    assert A[1, 2] - w0[0] == pytest.approx(-0.88, abs=5e-3)
    assert A[1, 3] + u0[0] == pytest.approx(1.18, abs=1e-2)


@given(rhos, st.floats(50.0, 300.0))
def test_trim_speeds_are_the_components_of_the_airspeed(rho, v):
    u0, w0 = MODEL.trim_speeds_m_s(rho, np.array([v]))
    A, _ = at(rho)
    assert np.hypot(u0[0], w0[0]) == pytest.approx(v, rel=1e-14)
    assert w0[0] / u0[0] == pytest.approx(A[0, 3], rel=1e-13)


@given(rhos)
def test_affine_in_rho(rho):
    expected_A = MODEL.tables["A"][0, :, :, 0] + sum(rho[j, 0] * MODEL.tables["A"][j + 1, :, :, 0] for j in range(4))
    expected_B = MODEL.tables["B"][0, :, :, 0] + sum(rho[j, 0] * MODEL.tables["B"][j + 1, :, :, 0] for j in range(4))
    A, B = at(rho)
    np.testing.assert_allclose(A, expected_A, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(B, expected_B, rtol=1e-14, atol=1e-17)


def test_rho_is_not_clipped():
    rho = MODEL.rho(*(np.array([value]) for value in (120e3, 0.41, 38e3, 160.0))).ravel()
    assert rho == pytest.approx([-4.0, 11 / 3, 3.6, -13 / 3], rel=1e-12)
    assert not MODEL.rho(*MODEL.trim).any()


def test_literature_raw_model_is_unstable_at_15_of_the_108_points_of_table_5():
    """Counted as: any eigenvalue with a positive real part; it is the Dutch roll every time."""
    assert TABLE_5.shape == (4, 108)
    A, _ = MODEL.matrices(MODEL.rho(*TABLE_5))
    modes = np.linalg.eigvals(A.transpose(2, 0, 1))
    unstable = modes.real > 0.0
    assert int(unstable.any(axis=1).sum()) == 15
    assert (modes.imag[unstable] != 0.0).all()


def test_27_of_the_108_points_of_table_5_cannot_be_flown():
    mass, _, altitude, v_cas = TABLE_5
    reasons = infeasible_reasons(mass, altitude, v_cas)
    assert sum(reason != "" for reason in reasons) == 27
    # X_cg takes no part in it: three points each
    assert all(len({reasons[i] for i in np.flatnonzero((p == TABLE_5[[0, 2, 3]].T).all(axis=1))}) == 1
               for p in TABLE_5[[0, 2, 3]].T)  # fmt: skip


def test_the_published_box_can_be_flown_and_its_raw_model_is_stable():
    corners = np.array(list(product((180e3, 220e3), (0.27, 0.33), (15e3, 25e3), (260.0, 320.0)))).T
    assert set(infeasible_reasons(corners[0], corners[2], corners[3])) == {""}
    A, _ = MODEL.matrices(MODEL.rho(*corners))
    assert np.linalg.eigvals(A.transpose(2, 0, 1)).real.max() < 0.0


def scaled_by_hand(A, B, u0, w0, d_y, d_l, d_n):
    """The rules of the benchmark, entry by entry, in the paper's one-based indices: A(2,3) is A[1, 2]."""
    A, B = A.copy(), B.copy()
    A[1, 1] *= 1 + d_y
    A[1, 2] = w0 + (1 + d_y) * (A[1, 2] - w0)
    A[1, 3] = -u0 + (1 + d_y) * (A[1, 3] + u0)
    A[2, 1:] *= 1 + d_l
    A[3, 1:] *= 1 + d_n
    B[1] *= 1 + d_y
    B[2] *= 1 + d_l
    B[3] *= 1 + d_n
    return A, B


@given(rhos, deltas, st.integers(0, 12), st.floats(-3.0, 3.0))
def test_aerodynamic_deltas_scale_what_is_aerodynamic(rho, delta, surface, gust):
    v = true_airspeed_m_s(np.array([290.0]), np.array([20e3]))
    u0, w0 = MODEL.trim_speeds_m_s(rho, v)
    A, B = MODEL.matrices(rho)
    u = np.zeros((13, 1))
    u[surface] = 7.0
    M, f = derivatives(
        A, B, u, u0_m_s=u0, w0_m_s=w0, gust_m_s=np.array([gust]), delta=tuple(np.array([d]) for d in delta)
    )
    expected_A, expected_B = scaled_by_hand(A[:, :, 0], B[:, :, 0], u0[0], w0[0], *delta)
    np.testing.assert_allclose(M[:, :, 0], expected_A, rtol=1e-12, atol=1e-12)
    # the gust enters through the aerodynamics of V_y alone
    np.testing.assert_allclose(f[:, 0], expected_B @ u[:, 0] - expected_A[:, 1] * gust, rtol=1e-12, atol=1e-14)


@given(rhos, deltas)
def test_gravity_and_kinematics_are_never_scaled(rho, delta):
    v = np.array([199.28])
    u0, w0 = MODEL.trim_speeds_m_s(rho, v)
    A, B = MODEL.matrices(rho)
    M, f = derivatives(
        A, B, np.ones((13, 1)), u0_m_s=u0, w0_m_s=w0, gust_m_s=np.ones(1), delta=tuple(np.array([d]) for d in delta)
    )
    assert M[0].tobytes() == A[0].tobytes()  # phi' = p + r tan theta
    assert M[:, 0].tobytes() == A[:, 0].tobytes()  # gravity
    assert f[0, 0] == 0.0  # no gust or surface turns the bank angle at once


@settings(max_examples=30)
@given(rhos, st.floats(-10.0, 10.0))
def test_zero_delta_is_bit_identical(rho, deflection):
    A, B = MODEL.matrices(rho)
    u = np.full((13, 1), deflection)
    zero = np.zeros(1)
    M, f = derivatives(
        A, B, u, u0_m_s=np.array([190.0]), w0_m_s=np.array([9.0]), gust_m_s=zero, delta=(zero, zero, zero)
    )
    assert np.array_equal(M, A)
    by_hand = [0.0] * 4
    for row in range(4):
        for j in range(13):
            by_hand[row] += B[row, j, 0] * u[j, 0]
    assert f[:, 0].tolist() == by_hand


def test_a_rotation_of_the_air_is_one_of_the_aircraft_the_other_way_without_kinematics():
    """Aerodynamic parts alone; and the yawing moment of a gust may be larger than the model of its sideslip says."""
    model = lateral_lpv()
    A, B = model.matrices(model.rho(*(np.array([v]) for v in (200e3, 0.3, 20e3, 290.0))))
    u0, w0, gust = np.array([199.07]), np.array([9.25]), np.array([2.0])
    same = {"u0_m_s": u0, "w0_m_s": w0, "gust_m_s": gust, "delta": (np.array([0.1]),) * 3}
    _, plain = derivatives(A, B, np.zeros((13, 1)), **same)
    M, turned = derivatives(A, B, np.zeros((13, 1)), **same, rotation_rad_s=(np.array([0.01]), np.array([0.02])))
    own = M[:, :, 0] @ [0.0, 0.0, -0.01, -0.02] - [-0.01 - 0.02 * A[0, 3, 0], -0.01 * 9.25 + 0.02 * 199.07, 0.0, 0.0]
    np.testing.assert_allclose((turned - plain)[:, 0], own, rtol=1e-9, atol=1e-12)
    M, stronger = derivatives(A, B, np.zeros((13, 1)), **same, gust_yaw=np.array([0.3]))
    np.testing.assert_allclose((stronger - plain)[:, 0], [0.0, 0.0, 0.0, -0.3 * M[3, 1, 0] * 2.0], rtol=1e-12)
    nothing = {"rotation_rad_s": (np.zeros(1), np.zeros(1)), "gust_yaw": np.zeros(1)}
    assert np.array_equal(derivatives(A, B, np.zeros((13, 1)), **same, **nothing)[1], plain)
