# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The laws by the words of `membrane.law`, and the elastomer that a parameter section describes.

Gent's constants are `membrane.shear_modulus` and `membrane.gent_limit`; those of any other law
stand in `membrane.constants`, checked here against what the law declares.
"""

import inspect
from collections.abc import Mapping

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.scales import Scales
from dewing_sim.schema import plugins
from dewing_sim.structure.material.elastomer import VACUUM_PERMITTIVITY, Elastomer
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.material.law import Law, Plane, energy, slopes
from dewing_sim.structure.material.mooney_rivlin import MooneyRivlin
from dewing_sim.structure.material.ogden import Ogden

LAWS: dict[str, type[Law]] = {'gent': Gent, 'ogden': Ogden, 'mooney_rivlin': MooneyRivlin}
# Stretches at which a law from outside is tried.
PROBES = ((1.1, 1.0, 0.95), (1.2, 1.1, 0.8))


def kind_of(word: str) -> type[Law]:
    """Return the class of a law, one of `LAWS` or ``package.module:Name``; raise `BadInput`."""
    if word in LAWS:
        return LAWS[word]
    found = plugins.load(word, 'membrane.law')
    if not (inspect.isclass(found) and issubclass(found, Law)) or inspect.isabstract(found):
        raise BadInput(f'membrane.law = {word!r} is not a law: a class with the base Law')
    return found


def law_of(section: parameters.Membrane) -> Law:
    """Return the law of a parameter section; raise `BadInput` for constants it does not take."""
    kind = kind_of(section.law)
    if section.law not in LAWS:
        return _from_outside(section.law, kind, section.constants)
    if kind is not Gent:
        return parameters.from_mapping(kind, section.constants, 'membrane.constants')
    if section.constants:
        raise BadInput(f'membrane.constants.{next(iter(section.constants))} is not a parameter of '
                       'the law gent: it takes membrane.shear_modulus and membrane.gent_limit')
    return Gent(section.shear_modulus, section.gent_limit)


def _from_outside(word: str, kind: type[Law], values: Mapping[str, float]) -> Law:
    """Return a law whose derivatives have been tried against differences of its energy."""
    try:
        law = parameters.from_mapping(kind, values, 'membrane.constants')
        wrong = inconsistent(law)
    except BadInput:
        raise
    except Exception as error:          # whatever a foreign law raises as it is called
        raise BadInput(f'membrane.law = {word!r} fails ({type(error).__name__}: {error})'
                       ) from error
    if wrong:
        raise BadInput(f'membrane.law = {word!r}: its derivatives are not those of its energy '
                       f'({wrong})')
    return law


def inconsistent(law: Law) -> str:
    """Return where the slopes of a law differ from differences of its energy, '' if nowhere."""
    return next(filter(None, (_inconsistent_at(law, *stretches) for stretches in PROBES)), '')


def _inconsistent_at(law: Law, l1: float, l2: float, l3: float) -> str:
    k, step = law.constants(0.0, 0.0), 1.0e-4
    i1, j = l1 * l1 + l2 * l2 + l3 * l3, l1 * l2 * l3

    def difference(function, by_i1, by_j):
        return (function(i1 + by_i1, j + by_j, l2, k)
                - function(i1 - by_i1, j - by_j, l2, k)) / (2.0 * step)
    expected = Plane(2.0 * difference(energy, step, 0.0), difference(energy, 0.0, step),
                     2.0 * difference(lambda *at: slopes(*at).f, step, 0.0),
                     difference(lambda *at: slopes(*at).f, 0.0, step),
                     difference(lambda *at: slopes(*at).c, 0.0, step))
    size = max(law.initial_shear_modulus, *map(abs, expected))
    for name, value, other in zip(Plane._fields, slopes(i1, j, l2, k), expected):
        if not abs(value - other) <= 1.0e-4 * size:
            return f'{name} is {value:.6g}, not {other:.6g}, at {l1:g}, {l2:g}, {l3:g}'
    return ''


def elastomer_of(section: parameters.Membrane, scales: Scales) -> Elastomer:
    """Return the elastomer of a parameter section in the units of ``scales``.

    Voltages stay in volt: the permittivity is taken in units of pressure length^2 / V^2.
    """
    return Elastomer(
        law_of(section).in_units(scales.pressure), section.bulk_modulus / scales.pressure,
        VACUUM_PERMITTIVITY * section.relative_permittivity
        / (scales.pressure * scales.length ** 2))
