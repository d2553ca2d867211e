import pytest

from fddbench.api.campaigns import plan
from fddbench.campaign.selection import selected
from fddbench.errors import FddbenchError


@pytest.fixture(scope="module")
def smoke():
    return plan("smoke")


def test_keys_narrow_and_values_of_a_key_join(smoke):
    names = [design.name for design in smoke.campaign.designs]
    whole = selected(smoke, ["run=0-9999"])
    assert whole.all()
    assert whole.shape == (len(names), smoke.n_cases)
    one = selected(smoke, [f"scenario={smoke.scenarios[0].name},detector={names[0]}"])
    assert one[0].sum() == smoke.scenarios[0].n_cases
    assert not one[1:].any()
    first, second = (each.name for each in smoke.scenarios[:2])
    joined = selected(smoke, [f"scenario={first},scenario={second}"])
    assert (joined == selected(smoke, [f"scenario={first}", f"scenario={second}"])).all()
    assert selected(smoke, ["run=0,point=0,level=0"]).sum() == len(names) * len(smoke.scenarios)


def test_all_mistakes_at_once(smoke):
    with pytest.raises(FddbenchError) as caught:
        selected(smoke, ["scenario=nowhere,detctor=x,run=3-1,run", "point=-1"])
    text = str(caught.value)
    for said in ("no scenario 'nowhere'", "Did you mean 'detector'?", "got '3-1'", "got 'run'", "got '-1'"):
        assert said in text


def test_what_chooses_nothing_says_what_there_is(smoke):
    with pytest.raises(FddbenchError, match="'run=9999' chooses no flight: the campaign has points 0 to"):
        selected(smoke, ["run=9999"])
