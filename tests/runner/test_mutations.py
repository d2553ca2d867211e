"""Thousands of campaigns with a mistake in them: each is refused with a place and a cure, or it flies."""

import random

import pytest

from fddbench import gallery
from fddbench.api.checking import described
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.runner.assembling import assemble
from fddbench.runner.run import run_campaign

SOURCES = ("smoke", "yaw_rate_gusts", "jet_engine_tuning", "b747_trim", "smoke_6dof")
ODD = (
    "", "~", "null", "true", "-1", "0", "1", "1e308", "-1e308", "1e-308", ".nan", ".inf", "-.inf", "010", "0x10", "1_000",
    "1e9", '"', "|", ">",
    "99999999999999999999", "on", "[]", "{}", "[1, 2]", "{a: 1}", "&a [*a]", "*b", "!!python/object:os.system {}", "'",
    "#", "- -", ": :", "\t", "\u202e", "\x00", "é", "../x", "/etc/passwd", "mine.py:Mine", "smoke", "r1", "jam", "a" * 300,
    "2026-11-27", "12:30:45", "<<", "{grid: [1, 1]}", "{uniform: [2, 1]}", "{normal: [0, -1]}", "{log_uniform: [0, 1]}",
)  # fmt: skip


def _mutated(text: str, chance: random.Random) -> str:
    """One to three changes of lines, values, characters."""
    for _ in range(chance.choice([1, 1, 1, 2, 3])):
        lines = text.split("\n")
        at = chance.randrange(len(lines))
        other = chance.randrange(len(lines))
        key, colon, _value = lines[at].partition(":")
        change = chance.randrange(9)
        if change == 0:
            del lines[at]
        elif change == 1:
            lines.insert(at, lines[other])
        elif change == 2:
            lines[at], lines[other] = lines[other], lines[at]
        elif change == 3 and colon:
            lines[at] = f"{key}: {chance.choice(ODD)}"
        elif change == 4:
            lines[at] = " " * chance.randint(1, 3) + lines[at]
        elif change == 5 and lines[at]:
            k = chance.randrange(len(lines[at]))
            lines[at] = (
                lines[at][:k] + chance.choice("{}[],:-#'\"&*!|>%@`0aé\t") + lines[at][k + chance.randint(0, 1) :]
            )
        elif change == 6:
            words = lines[at].split(" ")
            words[chance.randrange(len(words))] = chance.choice(ODD)
            lines[at] = " ".join(words)
        elif change == 7 and key.strip() and colon:
            other_key = chance.choice(["seed", "name", "faults", "kind", "x", key.strip() + "s"])
            lines[at] = lines[at].replace(key.strip(), other_key, 1)
        else:
            lines = lines[: max(at, 1)] if chance.random() < 0.2 else lines
        text = "\n".join(lines)
    return text


@pytest.mark.slow
@pytest.mark.parametrize("part", range(4))
def test_a_mistake_is_told_or_it_is_none_and_flies(tmp_path, part):
    """5000 in all; of those that are accepted every thirtieth is flown, if it is small."""
    (tmp_path / "detectors").symlink_to(gallery.folder("detectors"))
    texts = {name: (gallery.folder("campaigns") / f"{name}.yaml").read_text(encoding="utf-8") for name in SOURCES}
    accepted, told = [], 0
    for number in range(part, 5000, 4):
        chance = random.Random(number)
        path = tmp_path / f"m{number}.yaml"
        path.write_text(_mutated(texts[chance.choice(SOURCES)], chance), encoding="utf-8", errors="surrogatepass")
        try:
            described(path)
            accepted.append(path)
        except FddbenchError as error:
            told += bool(str(error).strip())
    assert told + len(accepted) == 1250
    assert len(accepted) > 100
    for path in accepted[::30]:
        campaign = read_campaign(path)
        if assemble(campaign).plan.n_cases <= 200:
            report = run_campaign(campaign, tmp_path / path.stem, jobs=1)
            assert sum(report.statuses.values()) == report.total * len(campaign.designs)
