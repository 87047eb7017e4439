# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fly the case ``realtime`` paced by the wall clock, simulator and controller in one process.

Every argument is that of dewing.launch.py, with other defaults.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

ONE = Path(__file__).with_name('dewing.launch.py')
GAINS = ONE.parents[1] / 'config' / 'controller_realtime.yaml'     # which bear late commands
ARGUMENTS = (('case', 'realtime', 'shipped case or YAML file'),
             ('mode', 'realtime', 'lockstep, realtime or free'),
             ('rate', '1.0', 'simulated over wall time'),
             ('composed', 'true', 'whether simulator and controller share one process'))


def generate_launch_description() -> LaunchDescription:
    """Describe the nodes of one wing in real time."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=about)
          for name, default, about in ARGUMENTS),
        DeclareLaunchArgument('gains', default_value=str(GAINS),
                              description='parameter file for the controller'),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(ONE)))])
