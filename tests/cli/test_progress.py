"""How far a run is: a rate of what it flew itself, and the time left from it."""

from collections import Counter

from fddbench.cli.progress import Pace, shown
from fddbench.runner.run import Progress, run_campaign


def progress(flown, done, total=100):
    return Progress(flown=flown, done=done, total=total, statuses=Counter(ok=done))


def pace_at(*times_s):
    times = iter((0.0, *times_s))
    return Pace(clock=lambda: next(times))


def test_the_rate_is_that_of_this_run_also_when_it_continues():
    assert pace_at(2.0).text(progress(10, 60)) == "5/s, 0:08 left"
    assert pace_at(7200.0).text(progress(10, 60)) == "0.00139/s, 8:00:00 left"
    assert pace_at(100.0).text(progress(40, 100)) == "0.4/s in 1:40"
    assert pace_at(3.0).text(progress(0, 60)) == "0:03 so far"


def test_where_there_is_no_terminal_lines_are_told_from_the_start(capsys):
    with shown("demo", quiet=False) as update:
        for flown in (0, 20, 40):
            update(progress(flown, 60 + flown))
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("demo: 60/100 flights, 0:00 so far")
    assert lines[-1].startswith("demo: 100/100 flights, ")
    assert "/s in 0:00" in lines[-1]
    assert len(lines) == 2
    with shown("demo", quiet=True) as update:
        assert update is None


def test_a_run_says_at_once_what_it_found_done(tmp_path):
    from tests.cli.test_commands import TINY

    from fddbench.campaign.load import read_campaign

    (tmp_path / "tiny.yaml").write_text(TINY)
    campaign, told = read_campaign(tmp_path / "tiny.yaml"), []
    for _ in range(2):
        run_campaign(campaign, tmp_path / "out", jobs=1, progress=told.append)
    assert [(one.flown, one.done, one.total) for one in told] == [(0, 0, 2), (2, 2, 2), (0, 2, 2)]
