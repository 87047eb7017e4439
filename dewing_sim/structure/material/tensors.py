# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The full tensors of an elastomer: derivatives by the deformation gradient in three dimensions.

The parts that depend on J and Y^2 = |cof(F) E0|^2, and laws of I1bar alone, follow from `motion`.
Of any other law the first and second derivative by F are, in principal axes n_a of the deformed
and N_a of the undeformed elastomer (Ogden, Non-linear elastic deformations, 1984, section 6.1),

    P = sum_a W_a n_a N_a,
    A = sum_ab W_ab n_a N_a n_b N_b + sum_(a != b) S_ab n_a N_b n_a N_b + R_ab n_a N_b n_b N_a.

S_ab and R_ab are differences of stresses over differences of stretches. The derivatives at a fixed
third stretch, `law.Plane`, are these already: S_ab = f and R_ab = -c J / (l_a l_b), without a
division by zero where stretches are equal.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.structure.material import law

_LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    _LEVI_CIVITA[_i, _j, _k], _LEVI_CIVITA[_i, _k, _j] = 1.0, -1.0


def _cofactor(gradient: np.ndarray) -> np.ndarray:
    """Return dJ/dF, (..., 3, 3)."""
    return 0.5 * np.einsum('iab,jcd,...ac,...bd->...ij', _LEVI_CIVITA, _LEVI_CIVITA,
                           gradient, gradient, optimize=True)


def _cofactor_slope(gradient: np.ndarray) -> np.ndarray:
    """Return d2J/dF dF, (..., 3, 3, 3, 3)."""
    return np.einsum('ika,jlb,...ab->...ijkl', _LEVI_CIVITA, _LEVI_CIVITA, gradient,
                     optimize=True)


class Motion(NamedTuple):
    """I1, J and Y^2 of deformation gradients with their (half) derivatives by F."""

    i1: np.ndarray
    j: np.ndarray
    y_squared: np.ndarray
    f: np.ndarray           # (..., 3, 3), F itself
    c: np.ndarray           # cof F
    y: np.ndarray
    c_both: np.ndarray      # (..., 3, 3, 3, 3)
    y_both: np.ndarray


def motion(gradient, field) -> Motion:
    """Return the motion of F (..., 3, 3) under nominal fields E0 (..., 3)."""
    gradient, field = np.asarray(gradient), np.asarray(field)
    cofactor = _cofactor(gradient)
    c_both = _cofactor_slope(gradient)
    electric = np.einsum('...ij,...j->...i', cofactor, field)
    slope = np.einsum('...ijkl,...j->...ikl', c_both, field)        # dY_i / dF_kl
    # Y is quadratic in F: its second derivative is that of the cofactor, a constant.
    bend = np.einsum('ikm,jln,...j,...i->...klmn', _LEVI_CIVITA, _LEVI_CIVITA, field, electric,
                     optimize=True)
    return Motion(
        np.einsum('...ij,...ij->...', gradient, gradient),
        np.einsum('...ij,...ij->...', gradient, cofactor) / 3.0,
        np.einsum('...i,...i->...', electric, electric),
        gradient, cofactor, np.einsum('...i,...ikl->...kl', electric, slope), c_both,
        np.einsum('...ikl,...imn->...klmn', slope, slope) + bend)


class Principal(NamedTuple):
    """Axes (..., 3, 3), in columns, and derivatives of a law by the principal stretches."""

    deformed: np.ndarray
    undeformed: np.ndarray
    energy: np.ndarray      # W, (...)
    first: np.ndarray       # W_a, (..., 3)
    second: np.ndarray      # W_ab, (..., 3, 3)
    like: np.ndarray        # S_ab
    swapped: np.ndarray     # R_ab


def principal(gradient, k: tuple) -> Principal:
    """Return what the law of the constants ``k`` says at F (..., 3, 3)."""
    gradient = np.asarray(gradient, dtype=float)
    squares, axes = np.linalg.eigh(np.swapaxes(gradient, -1, -2) @ gradient)
    lengths = np.sqrt(squares)
    found = np.array([_at(stretches, k) for stretches in lengths.reshape(-1, 3)])
    energy, first, second, like, swapped = np.split(found, [1, 4, 13, 22], axis=1)
    shape = lengths.shape[:-1]
    return Principal(gradient @ axes / lengths[..., None, :], axes, energy.reshape(shape),
                     first.reshape(*shape, 3), second.reshape(*shape, 3, 3),
                     like.reshape(*shape, 3, 3), swapped.reshape(*shape, 3, 3))


def _at(stretches: np.ndarray, k: tuple) -> np.ndarray:
    """Return W, W_a, W_ab, S_ab and R_ab in a row (31,)."""
    i1, j = float(np.sum(stretches ** 2)), float(np.prod(stretches))
    first, second = np.empty(3), np.empty((3, 3))
    like, swapped = np.zeros((3, 3)), np.zeros((3, 3))
    for a, b, third in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        s = law.slopes(i1, j, float(stretches[third]), k)
        la, lb = stretches[a], stretches[b]
        first[a] = s.f * la + s.c * j / la
        second[a, a] = (s.f + s.ff * la * la + 2.0 * s.fc * j + s.cc * (j / la) ** 2)
        second[a, b] = second[b, a] = (s.c * j + s.ff * la * la * lb * lb
                                       + s.fc * (la * la + lb * lb) * j + s.cc * j * j) / (la * lb)
        like[a, b] = like[b, a] = s.f
        swapped[a, b] = swapped[b, a] = -s.c * j / (la * lb)
    energy = law.energy(i1, j, float(stretches[2]), k)
    return np.concatenate([[energy], first, second.ravel(), like.ravel(), swapped.ravel()])


def stress_of(p: Principal) -> np.ndarray:
    """Return P, (..., 3, 3)."""
    return np.einsum('...a,...ia,...ja->...ij', p.first, p.deformed, p.undeformed)


def tangent_of(p: Principal) -> np.ndarray:
    """Return dP/dF, (..., 3, 3, 3, 3)."""
    n, m = p.deformed, p.undeformed
    return (np.einsum('...ab,...ia,...ja,...kb,...lb->...ijkl', p.second, n, m, n, m,
                      optimize=True)
            + np.einsum('...ab,...ia,...jb,...ka,...lb->...ijkl', p.like, n, m, n, m,
                        optimize=True)
            + np.einsum('...ab,...ia,...jb,...kb,...la->...ijkl', p.swapped, n, m, n, m,
                        optimize=True))
