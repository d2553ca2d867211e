"""What a step of each detector takes, on the page."""

from types import SimpleNamespace

from fddbench.reporting.loads import LOAD_HEADS, MEASURED_HEADS, load_heads, load_lines, measured_by


def cost(flops):
    operations = {"mul": 5, "div": 2, "sqrt": 1, "sin": 3, "exp": 1}
    return SimpleNamespace(flops=flops, multiply_adds=4, operations=operations, state_bytes=40, table_bytes=56)


MEASURED = {
    "code_bytes": 11340, "table_bytes": 1392, "state_bytes": 384, "stack_bytes": None, "ticks": 652, "by": "gcc 12, -O2",
}  # fmt: skip


def texts(designs):
    return [[cell.text for cell in line] for line in load_lines(designs)]


def test_the_fewest_operations_a_sample_come_first_and_what_cannot_be_counted_last():
    designs = [
        {"name": "python", "cost": None, "opaque": "it sorts"},
        {"name": "large", "cost": cost(100)},
        {"name": "seldom", "cost": cost(300), "every": 4},
    ]
    assert [line[0] for line in texts(designs)] == ["seldom", "large", "python"]
    assert load_lines(designs)[0][1].small == "at every 4 samples"
    assert load_lines(designs)[2][1].small == "it sorts"
    assert texts(designs)[1] == ["large", "100", "4", "2", "1", "4", "40", "56"]
    assert load_heads(designs) == LOAD_HEADS
    assert measured_by(designs) == ""


def test_what_was_measured_stands_beside_what_was_counted():
    designs = [{"name": "a", "cost": cost(9), "in_c": MEASURED}, {"name": "b", "cost": cost(10), "in_c": None}]
    assert load_heads(designs) == (*LOAD_HEADS, *MEASURED_HEADS)
    assert texts(designs)[0][8:] == ["11\u202f340", "1\u202f392", "384", "–", "652"]
    assert texts(designs)[1][8:] == ["–"] * 5
    assert measured_by(designs) == "gcc 12, -O2"


def test_nothing_known_is_no_table():
    assert load_lines([{"name": "a", "in_c": None}]) == []
