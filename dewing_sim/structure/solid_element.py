# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A solid element through the thickness of a strip in plane strain: energy and derivatives.

The eight-node hexahedron whose lateral displacement is prescribed has equal deformation
on both lateral faces, so it is exactly a four-node quadrilateral times the span, with the lateral
stretch in F. With xi, eta from -1 to 1 along length L and thickness H, nodes b0, t0, b1, t1,

    dx/dX = m + eta g/L,  dx/dY = n + xi g/H,   g = (t1 - t0 - b1 + b0) / 2.

Against volumetric and shear locking the element is Simo and Rifai's Q1/E4 (doi
10.1002/nme.1620290802) at finite strain with the transposed modes of Glaser and Armero (doi
10.1108/02644409710188664): written in the basis m, n at the centre, g = p L m + q H n, and with
both shear modes at their natural values, where they cancel the parasitic shear,

    F = [s1 m, s2 n],   s1 = 1 + xi a + eta p,   s2 = 1 + eta b + xi q.

The enhanced strains a, b minimise the energy of each element and are condensed. The energy
depends on A = m.m, B = n.n, D = m x n, p and q: rotations drop out.
"""

import math

import numba
import numpy as np

from dewing_sim.structure.material import Slopes, modulus, slopes, stress

BALANCED, LOCKED, INVERTED, UNBALANCED = 0, 1, 2, 3
GAUSS = math.sqrt(1.0 / 3.0)
_CORRECTIONS = 25
_LAST_CORRECTION = 1.0e-6       # Newton's next would be about its square
# Coefficients of b0, t0, b1, t1 in m L, n H, g.
NODES = np.array([[-0.5, -0.5, 0.5, 0.5], [-0.5, 0.5, -0.5, 0.5], [0.5, -0.5, -0.5, 0.5]])


@numba.njit(cache=True)
def shape(position, k, length, height):
    """Return the vectors m, n, g of element k in an array (6,)."""
    z = np.zeros(6)
    for node in range(4):
        for axis in range(2):
            x = position[2 * k + node, axis]
            z[axis] += NODES[0, node] * x / length
            z[2 + axis] += NODES[1, node] * x / height
            z[4 + axis] += NODES[2, node] * x
    return z


@numba.njit(cache=True)
def measures(z, length, height):
    """Return A, B, D, p, q."""
    d = z[0] * z[3] - z[1] * z[2]
    return (z[0] * z[0] + z[1] * z[1], z[2] * z[2] + z[3] * z[3], d,
            (z[4] * z[3] - z[5] * z[2]) / (d * length),
            (z[0] * z[5] - z[1] * z[4]) / (d * height))


@numba.njit(cache=True)
def relax(strains, lateral, field, mu, jm, bulk, eps):
    """Return the enhanced strains a, b that minimise the energy, and a status.

    ``field`` is (V / H)^2; Newton from the incompressible first-order solution a = -q, b = -p.
    """
    sa, sb, sd, p, q = strains
    a, b = -q, -p
    if not sd > 0.0:
        return a, b, INVERTED
    electric = lateral * lateral * field * sa
    for _ in range(_CORRECTIONS):
        ra, rb, haa, hab, hbb = 0.0, 0.0, 0.0, 0.0, 0.0
        for point in range(4):
            xi = GAUSS if point & 1 else -GAUSS
            eta = GAUSS if point & 2 else -GAUSS
            s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
            if not (s1 > 0.0 and s2 > 0.0):
                return a, b, INVERTED
            i1 = s1 * s1 * sa + s2 * s2 * sb + lateral * lateral
            j = lateral * s1 * s2 * sd
            if not i1 * j ** (-2.0 / 3.0) - 3.0 < jm:
                return a, b, LOCKED
            s = slopes(i1, j, electric * s1 * s1, mu, jm, bulk, eps)
            f1, c1, y1 = s1 * sa, j / s1, s1 * electric
            f2, c2 = s2 * sb, j / s2
            ra += xi * stress(s, f1, c1, y1)
            rb += eta * stress(s, f2, c2, 0.0)
            haa += xi * xi * modulus(s, f1, c1, y1, f1, c1, y1, sa, 0.0, electric)
            hab += xi * eta * modulus(s, f1, c1, y1, f2, c2, 0.0, 0.0, lateral * sd, 0.0)
            hbb += eta * eta * modulus(s, f2, c2, 0.0, f2, c2, 0.0, sb, 0.0, 0.0)
        determinant = haa * hbb - hab * hab
        da = (hab * rb - hbb * ra) / determinant
        db = (hab * ra - haa * rb) / determinant
        a, b = a + da, b + db
        if abs(da) + abs(db) < _LAST_CORRECTION:
            return a, b, BALANCED
    return a, b, UNBALANCED


@numba.njit(cache=True)
def second_order_area(z, before):
    """Return the part of D that a linear step from ``before`` to ``z``, both (6,), leaves out.

    Newton's step predicts pressures linearly, but an error of volume of second order makes
    pressures of K, far beyond any that the strip can carry, and as geometric stiffness they stall
    the iteration. With the predicted pressure, as in mixed methods, it converges (Magisano,
    Leonetti and Garcea, doi 10.1002/nme.5228).
    """
    return ((z[0] - before[0]) * (z[3] - before[3])
            - (z[1] - before[1]) * (z[2] - before[2]))


@numba.njit(cache=True, inline='always')
def _relieved(s, pressure):
    """Return slopes less a pressure, for second derivatives only."""
    return Slopes(s.f, s.c - pressure, s.y, s.ff, s.fc, s.cc, s.yc)


@numba.njit(cache=True)
def gradient(strains, a, b, lateral, field, mu, jm, bulk, eps):
    """Return the derivatives of the mean energy by A, B, D, p, q, where a and b are relaxed."""
    sa, sb, sd, p, q = strains
    squared = lateral * lateral * field
    by_a, by_b, by_d, by_p, by_q = 0.0, 0.0, 0.0, 0.0, 0.0
    for point in range(4):
        xi = GAUSS if point & 1 else -GAUSS
        eta = GAUSS if point & 2 else -GAUSS
        s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
        area = lateral * s1 * s2
        s = slopes(s1 * s1 * sa + s2 * s2 * sb + lateral * lateral, area * sd,
                   squared * s1 * s1 * sa, mu, jm, bulk, eps)
        by_a += 0.125 * s1 * s1 * stress(s, 1.0, 0.0, squared)
        by_b += 0.125 * s2 * s2 * s.f
        by_d += 0.25 * area * s.c
        by_p += 0.25 * eta * stress(s, s1 * sa, lateral * s2 * sd, squared * s1 * sa)
        by_q += 0.25 * xi * stress(s, s2 * sb, lateral * s1 * sd, 0.0)
    return by_a, by_b, by_d, by_p, by_q


@numba.njit(cache=True)
def hessian(strains, a, b, lateral, field, mu, jm, bulk, eps, excess, result, work):
    """Fill ``result`` (7, 7) with the Hessian of the mean energy in A, B, D, p, q, a, b.

    It takes the pressure of the volume that D - ``excess`` makes: zero for the exact Hessian, see
    `second_order_area` for Newton's method. ``work`` (18, 5) is zero or has served here before.
    """
    sa, sb, sd, p, q = strains
    result[:] = 0.0
    # Rows of first derivatives by s1, s2, A, B, D at a point, and of second ones.
    f, c, y, f_both, c_both, y_both = (work[0], work[1], work[2], work[3:8], work[8:13],
                                       work[13:18])
    squared = lateral * lateral * field
    for point in range(4):
        xi = GAUSS if point & 1 else -GAUSS
        eta = GAUSS if point & 2 else -GAUSS
        s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
        area = s1 * s2 * lateral
        f[0], f[1], f[2], f[3] = s1 * sa, s2 * sb, 0.5 * s1 * s1, 0.5 * s2 * s2
        c[0], c[1], c[4] = lateral * s2 * sd, lateral * s1 * sd, area
        y[0], y[2] = squared * s1 * sa, 0.5 * squared * s1 * s1
        f_both[0, 0], f_both[1, 1], f_both[0, 2], f_both[1, 3] = sa, sb, s1, s2
        c_both[0, 1], c_both[0, 4], c_both[1, 4] = lateral * sd, lateral * s2, lateral * s1
        y_both[0, 0], y_both[0, 2] = squared * sa, squared * s1
        s = slopes(s1 * s1 * sa + s2 * s2 * sb + lateral * lateral, area * sd,
                   squared * s1 * s1 * sa, mu, jm, bulk, eps)
        settled = _relieved(s, 2.0 * bulk * area * excess)
        for i in range(5):
            for k in range(i, 5):
                value = 0.25 * modulus(settled, f[i], c[i], y[i], f[k], c[k], y[k],
                                       f_both[i, k], c_both[i, k], y_both[i, k])
                _spread(result, value, i, k, xi, eta)


@numba.njit(cache=True, inline='always')
def _spread(result, value, i, k, xi, eta):
    """Add a second derivative by s1, s2, A, B or D to those by A, B, D, p, q, a, b."""
    row = 3 + i if i < 2 else i - 2
    column = 3 + k if k < 2 else k - 2
    share_row = (eta if i == 0 else xi) if i < 2 else 1.0
    share_column = (eta if k == 0 else xi) if k < 2 else 1.0
    _add(result, value * share_row * share_column, row, column)
    if i < 2:
        other_row = xi if i == 0 else eta
        _add(result, value * other_row * share_column, row + 2, column)
        if k < 2:
            other_column = xi if k == 0 else eta
            _add(result, value * other_row * other_column, row + 2, column + 2)
            if i != k:
                _add(result, value * share_row * other_column, row, column + 2)


@numba.njit(cache=True, inline='always')
def _add(result, value, row, column):
    result[row, column] += value
    if row != column:
        result[column, row] += value


@numba.njit(cache=True)
def condense(curvature):
    """Remove the enhanced strains from the Hessian, in its leading (5, 5) part, in place."""
    haa, hab, hbb = curvature[5, 5], curvature[5, 6], curvature[6, 6]
    determinant = haa * hbb - hab * hab
    for i in range(5):
        ta = (curvature[i, 5] * hbb - curvature[i, 6] * hab) / determinant
        tb = (curvature[i, 6] * haa - curvature[i, 5] * hab) / determinant
        for k in range(5):
            curvature[i, k] -= ta * curvature[5, k] + tb * curvature[6, k]


@numba.njit(cache=True)
def shape_gradient(z, strains, by, length, height):
    """Return the gradient of the mean energy in m, n, g, (6,)."""
    _, _, sd, p, q = strains
    by_d = by[2] - (by[3] * p + by[4] * q) / sd
    by_p, by_q = by[3] / (sd * length), by[4] / (sd * height)
    result = np.empty(6)
    result[0] = 2.0 * by[0] * z[0] + by_d * z[3] + by_q * z[5]
    result[1] = 2.0 * by[0] * z[1] - by_d * z[2] - by_q * z[4]
    result[2] = 2.0 * by[1] * z[2] - by_d * z[1] - by_p * z[5]
    result[3] = 2.0 * by[1] * z[3] + by_d * z[0] + by_p * z[4]
    result[4] = by_p * z[3] - by_q * z[1]
    result[5] = -by_p * z[2] + by_q * z[0]
    return result


@numba.njit(cache=True)
def _congruence(inner, slope):
    """Return slope^T inner slope, (6, 6)."""
    result = np.zeros((6, 6))
    for i in range(5):
        for column in range(6):
            value = 0.0
            for k in range(5):
                value += inner[i, k] * slope[k, column]
            for row in range(6):
                result[row, column] += slope[i, row] * value
    return result


@numba.njit(cache=True)
def shape_hessian(z, strains, by, curvature, length, height):
    """Return the Hessian of the mean energy in m, n, g, (6, 6), ``curvature`` being condensed."""
    _, _, sd, p, q = strains
    jacobian = np.zeros((5, 6))
    jacobian[0, 0], jacobian[0, 1] = 2.0 * z[0], 2.0 * z[1]
    jacobian[1, 2], jacobian[1, 3] = 2.0 * z[2], 2.0 * z[3]
    jacobian[2, 0], jacobian[2, 1], jacobian[2, 2], jacobian[2, 3] = z[3], -z[2], -z[1], z[0]
    jacobian[3, 2], jacobian[3, 3], jacobian[3, 4], jacobian[3, 5] = -z[5], z[4], z[3], -z[2]
    jacobian[4, 0], jacobian[4, 1], jacobian[4, 4], jacobian[4, 5] = z[5], -z[4], -z[1], z[0]
    for i in range(6):
        jacobian[3, i] = (jacobian[3, i] / length - p * jacobian[2, i]) / sd
        jacobian[4, i] = (jacobian[4, i] / height - q * jacobian[2, i]) / sd
    inner = curvature[:5, :5].copy()
    for strain in range(3, 5):
        inner[strain, 2] -= by[strain] / sd
        inner[2, strain] -= by[strain] / sd
    result = _congruence(inner, jacobian)
    by_d = by[2] - (by[3] * p + by[4] * q) / sd
    by_p, by_q = by[3] / (sd * length), by[4] / (sd * height)
    for axis in range(2):
        result[axis, axis] += 2.0 * by[0]
        result[2 + axis, 2 + axis] += 2.0 * by[1]
    # D = m x n, p D L = g x n and q D H = m x g.
    for value, left, right in ((by_d, 0, 2), (by_p, 4, 2), (by_q, 0, 4)):
        result[left, right + 1] += value
        result[right + 1, left] += value
        result[left + 1, right] -= value
        result[right, left + 1] -= value
    return result
