"""Names cut in the middle, never to equality."""

from hypothesis import given
from hypothesis import strategies as st

from fddbench.reporting.names import shortened

NAMES = st.lists(st.text("ab_", min_size=1, max_size=12), min_size=1, max_size=8, unique=True)


@given(NAMES, st.integers(3, 14))
def test_different_names_stay_different(names, width):
    found = shortened(names, width)
    assert len(set(found.values())) == len(names)
    for name, short in found.items():
        head, cut, tail = short.partition("…")
        assert name.startswith(head)
        assert name.endswith(tail)
        assert cut or short == name


@given(NAMES, st.integers(3, 14))
def test_as_short_as_asked_unless_two_would_be_equal(names, width):
    if len(
        {name[: width // 2] + "…" + name[-(width - width // 2 - 1) :] for name in names if len(name) > width}
    ) == sum(len(name) > width for name in names):
        assert max(map(len, shortened(names, width).values())) <= width


def test_the_cut_moves_where_two_would_read_alike():
    assert shortened(["sliding_mode_off_tuned", "sliding_mode_on_tuned"], 14) == {
        "sliding_mode_off_tuned": "slidin…f_tuned",
        "sliding_mode_on_tuned": "slidin…n_tuned",
    }
    assert shortened(["aXaaaaaaaa", "aYaaaaaaaa"], 4) == {"aXaaaaaaaa": "aX…a", "aYaaaaaaaa": "aY…a"}
    assert shortened(["short"], 3) == {"short": "s…t"}
