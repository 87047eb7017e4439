# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A bag of experiments played to the identification node gives the model of the experiments."""

import numpy as np
import pytest
from bag_player import Player
from ros_processes import PATIENCE, graph
from synthetic_plant import save_model

from dewing_sim.linear.model import Model
from dewing_sim.ros import harness
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.recorder import RecorderNode
from dewing_sysid.node import SysidNode

SHORT = {'experiment.record': 1.2, 'fresh.record': 1.2, 'realisation.window': 1.2,
         'realisation.order': 6, 'afterwards': 'exit'}
PLAYED = ('/dewing/case', '/dewing/measurement', '/dewing/command')


@pytest.fixture
def campaign(tmp_path):
    """Return the bag of a campaign on a linear wing, and the model that was found."""
    save_model(tmp_path / 'plant.npz')
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        recorder = session.add(RecorderNode, {'output': str(tmp_path / 'run.mcap')})
        session.add(SimulatorNode, {
            'run.plant': 'reduced', 'model': str(tmp_path / 'plant.npz'), 'run.subscribers': 2})
        node = session.add(SysidNode, SHORT | {'output': ''})
        session.spin_until(lambda: node.exit_status == 0, PATIENCE)
        recorder.interrupt()
    return tmp_path / 'run.mcap', node.found.model


def test_a_bag_played_gives_the_matrices_of_the_experiments(campaign, tmp_path):
    path, found = campaign
    with graph(tmp_path / 'ros') as ros, harness.Session(ros.domain) as session:
        sysid = ros.start('sysid', SHORT | {'begin': 'on_replay', 'output': 'played.npz'})
        player = session.add(lambda _, **options: Player(path, PLAYED, **options))
        session.spin_until(player.is_heard, PATIENCE)
        player.play()
        session.spin_until(lambda: sysid.poll() is not None, PATIENCE)
        assert sysid.returncode == 0, ros.said('sysid')
    played = Model.load(tmp_path / 'ros' / 'played.npz')
    for name in 'abc':
        assert np.array_equal(getattr(played, name), getattr(found, name)), name


def test_what_is_no_campaign_ends_with_a_sentence(campaign, tmp_path):
    path, _ = campaign
    with graph(tmp_path / 'ros') as ros, harness.Session(ros.domain) as session:
        sysid = ros.start('sysid', SHORT | {'begin': 'on_replay', 'output': ''})
        player = session.add(lambda _, **options: Player(path, PLAYED[:2], **options))
        session.spin_until(player.is_heard, PATIENCE)
        player.play()
        session.spin_until(lambda: sysid.poll() is not None, PATIENCE)
        assert sysid.returncode == 1
        assert 'runs of measurements do not fit 0 runs of commands' in ros.said('sysid')
