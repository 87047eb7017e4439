# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The laws by the words of `membrane.law`, and the elastomer that a parameter section describes.

Gent's constants are `membrane.shear_modulus` and `membrane.gent_limit`; those of any other law
stand in `membrane.constants`, checked here against what the law declares.
"""

import inspect

from dewing_sim import parameters, plugins
from dewing_sim.errors import BadInput
from dewing_sim.scales import Scales
from dewing_sim.structure.material.elastomer import VACUUM_PERMITTIVITY, Elastomer
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.material.law import Law
from dewing_sim.structure.material.mooney_rivlin import MooneyRivlin
from dewing_sim.structure.material.ogden import Ogden

LAWS: dict[str, type[Law]] = {'gent': Gent, 'ogden': Ogden, 'mooney_rivlin': MooneyRivlin}


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
    if kind is not Gent:
        return parameters.from_mapping(kind, section.constants, 'membrane.constants')
    if section.constants:
        raise BadInput(f'membrane.constants.{next(iter(section.constants))} is not a parameter of '
                       'the law gent: it takes membrane.shear_modulus and membrane.gent_limit')
    return Gent(section.shear_modulus, section.gent_limit)


def elastomer_of(section: parameters.Membrane, scales: Scales) -> Elastomer:
    """Return the elastomer of a parameter section in the units of ``scales``.

    Voltages stay in volt: the permittivity is taken in units of pressure length^2 / V^2.
    """
    return Elastomer(
        law_of(section).in_units(scales.pressure), section.bulk_modulus / scales.pressure,
        VACUUM_PERMITTIVITY * section.relative_permittivity
        / (scales.pressure * scales.length ** 2))
