# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of every parameter: its dataclass is documentation, check and ROS descriptor.

Two doors, one room: `load` reads a ROS-format YAML file, the nodes read declared ROS parameters;
both end in `from_mapping`, which accepts exactly the fields of a dataclass, each with the right
type and inside its range, and otherwise raises `BadInput` naming field, value, unit and range.
"""

import dataclasses
import math
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, Iterator, Mapping, TypeVar

import yaml

from dewing_sim.errors import BadInput

Section = TypeVar('Section')


def real(unit: str, meaning: str, low: float, high: float) -> Any:
    """Declare a floating-point field with its unit, meaning and admissible range."""
    return dataclasses.field(metadata=dict(
        type=float, unit=unit, meaning=meaning, low=low, high=high))


def count(meaning: str, low: int, high: int) -> Any:
    """Declare a whole-number field with its meaning and admissible range."""
    return dataclasses.field(metadata=dict(
        type=int, unit='', meaning=meaning, low=low, high=high))


def choice(meaning: str, *options: str) -> Any:
    """Declare a field that takes one of a few words."""
    return dataclasses.field(metadata=dict(
        type=str, unit='', meaning=meaning, options=options))


def text(meaning: str) -> Any:
    """Declare a free-text field, such as a path; it may be empty."""
    return dataclasses.field(metadata=dict(type=str, unit='', meaning=meaning))


@dataclass(frozen=True)
class Flow:
    """The air that meets the wing."""

    density: float = real('kg/m^3', 'air density', 1.0e-2, 1.0e4)
    kinematic_viscosity: float = real('m^2/s', 'air kinematic viscosity', 1.0e-8, 1.0e-2)
    speed: float = real('m/s', 'free-stream speed', 1.0e-3, 100.0)
    angle_of_attack_deg: float = real('deg', 'angle of attack of the chord', -15.0, 15.0)

    @property
    def angle_of_attack(self) -> float:
        """Angle of attack in radians."""
        return math.radians(self.angle_of_attack_deg)

    @property
    def dynamic_pressure(self) -> float:
        """Dynamic pressure q = rho U^2 / 2 in Pa."""
        return 0.5 * self.density * self.speed**2


@dataclass(frozen=True)
class Membrane:
    """The dielectric-elastomer membrane, pinned at leading and trailing edge."""

    chord: float = real('m', 'distance between the pinned edges', 1.0e-3, 1.0)
    initial_thickness: float = real('m', 'thickness before prestretch', 1.0e-6, 1.0e-2)
    prestretch: float = real('-', 'chordwise prestretch lambda_p', 1.0, 8.0)
    prestretch_lateral: float = real('-', 'spanwise prestretch lambda_z', 0.5, 8.0)
    density: float = real('kg/m^3', 'elastomer density', 10.0, 1.0e4)
    shear_modulus: float = real('Pa', 'Gent shear modulus mu', 1.0e2, 1.0e8)
    gent_limit: float = real('-', 'Gent limit Jm of I1 - 3', 1.0, 1.0e6)
    bulk_modulus: float = real('Pa', 'K of the volumetric energy K (J-1)^2', 1.0e4, 1.0e12)
    relative_permittivity: float = real('-', 'eps_r of the elastomer', 1.0, 1.0e3)
    elements: int = count('elements along the chord', 4, 2000)


@dataclass(frozen=True)
class Numerics:
    """How the equations are solved."""

    engine: str = choice('flow solver', 'finite_volume')
    grid: str = choice('flow grid preset', 'fast', 'standard', 'fine')
    time_step: float = real('s', 'time step dt', 1.0e-8, 1.0e-1)
    coupling_tolerance: float = real(
        '-', 'relative change of the membrane shape between coupling passes', 1.0e-12, 1.0e-1)
    coupling_iterations: int = count('most coupling passes in a step', 1, 100)
    trim_time: float = real(
        '-', 'convective times c/U marched from the flow start to the rest state', 0.0, 1.0e3)


@dataclass(frozen=True)
class Actuation:
    """The electrodes."""

    voltage: float = real('V', 'voltage of the rest state', 0.0, 1.0e5)
    voltage_limit: float = real('V', 'largest admissible voltage', 0.0, 1.0e5)


@dataclass(frozen=True)
class Disturbance:
    """Uniform wall pressure P (1 - cos 2 pi f t), paper eq. 11, pressing the camber down."""

    pressure: float = real('-', 'amplitude P as a fraction of q', -10.0, 10.0)
    frequency: float = real('Hz', 'frequency f', 0.0, 1.0e4)


@dataclass(frozen=True)
class Case:
    """A complete description of one wing in one flow."""

    flow: Flow
    membrane: Membrane
    numerics: Numerics
    actuation: Actuation
    disturbance: Disturbance


def fields(schema: type, prefix: str = '') -> Iterator[tuple[str, dataclasses.Field]]:
    """Yield (dotted name, field) of every leaf of a schema, depth first."""
    for field in dataclasses.fields(schema):
        if dataclasses.is_dataclass(field.type):
            yield from fields(field.type, f'{prefix}{field.name}.')
        else:
            yield prefix + field.name, field


def describe(field: dataclasses.Field) -> str:
    """Return meaning, unit and range of a field in one line, for descriptors and errors."""
    meta = field.metadata
    if 'options' in meta:
        return f"{meta['meaning']}; one of {', '.join(meta['options'])}"
    if 'low' not in meta:
        return meta['meaning']
    unit = f" [{meta['unit']}]" if meta['unit'] else ''
    return f"{meta['meaning']}{unit}, from {meta['low']:g} to {meta['high']:g}"


def check(name: str, field: dataclasses.Field, value: Any) -> Any:
    """Return ``value`` if ``field`` admits it; raise `BadInput` otherwise."""
    wanted = field.metadata['type']
    if type(value) is not wanted:
        hint = _FLOAT_HINT if wanted is float else ''
        raise BadInput(f'{name} = {value!r} is not a {_TYPE_NAMES[wanted]}{hint}: '
                       f'{describe(field)}')
    if 'options' in field.metadata:
        admissible = value in field.metadata['options']
    elif 'low' in field.metadata:
        admissible = field.metadata['low'] <= value <= field.metadata['high']
    else:
        admissible = True
    if not admissible:
        raise BadInput(f'{name} = {value!r} is out of range: {describe(field)}')
    return value


_TYPE_NAMES = {float: 'floating-point number', int: 'whole number', str: 'word'}
# YAML 1.1 reads 1e-4 and 1.0e4 as words, and ROS refuses an integer for a double.
_FLOAT_HINT = ' (write it with a decimal point and a signed exponent, as in 1.0 or 2.0e+4)'


def from_mapping(schema: type[Section], mapping: Any, name: str = '') -> Section:
    """Build a schema instance from nested mappings with exactly its keys.

    Raises `BadInput` for unknown or missing keys, wrong types and values out of range.
    """
    if not isinstance(mapping, Mapping):
        raise BadInput(f"{name or 'parameters'}: expected keys and values, got {mapping!r}")
    known = {field.name: field for field in dataclasses.fields(schema)}
    for key in mapping:
        if key not in known:
            raise BadInput(f'{_join(name, key)} is not a parameter; '
                           f"known here: {', '.join(known)}")
    values = {}
    for key, field in known.items():
        path = _join(name, key)
        if key not in mapping:
            raise BadInput(f'{path} is missing{_missing_hint(field)}')
        nested = dataclasses.is_dataclass(field.type)
        values[key] = (from_mapping(field.type, mapping[key], path) if nested
                       else check(path, field, mapping[key]))
    return schema(**values)


def _join(prefix: str, key: Any) -> str:
    return f'{prefix}.{key}' if prefix else str(key)


def _missing_hint(field: dataclasses.Field) -> str:
    return f': {describe(field)}' if field.metadata else ' (a section)'


def to_mapping(section: Any) -> dict:
    """Return the nested mapping from which `from_mapping` rebuilds ``section``."""
    return dataclasses.asdict(section)


def replace(section: Section, changes: Mapping[str, Any]) -> Section:
    """Return ``section`` with dotted keys changed, checked as on loading."""
    mapping = to_mapping(section)
    for name, value in changes.items():
        *path, last = name.split('.')
        target = mapping
        for key in path:
            target = target.get(key) if isinstance(target, dict) else None
        if not isinstance(target, dict):
            raise BadInput(f"{name} is not a parameter; sections here: {', '.join(mapping)}")
        target[last] = value
    return from_mapping(type(section), mapping)


def parse_assignment(text: str) -> tuple[str, Any]:
    """Split ``section.key=value`` (the ``--set`` option) into name and YAML value."""
    name, equals, value = text.partition('=')
    if not equals or not name:
        raise BadInput(f'{text!r} is not of the form section.key=value')
    try:
        return name.strip(), yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise BadInput(f'{text!r} has no readable value ({_one_line(error)})') from None


def config_file(name: str, directory: str | None = None) -> Path:
    """Return the path of a shipped configuration, or of the user's file of that name.

    A word without suffix is a shipped file (``paper`` is ``config/paper.yaml``).
    """
    path = Path(name)
    if path.suffix in ('.yaml', '.yml') or len(path.parts) > 1:
        if not path.is_file():
            raise BadInput(f'{name}: no such file')
        return path
    folder = Path(directory) if directory else _config_folder()
    shipped = folder / f'{name}.yaml'
    if not shipped.is_file():
        known = ', '.join(sorted(file.stem for file in folder.glob('*.yaml')))
        raise BadInput(f'{name!r} is not a shipped configuration ({known}) nor a YAML file')
    return shipped


def _config_folder() -> Path:
    """Return the folder of shipped YAML: beside the sources, else as installed."""
    beside = Path(__file__).resolve().parents[1] / 'config'
    if (beside / 'paper.yaml').is_file():
        return beside
    return Path(str(resources.files('dewing_config')))


def load(name: str, schema: type[Section] = Case, changes: Mapping[str, Any] | None = None,
         ) -> Section:
    """Load a shipped configuration or a ROS-format YAML file into ``schema``.

    ``changes`` maps dotted names to values and is applied before checking.
    """
    path = config_file(name)
    try:
        text = path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f'{path}: cannot be read ({_one_line(error)})') from None
    section = from_yaml(text, schema, str(path))
    return replace(section, changes) if changes else section


def from_yaml(text: str, schema: type[Section] = Case, origin: str = 'YAML') -> Section:
    """Build a schema instance from ROS-format YAML; ``origin`` opens the messages of errors."""
    try:
        parameters = yaml.load(text, _StrictLoader)['/**']['ros__parameters']
    except yaml.YAMLError as error:
        raise BadInput(f'{origin}: not valid YAML ({_one_line(error)})') from None
    except (TypeError, KeyError):
        raise BadInput(f'{origin}: parameters are expected below /**: ros__parameters:') from None
    try:
        return from_mapping(schema, parameters)
    except BadInput as error:
        raise BadInput(f'{origin}: {error}') from None


def to_yaml(section: Any) -> str:
    """Return the ROS-format YAML from which `from_yaml` rebuilds ``section``."""
    tree = {'/**': {'ros__parameters': to_mapping(section)}}
    return yaml.safe_dump(tree, sort_keys=False)


class _StrictLoader(yaml.SafeLoader):
    """A YAML loader that refuses a repeated key instead of taking its last value."""

    def construct_mapping(self, node, deep=False):
        keys = [self.construct_object(key, deep) for key, _ in node.value]
        for key in keys:
            if keys.count(key) > 1:
                raise yaml.constructor.ConstructorError(
                    None, None, f'{key} is given twice', node.start_mark)
        return super().construct_mapping(node, deep)


def _one_line(error: Exception) -> str:
    return ' '.join(str(error).split())
