# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The steady wing that modes are perturbations of: marched to, or solved for where it is unstable.

Newton's method solves F^N(x) - x = 0. Each correction d from (1 - P) d = F^N(x) - x needs P only
on vectors: GMRES in the Krylov space of the residual, by the same differences as the modes. The N
steps precondition: what decays within them costs no vector.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import NotConverged, RunFailed
from dewing_sim.modes.coordinates import Coordinates
from dewing_sim.modes.krylov import gmres
from dewing_sim.modes.propagator import Propagator, of_kick
from dewing_sim.parameters import Case
from dewing_sim.state import State
from dewing_sim.wing import Wing

TOLERANCE = 1.0e-6          # of the coupling: perturbations are small
ITERATIONS = 20             # of the coupling, at least
DRIFT = 0.01                # of a settled base within a period, relative to a perturbation
LOOK = 2.0                  # c/U between two looks at the drift
HORIZON = 1.2               # c/U, N dt of Newton's method
NEWTON, VECTORS = 12, 60    # most corrections, and vectors for one
LINEAR = 1.0e-2             # residual of a correction, relative
STEADY = 5.0e-3             # residual of a steady state, relative to a perturbation
BRIEF = 1.0e-3              # s, within which a kick gives a perturbation its size
STEP = 0.5                  # degrees between two steady states of a continuation

Progress = Callable[[int, int], None]


def undisturbed(case: Case) -> Case:
    """Return ``case`` without anything that acts in time, coupled tightly enough for modes."""
    numerics = case.numerics
    return parameters.replace(case, {
        'disturbance.pressure': 0.0, 'gust.shape': 'none', 'rigid_motion.shape': 'none',
        'numerics.coupling_tolerance': min(numerics.coupling_tolerance, TOLERANCE),
        'numerics.coupling_iterations': max(numerics.coupling_iterations, ITERATIONS)})


def settled(wing: Wing, period: float, longest: float, progress: Progress | None = None) -> State:
    """Return the wing marched on from its rest state until it no longer moves.

    ``period`` (s) is that of the propagator to come. Raises `RunFailed` after ``longest`` c/U.
    """
    state = replace(wing.rest(progress), step=0)
    steps = max(1, round(period / wing.dt))
    look = max(1, round(LOOK * wing.scales.time / wing.dt))
    looks = max(1, round(longest / LOOK))
    march = Propagator(wing, state, look)
    for done in range(looks + 1):
        drift = of_kick(wing, state, steps)[0].drift()
        if drift < DRIFT:
            return state
        state = replace(march.march(state), step=0)
        if progress:
            progress(done, looks)
    raise RunFailed(
        f'the wing is not steady {longest:g} c/U after its trim: in {1.0e3 * period:g} ms it '
        f'moves by {drift:.2g} of a perturbation, {DRIFT:g} are borne; take a longer --settle, or '
        '--base steady for a wing that sheds or flutters')


def steady(wing: Wing, guess: State) -> State:
    """Return the steady state next to ``guess``, stable or not, by Newton's method.

    Raises `NotConverged` if the residual does not fall; a flow that diverges on the way does too.
    """
    state = replace(guess, step=0)
    steps = max(1, round(HORIZON * wing.scales.time / wing.dt))
    kicked = of_kick(wing, state, max(1, round(BRIEF / wing.dt)))[0]
    for _correction in range(NEWTON):
        propagator = replace(kicked, base=state, steps=steps)
        vector = propagator.coordinates.vector
        after = propagator.march(state)
        residual = vector(after) - vector(state)
        norm = float(np.linalg.norm(residual))
        if norm < STEADY * kicked.size:
            return replace(after, step=0)
        state = _corrected(propagator, residual)
    raise NotConverged(f'the steady wing: after {NEWTON} corrections it still moves by '
                       f'{norm / kicked.size:.3g} of a perturbation in {HORIZON:g} c/U')


def _corrected(propagator: Propagator, residual: np.ndarray) -> State:
    """Return the base of ``propagator`` after one correction for its ``residual`` (n,)."""
    coordinates = propagator.coordinates
    correction = gmres(lambda v: v - propagator(v), residual, VECTORS, LINEAR)
    return replace(coordinates.state(coordinates.vector(propagator.base) + correction), step=0)


def continued(case: Case, progress: Progress | None = None, start: float = 4.0,
              ) -> tuple[Wing, State]:
    """Return the wing of ``case`` and its steady state, followed from ``start`` degrees.

    Each angle starts from the line through the last two steady states.
    """
    target = case.flow.angle_of_attack_deg
    start = float(np.copysign(min(start, abs(target)), target))
    angles = np.linspace(start, target, 1 + int(np.ceil(abs(target - start) / STEP)))
    past: list[tuple[float, State]] = []
    for done, angle in enumerate(angles):
        wing = Wing(parameters.replace(case, {'flow.angle_of_attack_deg': float(angle)}))
        past.append((angle, steady(wing, _foreseen(past, angle) or wing.rest())))
        if progress:
            progress(done + 1, len(angles))
    return wing, past[-1][1]


def _foreseen(past: list[tuple[float, State]], angle: float) -> State | None:
    """Return the state at ``angle`` on the line through the last two, if there is any."""
    if not past:
        return None
    last_angle, last = past[-1]
    if len(past) == 1:
        return last
    before_angle, before = past[-2]
    coordinates = Coordinates(last)
    share = (angle - last_angle) / (last_angle - before_angle)
    end = coordinates.vector(last)
    return coordinates.state(end + share * (end - coordinates.vector(before)))
