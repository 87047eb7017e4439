# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Start the simulator with a controller and a recorder; the end of the simulator ends them all."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = (
    ('case', 'paper', 'shipped case or YAML file'),
    ('mode', 'lockstep', 'lockstep, realtime or free'),
    ('duration', '0.0', 'simulated time in s, 0: endless'),
    ('controller', 'true', 'whether a controller is started'),
    ('bag', '', 'MCAP file to record into; empty: no recorder'),
)


def generate_launch_description() -> LaunchDescription:
    """Describe the nodes of one run."""
    value = {name: LaunchConfiguration(name) for name, _, _ in ARGUMENTS}
    listeners = PythonExpression([
        "int('", value['controller'], "' == 'true') + int('", value['bag'], "' != '')"])
    simulator = Node(
        package='dewing', executable='simulator', output='screen',
        parameters=[{'case': ParameterValue(value['case'], value_type=str),
                     'run.mode': ParameterValue(value['mode'], value_type=str),
                     'run.duration': ParameterValue(value['duration'], value_type=float),
                     'run.subscribers': ParameterValue(listeners, value_type=int)}])
    controller = Node(package='dewing', executable='controller', output='screen',
                      condition=IfCondition(value['controller']))
    recorder = Node(
        package='dewing', executable='recorder', output='screen',
        parameters=[{'output': ParameterValue(value['bag'], value_type=str)}],
        condition=IfCondition(PythonExpression(["'", value['bag'], "' != ''"])))
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=help)
          for name, default, help in ARGUMENTS),
        recorder, controller, simulator,
        RegisterEventHandler(OnProcessExit(
            target_action=simulator, on_exit=[EmitEvent(event=Shutdown())])),
    ])
