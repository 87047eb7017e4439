# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A law of elasticity: its constants, its energy in the plane of the strip, its lock-up.

Both elements deform a strip in the plane of two principal stretches while the third one, across
the strip, is prescribed. An isotropic energy W of the change of shape then depends on

    I1 = tr(F^T F),   J = det F   and the prescribed stretch lambda_z

only: of the other two, the squares have the sum I1 - lambda_z^2 and the product (J / lambda_z)^2.
A law is therefore given to compiled code by three functions, `Compiled`, with derivatives by I1
and J at fixed lambda_z. Laws rarely write them: the classes of `forms` make them of derivatives by
the invariants or of exponents.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cache
from typing import ClassVar, NamedTuple

from numba.extending import overload

from dewing_sim.errors import BadInput
from dewing_sim.structure.material import constants

OPTIONS = {'error_model': 'numpy'}


class Plane(NamedTuple):
    """Derivatives of W by I1 and J: f = 2 W_I, c = W_J, ff = 4 W_II, fc = 2 W_IJ, cc = W_JJ.

    f is the shear stiffness in the plane: tau_1 - tau_3 = f (lambda_1^2 - lambda_3^2).
    """

    f: float
    c: float
    ff: float
    fc: float
    cc: float


class Compiled(NamedTuple):
    """What kernels call; ``k`` is the tuple of constants, stretches are those of F.

    ``energy(i1, j, lateral, k)`` returns W, zero where nothing is deformed, and
    ``slopes(i1, j, lateral, k)`` its `Plane`. ``deviatoric(c11, c22, c12, c33, k)`` returns S_11,
    S_22 and S_12, the second Piola-Kirchhoff stress of W, from F^T F whose third axis is the
    prescribed one.
    """

    energy: Callable
    slopes: Callable
    deviatoric: Callable


@dataclass(frozen=True)
class Law(ABC):
    """Base of all laws: a frozen dataclass whose fields are constants declared by `schema.real`.

    W is proportional to the constants in Pa. ``TITLE`` and the docstring describe the law.
    """

    TITLE: ClassVar[str] = ''
    OF_I1_ALONE: ClassVar[bool] = False     # W = W(I1bar), whatever the prescribed stretch
    TAKES_ARRAYS: ClassVar[bool] = False    # so do its functions in plain Python

    def __post_init__(self):
        """Raise `BadInput` unless the undeformed elastomer resists shear."""
        modulus = self.initial_shear_modulus
        if not 0.0 < modulus < math.inf:
            raise BadInput(f'the constants of {type(self).__name__} make an initial shear modulus '
                           f'of {modulus:g} Pa; it must be more than zero')

    @classmethod
    @abstractmethod
    def compile(cls) -> Compiled:
        """Return the functions of the law, each a `kernels.formula`; called once."""

    def overrun(self, i1: float, i2: float) -> float:
        """Return a number that rises through zero where the law locks up, at I1bar and I2bar.

        Below zero for all deformations, as here, it never does.
        """
        return -math.inf

    @property
    def limit(self) -> str:
        """What happens where f is no longer positive, in the words of an error."""
        return f'the law {type(self).__name__} no longer resists shear'

    @property
    def initial_shear_modulus(self) -> float:
        """The shear modulus of the undeformed elastomer, Pa: f there."""
        return float(slopes(3.0, 1.0, 1.0, self.constants(0.0, 0.0)).f)

    def constants(self, bulk: float, eps: float, gain: float = 0.0) -> tuple:
        """Return the tuple for kernels, with W multiplied by 1 + ``gain``."""
        own = ((1.0 + gain) * value if is_modulus else value
               for value, is_modulus in zip(vars(self).values(), _moduli(type(self))))
        return tuple_of(type(self))(*own, bulk, eps)

    def in_units(self, pressure: float) -> 'Law':
        """Return the law with constants in units of ``pressure`` (Pa)."""
        return type(self)(*(value / pressure if is_modulus else value for value, is_modulus
                            in zip(vars(self).values(), _moduli(type(self)))))


@cache
def _moduli(kind: type[Law]) -> list[bool]:
    return [field.metadata['unit'] == 'Pa' for field in fields(kind)]


@cache
def tuple_of(kind: type[Law]) -> type:
    """Return the class of the tuples of constants of a law; it tells kernels the law."""
    return constants.tuple_of(kind, kind.compile())


def energy(i1, j, lateral, k):
    """Return W of the law of ``k``, see `Compiled`."""
    return type(k).compiled.energy(i1, j, lateral, k)


def slopes(i1, j, lateral, k):
    """Return the `Plane` of the law of ``k``."""
    return type(k).compiled.slopes(i1, j, lateral, k)


def deviatoric(c11, c22, c12, c33, k):
    """Return S_11, S_22, S_12 of the law of ``k``."""
    return type(k).compiled.deviatoric(c11, c22, c12, c33, k)


# Inside compiled code the type of the tuple chooses the law, when the kernel is compiled.

@overload(energy, jit_options=OPTIONS, strict=False)
def _energy(i1, j, lateral, k):
    return k.instance_class.compiled.energy


@overload(slopes, jit_options=OPTIONS, strict=False)
def _slopes(i1, j, lateral, k):
    return k.instance_class.compiled.slopes


@overload(deviatoric, jit_options=OPTIONS, strict=False)
def _deviatoric(c11, c22, c12, c33, k):
    return k.instance_class.compiled.deviatoric
