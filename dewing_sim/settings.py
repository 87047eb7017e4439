# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of the simulator node's own parameters; those of the case stand beside them."""

from dataclasses import dataclass

from dewing_sim.parameters import choice, count, flag, real, text


@dataclass(frozen=True)
class Run:
    """How the simulator keeps step; time-outs are in wall time, rates in simulated time."""

    plant: str = choice('what is simulated', 'wing', 'reduced', open=True)
    mode: str = choice(
        'wait for the command that answers each measurement, or step on with the last one, '
        'paced or as fast as it goes', 'lockstep', 'realtime', 'free')
    rate: float = real('-', 'simulated over wall time in mode realtime', 1.0e-6, 1.0e3)
    duration: float = real('s', 'simulated time after which the run ends, 0: never', 0.0, 1.0e6)
    subscribers: int = count('listeners to measurement to wait for before the first step', 0, 100)
    discovery_timeout: float = real(
        's', 'longest wait for listeners and a controller before the first step', 0.1, 1.0e6)
    command_timeout: float = real(
        's', 'wait for a valid command after which a warning is published', 0.01, 1.0e6)
    hold_timeout: float = real(
        's', 'further wait, with the last command held, after which the run stops', 0.0, 1.0e6)
    resend_period: float = real(
        's', 'wait after which an unanswered measurement is published again', 0.05, 1.0e3)
    delivery_timeout: float = real(
        's', 'longest wait at the end for slow listeners to take every message', 0.0, 1.0e6)
    save_steps: int = count('steps between two saves of the state, 0: at the end', 0, 10**9)
    step_count: int = count('steps that one call of the service step makes', 1, 1000000)
    scalar_rate: float = real('Hz', 'rate of clock, scalars and loads', 1.0e-3, 1.0e9)
    membrane_rate: float = real('Hz', 'rate of the membrane shape', 1.0e-3, 1.0e9)
    publish_clock: bool = flag('whether simulated time is published on clock_topic', default=True)
    clock_topic: str = text('topic of simulated time; relative names stand in the namespace of '
                            'the node', default='/clock')
    marker_exaggeration: float = real(
        '-', 'factor on the deflection in membrane_marker', 1.0e-3, 1.0e6)


@dataclass(frozen=True)
class Following:
    """How gust and motion that come over topics are followed."""

    smoothing: float = real(
        's', 'lag within which gust and motion follow their messages, at least two time steps',
        1.0e-6, 10.0)


@dataclass(frozen=True)
class SimulatorSettings:
    """Parameters of the simulator that do not belong to the case."""

    case: str = text('shipped case or YAML file the wing is built from')
    model: str = text('npz file of the reduced plant')
    save: str = text('npz file for the last state; after a failure dewing_state.npz if empty')
    restore: str = text('npz file of a saved state to start from, the rest state if empty')
    run: Run

    ros_node = 'simulator'
    inputs: Following
