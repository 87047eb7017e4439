# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The rest state: where it starts, how it settles, and how it is kept and healed on disk."""

import dataclasses
import subprocess
import sys

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.machine import fingerprint as machine
from dewing_sim.rest import checkpoint, trim
from dewing_sim.wing import Wing

COARSE = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
          'numerics.time_step': 5.0e-4, 'numerics.trim_time': 12.0, 'membrane.elements': 32}
CASE = parameters.load('paper', changes=COARSE)
WING = Wing(CASE)


def trimmed_for(time: float) -> tuple[Wing, trim.State]:
    """Return a wing and what it is after ``time`` (c/U) of trimming."""
    wing = Wing(parameters.replace(CASE, {'numerics.trim_time': float(time)}))
    return wing, trim.march(wing)


def arrays(state) -> list[np.ndarray]:
    """Return every array of a state."""
    return [value for part in (state.flow, state.motion)
            for value in (getattr(part, field.name) for field in dataclasses.fields(part))]


def same(ours, theirs) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(arrays(ours), arrays(theirs), strict=True))


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    return tmp_path / 'dewing'


@pytest.fixture
def no_march(monkeypatch):
    """Let no state be computed."""
    def march(wing, progress=None):
        raise AssertionError('the state is computed anew')
    monkeypatch.setattr(trim, 'march', march)


def test_the_start_is_a_flat_membrane_at_rest_in_potential_flow():
    wing = Wing(parameters.replace(CASE, {'actuation.voltage': 300.0}))
    state = trim.start(wing)
    assert (state.step, state.v_squared, state.iterations) == (0, 300.0**2, 0)
    assert np.array_equal(state.motion.position, wing.membrane.rest_position)
    assert not state.motion.velocity.any()
    expected = 0.9 * np.pi * np.sin(np.radians(4.0))        # nine tenths of the flat plate's
    assert state.flow.circulation == pytest.approx(expected, rel=1.0e-12)


def test_the_first_frequency_is_the_string_s_in_vacuo():
    """102.6 Hz for the paper's membrane, falling with the root of the tension."""
    in_hertz = trim.first_frequency(WING) / (2.0 * np.pi) / WING.scales.time
    assert in_hertz == pytest.approx(102.6, rel=5.0e-4)
    volts = Wing(parameters.replace(CASE, {'actuation.voltage': 1000.0}))
    assert trim.first_frequency(volts) / trim.first_frequency(WING) == pytest.approx(
        np.sqrt(0.4949 / 1.2121), rel=2.0e-3)


def test_until_ten_convective_times_the_membrane_follows_without_ringing(monkeypatch):
    def cambers():
        """Return the camber from 3 to 10 c/U relative to the last one."""
        found = [wing.observe(state).camber_mean
                 for wing, state in map(trimmed_for, range(3, 11))]
        return np.array(found) / found[-1]
    followed = cambers()
    assert (np.diff(followed) < 0.0).all()
    assert 1.05 < followed[0] < 1.2
    monkeypatch.setattr(trim, 'QUASI_STEADY', 0.0)
    free = cambers()
    assert np.sum(np.diff(np.sign(np.diff(free))) != 0) >= 3       # turns up and down
    assert np.ptp(free) > 0.25


def test_the_rest_state_is_in_equilibrium_with_its_own_load():
    wing, state = trimmed_for(20.0)
    outputs = wing.observe(state)
    x = state.motion.position[:, 0]
    nodal = outputs.pressure_jump / wing.scales.pressure
    static = wing.membrane.equilibrium(0.5 * (nodal[1:] + nodal[:-1]), 0.0)
    assert x[0] == 0.0 and x[-1] == 1.0
    height = static[:, 1].max()
    assert height == pytest.approx(outputs.camber_max / wing.scales.length, rel=0.02)
    assert state.motion.position[:, 1] == pytest.approx(static[:, 1], abs=0.02 * height)


def test_time_begins_at_the_rest_state_and_progress_is_counted():
    calls = []
    wing = Wing(parameters.replace(CASE, {'numerics.trim_time': 4.0}))
    state = trim.march(wing, lambda *done: calls.append(done))
    total = round(4.0 * wing.scales.time / wing.dt)
    assert state.step == 0
    assert calls == [(done, total) for done in range(50, total + 1, 50)]


def test_a_kept_state_is_read_back_bit_for_bit_and_not_computed(cache, monkeypatch):
    wing = Wing(parameters.replace(CASE, {'numerics.trim_time': 1.0}))
    first = wing.rest()
    kept, = cache.iterdir()
    assert kept.name == f'rest-{trim.fingerprint(wing)}.npz'
    assert checkpoint.load_case(kept) == wing.case
    monkeypatch.setattr(trim, 'march', None)
    assert same(Wing(wing.case).rest(), first)


@pytest.mark.parametrize('harm', [
    lambda path: path.write_bytes(b''), lambda path: path.write_bytes(b'broken'),
    lambda path: path.write_bytes(path.read_bytes()[:-200]), lambda path: np.savez(path, a=1)],
    ids=['empty', 'no archive', 'cut short', 'of another kind'])
def test_a_broken_file_is_computed_again_and_replaced(cache, harm):
    wing = Wing(parameters.replace(CASE, {'numerics.trim_time': 1.0}))
    first = wing.rest()
    kept, = cache.iterdir()
    harm(kept)
    assert same(wing.rest(), first)
    assert same(checkpoint.load(kept), first)
    assert list(cache.iterdir()) == [kept]


def test_a_folder_that_cannot_be_written_only_costs_time(tmp_path, monkeypatch):
    (tmp_path / 'file').write_text('no folder', encoding='utf-8')
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'file'))
    wing = Wing(parameters.replace(CASE, {'numerics.trim_time': 1.0}))
    assert same(wing.rest(), trim.march(wing))


@pytest.mark.parametrize('changes', [
    {'actuation.voltage': 300.0}, {'flow.angle_of_attack_deg': 5.0}, {'membrane.elements': 31},
    {'membrane.shear_modulus': 2.1e4}, {'numerics.trim_time': 12.5},
    {'numerics.time_step': 4.0e-4}, {'numerics.coupling_tolerance': 1.0e-3},
    {'numerics.grid': 'fast'}, {'numerics.engine': 'finite_volume', 'numerics.grid': 'fast'}])
def test_states_of_other_wings_have_other_names(changes):
    other = Wing(parameters.replace(CASE, changes))
    assert trim.fingerprint(other) != trim.fingerprint(WING)


@pytest.mark.parametrize('changes', [
    {'disturbance.pressure': 0.015}, {'disturbance.frequency': 12.0}, {'gust.vertical': 0.1},
    {'gust.shape': 'ramp'}, {'rigid_motion.pitch_deg': 1.0}, {'rigid_motion.shape': 'sine'},
    {'actuation.voltage_limit': 900.0}])
def test_what_begins_after_the_rest_does_not_change_its_name(changes, cache, no_march):
    other = Wing(parameters.replace(CASE, changes))
    assert trim.fingerprint(other) == trim.fingerprint(WING)


def test_a_wing_takes_its_name_from_every_source_that_computes_it():
    code = ('import sys, dewing_sim.wing\n'
            'from dewing_sim.fluid import engines\n'
            'for name in engines.NAMES: engines.find(name)\n'
            'print(*[name for name in sys.modules if name.startswith("dewing_")])')
    loaded = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                            check=True).stdout.split()
    assert set(loaded) <= set(machine.sources(Wing.__module__))
    assert {'dewing_sim.wing', 'dewing_sim.fluid.conformal.adi',
            'dewing_sim.structure.dynamics.band'} <= set(loaded)


def test_another_source_gives_another_name(monkeypatch):
    before = trim.fingerprint(WING)
    monkeypatch.setattr(machine, 'fingerprint', lambda *modules: f'changed {modules}')
    assert trim.fingerprint(WING) != before
