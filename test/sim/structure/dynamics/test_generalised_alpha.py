# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Generalised alpha: order, damping, and an energy balance that closes."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.structure import elements
from dewing_sim.structure.dynamics.energy_balance import Balance, balance
from dewing_sim.structure.dynamics.generalised_alpha import Scheme, Swing
from dewing_sim.structure.dynamics.step import Motion, Operator, advance

SECTION = parameters.replace(parameters.load('paper').membrane, {'elements': 16})
THIN = elements.make(SECTION)
THICK = elements.make(parameters.replace(SECTION, {'element': 'solid'}))
SHAPE = np.sin(np.pi * THIN.rest_position[:, 0] / THIN.chord)
TENSION = THIN.rest_tension(0.0)
OMEGA = 2.0 * np.sqrt(TENSION * 16 / 0.03 / THIN.mass[1]) * np.sin(np.pi / 32)


def plucked(structure, amplitude):
    position = structure.rest_position.copy()
    x = structure.surface(position)[:, 0] / structure.chord
    position[:, 1] += amplitude * np.repeat(np.sin(np.pi * x), len(position) // len(x))
    return Swing.of(structure, position, np.zeros_like(position), 0.0, np.zeros_like(position))


def at_rest(structure):
    still = np.zeros_like(structure.rest_position)
    return Swing.of(structure, structure.rest_position, still, 0.0, still)


def swings(structure, scheme, start, steps, v_squared=lambda k: 0.0, load=None):
    """Yield (before, after, balance) of steps; the voltage of step k is v_squared(k)."""
    load = load or (lambda position, k: np.zeros_like(position))
    for k in range(1, steps + 1):
        square, last = v_squared(k), v_squared(k - 1)
        end = scheme.advance(structure, start, square, lambda p, k=k: load(p, k))
        internal = scheme.mean_force(structure.internal_force(start.position, square),
                                     structure.internal_force(end.position, square))
        yield end, balance(structure, start, end, last, square,
                           scheme.mean_acceleration(start, end), internal,
                           scheme.mean_force(start.load, end.load))
        start = end


@pytest.mark.parametrize('radius', [0.0, 0.5, 0.8, 1.0])
def test_small_vibration_is_second_order_in_time(radius):
    steps, errors = np.array([50, 100, 200]), []
    for n in steps:
        scheme = Scheme(radius, 1.5 * np.pi / OMEGA / n)    # to where the exact motion is zero
        *_, (end, _) = swings(THIN, scheme, plucked(THIN, 1.0e-7), n)
        errors.append(abs(end.position[8, 1]))
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize('radius', [0.3, 0.8, 1.0])
def test_the_highest_frequency_has_the_spectral_radius_as_triple_root(radius):
    scheme = Scheme(radius, 1.0e4 * np.pi / OMEGA)
    y = np.array([end.position[8, 1]
                  for end, _ in swings(THIN, scheme, plucked(THIN, 1.0e-7), 12)])[2:]
    missing = (y[3:] + 3.0 * radius * y[2:-1] + 3.0 * radius ** 2 * y[1:-2]
               + radius ** 3 * y[:-3])
    assert np.abs(missing).max() < 1e-4 * np.abs(y).max()


def total(parts):
    result = Balance()
    for _, part in parts:
        result = result.plus(part)
    return result


@pytest.mark.parametrize('structure', [THIN, THICK], ids=['membrane', 'solid'])
@pytest.mark.parametrize('radius', [0.5, 1.0])
def test_energy_adds_up_under_changing_voltage_and_pressure(structure, radius):
    dt = 2.0e-4
    start = at_rest(structure)

    def load(position, k):
        return structure.pressure_force(position, 2.0 * np.sin(300.0 * k * dt) ** 2)
    parts = total(swings(structure, Scheme(radius, dt), start, 60,
                         lambda k: 2.0e5 * np.sin(0.1 * k) ** 2, load))
    assert min(abs(part) for part in parts[:5]) > 1e-3 * max(abs(part) for part in parts)
    assert parts.error < 1e-9


def test_without_damping_a_closed_membrane_keeps_its_energy():
    start = plucked(THIN, 1.0e-4)
    energy = np.subtract(*THIN.energies(start.position, 1.0e5)) - np.subtract(
        *THIN.energies(THIN.rest_position, 1.0e5))
    parts = total(swings(THIN, Scheme(1.0, 2.0e-6), start, 2400, lambda k: 1.0e5))
    assert abs(parts.dissipation) < 1e-6 * energy
    lost = parts.elastic - parts.electric + parts.kinetic
    assert abs(lost) < 1e-6 * energy
    damped = total(swings(THIN, Scheme(0.5, 1.0e-3), start, 50, lambda k: 1.0e5))
    assert 1e-3 * energy < damped.dissipation < energy


def test_the_balance_of_bdf2_closes_too():
    dt, motion = 1.0e-4, Motion.at_rest(THIN.rest_position)
    operator, parts = Operator.of(THIN, dt), Balance()
    for k in range(60):
        load = THIN.pressure_force(THIN.rest_position, 1.0 - np.cos(0.2 * k))
        after = advance(THIN, motion, 1.0e5, lambda p, w, f=load: f, operator,
                        tolerance=1e-13)
        rate = (3.0 * after.velocity - 4.0 * motion.velocity + motion.velocity_before) / (2 * dt)
        parts = parts.plus(balance(THIN, motion, after, 1.0e5, 1.0e5, rate,
                                   THIN.internal_force(after.position, 1.0e5), load))
        motion = after
    assert parts.load > 0.0 and parts.error < 1e-6


@pytest.mark.parametrize('radius', [-0.1, 1.1, np.nan])
def test_a_spectral_radius_out_of_range_is_refused(radius):
    with pytest.raises(BadInput, match='spectral_radius = .* out of range: from 0 to 1'):
        Scheme(radius, 1.0e-4)
