"""Plug-ins that end, hang or exhaust whoever imports or makes them: a sentence, an exit code, and nothing written.

With `read_safely` reading at once, this test process ends, hangs or dies itself.
"""

import pytest
from tests.runner.plugins import HEAD, PLAIN

import fddbench
from fddbench.cli import main
from fddbench.errors import FddbenchError
from fddbench.runner.supervised import trial

TEXT = """\
name: trial
benchmark: yaw_rate
seed: 5
duration_s: 0.5
detectors: [mine]
scenarios:
  - {name: healthy, manoeuvre: cruise}
"""
MADE = "    @classmethod\n    def from_design(cls, gains, bus):\n        HARM\n        return cls()\n\n    recorded ="
HARMS = {
    "exits": ("import os; os._exit(0)", "ends the process with exit code 0"),
    "segfaults": ("import ctypes; ctypes.string_at(0)", "ends the process with SIGSEGV"),
    "kills": ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "ends the process with SIGKILL"),
    "hangs": ("import ctypes; ctypes.CDLL(None).pause()", "did not come to an end in 4 s"),
    "closes": ("import os; os.closerange(0, 1024)", "closes files that are not its own"),
    "interrupts": ("raise KeyboardInterrupt", "KeyboardInterrupt"),
}


def _written(folder, body):
    (folder / "detectors").mkdir()
    (folder / "detectors" / "mine.py").write_text(body)
    head = "kind: mine.py:Mine\nabout: a test\nsource: me\ntuned_on: null\n"
    (folder / "detectors" / "mine.yaml").write_text(f"{head}gains: {{}}\n")
    path = folder / "trial.yaml"
    path.write_text(TEXT)
    return path


@pytest.mark.slow
@pytest.mark.parametrize("when", ["imported", "made", "traced"])
@pytest.mark.parametrize("harm", HARMS)
def test_harm_is_a_sentence_and_nothing_is_written(tmp_path, monkeypatch, capsys, harm, when):
    monkeypatch.setattr(trial, "LONGEST_S", 4.0)
    code, message = HARMS[harm]
    body = {
        "imported": f"{code}\n{HEAD}{PLAIN}",
        "made": HEAD + PLAIN.replace("    recorded =", MADE.replace("HARM", code)),
        "traced": HEAD + PLAIN.replace("        for i, r", f"        {code}\n        for i, r"),
    }[when]
    path = _written(tmp_path, body)
    for command in (["run", str(path), "--out", str(tmp_path / "out")], ["check", str(path)]):
        assert main(command) == 2
        said = capsys.readouterr().err
        assert message in said
        assert "mine.py" in said
        assert "Traceback" not in said
    assert not (tmp_path / "out").exists()


def test_a_leak_is_met_before_it_is_one_of_this_process(tmp_path):
    leak = "KEPT = []\nfor _ in range(12):\n    KEPT.append(bytearray(10**9))\n"
    with pytest.raises(FddbenchError, match="needs more than 4 GB of memory"):
        fddbench.read(_written(tmp_path, leak + HEAD + PLAIN))


def test_mistakes_that_are_exceptions_are_told_as_ever(tmp_path):
    with pytest.raises(FddbenchError, match=r"mine\.py:1 does not run: ZeroDivisionError"):
        fddbench.read(_written(tmp_path, "1 / 0\n" + HEAD + PLAIN))


def test_nothing_is_tried_where_nothing_is_brought(monkeypatch):
    monkeypatch.setattr(trial, "_harm", lambda *_: pytest.fail("a process was started"))
    assert fddbench.read("smoke").name == "smoke"


def test_a_sound_plug_in_is_read(tmp_path):
    assert fddbench.read(_written(tmp_path, HEAD + PLAIN)).designs[0].name == "mine"
