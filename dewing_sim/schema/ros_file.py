# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files of ROS: whose the parameters are that stand below a key."""

from typing import Any

from dewing_sim.errors import BadInput

PARAMETERS = 'ros__parameters'
WILD = ('**', '*')


def is_for(key: Any, node: str) -> bool:
    """Return whether the key of a file is for a node of the name ``node`` in some namespace.

    ``/**`` is for every node; ``/**/simulator``, ``/dewing/simulator`` and ``simulator`` are for
    one of that name.
    """
    return isinstance(key, str) and key.rpartition('/')[2] in (*WILD, node)


def is_shared(key: Any) -> bool:
    """Return whether the key of a file is for nodes of any name."""
    return is_for(key, WILD[0])


def below(tree: Any, node: str) -> Any:
    """Return the parameters that a file is to give the node ``node``, later keys over earlier.

    Raises `BadInput` if there are none.
    """
    keys = [key for key in tree if is_for(key, node)] if isinstance(tree, dict) else []
    found = [tree[key][PARAMETERS] for key in keys
             if isinstance(tree[key], dict) and PARAMETERS in tree[key]]
    if not found:
        own = f' or /**/{node}' if node else ''
        raise BadInput(f'parameters are expected below /**{own}: {PARAMETERS}:')
    result = found[0]
    for more in found[1:]:
        result = _merged(result, more)
    return result


def _merged(below: Any, above: Any) -> Any:
    if not (isinstance(below, dict) and isinstance(above, dict)):
        return above
    return below | {key: _merged(below.get(key), value) for key, value in above.items()}


def dotted(tree: Any, prefix: str = '') -> set[str]:
    """Return the dotted names of all leaves of nested parameters."""
    if not isinstance(tree, dict):
        return {prefix[:-1]} if prefix else set()
    return {name for key, value in tree.items() for name in dotted(value, f'{prefix}{key}.')}
