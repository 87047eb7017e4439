# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Static equilibria against polygons that solve the discrete equations exactly, and load steps."""

import numpy as np
import pytest
from scipy.optimize import brentq

from dewing_sim import parameters
from dewing_sim.errors import Diverged, NotConverged, Slack
from dewing_sim.structure.dynamics import statics
from dewing_sim.structure.membrane import Membrane

SECTION = parameters.replace(parameters.load('paper').membrane, {'elements': 12})
MEMBRANE = Membrane.from_parameters(SECTION)
CHORD, N = MEMBRANE.chord, MEMBRANE.elements
EXACT = 1.0e-10 * CHORD


def tension_at(length: float, v_squared: float, membrane: Membrane = MEMBRANE) -> float:
    """Return the tension of an element of the given length."""
    stretch = membrane.prestretch * length * membrane.elements / membrane.chord
    return float(membrane.sheet.respond([stretch], v_squared).tension[0])


def regular_polygon(pressure: float, v_squared: float, turn: float) -> np.ndarray:
    """Return the nodes on a circle of radius R whose chords carry T = p R cos(turn / 2).

    That is a node's balance: p L cos(turn / 2) outwards, 2 T sin(turn / 2) inwards, with the
    chords' length L = 2 R sin(turn / 2) and ``turn`` from one chord to the next, near which the
    solution is looked for.
    """
    def radius(turn):
        return 0.5 * CHORD / np.sin(0.5 * N * turn)

    def excess(turn):
        length = 2.0 * radius(turn) * np.sin(0.5 * turn)
        return tension_at(length, v_squared) - pressure * radius(turn) * np.cos(0.5 * turn)

    turn = brentq(excess, 0.5 * turn, 2.0 * turn, xtol=1.0e-16)
    angle = turn * (np.arange(N + 1) - 0.5 * N)
    return np.stack((0.5 * CHORD + radius(turn) * np.sin(angle),
                     radius(turn) * (np.cos(angle) - np.cos(0.5 * N * turn))), axis=1)


def hanging_polygon(load: float, v_squared: float) -> np.ndarray:
    """Return the nodes under the dead load ``load`` per rest length.

    The horizontal tension H is uniform, the vertical one falls by the load of every node, so
    that H alone says how long each element is and where it points; H follows from the chord.
    """
    vertical = load * CHORD / N * (0.5 * N - 0.5 - np.arange(N))

    def steps(horizontal):
        total = np.hypot(horizontal, vertical)
        length = np.array([brentq(lambda length, t=t: tension_at(length, v_squared) - t,
                                  0.5 * CHORD / N, 4.0 * CHORD / N, xtol=1.0e-18)
                           for t in total])
        return length * (np.array([np.full(N, horizontal), vertical]) / total)

    flat = tension_at(CHORD / N, v_squared)
    horizontal = brentq(lambda h: steps(h)[0].sum() - CHORD, 0.05 * flat, 3.0 * flat,
                        xtol=1.0e-16)
    return np.concatenate((np.zeros((1, 2)), np.cumsum(steps(horizontal), axis=1).T))


@pytest.mark.parametrize('pressure, v_squared, turn', [
    (1.0, 0.0, 0.002), (20.0, 4.0e5, 0.06), (60.0, 8.0e5, 0.2)])
def test_follower_pressure_bends_a_regular_polygon(pressure, v_squared, turn):
    found = statics.equilibrium(MEMBRANE, pressure, v_squared)
    assert found == pytest.approx(regular_polygon(pressure, v_squared, turn), abs=EXACT)


@pytest.mark.parametrize('load, v_squared', [(1.0, 0.0), (20.0, 4.0e5), (60.0, 8.0e5)])
def test_dead_load_bends_the_funicular_polygon(load, v_squared):
    found = statics.equilibrium(MEMBRANE, load, v_squared, follower=False)
    assert found == pytest.approx(hanging_polygon(load, v_squared), abs=EXACT)


def test_a_small_load_bends_the_parabola_of_a_string():
    """At the nodes of a string y = p x (c - x) / (2 T) is exact."""
    pressure = 1.0e-3
    x = MEMBRANE.rest_position[:, 0]
    parabola = pressure * x * (CHORD - x) / (2.0 * tension_at(CHORD / N, 2.0e5))
    for follower in (True, False):
        found = statics.equilibrium(MEMBRANE, pressure, 2.0e5, follower)
        assert found[:, 1] == pytest.approx(parabola, abs=1.0e-6 * parabola.max())


def test_a_point_force_pulls_two_elements_into_a_triangle():
    """2 T(l) sin(slope) = F; ``held`` are dead nodal forces."""
    pair = Membrane.uniform(MEMBRANE.sheet, MEMBRANE.prestretch, SECTION.density, CHORD, 2)
    height = 0.3 * CHORD
    length = np.hypot(0.5 * CHORD, height)
    held = np.zeros((3, 2))
    held[1, 1] = 2.0 * tension_at(length, 1.0e5, pair) * height / length
    start = pair.rest_position.copy()
    start[1, 1] = 0.2 * CHORD
    found = statics.newton(pair, start, 1.0e5, held=held)
    assert found[1] == pytest.approx([0.5 * CHORD, height], abs=EXACT)


def test_pressures_of_either_sign_are_mirror_images():
    above = statics.equilibrium(MEMBRANE, 20.0, 4.0e5)
    below = statics.equilibrium(MEMBRANE, -20.0, 4.0e5)
    assert below == pytest.approx(above * [1.0, -1.0], abs=EXACT)


def test_load_steps_reach_what_newton_alone_does_not():
    pressure, v_squared = 60.0, 2.0e6
    with pytest.raises((Diverged, NotConverged)):
        statics.newton(MEMBRANE, MEMBRANE.rest_position, v_squared, pressure)
    found = statics.equilibrium(MEMBRANE, pressure, v_squared)
    net = (MEMBRANE.internal_force(found, v_squared)
           - MEMBRANE.pressure_force(found, pressure))[1:-1]
    assert np.abs(net).max() < 1.0e-10 * MEMBRANE.tension(found, v_squared).max()


def bearing(largest: float, tried: list):
    """Return a solver that fails for steps above ``largest`` and notes the shares it is asked."""
    def solve(position, share):
        tried.append(share)
        if share - position > largest:
            raise NotConverged(f'a step to {share}')
        return share
    return solve


@pytest.mark.parametrize('largest, shares', [
    (1.0, [1.0]),
    (0.3, [1.0, 0.5, 0.25, 0.75, 0.5, 1.0, 0.75, 1.0]),
    (0.25, [1.0, 0.5, 0.25, 0.75, 0.5, 1.0, 0.75, 1.0])])
def test_steps_are_halved_on_failure_and_doubled_after(largest, shares):
    tried = []
    assert statics.march(bearing(largest, tried), 0.0) == 1.0
    assert tried == shares


def test_the_step_that_could_not_be_made_smaller_says_why():
    tried = []
    with pytest.raises(NotConverged, match='a step to 0.125$'):
        statics.march(bearing(0.1, tried), 0.0, smallest=0.125)
    assert tried == [1.0, 0.5, 0.25, 0.125]


class Softening:
    """A point on a spring of force d^(1/3), about which Newton's method doubles every error."""

    rest_position, chord, free = np.ones((1, 2)), 1.0, slice(1, 2)

    def internal_force(self, position, v_squared):
        return np.cbrt(position)

    def pressure_force(self, position, pressure):
        return np.zeros((1, 2))

    def tangent(self, position, v_squared, pressure, before):
        return np.cbrt(position[:, 1:])**-2 / 3.0


def test_iterations_that_do_not_end_say_so_in_one_sentence():
    with pytest.raises(NotConverged) as caught:
        statics.newton(Softening(), np.ones((1, 2)), 1.0e4)
    assert str(caught.value) == ('static equilibrium at 100 V: correction '
                                 f'{3.0 * 2.0**39:.3g} chords after 40 iterations; '
                                 'reduce pressure or voltage')


def test_a_load_that_is_no_number_stops_the_iteration():
    with pytest.raises(Diverged) as caught:
        statics.newton(MEMBRANE, MEMBRANE.rest_position, 0.0, held=np.nan)
    assert str(caught.value) == ('the stiffness is singular or not finite; '
                                 'the membrane carries no tension')


def test_a_voltage_that_takes_all_tension_is_slack_with_both_voltages():
    with pytest.raises(Slack, match=r'^slack membrane: element \d+ has tension -\S+ at 1300\.05 V '
                       r'and loses it at 1300\.04 V; lower the voltage or raise the prestretch$'):
        statics.equilibrium(MEMBRANE, 0.0, 1400.0**2)
