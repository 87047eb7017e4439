# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A law of elasticity and its constants as parameters of the simulator node."""

import pytest
from rclpy.node import Node

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.ros import harness
from dewing_sim.ros.simulator_parameters import settings_of

OGDEN = {'membrane.law': 'ogden', 'membrane.constants.mu_1': 1.5e4,
         'membrane.constants.alpha_1': 2.5}


@pytest.fixture
def node_of():
    """Return a function that makes a node with parameters given as on the command line."""
    with harness.Session() as session:
        yield lambda given: session.add(lambda parameters, **options: Node(
            'simulator', namespace='dewing', **harness.overrides(parameters), **options), given)


def test_constants_are_parameters_with_the_descriptors_of_the_law(node_of):
    node = node_of(OGDEN)
    _, case = settings_of(node)
    assert case == parameters.load('paper', changes=OGDEN)
    assert node.get_parameter('membrane.constants.mu_1').value == 1.5e4
    described = node.describe_parameter('membrane.constants.mu_1')
    assert described.description == 'mu_1 [Pa], from -1e+08 to 1e+08' and described.read_only
    assert described.floating_point_range[0].to_value == 1.0e8


def test_a_case_of_gent_has_no_such_parameter(node_of):
    node = node_of({})
    settings_of(node)
    assert node.get_parameter('membrane.law').value == 'gent'
    assert not node.has_parameter('membrane.constants.mu_1')


def test_a_constant_that_is_no_number_is_refused(node_of):
    with pytest.raises(BadInput, match='membrane.constants.mu_1 = .steep. is not a floating'):
        settings_of(node_of({**OGDEN, 'membrane.constants.mu_1': 'steep'}))
