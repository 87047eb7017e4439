# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The sections of the report, one module each: ``section(plan, found)`` draws finished runs."""

from types import ModuleType

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report.drawing import LOOK
from dewing_cli.paper.report.section import Found, Missing, Section
from dewing_cli.paper.report.sections import (
    alpha8,
    contest,
    controller,
    energy_balance,
    fig5,
    lift,
    long_run,
    picture,
    pod,
    pulse,
    readings,
    resolution,
    scans,
    shapes,
    space_time,
)

PAPER = (resolution, shapes, lift, pod, space_time, pulse, controller, fig5)
BEYOND = (readings, scans, long_run, energy_balance, contest, alpha8, picture)


def make(plan: Plan, found: Found) -> list[Section]:
    """Return every section; one that lacks a run says so in its place."""
    import matplotlib
    with matplotlib.rc_context(LOOK):
        return [_make(module, plan, found) for module in PAPER + BEYOND]


def _make(module: ModuleType, plan: Plan, found: Found) -> Section:
    try:
        return module.section(plan, found)
    except Missing as error:
        name = module.__name__.rpartition('.')[2]
        title = module.__doc__.strip().splitlines()[0].rstrip('.')
        return Section(name, title, [f'Not available, because a run failed: {error}.'])
