# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters given to a node from outside: for which of its schemas they are, or for others.

ROS hands a file's section ``/**`` to every node, and a node that declares its parameters never
sees what is meant for others. These nodes declare what they are given, so as to refuse a name that
was mistyped; a name of a file for all is mistyped only if it stands in a section of their own.
"""

import dataclasses
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from dewing_sim.errors import BadInput
from dewing_sim.ros import messages
from dewing_sim.schema import ros_file, yaml_text

LISTED = 9      # names in a warning


def take(node, *schemas: type, given: Mapping[str, Any] | None = None) -> list[dict[str, Any]]:
    """Return what is given to ``node`` for each of ``schemas``, and leave it undeclared.

    ``given`` are its overrides where they have been taken already. Names that only files for
    every node have, and in no section of ``schemas``, are warned of; raises `BadInput` for others.
    """
    if given is None:
        given = messages.take_overrides(node)
    known = [{field.name for field in dataclasses.fields(schema)} for schema in schemas]
    taken, foreign = [{} for _ in schemas], []
    shared = shared_names(sys.argv) if given else set()
    for name, value in given.items():
        section = name.partition('.')[0]
        owner = next((number for number, names in enumerate(known) if section in names), None)
        if owner is not None:
            taken[owner][name] = value
        elif name in shared:
            foreign.append(name)
        else:
            raise BadInput(f'{name} is not a parameter; known here: '
                           + ', '.join(field.name for schema in schemas
                                       for field in dataclasses.fields(schema)))
    if foreign:
        more = ' and others' if len(foreign) > LISTED else ''
        node.get_logger().warning(f'not parameters of {node.get_name()}, ignored: '
                                  f'{", ".join(foreign[:LISTED])}{more}')
    return taken


def shared_names(arguments: Sequence[str]) -> set[str]:
    """Return the names that the files of ``--params-file`` give to nodes of any name."""
    names = set()
    for option, path in zip(arguments, arguments[1:]):
        if option == '--params-file':
            tree = yaml_text.read(Path(path).read_text(encoding='utf-8'), path)
            for key in filter(ros_file.is_shared, tree if isinstance(tree, dict) else ()):
                names |= ros_file.dotted((tree[key] or {}).get(ros_file.PARAMETERS))
    return names
