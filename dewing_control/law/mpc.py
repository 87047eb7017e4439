# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Linear model predictive control: LQG that foresees the bounds of V^2.

The prediction corrects the LQG law by c, held over blocks of growing length,

    w_j = w_r - load_j - K (x_j - x_r) + c_b(j),     x_j - x_r advancing with A - B K,

which costs (rho + B^T P B) sum c^2 more than LQG (completion of squares with the Riccati cost P).
So the programme is  min c^T H c  with diagonal H, subject at the start of each block to
0 <= w <= w_max and |w_b - w_b-1| <= rate limit; its matrices are constant and only bounds change.
Each block moves its own row, so w = w_applied is always feasible. Where V^2 was above its limit,
the limit counts as applied, and is held as long as LQG would: the governor lowers the reference at
once, and V^2 would dip below the limit to brake the fall. Where LQG satisfies the bounds c = 0 is
the solution. Otherwise OSQP (Stellato et al. 2020, doi:10.1007/s12532-020-00179-2) solves
it, factorised once and warm-started from the memory.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from dewing_control.law import lqg
from dewing_control.law.base import Law, Settings
from dewing_control.law.lqg import Lqg
from dewing_control.model.design import Design
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.linear.state_space import Matrices
from dewing_sim.parameters import count, real
from dewing_sim.plant import Measurement

TOLERANCE = 1.0e-6          # of the programme, in V_L^2
MOST_ITERATIONS = 600       # which bound the time of a step; bounds hold whatever is left
PENALTY = 5.0               # of ADMM, which needs fewest iterations here


@dataclass(frozen=True)
class Predictive:
    """What is predicted."""

    horizon: float = real('s', 'time over which the bounds of V^2 are foreseen', 1.0e-6, 10.0)
    moves: int = count('blocks of constant correction in the horizon', 1, 200)
    rate_limit: float = real(
        '1/s', 'largest rate of change of V^2/V_L^2', 1.0e-3, 1.0e9)


class Memory(NamedTuple):
    """Memory of the LQG part and the solution to start from."""

    base: lqg.Memory
    primal: np.ndarray
    dual: np.ndarray
    falling: bool = False           # from a voltage above the limit, which is held meanwhile


@dataclass(frozen=True, eq=False)
class Prediction:
    """w - u0 at the start of each block: hold (w_r - u0) - gain z + effect c."""

    lengths: np.ndarray             # steps of each block, (blocks,)
    hold: np.ndarray                # (blocks,)
    gain: np.ndarray                # (blocks, states of the observer)
    effect: np.ndarray              # (blocks, blocks), unit lower triangular

    @classmethod
    def of(cls, base: Lqg, settings: Predictive) -> 'Prediction':
        """Return the predictions over ``settings.horizon``."""
        observer = base.observer
        model, feedback = observer.design, base.feedback
        lengths = block_lengths(settings.moves, round(settings.horizon / model.dt))
        closed = model.a - np.outer(model.b, feedback)
        starts = np.concatenate([[0], np.cumsum(lengths)[:-1]])
        load, regulation = observer.load, feedback
        loads, regulations = [], []
        for step in range(starts[-1] + 1):
            if step in starts:
                loads.append(load)
                regulations.append(regulation)
            load, regulation = load @ observer.transition, regulation @ closed
        gain, regulations = np.array(loads), np.array(regulations)
        gain[:, :model.order] += regulations
        return cls(lengths, 1.0 + regulations @ model.steady, gain,
                   _effect(model, feedback, closed, lengths))


def block_lengths(moves: int, steps: int) -> np.ndarray:
    """Return ``moves`` block lengths, growing geometrically from one, that fill ``steps``.

    Raises `BadInput` if there are fewer steps than moves.
    """
    if steps < moves:
        raise BadInput(f'mpc.horizon of {steps} control periods is too short for mpc.moves = '
                       f'{moves}')
    low, high = 1.0, float(steps)
    for _ in range(60):
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if _total(ratio, moves) < steps else (low, ratio)
    ends = np.round(np.cumsum(ratio ** np.arange(moves))).astype(int)
    ends = np.maximum(ends, np.arange(1, moves + 1))
    ends[-1] = max(steps, ends[-1])
    return np.diff(ends, prepend=0)


def _total(ratio: float, moves: int) -> float:
    return float(np.sum(np.power(ratio, np.arange(moves)).clip(max=1.0e9)))


def _effect(model: Design, feedback, closed, lengths) -> np.ndarray:
    """Return how c of each block shows in w at the start of the same and of later blocks."""
    starts = np.concatenate([[0], np.cumsum(lengths)])
    effect = np.eye(len(lengths))
    for block, length in enumerate(lengths):
        xi = np.zeros(model.order)
        for step in range(starts[block], starts[-2]):
            xi = closed @ xi + (model.b if step < starts[block] + length else 0.0)
            if step + 1 in starts:
                effect[np.searchsorted(starts, step + 1), block] = -feedback @ xi
    return effect


@dataclass(frozen=True, eq=False)
class Mpc(Law):
    """MPC from a camber in m to V^2 in V^2."""

    kind = 'mpc'
    title = 'MPC'
    about = ('the same, with 0 <= V^2 <= V_max^2 and a rate limit foreseen by OSQP, and a '
             "governor of the reference; `pip install 'dewing[mpc]'`")
    sections = {**Lqg.sections, 'mpc': Predictive}
    memory = (*Lqg.memory, 'mpc.moves')
    ranges = Lqg.ranges
    needs_model = True
    requires = {'osqp': 'dewing[mpc]'}

    base: Lqg
    prediction: Prediction
    rate_limit: float               # V_L^2 per s
    solver: Any                     # OSQP; each solution depends on what it is given alone

    @classmethod
    def of(cls, settings: Settings, identity: Identity, model: Design) -> 'Mpc':
        """Return the controller of ``settings``, designed on ``model``."""
        base = Lqg.of(settings, identity, model)
        prediction = Prediction.of(base, settings.mpc)
        return cls(base, prediction, settings.mpc.rate_limit, _solver(prediction))

    @property
    def v_squared_max(self) -> float:
        """Return the largest V^2 asked for."""
        return self.base.v_squared_max

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory of a controller that takes over, without a bump, at ``v_squared``."""
        blocks = len(self.prediction.lengths)
        return Memory(self.base.start(v_squared), np.zeros(blocks), np.zeros(2 * blocks))

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Return the next memory and V^2, which is never negative nor above the limit."""
        base, bound = self.base, self.v_squared_max / self.base.v_squared_reference
        sight = base.observe(memory.base, measurement)
        reference, z, scale = sight.reference, sight.ahead, sight.scale_ahead
        w_max = scale * base.v_squared_max / base.v_squared_reference
        applied = memory.base.command * scale
        falling = memory.falling or memory.base.command > bound
        if falling:
            applied = min(applied, w_max)
        w, primal, dual = self._solve(memory, z, self.govern(z, reference, w_max), applied, w_max)
        falling = falling and base.wanted(z, reference) >= w_max
        held, v_squared = base.command(memory.base, sight, w_max if falling else w)
        return Memory(held, primal, dual, falling), v_squared

    def govern(self, z: np.ndarray, reference: float, w_max: float) -> float:
        """Return w_r - u0 for the reference nearest to ``reference`` that is ever attainable.

        Attainable means that 0 <= w <= w_max holds at some phase of the disturbing load.
        """
        model = self.base.observer.design
        oscillation = z[model.order + 1:]
        swing = float(np.hypot(oscillation[::2], oscillation[1::2]).sum())
        drift = float(z[model.order]) - model.operating_input
        held = (reference - 1.0) / model.static_gain
        return min(max(held, drift - swing), w_max + drift + swing)

    def _solve(self, memory: Memory, z, held: float, applied: float, w_max: float):
        """Return w, c and the multipliers."""
        model, prediction = self.base.observer.design, self.prediction
        free = model.operating_input + held * prediction.hold - prediction.gain @ z
        change = self.rate_limit * model.dt * prediction.lengths
        step = np.empty_like(free)
        step[0], step[1:] = free[0] - applied, free[1:] - free[:-1]
        low = np.concatenate([-free, -change - step])
        high = np.concatenate([w_max - free, change - step])
        if low.max() <= 0.0 and high.min() >= 0.0:
            return float(free[0]), np.zeros_like(memory.primal), np.zeros_like(memory.dual)
        self.solver.update(l=low, u=high)
        self.solver.warm_start(x=memory.primal, y=memory.dual)
        solution = self.solver.solve(raise_error=False)
        w = min(max(float(free[0] + solution.x[0]), applied - change[0]), applied + change[0])
        return w, solution.x.copy(), solution.y.copy()

    def compensator(self) -> Matrices:
        """Return the law without bounds, which is LQG."""
        return self.base.compensator()


def _solver(prediction: Prediction) -> Any:
    """Return OSQP with the constant matrices factorised."""
    import osqp
    from scipy import sparse
    lengths, effect = prediction.lengths, prediction.effect
    rows = np.vstack([effect, np.diff(effect, axis=0, prepend=0.0)])
    bounds = np.full(len(rows), 1.0)
    solver = osqp.OSQP()
    solver.setup(sparse.diags(lengths.astype(float), format='csc'), np.zeros(len(lengths)),
                 sparse.csc_matrix(rows), -bounds, bounds, verbose=False, adaptive_rho=False,
                 eps_abs=TOLERANCE, eps_rel=TOLERANCE, max_iter=MOST_ITERATIONS,
                 check_termination=10, rho=PENALTY)
    return solver
