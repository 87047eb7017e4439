# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of a controller's parameters; gains and set-points are normalised.

Camber is measured in passive cambers a_ref and V^2 in V_L^2, its value at the loss of tension;
the wing's identity supplies both.
"""

from dataclasses import dataclass

from dewing_sim.parameters import choice, count, real, text

KINDS = ('pid', 'periodic', 'lqg', 'mpc')


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
class DisturbanceModel:
    """What kinds periodic, lqg and mpc know of a periodic disturbance."""

    frequency: float = real('Hz', 'fundamental frequency', 1.0e-3, 1.0e4)
    harmonics: int = count('harmonics cancelled, from the fundamental up', 0, 20)


@dataclass(frozen=True)
class Learning:
    """Kind periodic: PID with learnt feed-forward."""

    learning_rate: float = real(
        '1/s', 'rate at which the phasors learn', 0.0, 1.0e4)


@dataclass(frozen=True)
class Estimator:
    """Standard deviations a sample of the Kalman filter of kinds lqg and mpc; normalised."""

    sensor_noise: float = real('-', 'noise of the measured camber, in a_ref', 1.0e-9, 1.0)
    load_noise: float = real('-', 'white load on the membrane, in V_L^2', 0.0, 1.0e3)
    drift: float = real('-', 'increments of the drifting load, in V_L^2', 1.0e-12, 1.0e3)
    oscillation: float = real(
        '-', 'increments of the phasors of the periodic load, in V_L^2', 1.0e-12, 1.0e3)


@dataclass(frozen=True)
class Regulator:
    """Linear-quadratic regulator of kinds lqg and mpc."""

    states: str = choice('model it is designed on: of the main mode or as identified',
                         'fundamental', 'identified')
    control_weight: float = real(
        '-', 'cost rho of (V^2/V_L^2)^2 against that of (a/a_ref)^2', 1.0e-12, 1.0e6)


@dataclass(frozen=True)
class Predictive:
    """Kind mpc: what is predicted."""

    horizon: float = real('s', 'time over which the bounds of V^2 are foreseen', 1.0e-6, 10.0)
    moves: int = count('blocks of constant correction in the horizon', 1, 200)
    rate_limit: float = real(
        '1/s', 'largest rate of change of V^2/V_L^2', 1.0e-3, 1.0e9)


@dataclass(frozen=True)
class Command:
    """How V^2 is issued."""

    voltage_limit: float = real('V', 'largest voltage the controller asks for', 0.0, 1.0e5)
    period_steps: int = count('steps of the plant in one control period', 1, 100000)
    hold_steps: int = count(
        'unusable measurements in a row answered with the last V^2, zero afterwards', 0, 1000000)


@dataclass(frozen=True)
class ControllerSettings:
    """All parameters of the controller; sections that its kind does not use lie idle."""

    kind: str = choice('control law', *KINDS)
    model: str = text('npz file of the identified model, for kinds lqg and mpc')
    reference: Reference
    pid: PidGains
    disturbance_model: DisturbanceModel
    periodic: Learning
    estimator: Estimator
    lqg: Regulator
    mpc: Predictive
    command: Command
