# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A Kalman filter for the wing and for what disturbs it.

The state z = (x, d, s1, s2, ...) holds the states of the model, a drifting load d and the phasors
of loads at n f, n = 1 ... harmonics, all acting where w does:

    x+ = A x + B (w - u0 + d + s1 + ...),   d+ = d,   s+ = rotation(2 pi n f T) s,   a = 1 + C x

(internal model principle, Francis and Wonham 1976, doi:10.1016/0005-1098(76)90006-6). The
stationary filter solves the discrete Riccati equation for white noise on w, d and the phasors,
with intensities relative to that of the measurement.
"""

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from dewing_control.law.base import DisturbanceModel
from dewing_control.model.design import Design
from dewing_sim.parameters import real


@dataclass(frozen=True)
class Estimator:
    """Standard deviations a sample of the Kalman filter; normalised."""

    sensor_noise: float = real('-', 'noise of the measured camber, in a_ref', 1.0e-9, 1.0)
    load_noise: float = real('-', 'white load on the membrane, in V_L^2', 0.0, 1.0e3)
    drift: float = real('-', 'increments of the drifting load, in V_L^2', 1.0e-12, 1.0e3)
    oscillation: float = real(
        '-', 'increments of the phasors of the periodic load, in V_L^2', 1.0e-12, 1.0e3)


@dataclass(frozen=True, eq=False)
class Observer:
    """Matrices of z (m,) and the filter's gain (m,)."""

    design: Design
    transition: np.ndarray          # (m, m)
    inlet: np.ndarray               # (m,), of w - u0
    outlet: np.ndarray              # (m,), a = 1 + outlet z
    load: np.ndarray                # (m,), the disturbing load is load z
    gain: np.ndarray                # (m,)

    @classmethod
    def of(cls, design: Design, disturbance: DisturbanceModel, estimator: Estimator,
           ) -> 'Observer':
        """Return the stationary Kalman filter for ``design`` and the disturbances described.

        Its gain corrects before the prediction: `control.dlqe` gives transition times gain. The
        solver is the same, without the second in which a flying node would import it.
        """
        rotation, load = exosystem(disturbance, design.dt)
        order, extra = design.order, load.size
        transition = np.block([[design.a, np.outer(design.b, load)],
                               [np.zeros((extra, order)), rotation]])
        inlet = np.concatenate([design.b, np.zeros(extra)])
        outlet = np.concatenate([design.c, np.zeros(extra)])
        noise = np.concatenate([[estimator.drift], np.full(extra - 1, estimator.oscillation)])
        process = linalg.block_diag(estimator.load_noise**2 * np.outer(design.b, design.b),
                                    np.diag(noise**2))
        covariance = linalg.solve_discrete_are(
            transition.T, outlet[:, None], process, np.array([[estimator.sensor_noise**2]]))
        gain = covariance @ outlet / (
            outlet @ covariance @ outlet + estimator.sensor_noise**2)
        return cls(design, transition, inlet, outlet,
                   np.concatenate([np.zeros(order), load]), gain)

    def begin(self, camber: float, w: float) -> np.ndarray:
        """Return the z in which ``camber`` is steady under ``w`` and a constant load."""
        deviation = (camber - 1.0) / self.design.static_gain
        z = np.zeros(self.inlet.size)
        z[:self.design.order] = deviation * self.design.steady
        z[self.design.order] = deviation - (w - self.design.operating_input)
        return z

    def correct(self, z: np.ndarray, camber: float) -> np.ndarray:
        """Return z after a measurement of the normalised camber."""
        return z + self.gain * (camber - 1.0 - self.outlet @ z)

    def predict(self, z: np.ndarray, w: float) -> np.ndarray:
        """Return z one sampling time later with ``w`` held."""
        return self.transition @ z + self.inlet * (w - self.design.operating_input)


def exosystem(disturbance: DisturbanceModel, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Return transition (e, e) and outlet (e,) of a drift and of the harmonics' phasors."""
    blocks, outlet = [np.ones((1, 1))], [1.0]
    for angle in disturbance.angles(dt):
        cosine, sine = np.cos(angle), np.sin(angle)
        blocks.append(np.array([[cosine, sine], [-sine, cosine]]))
        outlet += [1.0, 0.0]
    return linalg.block_diag(*blocks), np.array(outlet)
