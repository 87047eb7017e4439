# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command that describes and draws bags."""

import json
from pathlib import Path

import numpy as np
import pytest

from dewing_cli import main as cli
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.records import bag, bag_summary
from dewing_sim.records.bag import _types

JOINTS, TEXT = 'sensor_msgs/msg/JointState', 'std_msgs/msg/String'
IDENTITY = ('{plant: reduced, dt: 1.0e-4, camber_mean: 2.0e-5, camber_max: 3.0e-5, '
            'v_squared_slack: 1.0e+6, v_squared_max: 1.0e+6, case: {}, version: test}')


@pytest.fixture
def path(tmp_path):
    """Return a bag of 50 steps of which two are missing."""
    types = _types()
    header, time = types.types['std_msgs/msg/Header'], types.types['builtin_interfaces/msg/Time']
    writer = bag.BagWriter(tmp_path / 'run.mcap')
    writer.add_topic('/dewing/case', TEXT)
    writer.add_topic('/dewing/measurement', JOINTS)
    writer.write('/dewing/case', types.serialize_cdr(types.types[TEXT](IDENTITY), TEXT), 0, 0)
    for step in [*range(20), *range(22, 51)]:
        message = types.types[JOINTS](
            header(time(0, step * 100_000), ''), ['camber_mean', 'v_squared'],
            np.array([2.0e-5, 1.0e4 * step]), np.empty(0), np.empty(0))
        writer.write('/dewing/measurement', types.serialize_cdr(message, JOINTS),
                     step * 10_000_000, step)
    writer.close()
    return tmp_path / 'run.mcap'


def test_info_counts_messages_and_missing_steps(path, tmp_path, capsys):
    assert cli.main(['bag', 'info', str(path), '--json', str(tmp_path / 'info.json')]) == 0
    found = json.loads((tmp_path / 'info.json').read_text())
    assert found['topics']['/dewing/measurement'] == {'type': JOINTS, 'messages': 49}
    assert found['simulated_s'] == pytest.approx(5.0e-3) and found['steps_missing'] == 2
    assert found['wall_s'] == pytest.approx(0.5) and found['plant']['name'] == 'reduced'
    assert '0.005 s of simulated time, 2 steps missing' in capsys.readouterr().out


def test_plot_draws_beside_the_bag_and_writes_over_nothing(path, tmp_path, capsys):
    assert cli.main(['bag', 'plot', str(path), '--json', str(tmp_path / 'plot.json')]) == 0
    assert path.with_suffix('.png').read_bytes().startswith(b'\x89PNG')
    assert json.loads((tmp_path / 'plot.json').read_text())['v_max'] == pytest.approx(500000**0.5)
    assert cli.main(['bag', 'plot', str(path)]) == 2
    assert 'exists; --force writes over it' in capsys.readouterr().err


@pytest.mark.parametrize('arguments, sentence', [
    (['draw', 'run.mcap'], 'ACTION draw is not known; one of info, plot'),
    (['info', 'none.mcap'], 'none.mcap: cannot be read')])
def test_what_cannot_be_done_is_said(arguments, sentence, capsys):
    assert cli.main(['bag', *arguments]) == 2
    assert sentence in capsys.readouterr().err


def test_a_bag_of_version_0_1_is_read():
    """Written by its recorder: a linear wing under PID, which had to say cd = 0."""
    old = Path(__file__).parents[2] / 'reference' / 'flight_0.1.mcap'
    series = bag.series(old, '/dewing/measurement')
    assert [*series] == ['time', 'camber_mean', 'camber_max', 'cl', 'cd', 'v_squared']
    assert len(series['cl']) == 13 and series['cl'][-1] == pytest.approx(0.3948, abs=1.0e-4)
    assert bag_summary.summary(old)['steps_missing'] == 0
    identity = Identity.from_yaml(next(bag.read(old, '/dewing/case')).message.data)
    assert identity.version == '0.1.0' and identity.outputs is None
    assert identity.units['camber_max'] == 'm'


def test_who_has_no_option_to_overwrite_is_told_what_else_to_do(path):
    with pytest.raises(BadInput, match='run.mcap exists; name another file'):
        bag.BagWriter(path)


def test_a_bag_of_a_plant_without_camber_says_what_it_measured(tmp_path):
    writer, types = bag.BagWriter(tmp_path / 'bare.mcap'), _types()
    header, time = types.types['std_msgs/msg/Header'], types.types['builtin_interfaces/msg/Time']
    writer.add_topic('/dewing/measurement', JOINTS)
    message = types.types[JOINTS](header(time(0, 0), ''), ['cl', 'v_squared'],
                                  np.array([0.4, 0.0]), np.empty(0), np.empty(0))
    writer.write('/dewing/measurement', types.serialize_cdr(message, JOINTS), 0, 0)
    writer.close()
    with pytest.raises(BadInput, match='measured time, cl, v_squared; camber_mean and'):
        bag_summary.draw(tmp_path / 'bare.mcap', tmp_path / 'bare.png')
