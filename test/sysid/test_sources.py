# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of several runs as records of an identification."""

import bags
import numpy as np
import pytest
from synthetic_plant import SyntheticPlant

from dewing_cli import main as cli
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.lockstep import nanoseconds
from dewing_sysid import experiment, plan, sources
from dewing_sysid.settings import Settings

SHORT = {'experiment.record': 1.2, 'fresh.record': 1.2, 'realisation.window': 1.2,
         'realisation.order': 4}


@pytest.fixture(scope='module')
def campaign():
    """Return identity, V^2 and outputs of every run of a campaign, and the names of outputs."""
    plant, case = SyntheticPlant(), parameters.load('paper')
    identity = Identity.of('synthetic', plant, plant.rest(), 1250.0**2,
                           parameters.to_mapping(case))
    planned = plan.make(parameters.load('sysid', Settings, SHORT), identity)
    inputs = list(planned.inputs.values())
    outputs = experiment.run_all(plant, plant.rest(), planned.names, inputs)
    return identity, dict(zip(planned.inputs, zip(inputs, outputs))), planned.names


def record(path, campaign, *names, identities=(), gusts=()):
    """Write a bag of the named runs, between which the plant is reset.

    ``gusts`` are (run counted from 1, sample, upwards in m/s).
    """
    identity, runs, outputs = campaign
    messages = [('/dewing/case', bags.TEXT, bags.text(each.to_yaml()))
                for each in identities or (identity,)]
    for number, name in enumerate(names, start=1):
        for k, (v_squared, values) in enumerate(zip(runs[name][0], runs[name][1].T)):
            stamp = nanoseconds(k * identity.dt)
            messages += [('/dewing/measurement', bags.JOINTS, bags.joints(stamp, outputs, values)),
                         ('/dewing/command', bags.JOINTS,
                          bags.joints(stamp, ['v_squared'], (), [v_squared]))]
            messages += [('/dewing/inputs', bags.JOINTS,
                          bags.joints(stamp, ['gust_along', 'gust_up'], [0.0, speed]))
                         for run, sample, speed in gusts if (run, sample) == (number, k)]
    return bags.write(path, *messages)


def test_one_run_of_a_bag_is_the_experiment(campaign, tmp_path):
    path = record(tmp_path / 'run.mcap', campaign, 'experiment', 'prbs', 'baseline', 'experiment')
    _, runs, names = campaign
    for number, name in ((2, 'prbs'), (4, 'experiment')):
        records, _ = sources.load(path, number)
        assert list(records) == ['experiment'] and records['experiment'].names == names
        assert np.array_equal(records['experiment'].v_squared[:-1], runs[name][0][:-1])
        assert np.array_equal(records['experiment'].outputs, runs[name][1])
        assert np.array_equal(records['experiment'].baseline,
                              runs['baseline'][1][:, :len(runs[name][0])])
    with pytest.raises(BadInput, match='V.2 never changes in run 3'):
        sources.load(path, 3)
    with pytest.raises(BadInput, match='has no run 5; it has 1'):
        sources.load(path, 5)


@pytest.mark.parametrize('gusts, run, said', [
    ([(2, 3, 0.1), (2, 9, 0.0)], None, 'gust_up acted in run 2 from 0.0003 s on'),
    ([(1, 3, 0.1)], None, 'gust_up acted in run 1 from 0.0003 s on'),
    ([(1, 3, 0.1), (2, 3, 0.2)], 2, 'gust_up acted in run 2 from 0.0003 s on'),
    ([(1, 3, 0.1), (2, 4, 0.1)], 2, 'gust_up acted in run 2'),
    ([(1, 3, 0.1), (2, 3, 0.1)], None, ''),             # cancels
    ([(3, 3, 0.1)], 2, ''),                             # in a run that is not taken
    ([(1, 3, 0.0), (2, 5, 0.0)], None, '')])
def test_what_a_gust_does_is_not_taken_for_the_response_to_v_squared(
        campaign, tmp_path, gusts, run, said):
    path = record(tmp_path / 'run.mcap', campaign, 'baseline', 'experiment',
                  *(['prbs'] if run else []), gusts=gusts)
    if said:
        with pytest.raises(BadInput, match=said):
            sources.load(path, run)
    else:
        assert list(sources.load(path, run)[0]) == ['experiment']


def test_runs_that_could_be_the_same_are_not_guessed(campaign, tmp_path):
    path = record(tmp_path / 'run.mcap', campaign, 'baseline', 'experiment', 'baseline',
                  'experiment')
    with pytest.raises(BadInput, match='runs 2 and 4 both look like the run experiment'):
        sources.load(path)


def test_a_whole_campaign_needs_no_choice(campaign, tmp_path):
    path = record(tmp_path / 'run.mcap', campaign, *campaign[1])
    records, identity = sources.load(path)
    assert set(records) == set(campaign[1]) - {'baseline'} and identity == campaign[0]


def test_two_plants_in_a_bag_are_not_mixed(campaign, tmp_path):
    other = Identity(**vars(campaign[0]) | {'plant': 'other'})
    path = record(tmp_path / 'run.mcap', campaign, 'experiment',
                  identities=(campaign[0], campaign[0], other))
    with pytest.raises(BadInput, match='2 different plants were recorded'):
        sources.load(path)


def test_the_command_takes_the_run(campaign, tmp_path, capsys):
    path = record(tmp_path / 'run.mcap', campaign, 'experiment', 'experiment')
    identify = ['identify', '--from', str(path), '--order', '4', '--set',
                'realisation.window=1.2', '--quiet']
    assert cli.main(identify) == 2 and 'both look like' in capsys.readouterr().err
    assert cli.main([*identify, '--run', '9']) == 2 and 'no run 9' in capsys.readouterr().err
    assert cli.main([*identify, '--run', '2', '--out', str(tmp_path / 'model.npz')]) == 0
    capsys.readouterr()
    assert cli.main(['identify', '--run', '2']) == 2
    assert '--run picks a run of a bag: --from names it' in capsys.readouterr().err
    assert cli.main(['identify', '--run', '2', '--from', str(tmp_path / 'x.npz')]) == 2
    assert 'from a bag, MCAP, only' in capsys.readouterr().err
