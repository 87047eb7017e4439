# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Both halves of a step, each compiled as one function that works in fields made once.

`predict` is momentum, and the projection up to the pressure jump that the predicted wall velocity
makes; `correct` finishes the projection with the final one.  A fresh array costs more than the
arithmetic that fills it: only what a state or a prediction keeps is new.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume import adi, mapping, momentum, poisson, projection
from dewing_sim.fluid.finite_volume.loads import jump_of
from dewing_sim.machine.kernels import kernel, stage

FASTEST = 50.0                      # |u| in free-stream speeds beyond which a run has diverged


@dataclass(frozen=True)
class FlowState:
    """Everything the next step depends on; faces as in `Grid`, speeds in U."""

    u: np.ndarray                   # (nx + 1, ny)
    v: np.ndarray                   # (nx, ny + 1)
    fx: np.ndarray                  # Fx, flux through xi-faces
    w: np.ndarray                   # Fy - g Y_t, flux through the moving eta-faces
    p: np.ndarray                   # (nx, ny) pressure in rho U^2
    u_before: np.ndarray            # one step earlier
    v_before: np.ndarray
    fx_before: np.ndarray
    w_before: np.ndarray
    height: np.ndarray              # wall heights at the column faces
    velocity: np.ndarray            # wall velocities of the columns
    circulation: float              # of wing and wake together, in U c

    @classmethod
    def resting(cls, u: np.ndarray, v: np.ndarray, fx: np.ndarray, w: np.ndarray, p: np.ndarray,
                wall: Wall, circulation: float) -> 'FlowState':
        """Return a flow that has been the same one step earlier."""
        return cls(u=u, v=v, fx=fx, w=w, p=p, u_before=u, v_before=v, fx_before=fx, w_before=w,
                   height=wall.height, velocity=wall.velocity, circulation=circulation)

    @property
    def past(self) -> tuple[np.ndarray, ...]:
        """The fields of the last two instants, a `Past`."""
        return (self.u, self.u_before, self.v, self.v_before, self.p, self.fx, self.fx_before,
                self.w, self.w_before)

    def followed_by(self, u: np.ndarray, v: np.ndarray, fx: np.ndarray, w: np.ndarray,
                    p: np.ndarray, height: np.ndarray, velocity: np.ndarray) -> 'FlowState':
        """Return the state one step later."""
        return FlowState(u=u, v=v, fx=fx, w=w, p=p, u_before=self.u, v_before=self.v,
                         fx_before=self.fx, w_before=self.w, height=height, velocity=velocity,
                         circulation=self.circulation)


class Past(NamedTuple):
    """The last two instants, see `FlowState`."""

    u: np.ndarray
    u_before: np.ndarray
    v: np.ndarray
    v_before: np.ndarray
    p: np.ndarray
    fx: np.ndarray
    fx_before: np.ndarray
    w: np.ndarray
    w_before: np.ndarray


class Before(NamedTuple):
    """What the projection corrects: predicted fluxes, and the old pressure."""

    fx: np.ndarray
    fy: np.ndarray
    p: np.ndarray


class After(NamedTuple):
    """What it fills, see `FlowState`."""

    u: np.ndarray
    v: np.ndarray
    fx: np.ndarray
    w: np.ndarray
    p: np.ndarray


@kernel
def predict(solver, u, u_before, v, v_before, p, fx, fx_before, w, w_before, height,
            velocity, velocity_before, before, behind, p_outlet):
    """Return what `correct` needs, the pressure jump, the largest deflection and if all is finite.

    ``solver`` holds the `Solver`; fields are those of a `FlowState`, ``before`` and ``behind``
    the velocities of the edges, ``p_outlet`` (ny,) is given behind.
    """
    solver = solver.value
    m = mapping.metrics_of(height, velocity, before, behind, solver.following)
    past = Past(u, u_before, v, v_before, p, fx, fx_before, w, w_before)
    _velocities(past, m, velocity - velocity_before, p_outlet, solver)
    lattice, fields, theta = solver.lattice, solver.fields, solver.theta
    fx, fy = np.empty(u.shape), np.empty(v.shape)
    projection.to_fluxes(fields.u, fields.v, lattice, m, solver.g, fx, fy)
    even_hat, odd_hat, increment = poisson.forward(fx, fy, lattice.dx, lattice.dy, theta,
                                                   solver.poisson)
    jump = jump_of(p, lattice) - increment
    return (fx, fy, even_hat, odd_hat, increment, jump, np.abs(height).max(),
            np.isfinite(jump).all())


@stage
def _velocities(past, m, wall_change, p_outlet, solver):
    """Fill u and v of the solver's fields: they satisfy momentum with the old pressure."""
    f = solver.fields
    momentum.eliminate_u(past, m, p_outlet, solver, f)
    adi.finish(past.u, f.south, f.north, f.drag, f.ratio, f.r, f.u)
    momentum.eliminate_v(past, m, wall_change, solver, f)
    adi.finish(past.v, f.south, f.north, f.drag, f.ratio, f.r, f.v)


@kernel
def velocities(solver, past, m, wall_change, p_outlet):
    """Do the momentum half alone, for those who time it."""
    _velocities(past.value, m.value, wall_change, p_outlet, solver.value)


@kernel
def correct(solver, fx, fy, even_hat, odd_hat, increment, p, height, predicted, velocity, before,
            behind):
    """Return u, v, Fx, W and p after the step, and whether u is sound.

    ``predicted`` is the wall velocity of `predict`, ``velocity`` the final one.
    """
    solver = solver.value
    m = mapping.metrics_of(height, velocity, before, behind, solver.following)
    change = velocity - predicted
    dx = solver.lattice.dx[solver.lattice.leading:solver.lattice.trailing]
    halves = poisson.backward(even_hat, odd_hat, increment + np.dot(solver.impedance, change),
                              dx * change / solver.theta, solver.poisson)
    after = After(np.empty(fx.shape), np.empty(fy.shape), np.empty(fx.shape), np.empty(fy.shape),
                  np.empty(p.shape))
    projection.correct(Before(fx, fy, p), halves, m, solver, after)
    faults = 0
    for i in range(fx.shape[0]):
        for j in range(fx.shape[1]):
            faults += not abs(after.u[i, j]) < FASTEST
    return after.u, after.v, after.fx, after.w, after.p, faults == 0
