# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs, commands and parameters to ROS messages and back: pure functions.

Frames: ``wing`` has x along the chord from the leading edge and y towards the upper side,
``wind`` has x along the free stream and y along the lift; z follows from the right-hand rule.
"""

import dataclasses
from array import array
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, WrenchStamped
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import ColorRGBA, Float64
from visualization_msgs.msg import Marker

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.parameters import Case, Flow
from dewing_sim.plant import Measurement, Outputs, measurement_type
from dewing_sim.quantities import schema
from dewing_sim.ros import codec, names

MEASURED = list(schema(Outputs).measured)      # by the wing
COMMANDED = ('v_squared',)
MEMBRANE_FIELDS = ('x', 'y', 'z', 'dp', 'tension')
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def to_stamp(nanoseconds: int) -> Time:
    """Return the stamp of a whole number of nanoseconds."""
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return Time(sec=seconds, nanosec=rest)


def from_stamp(stamp: Time) -> int:
    """Return the nanoseconds of a stamp."""
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def measurement(outputs: Outputs) -> JointState:
    """Return the measured quantities (SI) by name, stamped with simulated time.

    What the plant does not have is not in it.
    """
    seen = Measurement.of(outputs)
    message = JointState(name=list(seen._fields[1:]), position=array('d', seen[1:]))
    message.header.stamp = to_stamp(round(outputs.time * 1.0e9))
    return message


def to_measurement(message: JointState) -> Measurement:
    """Return the quantities of a message; raise `BadInput` for names that are unusable.

    A quantity that the message does not have is missed when a controller asks for it.
    """
    return measured(codec.reading(message, 'position'))


def measured(read: codec.Reading) -> Measurement:
    """Return the quantities of a measurement that was read, as `to_measurement` does."""
    stamp, names, values = read
    if len(names) != len(values):
        raise BadInput(f'measurement with {len(names)} names and {len(values)} positions')
    try:
        return measurement_type(names)(stamp * 1.0e-9, *values)
    except ValueError as error:
        raise BadInput(f'measurement with unusable names: {error}') from None


def command(v_squared: float, stamp: Time) -> JointState:
    """Return the command V^2 that answers the measurement stamped ``stamp``."""
    message = JointState(name=COMMANDED, effort=array('d', [v_squared]))
    message.header.stamp = stamp
    return message


def to_v_squared(message: JointState) -> float:
    """Return V^2 of a command; raise `BadInput` if it is not one."""
    return commanded(codec.reading(message, 'effort'))


def commanded(read: codec.Reading) -> float:
    """Return V^2 of a command that was read, as `to_v_squared` does."""
    if read.names != COMMANDED or len(read.values) != 1:
        raise BadInput(f'command with names {list(read.names)} and {len(read.values)} '
                       f'efforts; expected one effort named v_squared')
    return read.values[0]


def outputs(outputs: Outputs) -> JointState:
    """Return every number that the plant has (SI), by name, stamped with simulated time."""
    known = schema(type(outputs))
    names, values = known.given(outputs, known.scalars)
    message = JointState(name=list(names[1:]), position=array('d', values[1:]))     # but time
    message.header.stamp = to_stamp(round(outputs.time * 1.0e9))
    return message


def scalar(value: float) -> Float64:
    """Return a plain number to echo and plot."""
    return Float64(data=float(value))


def clock(time: float) -> Clock:
    """Return simulated time (s)."""
    return Clock(clock=to_stamp(round(time * 1.0e9)))


def membrane(outputs: Outputs, frame: str = 'wing') -> PointCloud2:
    """Return the membrane nodes in m with the pressure jump in Pa and the tension in N/m."""
    points = np.zeros((outputs.x.size, len(MEMBRANE_FIELDS)), np.float32)
    points[:, 0], points[:, 1] = outputs.x, outputs.y
    points[:, 3], points[:, 4] = outputs.pressure_jump, outputs.tension
    message = PointCloud2(height=1, width=len(points), is_dense=True, is_bigendian=False)
    message.header.frame_id = frame
    message.header.stamp = to_stamp(round(outputs.time * 1.0e9))
    message.fields = [PointField(name=name, offset=4 * i, datatype=PointField.FLOAT32, count=1)
                      for i, name in enumerate(MEMBRANE_FIELDS)]
    message.point_step = 4 * len(MEMBRANE_FIELDS)
    message.row_step = message.point_step * len(points)
    message.data = array('B', points.astype('<f4').tobytes())
    return message


def membrane_marker(outputs: Outputs, exaggeration: float, frame: str = 'wing') -> Marker:
    """Return the membrane as a line in its frame, the deflection times ``exaggeration``."""
    marker = Marker(ns='membrane', type=Marker.LINE_STRIP, action=Marker.ADD)
    marker.header.frame_id = frame
    marker.header.stamp = to_stamp(round(outputs.time * 1.0e9))
    marker.pose.orientation.w = 1.0
    marker.scale.x = 0.005 * float(np.ptp(outputs.x))       # width of the line in m
    marker.color = ColorRGBA(r=0.0, g=0.45, b=0.7, a=1.0)
    marker.points = [Point(x=x, y=y) for x, y in zip(
        outputs.x.tolist(), (exaggeration * outputs.y).tolist())]
    return marker


def loads(outputs: Outputs, flow: Flow, chord: float, frame: str = 'wind') -> WrenchStamped:
    """Return drag and lift (N/m) and the moment about c/4 (N) per unit span in wind axes.

    The moment about z is positive nose down, as the right-hand rule has it.
    """
    scale = flow.dynamic_pressure * chord
    message = WrenchStamped()
    message.header.frame_id = frame
    message.header.stamp = to_stamp(round(outputs.time * 1.0e9))
    message.wrench.force.x = scale * outputs.cd
    message.wrench.force.y = scale * outputs.cl
    message.wrench.torque.z = -scale * chord * outputs.cm
    return message


def diagnostics(name: str, level: bytes, sentence: str, values: Mapping[str, Any], stamp: Time,
                ) -> DiagnosticArray:
    """Return the status of the node with the full ``name``, with ``values`` as text."""
    status = DiagnosticStatus(name=name, level=level, message=sentence,
                              hardware_id=names.hardware(name.rpartition('/')[0]))
    status.values = [KeyValue(key=key, value=str(value)) for key, value in values.items()]
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def descriptor(field: dataclasses.Field, read_only: bool) -> ParameterDescriptor:
    """Return meaning, unit and range of a schema field for ``ros2 param describe``."""
    result = ParameterDescriptor(description=parameters.describe(field), read_only=read_only)
    meta = field.metadata
    if 'low' in meta and meta['type'] is float:
        result.floating_point_range = [FloatingPointRange(
            from_value=meta['low'], to_value=meta['high'])]
    elif 'low' in meta:
        result.integer_range = [IntegerRange(from_value=meta['low'], to_value=meta['high'])]
    if 'options' in meta:
        outside = ' or package.module:Name' if meta.get('open') else ''
        result.additional_constraints = 'one of ' + ', '.join(meta['options']) + outside
    return result


def take_overrides(node) -> dict[str, Any]:
    """Return the parameters given to a node from outside, and leave them undeclared.

    The node must have been made with ``automatically_declare_parameters_from_overrides``; what
    ROS itself declares stays declared.
    """
    given = {name: parameter.value for name, parameter
             in node.get_parameters_by_prefix('').items()
             if not name.startswith(('qos_overrides.', 'use_sim_time', 'start_type_desc'))}
    for name in given:
        node.undeclare_parameter(name)
    return given


def declare(node, section: Any, read_only: bool, live: Collection[str] = (),
            open_fields: Mapping[str, Any] | None = None) -> None:
    """Declare every leaf of ``section`` with its value, unit, meaning and range.

    What is declared already stays as it is. ``live`` names leaves that may be changed although
    the others are read-only; ``open_fields`` are the declarations of what stands in open sections.
    """
    known = open_fields or {}
    for name, value, field in parameters.leaves(section):
        if not node.has_parameter(name):
            described = descriptor(known.get(name, field), read_only and name not in live)
            node.declare_parameter(name, value, described, ignore_override=True)


def constants(case: Case) -> dict[str, Any]:
    """Return the declarations of the constants of another law than Gent's, if there are any."""
    if not case.membrane.constants:
        return {}
    from dewing_sim.structure.material.registry import kind_of
    return {f'membrane.constants.{name}': field
            for name, field in parameters.fields(kind_of(case.membrane.law))}


def changed(section: Any, given) -> tuple[Any, SetParametersResult]:
    """Return ``section`` with ROS parameters ``given`` replaced, and the answer to the setter.

    Names outside the section are not its business; a refused value leaves it as it is.
    """
    known = {name for name, _value, _field in parameters.leaves(section)}
    changes = {item.name: item.value for item in given if item.name in known}
    try:
        return parameters.replace(section, changes), SetParametersResult(successful=True)
    except BadInput as error:
        return section, SetParametersResult(successful=False, reason=str(error))
