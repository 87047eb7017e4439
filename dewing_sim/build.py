# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From parameters to a plant with its states, its files and its identity."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dewing_sim import parameters
from dewing_sim.errors import BadInput, DewingError
from dewing_sim.fluid.base import Monitor
from dewing_sim.identity import Identity
from dewing_sim.linear import reduced
from dewing_sim.parameters import Case
from dewing_sim.plant import Plant
from dewing_sim.schema import plugins
from dewing_sim.settings import SimulatorSettings


@dataclass(frozen=True)
class Built:
    """A plant, its rest state, what it is, and how its states go to a file and back.

    ``monitor`` and ``caution`` are those of the flow of a state, zero and empty where none is
    solved.
    """

    plant: Plant
    rest: Any
    identity: Identity
    save: Callable[[str, Any], None]
    load: Callable[[str], Any]
    monitor: Callable[[Any], Monitor]
    caution: Callable[[Any], str]
    incidence: Callable[[Any], float] | None = None     # of a state in rad; None: there is none
    pitches: bool = False                               # whether that may change


def build(settings: SimulatorSettings, case: Case, progress=None) -> Built:
    """Return what ``settings`` and ``case`` describe; raise `BadInput` if they cannot.

    ``progress(done, total)`` is called while a wing is trimmed.
    """
    if settings.run.plant == 'wing':
        return build_wing(case, progress)
    if plugins.is_plugin(settings.run.plant):
        return build_foreign(settings.run.plant, case)
    if not settings.model:
        raise BadInput('model is empty: the reduced plant needs the npz file of its matrices')
    return build_reduced(settings.model)


def build_wing(case: Case, progress=None) -> Built:
    """Return the Navier-Stokes wing of ``case``, trimmed."""
    from dewing_sim.rest import checkpoint, passive
    from dewing_sim.wing import Wing
    wing = Wing(case)
    rest = wing.rest(progress)
    identity = Identity.of('wing', wing, rest, case.actuation.voltage_limit**2,
                           parameters.to_mapping(wing.case),
                           passive.camber(wing, rest, progress))

    def load(path: str) -> Any:
        if checkpoint.load_case(path) != wing.case:
            raise BadInput(f'{path}: the saved state belongs to another case')
        return checkpoint.load(path)

    return Built(wing, rest, identity,
                 lambda path, state: checkpoint.save(path, state, wing.case), load,
                 wing.monitor, wing.caution, incidence=wing.incidence,
                 pitches='motion' in wing.open_to)


def build_reduced(model: str) -> Built:
    """Return the linear plant of the npz file ``model``."""
    plant = reduced.load(model)
    rest = plant.rest()
    text = plant.model.case_yaml
    case = parameters.to_mapping(parameters.from_yaml(text)) if text else {}
    identity = Identity.of('reduced', plant, rest, plant.v_squared_max, case)
    return Built(plant, rest, identity, plant.save, plant.load,
                 lambda _: Monitor(0.0, 0.0, 0.0), lambda _: '')


def build_foreign(word: str, case: Case) -> Built:
    """Return the plant that ``package.module:Name`` makes of ``case``.

    Besides what `Plant` says it has ``v_squared_slack``, the V^2 at the loss of tension, and, if
    its states may be kept, ``save(path, state)`` and ``load(path)``. Raises `BadInput` if it
    cannot be made, or is no plant.
    """
    make = plugins.load(word, 'run.plant')
    try:
        plant = make(case)
        rest = plant.rest()
        identity = Identity.of(word, plant, rest, case.actuation.voltage_limit**2,
                               parameters.to_mapping(case))
    except DewingError:
        raise
    except Exception as error:          # whatever a foreign plant raises
        raise BadInput(f'run.plant = {word!r} cannot be built '
                       f'({type(error).__name__}: {error})') from error

    def refuse(path: str, state: Any = None) -> Any:
        raise BadInput(f'{path}: the plant {word} does not keep its states')

    return Built(plant, rest, identity, getattr(plant, 'save', refuse),
                 getattr(plant, 'load', refuse), lambda _: Monitor(0.0, 0.0, 0.0), lambda _: '')
