# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The control laws: a law of dewing's own is a file and its line in `LAWS`.

A law from outside the package needs no line: its kind is ``package.module:Name``.
"""

import dataclasses
import math
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

import numpy as np

from dewing_control.law.base import Law, Settings
from dewing_control.law.lqg import Lqg
from dewing_control.law.mpc import Mpc
from dewing_control.law.periodic import Periodic
from dewing_control.law.pid import Pid
from dewing_control.model import design
from dewing_control.model.design import Design
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.plant import measurement_type
from dewing_sim.schema import plugins

LAWS: dict[str, type[Law]] = {law.kind: law for law in (Pid, Periodic, Lqg, Mpc)}
TRIED = 3                   # steps in which any gain that is not finite has reached V^2


def of_kind(kind: str) -> type[Law]:
    """Return the law that ``kind`` names; raise `BadInput` if there is none that can be used."""
    if kind in LAWS:
        return LAWS[kind]
    if not plugins.is_plugin(kind):
        raise BadInput(f'kind = {kind!r} is no control law: one of {", ".join(LAWS)} or '
                       'package.module:Name')
    found = plugins.load(kind, 'kind')
    try:
        flaw = _flaw(found)
    except Exception as error:                      # whatever stands there in place of a mapping
        flaw = f'its declarations cannot be read ({type(error).__name__}: {error})'
    if flaw:
        raise BadInput(f'kind = {kind!r} is no control law: {flaw}')
    return found


def _flaw(found: type) -> str:
    """Return why ``found`` cannot be used as a law, nothing if it can."""
    if not (isinstance(found, type) and issubclass(found, Law)):
        return 'it does not inherit Law of dewing_control.law.base'
    if found.__abstractmethods__:
        return f'it does not define {", ".join(sorted(found.__abstractmethods__))}'
    for name, section in found.sections.items():
        if not (dataclasses.is_dataclass(section) and all(
                'type' in field.metadata for _, field in parameters.fields(section))):
            return (f'its section {name} is no dataclass of fields declared by real, count, '
                    'choice and text of dewing_sim.parameters')
    known = {f'{name}.{leaf}': field for name, section in found.sections.items()
             for leaf, field in parameters.fields(section)}
    for name, field in known.items():
        if 'default' in field.metadata:
            parameters.check(name, field, field.metadata['default'])
    unknown = [name for name in found.memory if name not in known]
    if unknown:
        return f'its memory depends on {unknown[0]}, which is not in its sections'
    for name, (low, high) in found.ranges.items():
        if name not in known or not 0.0 < low < high:
            return f'its range of {name} is not that of a positive setting in its sections'
    return ''


def installed(kind: str) -> bool:
    """Return whether all that the law ``kind`` imports is there."""
    return not _missing(of_kind(kind))


def _missing(found: type[Law]) -> list[str]:
    return [what for module, what in found.requires.items() if find_spec(module) is None]


def law(settings: Settings, identity: Identity, model: Design | None = None) -> Law:
    """Return the law that ``settings.kind`` names, for the plant of ``identity``.

    ``model`` is what a law that needs one is designed on, by default that in the file
    ``settings.model``. Raises `BadInput` if the kind is not known, if its model is missing or
    unusable, and whenever the design fails or leads to a V^2 that is not finite.
    """
    found = of_kind(settings.kind)
    if _missing(found):
        raise BadInput(f"kind = {settings.kind} needs more: pip install '{_missing(found)[0]}'")
    with refusing(settings.kind):
        models = (model or _model(settings, identity),) if found.needs_model else ()
        made = found.of(settings, identity, *models)
        _try(made, settings, identity)
    return made


@contextmanager
def refusing(kind: str) -> Iterator[None]:
    """Turn whatever fails within a design into `BadInput`.

    That is the LinAlgError of a Riccati equation without a solution, or anything that a law from
    outside raises.
    """
    try:
        with np.errstate(all='ignore'):             # whether all is finite is tried afterwards
            yield
    except BadInput:
        raise
    except Exception as error:
        raise BadInput(f'kind = {kind} cannot be designed with these settings '
                       f'({type(error).__name__}: {" ".join(str(error).split())})') from error


def _model(settings: Settings, identity: Identity) -> Design:
    return design.load(settings.model, settings.reference.output,
                       settings.command.period_steps * identity.dt)


def _try(made: Law, settings: Settings, identity: Identity) -> None:
    """Let the law answer the plant at rest; raise `BadInput` if it cannot."""
    values = dict.fromkeys((*identity.measured, 'v_squared'), 0.0) | {
        name: getattr(identity, name) for name in ('camber_mean', 'camber_max')
        if name in identity.measured}
    rest = measurement_type(tuple(values))(0.0, *values.values())
    memory = made.start(0.0)
    for step in range(TRIED):
        time = step * settings.command.period_steps * identity.dt
        memory, v_squared = made.step(memory, rest._replace(time=time))
        if not math.isfinite(v_squared):
            raise BadInput(f'kind = {settings.kind} cannot be designed with these settings: it '
                           f'answers the plant at rest with V^2 = {v_squared}')
