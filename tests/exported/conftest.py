"""Designs as interfaces of C, each once."""

from functools import cache

import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.exported.code import sources
from fddbench.exported.interface import interface_of
from fddbench.runner.assembling import assemble


@cache
def assembled(campaign):
    """Assembly of a shipped campaign."""
    return assemble(read_campaign(gallery.folder("campaigns") / f"{campaign}.yaml"))


@cache
def exported(campaign, name):
    """Interface of a detector, and its header and source."""
    assembly = assembled(campaign)
    own = assembly.detectors[name]
    interface = interface_of(own, assembly.loop.bus, name=name)
    return interface, *sources(interface, own.detector).values()


@cache
def traceable():
    """Campaign and name of every shipped design that can be traced, each design once."""
    found = {}
    for path in sorted(gallery.folder("campaigns").glob("*.yaml")):
        assembly = assembled(path.stem)
        for design in assembly.plan.campaign.designs:
            if not assembly.detectors[design.name].opaque:
                found.setdefault(design.base, (path.stem, design.name))
    return found


@pytest.fixture
def voting_monitor():
    return exported("smoke", "voting_monitor")
