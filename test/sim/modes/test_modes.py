# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Modes of the Navier-Stokes wing, against its own marching in time."""

from dataclasses import replace

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.inputs.base import Inputs
from dewing_sim.modes import base_flow, modes
from dewing_sim.modes.coordinates import Coordinates
from dewing_sim.modes.propagator import Propagator
from dewing_sim.wing import Wing

COARSE = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
          'numerics.time_step': 5.0e-4, 'numerics.trim_time': 40.0}
PERIOD = 1.0e-3


def wing_of(**changes) -> Wing:
    return Wing(base_flow.undisturbed(parameters.load('paper', changes=COARSE | changes)))


@pytest.fixture(scope='module')
def settled():
    wing = wing_of()
    base = base_flow.settled(wing, PERIOD, 100.0)
    return wing, base, modes.find(wing, base, PERIOD, vectors=110, count=4)


@pytest.mark.parametrize('changes', [
    {}, {'membrane.viscous_share': 0.5, 'membrane.viscous_time': 0.01},
    {'numerics.engine': 'finite_volume', 'numerics.grid': 'fast'}], ids=['plain', 'viscous', 'fv'])
def test_a_state_and_its_vector_undo_each_other(changes):
    wing = wing_of(**{'numerics.trim_time': 0.05} | changes)
    state = wing.step(wing.step(wing.rest(), Inputs(1.0e5)), Inputs(0.0))
    coordinates = Coordinates(wing.step(state, Inputs(0.0)))
    again = coordinates.state(coordinates.vector(state))
    ahead, same = (wing.observe(wing.step(each, Inputs(0.0))) for each in (state, again))
    assert (ahead.cl, ahead.camber_mean) == (same.cl, same.camber_mean)


def test_the_first_mode_is_what_the_wing_rings_with(settled):
    wing, base, found = settled
    mode = max(found.modes, key=lambda each: each.observability['camber_mean'])
    rate = mode.growth + 2.0j * np.pi * mode.frequency
    coordinates, size = found.propagator.coordinates, found.propagator.size
    step = size / np.linalg.norm(mode.vector) * mode.vector
    state = coordinates.state(coordinates.vector(base) + step.real)
    seen, still = [], base
    for _ in range(120):
        state, still = (wing.step(each, Inputs(0.0)) for each in (state, still))
        seen.append(wing.observe(state).camber_mean - wing.observe(still).camber_mean)
    # y_k+1 = 2 Re(z) y_k - |z|^2 y_k-1 for the factor z of one step
    seen = np.array(seen)
    both = np.linalg.lstsq(np.array([seen[1:-1], -seen[:-2]]).T, seen[2:], rcond=None)[0]
    z = 0.5 * both[0] + 1.0j * np.sqrt(both[1] - 0.25 * both[0]**2)
    marched = np.log(z) / wing.dt
    assert rate.imag == pytest.approx(marched.imag, rel=0.002)
    assert rate.real == pytest.approx(marched.real, rel=0.02)


def test_the_modes_do_not_depend_on_the_period(settled):
    wing, base, found = settled
    other = modes.find(wing, base, 2.5e-3, vectors=110, count=8)
    for mode in found.modes[:3]:
        twin = min(other.modes, key=lambda each: abs(each.frequency - mode.frequency))
        assert twin.frequency == pytest.approx(mode.frequency, rel=1e-3)
        assert twin.growth == pytest.approx(mode.growth, rel=1e-2)


def test_each_mode_says_whose_it_is(settled):
    for mode in settled[2].modes:
        assert 0.0 <= mode.membrane_share <= 1.0 and 0.0 <= mode.in_plane_share <= 1.0
        assert mode.residual < modes.CONVERGED and mode.check < modes.SAME
    first = max(settled[2].modes, key=lambda each: each.observability['camber_mean'])
    assert first.in_plane_share < 1e-3 and first.membrane_share > 0.01
    assert 70.0 < first.frequency < 75.0 and 0.02 < first.damping < 0.03


def test_newton_s_method_finds_the_state_that_marching_settles_at(settled):
    wing, base, _found = settled
    off = replace(Propagator(wing, base, 40).march(base, 80.0), step=0)
    found = wing.observe(base_flow.steady(wing, off))
    early, late = (wing.observe(Propagator(wing, base, steps).march(base)) for steps in (1, 4000))
    for name in ('cl', 'camber_mean'):
        start, want = getattr(early, name), getattr(late, name)
        assert getattr(found, name) == pytest.approx(want, rel=1e-4)
        assert abs(getattr(found, name) - want) < 0.2 * abs(start - want)


def test_a_wing_that_still_moves_has_no_modes_yet():
    wing = wing_of(**{'numerics.trim_time': 2.0})
    with pytest.raises(RunFailed, match=r'not steady 2 c/U after its trim: in 1 ms it moves by'):
        base_flow.settled(wing, PERIOD, 2.0)
