# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which control law a kind names."""

from dewing_control.law.supervisor import Controller
from dewing_control.model import design
from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings
from dewing_sim.identity import Identity


def law(settings: ControllerSettings, identity: Identity, model: Design | None = None,
        ) -> Controller:
    """Return the law that ``settings.kind`` names, for the plant of ``identity``.

    ``model`` is what lqg and mpc are designed on, by default that in the file ``settings.model``.
    Raises `BadInput` if it is missing or unusable.
    """
    if settings.kind == 'pid':
        from dewing_control.law.pid import Pid
        return Pid.of(settings, identity)
    if settings.kind == 'periodic':
        from dewing_control.law.periodic import Periodic
        return Periodic.of(settings, identity)
    model = model or design.load(settings.model, settings.reference.output,
                                 settings.command.period_steps * identity.dt)
    if settings.kind == 'lqg':
        from dewing_control.law.lqg import Lqg
        return Lqg.of(settings, identity, model)
    from dewing_control.law.mpc import Mpc
    return Mpc.of(settings, identity, model)
