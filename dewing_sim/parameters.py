# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters from files and back.

Two doors, one room: `load` reads a ROS-format YAML file, the nodes read declared ROS parameters;
both end in the strict `schema.from_mapping`. What there is to set stands in `case`.
"""

from importlib import resources
from pathlib import Path
from typing import Any, Mapping

import yaml

from dewing_sim.case import (
    Actuation,
    Case,
    Disturbance,
    Flow,
    Gust,
    Membrane,
    Numerics,
    RigidMotion,
)
from dewing_sim.errors import BadInput
from dewing_sim.schema import (
    Section,
    check,
    choice,
    count,
    describe,
    fields,
    flag,
    from_mapping,
    leaves,
    numbers,
    outside_modules,
    real,
    replace,
    ros_file,
    shown,
    text,
    to_mapping,
    yaml_text,
)

__all__ = [
    'Actuation', 'Case', 'Disturbance', 'Flow', 'Gust', 'Membrane', 'Numerics', 'RigidMotion',
    'check', 'choice', 'config_file', 'count', 'describe', 'fields', 'flag', 'from_mapping',
    'from_yaml', 'leaves', 'load', 'numbers', 'outside_modules', 'parse_assignment', 'real',
    'replace', 'text', 'to_mapping', 'to_yaml',
]


def parse_assignment(text: str) -> tuple[str, Any]:
    """Split ``section.key=value`` (the ``--set`` option) into name and YAML value."""
    name, equals, value = text.partition('=')
    if not equals or not name:
        raise BadInput(f'{shown(text)} is not of the form section.key=value')
    return name.strip(), yaml_text.read(value, f'{shown(text)} has no readable value')


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

    Of several for one node a word is enough: ``realtime`` among controllers is
    ``config/controller_realtime.yaml``. ``changes`` maps dotted names to values and is applied
    before checking.
    """
    path = config_file(_named_for(getattr(schema, 'ros_node', ''), name))
    try:
        text = path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f'{path}: cannot be read ({_one_line(error)})') from None
    section = from_yaml(text, schema, str(path))
    return replace(section, changes) if changes else section


def _named_for(node: str, name: str) -> str:
    """Return the full name of a shipped configuration for ``node``, if there is such a one."""
    full = f'{node}_{name}'
    there = str(name).isidentifier() and (_config_folder() / f'{full}.yaml').is_file()
    return full if there else name


def from_yaml(text: str, schema: type[Section] = Case, origin: str = 'YAML') -> Section:
    """Build a schema instance from ROS-format YAML; ``origin`` opens the messages of errors.

    It takes what the file has for every node and for ``schema.ros_node``, as ROS does.
    """
    tree = yaml_text.read(text, f'{origin}: not valid YAML', strict=True)
    try:
        return from_mapping(schema, ros_file.below(tree, getattr(schema, 'ros_node', '')))
    except BadInput as error:
        raise BadInput(f'{origin}: {error}') from None


def to_yaml(section: Any, key: str = '/**') -> str:
    """Return the ROS-format YAML, below ``key``, from which `from_yaml` rebuilds ``section``."""
    tree = {key: {ros_file.PARAMETERS: _without_empty(to_mapping(section))}}
    return yaml.safe_dump(tree, sort_keys=False)


def _without_empty(tree: dict) -> dict:
    """Return nested mappings less the empty ones, which ROS cannot read."""
    return {key: _without_empty(value) if isinstance(value, dict) else value
            for key, value in tree.items() if value != {}}


def _one_line(error: Exception) -> str:
    return ' '.join(str(error).split())
