"""File systems that cannot do everything are met with a word."""

import errno
import os
import stat

import filelock
import pytest
from tests.results.conftest import fly

from fddbench import load
from fddbench.results import lock, shards


@pytest.mark.skipif(os.name != "posix", reason="only there a folder can be synced")
def test_a_folder_that_cannot_be_synced(campaign, flown, tmp_path, monkeypatch):
    known = os.fsync

    def fsync(handle):
        if stat.S_ISDIR(os.fstat(handle).st_mode):
            raise OSError(errno.EINVAL, "Invalid argument")
        known(handle)

    monkeypatch.setattr(shards.os, "fsync", fsync)
    told = []
    fly(campaign, tmp_path / "out", notice=told.append)
    assert [text for text in told if "does not say when a renamed file is safe" in text] == told
    assert len(told) == 1
    assert load(tmp_path / "out").equals(load(flown))


def test_a_broken_disk_is_no_such_file_system(campaign, tmp_path, monkeypatch):
    def fsync(handle):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(shards.os, "fsync", fsync)
    with pytest.raises(OSError, match="Input/output"):
        fly(campaign, tmp_path / "out")


@pytest.mark.parametrize("error", [NotImplementedError("no flock"), OSError(errno.ENOLCK, "No locks available")])
def test_a_file_system_without_locks(campaign, flown, tmp_path, monkeypatch, error):
    def acquire(self, timeout=None, **_more):
        raise error

    monkeypatch.setattr(filelock.FileLock, "acquire", acquire)
    told = []
    with lock.locked(tmp_path / "out", notice=told.append):
        pass
    assert len(told) == 1
    assert "has no locks: start no second run" in told[0]
