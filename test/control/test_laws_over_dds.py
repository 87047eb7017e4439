# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every control law over DDS is the same law offline, bit for bit."""

import numpy as np
import pytest
from ros_processes import PATIENCE, graph, offline

from dewing_sim.records import bag

pytest.importorskip('osqp')


@pytest.mark.parametrize('kind, target', [('periodic', 1.10), ('lqg', 1.10), ('mpc', 0.97)])
def test_loop_over_dds_is_bit_identical_to_the_loop_offline(tmp_path, kind, target):
    with graph(tmp_path) as ros:
        settings = {'kind': kind, 'model': str(ros.model), 'reference.target': target}
        path = ros.recorder()
        simulator = ros.simulator(duration=0.12, subscribers=2)
        ros.start('controller', settings)
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator') + ros.said('controller')
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(1200, settings)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name
    assert np.ptp(recorded['v_squared']) > 0.0


def test_a_law_that_cannot_be_designed_is_named(tmp_path):
    with graph(tmp_path) as ros:
        simulator = ros.simulator(duration=0.1, subscribers=1, hold_timeout=2.0,
                                  command_timeout=0.5)
        ros.start('controller', {'kind': 'lqg'})
        assert simulator.wait(PATIENCE) == 1
        assert 'model is empty' in ros.said('controller')
        assert 'Traceback' not in ros.said('controller')
