# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Linear-quadratic-Gaussian control of the camber with disturbance cancellation.

The regulator minimises sum (a - r)^2 + rho (w + load - w_r)^2 on the design model, where w_r holds
the camber at r, and takes off the load that the observer sees:

    w = w_r - K (x - x_r) - load.

The observer is told the w that was applied after saturation, so there is nothing to wind up; the
drifting load gives integral action. V^2/V_L^2 = w/a undoes the bilinear action of V^2.

Commands that take effect n periods late are remembered until they do. The observer predicts the
state and the load n periods ahead under them, and the law acts on what it predicts, with the same
K: for a pure delay of the input that is the optimum (certainty equivalence).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import linalg

from dewing_control.law.base import DisturbanceModel, Law, Settings, ramp
from dewing_control.law.observer import Estimator, Observer
from dewing_control.model.design import Design
from dewing_sim.identity import Identity
from dewing_sim.linear.state_space import Matrices
from dewing_sim.parameters import choice, real
from dewing_sim.plant import Measurement

LEAST_CAMBER = 0.1          # of the passive one, below which w/a would be ill-conditioned


@dataclass(frozen=True)
class Regulator:
    """Linear-quadratic regulator."""

    states: str = choice('model it is designed on: of the main mode or as identified',
                         'fundamental', 'identified')
    control_weight: float = real(
        '-', 'cost rho of (V^2/V_L^2)^2 against that of (a/a_ref)^2', 1.0e-12, 1.0e6)


class Memory(NamedTuple):
    """What the next step depends on; V^2 in V_L^2, None before the first measurement."""

    reference: float | None
    z: np.ndarray | None            # predicted state of the observer
    command: float                  # V^2/V_L^2, the last
    pending: tuple[float, ...] = ()     # those that have yet to take effect, oldest first


class Sight(NamedTuple):
    """What is known at a measurement; ``ahead`` is when the next command takes effect."""

    reference: float                # ramped
    z: np.ndarray                   # corrected state of the observer
    scale: float                    # the camber in w = V^2 camber
    ahead: np.ndarray               # z then, without a delay now
    scale_ahead: float              # the camber then


@dataclass(frozen=True, eq=False)
class Lqg(Law):
    """LQG from a camber in m to V^2 in V^2."""

    kind = 'lqg'
    title = 'LQG'
    about = ('regulator and Kalman filter with a drifting load (integral action) and an '
             'oscillating one (disturbance model)')
    sections = {'disturbance_model': DisturbanceModel, 'estimator': Estimator, 'lqg': Regulator}
    memory = ('lqg.states', 'disturbance_model.harmonics')
    ranges = {'lqg.control_weight': (3.0e-3, 3.0), 'estimator.load_noise': (1.0e-2, 1.0),
              'estimator.drift': (1.0e-4, 0.1)}
    needs_model = True

    observer: Observer
    feedback: np.ndarray            # K (n,)
    output: str
    target: float
    rate: float                     # 1/s
    camber_reference: float         # a_ref in m
    v_squared_reference: float      # V_L^2
    v_squared_max: float
    delay: int = 0                  # periods by which V^2 takes effect late

    @classmethod
    def of(cls, settings: Settings, identity: Identity, model: Design) -> 'Lqg':
        """Return the controller of ``settings``, designed on ``model``."""
        reference, command = settings.reference, settings.command
        if settings.lqg.states == 'fundamental':
            model = model.fundamental()
        observer = Observer.of(model, settings.disturbance_model, settings.estimator)
        return cls(observer, regulator(model, settings.lqg.control_weight)[0],
                   reference.output, reference.target, reference.rate,
                   identity.passive(reference.output), identity.v_squared_slack,
                   min(command.voltage_limit**2, identity.v_squared_max),
                   delay=command.delay_periods)

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory of a controller that takes over, without a bump, at ``v_squared``."""
        command = v_squared / self.v_squared_reference
        return Memory(None, None, command, (command,) * self.delay)

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Return the next memory and V^2, which is never negative nor above the limit."""
        sight = self.observe(memory, measurement)
        return self.command(memory, sight, self.wanted(sight.ahead, sight.reference))

    def observe(self, memory: Memory, measurement: Measurement) -> Sight:
        """Return what is known at a measurement, and foreseen of the next command's effect."""
        camber = getattr(measurement, self.output) / self.camber_reference
        reference = ramp(memory.reference, camber, self.target,
                         self.rate * self.observer.design.dt)
        scale = max(camber, LEAST_CAMBER)
        z = memory.z
        if z is None:
            z = self.observer.begin(camber, memory.command * scale)
        z = self.observer.correct(z, camber)
        ahead, scale_ahead = z, scale
        for command in memory.pending:
            ahead = self.observer.predict(ahead, command * scale_ahead)
            scale_ahead = max(1.0 + float(self.observer.outlet @ ahead), LEAST_CAMBER)
        return Sight(reference, z, scale, ahead, scale_ahead)

    def command(self, memory: Memory, sight: Sight, wanted: float) -> tuple[Memory, float]:
        """Return the next memory and V^2 for a ``wanted`` w, within the limits of V^2."""
        command = min(max(wanted / sight.scale_ahead, 0.0),
                      self.v_squared_max / self.v_squared_reference)
        v_squared = min(command * self.v_squared_reference, self.v_squared_max)
        acting, *pending = *memory.pending, command
        z = self.observer.predict(sight.z, acting * sight.scale)
        return Memory(sight.reference, z, command, tuple(pending)), v_squared

    @cached_property
    def gain(self) -> np.ndarray:
        """Row vector (m,) of the observer's state: K on x and the load taken off."""
        gain = self.observer.load.copy()
        gain[:self.feedback.size] += self.feedback
        return gain

    @cached_property
    def hold(self) -> float:
        """Part of w for each unit of w_r - u0: 1 + K (I - A)^-1 B."""
        return 1.0 + float(self.feedback @ self.observer.design.steady)

    def wanted(self, z: np.ndarray, reference: float) -> float:
        """Return w without its limits."""
        model = self.observer.design
        held = (reference - 1.0) / model.static_gain
        return model.operating_input + held * self.hold - float(self.gain @ z)

    def compensator(self) -> Matrices:
        """Return the law without saturation, from r - a to w; its states are z and pending w."""
        observer, order, delay = self.observer, self.gain.size, self.delay
        corrected = np.eye(order) - np.outer(observer.gain, observer.outlet)
        line = np.eye(order + delay)[order:]            # rows that pick each w of the line
        now = np.hstack([corrected, np.zeros((order, delay))])      # z, from z and the line
        fresh = -observer.gain                                      # and from the error
        ahead, ahead_fresh = now, fresh
        for w in line:
            ahead = observer.transition @ ahead + np.outer(observer.inlet, w)
            ahead_fresh = observer.transition @ ahead_fresh
        wanted, direct = -self.gain @ ahead, -float(self.gain @ ahead_fresh)
        acting, *rest = *line, wanted                   # what acts now, what is remembered
        inlets = [0.0] * delay + [direct]
        a = np.vstack([observer.transition @ now + np.outer(observer.inlet, acting), *rest])
        b = np.concatenate([observer.transition @ fresh + observer.inlet * inlets[0], inlets[1:]])
        return Matrices.siso(a, b, wanted, direct)


def regulator(model: Design, control_weight: float) -> tuple[np.ndarray, np.ndarray]:
    """Return K (n,) and the cost P (n, n) of the regulator with rho = ``control_weight``.

    These are those of `control.dlqr`, which calls the same solver, without the second in which a
    flying node would import it.
    """
    cost = linalg.solve_discrete_are(model.a, model.b[:, None], np.outer(model.c, model.c),
                                     np.array([[control_weight]]))
    gain = model.b @ cost @ model.a / (control_weight + model.b @ cost @ model.b)
    return gain, cost
