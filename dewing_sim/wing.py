# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupled wing: a Navier-Stokes flow about a dielectric-elastomer membrane.

This file is the algorithm of the paper (section 2) on one screen: a V^2 held over the step changes
the tension of the membrane, and flow and membrane are solved together until the shape no longer
changes.
"""

import math
from dataclasses import replace

import numpy as np

from dewing_sim.coupling import engine_choice, transfer
from dewing_sim.coupling.iteration import Coupling
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Monitor
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.fluid.plate import starting_circulation
from dewing_sim.inputs.amplifier import Amplifier
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.sources import Motion, Pressure, Sources
from dewing_sim.machine import compilation
from dewing_sim.parameters import Case
from dewing_sim.plant import Measurement, Outputs, instant
from dewing_sim.rest import trim
from dewing_sim.scales import Scales
from dewing_sim.state import State
from dewing_sim.structure import elements
from dewing_sim.structure.bearable import Bearable
from dewing_sim.structure.camber import camber
from dewing_sim.structure.dynamics.step import Operator
from dewing_sim.structure.material.elastomer import VACUUM_PERMITTIVITY
from dewing_sim.structure.material.limits import require_tension


class Wing:
    """An immutable membrane wing in a flow, a `plant.Plant`.

    A user's functions of time (s) add to what the case says: ``wall_pressure(time)`` is a uniform
    pressure jump as a fraction of q, positive if it presses the camber up; ``gust(time)`` the
    gust's speeds (along the free stream, upwards) in m/s; ``motion(time)`` the heave in m and the
    pitch in rad, about the pivot of the case, both zero at first. Gust and motion have to be
    smooth, since their rates act too: interpolate a table by a spline. All are sampled at the end
    of every time step dt, so what is faster than 1/(2 dt) acts as something slower.
    """

    def __init__(self, case: Case, *, wall_pressure: Pressure | None = None,
                 gust: Motion | None = None, motion: Motion | None = None):
        """Prepare the solvers of ``case``."""
        compilation.prepare()
        self.dt = case.numerics.time_step
        self.scales = Scales.of(case.flow, case.membrane.chord)
        self.membrane = elements.make(case.membrane, self.scales)
        self.v_squared_slack = self.membrane.sheet.loss_of_tension_v_squared(
            case.membrane.prestretch)
        require_tension(case.membrane.prestretch, math.sqrt(self.v_squared_slack), {
            f'actuation.{name} =': getattr(case.actuation, name)
            for name in ('voltage', 'voltage_limit')}, case.actuation.slack_margin)
        self.bearable = Bearable(self.membrane, case.actuation.slack_margin)
        self.amplifier = Amplifier.of(case.actuation)
        self.sources = Sources.of(case, self.scales, wall_pressure, gust, motion)
        self.case = engine_choice.settled(case, self.membrane, self.scales,
                                          not self.sources.inflow_schedule.is_steady)
        self.fluid = engines.make(
            self.case.numerics.engine, case.numerics.grid, self.scales.reynolds,
            case.flow.angle_of_attack, self.dt / self.scales.time)
        self._centres = 0.5 * (self.fluid.columns[1:] + self.fluid.columns[:-1])
        self._permittivity = VACUUM_PERMITTIVITY * case.membrane.relative_permittivity
        self._coupling = self.coupling()

    def rest(self, progress=None) -> State:
        """Return the trimmed state at time 0 under the voltage of the case, cached on disk.

        ``progress(done, total)`` is called along the way if the state has to be computed.
        """
        return trim.rest(self, progress)

    def step(self, state: State, inputs: Inputs) -> State:
        """Return the state one ``dt`` later with ``inputs`` held, beside the wing's own sources.

        The amplifier, ideal by default, makes the electrodes' V^2 of the command, which is
        clipped below the loss of tension of the present shape. Raises `BadInput` for a V^2 that
        is negative or not finite, `NotConverged`, `Diverged` or `Slack` with the last good state.
        """
        if not 0.0 <= inputs.v_squared < math.inf:
            raise BadInput(f'v_squared = {inputs.v_squared!r} V^2 is out of range: zero or more')
        v_squared = self.amplifier.drive(state.v_squared, inputs.v_squared, self.dt)
        bearable = self.bearable(state.motion, state.v_squared)
        clipped = state.clipped + (v_squared > bearable)
        acting = self.sources.at((state.step + 1) * self.dt,
                                 Inputs(min(v_squared, bearable), inputs.wall_pressure,
                                        inputs.inflow))
        after = self.couple(state, acting, self._coupling)
        return replace(after, clipped=clipped) if clipped else after

    def incidence(self, state: State) -> float:
        """Return the angle of the chord to the undisturbed stream in rad, nose up."""
        return getattr(state.flow, 'incidence', self.fluid.alpha)

    @property
    def open_to(self) -> frozenset[str]:
        """What may disturb it from outside, see `inputs.outside`; the engine meets inflows."""
        return self.fluid.inflows | {'pressure_disturbance'}

    def meets(self, time: float, gust: np.ndarray, motion: np.ndarray) -> Inflow:
        """Return its inflow at ``time`` (s) with a gust and a motion from outside added.

        ``gust`` (2, 2) holds speeds along the stream and upwards in m/s and their rates,
        ``motion`` (3, 2) heave in m and pitch in rad with their first two derivatives.
        """
        return self.sources.meets(time, gust, motion, self.scales)

    def couple(self, state: State, inputs: Inputs, coupling: Coupling) -> State:
        """Advance flow and membrane by one step; failures carry ``state`` and its time."""
        try:
            return coupling.advance(state, inputs)
        except RunFailed as error:
            message = f'step {state.step + 1} (t = {(state.step + 1) * self.dt:.6g} s): {error}'
            raise type(error)(message, state) from None

    def coupling(self, damping: float = 0.0) -> Coupling:
        """Return flow and membrane, damped in proportion to its mass by ``damping`` (U/c).

        The membrane's iteration operator is made about the static shape under the lift of
        thin-aerofoil theory, near which the wing will move: that only saves iterations.
        """
        mean_jump = starting_circulation(self.case.flow.angle_of_attack, 0.0)   # Cl / 2
        v_squared = self.case.actuation.voltage**2
        operator = Operator.of(
            self.membrane, self.dt / self.scales.time,
            transfer.nodal_impedance(self.fluid, self.membrane), damping,
            self.membrane.equilibrium(mean_jump, v_squared), v_squared)
        numerics = self.case.numerics
        return Coupling(self.fluid, self.membrane, operator, numerics.coupling_tolerance,
                        numerics.coupling_iterations)

    def observe(self, state: State) -> Outputs:
        """Return the outputs of ``state`` in SI units."""
        chord = self.scales.length
        loads = self.fluid.loads(state.flow)
        line = self.membrane.surface(state.motion.position)
        mean, largest, place = camber(line)
        x, y = line.T
        sheet = self.membrane.settled(state.motion).respond(state.motion.position, state.v_squared)
        return Outputs(
            time=state.step * self.dt, v_squared=state.v_squared,
            cl=loads.cl, cd=loads.cd, cm=loads.cm,
            camber_mean=chord * mean, camber_max=chord * largest, camber_max_position=place,
            tension=self.scales.tension * float(sheet.tension.sum()) / sheet.tension.size,
            electric_field=math.sqrt(state.v_squared) / (chord * float(sheet.thickness.min())),
            capacitance=self._permittivity * electrode_ratio(x, y, sheet.thickness),
            coupling_iterations=state.iterations, clipped=state.clipped,
            x=chord * x, y=chord * y,
            pressure_jump=self.scales.pressure * np.interp(x, self._centres, loads.jump))

    def measure(self, state: State) -> Measurement:
        """Return the measured outputs of ``state``, those of `observe`."""
        chord, loads = self.scales.length, self.fluid.loads(state.flow)
        mean, largest, _ = camber(self.membrane.surface(state.motion.position))
        return Measurement(
            time=instant(state.step * self.dt), camber_mean=chord * mean,
            camber_max=chord * largest, cl=loads.cl, cd=loads.cd, v_squared=state.v_squared)

    def monitor(self, state: State) -> Monitor:
        """Return how near the flow of ``state`` is to the largest time step it bears."""
        return self.fluid.monitor(state.flow)

    def caution(self, state: State) -> str:
        """Return the warning of the flow, none within a convective time of its start."""
        if state.step * self.dt <= self.scales.time:
            return ''
        return self.fluid.caution(state.flow)

    @property
    def reference_deflection(self) -> float:
        """y_ref = q c^2 / (8 T0) in m: the deflection of a string under a uniform pressure q."""
        tension = self.membrane.rest_tension(0.0) * self.scales.tension
        return self.case.flow.dynamic_pressure * self.scales.length**2 / (8.0 * tension)


def electrode_ratio(x: np.ndarray, y: np.ndarray, thickness: np.ndarray) -> float:
    """Return the integral of ds / h over the arc s of nodes ``x, y`` (n+1,), h (n,) between them.

    Times the permittivity that is the capacitance per unit span: the field V/h crosses the
    deformed sheet, whose electrodes lie along the arc.
    """
    return float(np.hypot(x[1:] - x[:-1], y[1:] - y[:-1]) @ (1.0 / thickness))
