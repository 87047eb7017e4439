# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Who a plant is: what a controller or a late listener must know to read its outputs."""

import dataclasses
import math
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import yaml

from dewing_sim.errors import BadInput
from dewing_sim.parameters import Case, from_mapping
from dewing_sim.plant import Outputs, Plant, units_of
from dewing_sim.quantities import Absent, schema
from dewing_sim.scales import Scales
from dewing_sim.schema import shown, yaml_text

LEAST = 1.0e-3          # of y_ref: a smaller camber is no reference
DOUBTFUL = 1.0e-4       # chords: a larger camber is one whatever y_ref


def version() -> str:
    """Return the installed version of dewing, or ``unknown`` beside bare sources."""
    try:
        return metadata.version('dewing')
    except metadata.PackageNotFoundError:
        return 'unknown'


def loss_of_tension(case: Case) -> float:
    """Return V_L^2, the V^2 at which the flat prestretched membrane of ``case`` goes slack."""
    from dewing_sim.structure.membrane import Membrane
    membrane = Membrane.from_parameters(case.membrane, Scales.of(case.flow, case.membrane.chord))
    return membrane.sheet.loss_of_tension_v_squared(case.membrane.prestretch)


def reference_deflection(case: Case) -> float:
    """Return y_ref = q c^2 / (8 T0) in m, T0 the tension of ``case`` without voltage."""
    from dewing_sim.structure.sheet import Sheet
    section = case.membrane
    tension = Sheet.from_parameters(section).respond([section.prestretch], 0.0).tension[0]
    return case.flow.dynamic_pressure * section.chord**2 / (8.0 * float(tension))


def require_reference(what: str, camber: float, case: Case | None) -> float:
    """Return ``camber`` (m) if others may be measured in it; raise `BadInput` otherwise.

    It may be negative, but is to exceed `LEAST` of y_ref, below which it may be rounding. Of a
    plant without ``case`` only that it is not zero can be told.
    """
    scale = 0.0
    if case is not None and not abs(camber) > DOUBTFUL * case.membrane.chord:
        scale = reference_deflection(case)
    if abs(camber) > LEAST * scale:
        return camber
    than = f', less than {LEAST:g} of y_ref = {scale:.3g} m' if scale else ''
    raise BadInput(f'{what}: the passive camber is {camber:.3g} m{than}: nothing can be measured '
                   'in it, nor a target be a multiple of it; change the angle of attack')


@dataclass(frozen=True)
class Identity:
    """Time step, references and limits of a plant, with the case it was built from."""

    plant: str                      # wing or reduced
    dt: float                       # s
    camber_mean: float | None       # m, passive: a_ref of a controller on it, of either sign
    camber_max: float | None        # m, the same of the largest; None: not an output
    v_squared_slack: float          # V^2 at the loss of tension, V_L^2
    v_squared_max: float            # V^2 the plant accepts
    case: dict                      # nested parameters of the case, empty when unknown
    version: str
    outputs: dict | None = None     # units of what responds to V^2; None: those of `Outputs`

    @classmethod
    def of(cls, name: str, plant: Plant, rest: Any, v_squared_max: float, case: dict,
           camber: tuple[float, float] | None = None) -> 'Identity':
        """Return the identity of ``plant``; raise `BadInput` for unusable references.

        ``camber`` is the passive one in m, its chord average and maximum: by default at ``rest``.
        """
        outputs = plant.observe(rest)
        if camber is None:
            camber = outputs.camber_mean, outputs.camber_max
        units = units_of(outputs)
        identity = cls(
            name, float(plant.dt), *(None if each is None else float(each) for each in camber),
            float(plant.v_squared_slack), float(v_squared_max), case, version(),
            None if units == schema(Outputs).units else units)
        return identity.checked()

    @property
    def units(self) -> dict[str, str]:
        """SI units, by name, of what responds to V^2 and may be identified."""
        return schema(Outputs).units if self.outputs is None else self.outputs

    @property
    def measured(self) -> tuple[str, ...]:
        """Names that a measurement may hold: those of `Outputs` that do, and any from outside."""
        known = schema(Outputs)
        return tuple(name for name in self.units
                     if name in known.measured or name not in known.units)

    def passive(self, output: str) -> float:
        """Return the passive camber in m by name, to measure others in.

        Raises `Absent` if the plant does not have it, `BadInput` if it is none to speak of, see
        `require_reference`.
        """
        value = getattr(self, output)
        if value is None:
            raise Absent(f'the plant ({self.plant}) has no output {output}: it has '
                         f'{", ".join(self.units)}')
        case = from_mapping(Case, self.case) if self.case else None
        return require_reference(output, value, case)

    def require_response(self) -> None:
        """Raise `BadInput` if V^2 moves nothing, as it does where the membrane lies flat.

        V^2 changes the tension, which acts through the curvature: without a passive camber the
        outputs respond by rounding errors. A plant without any camber among its outputs passes.
        """
        known = [name for name in ('camber_mean', 'camber_max')
                 if getattr(self, name) is not None]
        if known:
            self.passive(max(known, key=lambda name: abs(getattr(self, name))))

    def checked(self) -> 'Identity':
        """Return self; raise `BadInput` unless cambers are finite and other numbers positive."""
        for name in ('dt', 'camber_mean', 'camber_max', 'v_squared_slack', 'v_squared_max'):
            value = getattr(self, name)
            signed = name.startswith('camber')
            if value is None and signed:
                continue
            if not (isinstance(value, float) and math.isfinite(value)
                    and (signed or value > 0.0)):
                raise BadInput(f'identity: {name} = {shown(value)} is not a '
                               f'{"finite" if signed else "positive"} number')
        return self

    def to_yaml(self) -> str:
        """Return YAML from which `from_yaml` rebuilds the identity exactly."""
        known = dataclasses.asdict(self)
        if self.outputs is None:            # as version 0.1 wrote it
            del known['outputs']
        return yaml.safe_dump(known, sort_keys=False)

    @classmethod
    def from_yaml(cls, text: str) -> 'Identity':
        """Rebuild an identity; raise `BadInput` if ``text`` is not one."""
        try:
            return cls(**yaml_text.read(text, 'not the identity of a plant')).checked()
        except TypeError as error:
            raise BadInput(f'not the identity of a plant: {error}') from None
