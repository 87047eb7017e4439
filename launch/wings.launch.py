# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Start several wings in one domain, ``wing1``, ``wing2`` and so on, each with its controller.

Every other argument is that of dewing.launch.py. The first wing has ``/clock``, the others a
clock in their namespace. A bag is written for each, run.mcap becomes run_wing1.mcap. The end of
one leaves the others alone.
"""

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration

ONE = Path(__file__).with_name('dewing.launch.py')
ARGUMENTS = (('count', '2', 'number of wings'),
             ('bag', '', 'MCAP file to record into, one for each wing; empty: none'))


def generate_launch_description() -> LaunchDescription:
    """Describe the wings."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=about)
          for name, default, about in ARGUMENTS),
        OpaqueFunction(function=wings)])


def wings(context: LaunchContext) -> list[GroupAction]:
    """Return the wings for the arguments in ``context``."""
    count, bag = (LaunchConfiguration(name).perform(context) for name, *_ in ARGUMENTS)
    return [one(f'wing{number}', '' if number == 1 else 'clock', bag)
            for number in range(1, int(count) + 1)]


def one(namespace: str, clock: str, bag: str) -> GroupAction:
    """Return one wing, whose arguments end with it."""
    path = Path(bag)
    own = path.with_name(f'{path.stem}_{namespace}{path.suffix}') if bag else ''
    return GroupAction([IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(ONE)), launch_arguments={
            'namespace': namespace, 'clock': clock, 'bag': str(own)}.items())])
