"""Designs as interfaces of C, each once."""

from functools import cache

import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.exported.code import sources
from fddbench.exported.interface import interface_of
from fddbench.runner.assembling import assemble
from fddbench.runner.single import assembly_with

ALONE = "alone:"
"""Before the name of a design that is flown alone, on the first campaign that feeds it."""


@cache
def assembled(campaign):
    """Assembly of a shipped campaign, or of a design alone."""
    if campaign.startswith(ALONE):
        return assembly_with(campaign.removeprefix(ALONE), None)
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
    """Campaign and name of every shipped design that can be traced, each design once; those of no campaign alone."""
    found = {}
    for path in sorted(gallery.folder("campaigns").glob("*.yaml")):
        assembly = assembled(path.stem)
        for design in assembly.plan.campaign.designs:
            if not assembly.detectors[design.name].opaque:
                found.setdefault(design.base, (path.stem, design.name))
    for path in sorted(gallery.folder("detectors").glob("*.yaml")):
        if path.stem not in found and not assembled(ALONE + path.stem).detectors[path.stem].opaque:
            found[path.stem] = (ALONE + path.stem, path.stem)
    return found


@pytest.fixture
def voting_monitor():
    return exported("smoke", "voting_monitor")
