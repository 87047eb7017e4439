# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of a controller's parameters; gains and set-points are normalised.

Camber is measured in passive cambers a_ref and V^2 in V_L^2, its value at the loss of tension;
the wing's identity supplies both.
"""

from dataclasses import dataclass

from dewing_sim.parameters import choice, count, real


@dataclass(frozen=True)
class Reference:
    """What the camber shall follow."""

    output: str = choice('camber fed back', 'camber_mean', 'camber_max')
    target: float = real('-', 'wanted camber as a multiple of the passive one', 0.0, 10.0)
    rate: float = real('1/s', 'largest rate of change of the reference', 1.0e-6, 1.0e6)


@dataclass(frozen=True)
class PidGains:
    """PID of a/a_ref to V^2/V_L^2 (paper eq. 10)."""

    kp: float = real('-', 'proportional gain', 0.0, 1.0e6)
    ki: float = real('1/s', 'integral gain', 0.0, 1.0e9)
    kd: float = real('s', 'derivative gain', 0.0, 1.0e6)
    derivative_filter: float = real(
        's', 'time constant of the derivative filter', 0.0, 1.0e3)
    tracking_time: float = real(
        's', 'time constant of the anti-windup back-calculation', 1.0e-9, 1.0e3)


@dataclass(frozen=True)
class Command:
    """How V^2 is issued."""

    voltage_limit: float = real('V', 'largest voltage the controller asks for', 0.0, 1.0e5)
    period_steps: int = count('steps of the plant in one control period', 1, 100000)
    hold_steps: int = count(
        'unusable measurements in a row answered with the last V^2, zero afterwards', 0, 1000000)


@dataclass(frozen=True)
class ControllerSettings:
    """All parameters of the controller."""

    reference: Reference
    pid: PidGains
    command: Command
