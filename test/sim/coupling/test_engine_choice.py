# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What engine `auto` stands for."""

import dataclasses
import math

import pytest

from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.coupling import engine_choice
from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import INFLOWS, Demand
from dewing_sim.fluid.choice import choose
from dewing_sim.fluid.plate import Plate
from dewing_sim.rest import checkpoint, trim
from dewing_sim.wing import Wing

ORDINARY = Demand('standard', 0.01, 2500.0, math.radians(4.0), 0.004)
AUTO = {'numerics.engine': 'auto', 'numerics.grid': 'fast', 'numerics.trim_time': 1.0}


def test_the_conformal_engine_is_taken_where_it_has_been_verified():
    assert choose('auto', ORDINARY) == 'conformal'
    assert choose('finite_volume', ORDINARY) == 'finite_volume'


@pytest.mark.parametrize('change, reason', [
    ({'camber': 0.16}, 'a camber of 0.16 is outside 0 to 0.15'),
    ({'camber': -0.16}, 'a camber of 0.16'),
    ({'camber': math.inf}, 'a camber of inf'),
    ({'reynolds': 50.0}, 'a Reynolds number of 50 is outside 100 to 10000'),
    ({'reynolds': 2.0e4}, 'a Reynolds number of 2e.04'),
    ({'alpha': math.radians(-14.0)}, 'an? angle of attack in deg of 14 is outside 0 to 12'),
    ({'dt': 0.05}, 'a time step in c/U of 0.05 is outside 0 to 0.0205'),
])
def test_elsewhere_the_finite_volumes_are(change, reason):
    demand = dataclasses.replace(ORDINARY, **change)
    assert choose('auto', demand) == 'finite_volume'
    with pytest.raises(BadInput, match=f'one of the conformal engine, for which {reason}'):
        choose('auto', dataclasses.replace(demand, grid='realtime'))


def test_finer_grids_of_the_conformal_engine_take_shorter_steps():
    taken = {grid: [choose('auto', dataclasses.replace(ORDINARY, grid=grid, dt=dt))
                    for dt in (0.004, 0.012)] for grid in ('fast', 'standard', 'fine')}
    assert taken == {'fast': ['conformal', 'conformal'],
                     'standard': ['conformal', 'finite_volume'],
                     'fine': ['conformal', 'finite_volume']}


def test_a_gust_asks_for_the_conformal_engine_whatever_the_case():
    gusty = dataclasses.replace(ORDINARY, inflows=INFLOWS, reynolds=50.0)
    assert engines.find('conformal').obstacle(gusty)
    assert choose('auto', gusty) == 'conformal'
    with pytest.raises(BadInput, match="numerics.engine = 'finite_volume' knows no gust"):
        choose('finite_volume', gusty)


@pytest.mark.parametrize('case', ['paper', 'paper_alpha8', 'soft'])
def test_every_shipped_case_goes_to_the_conformal_engine(case):
    wing = Wing(parameters.load(case, changes=AUTO))
    assert wing.case.numerics.engine == 'conformal'
    assert wing.case == parameters.load(case, changes={**AUTO, 'numerics.engine': 'conformal'})


def test_the_expected_camber_is_near_that_of_the_coupled_wing():
    case = parameters.load('soft', changes={**AUTO, 'actuation.voltage_limit': 0.0})
    wing = Wing(case)
    found = wing.observe(trim.march(Wing(parameters.replace(
        case, {'numerics.trim_time': 15.0}))))
    expected = engine_choice.expected_camber(case, wing.membrane)
    assert found.camber_max / case.membrane.chord == pytest.approx(expected, rel=0.4)


def test_a_wing_that_is_too_soft_goes_to_the_finite_volumes():
    soft = parameters.load('soft', changes={**AUTO, 'membrane.shear_modulus': 1.0e3,
                                            'actuation.voltage_limit': 0.0})
    assert Wing(soft).case.numerics.engine == 'finite_volume'


def test_what_was_taken_is_recorded_in_the_identity_and_in_saved_states(tmp_path):
    built = build_wing(parameters.load('paper', changes=AUTO))
    built.save(str(tmp_path / 'state.npz'), built.rest)
    assert checkpoint.load_case(tmp_path / 'state.npz').numerics.engine == 'conformal'
    assert built.load(str(tmp_path / 'state.npz')).step == 0
    assert Plate(0.1, grid='fast', engine='auto').engine == 'conformal'
