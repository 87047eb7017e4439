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

# Sums may be reordered and divisions by zero need no check: twice as fast.
_OPTIONS = {'cache': True, 'error_model': 'numpy', 'fastmath': {'contract', 'reassoc', 'arcp'}}
KERNEL = numba.njit(**_OPTIONS)
KERNEL_INSIDE = numba.njit(inline='always', **_OPTIONS)
BALANCED, LOCKED, INVERTED, UNBALANCED = 0, 1, 2, 3
GAUSS = math.sqrt(1.0 / 3.0)
_CORRECTIONS = 25
_LAST_CORRECTION = 1.0e-6       # Newton's next would be about its square
# Coefficients of b0, t0, b1, t1 in m L, n H, g.
NODES = np.array([[-0.5, -0.5, 0.5, 0.5], [-0.5, 0.5, -0.5, 0.5], [0.5, -0.5, -0.5, 0.5]])


@KERNEL
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


@KERNEL
def measures(z, length, height):
    """Return A, B, D, p, q."""
    d = z[0] * z[3] - z[1] * z[2]
    return (z[0] * z[0] + z[1] * z[1], z[2] * z[2] + z[3] * z[3], d,
            (z[4] * z[3] - z[5] * z[2]) / (d * length),
            (z[0] * z[5] - z[1] * z[4]) / (d * height))


@KERNEL
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
            s = slopes(i1, j, electric * s1 * s1, mu, jm, bulk, eps)
            if not s.f > 0.0:           # the Gent energy has no slope beyond its limit
                return a, b, LOCKED
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


@KERNEL
def second_order_area(z, before):
    """Return the part of D that a linear step from ``before`` to ``z``, both (6,), leaves out.

    Newton's step predicts pressures linearly, but an error of volume of second order makes
    pressures of K, far beyond any that the strip can carry, and as geometric stiffness they stall
    the iteration. With the predicted pressure, as in mixed methods, it converges (Magisano,
    Leonetti and Garcea, doi 10.1002/nme.5228).
    """
    return ((z[0] - before[0]) * (z[3] - before[3])
            - (z[1] - before[1]) * (z[2] - before[2]))


@KERNEL_INSIDE
def _relieved(s, pressure):
    """Return slopes less a pressure, for second derivatives only."""
    return Slopes(s.f, s.c - pressure, s.y, s.ff, s.fc, s.cc, s.yc)


@KERNEL
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


@KERNEL
def hessian(strains, a, b, lateral, field, mu, jm, bulk, eps, excess, result):
    """Fill ``result`` (7, 7) with the Hessian of the mean energy in A, B, D, p, q, a, b.

    It takes the pressure of the volume that D - ``excess`` makes: zero for the exact Hessian, see
    `second_order_area` for Newton's method.
    """
    sa, sb, sd, p, q = strains
    result[:] = 0.0
    squared = lateral * lateral * field
    for point in range(4):
        xi = GAUSS if point & 1 else -GAUSS
        eta = GAUSS if point & 2 else -GAUSS
        s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
        area = s1 * s2 * lateral
        s = slopes(s1 * s1 * sa + s2 * s2 * sb + lateral * lateral, area * sd,
                   squared * s1 * s1 * sa, mu, jm, bulk, eps)
        settled = _relieved(s, 2.0 * bulk * area * excess)
        _add_point(result, settled, s1, s2, sa, sb, sd, lateral, squared, xi, eta)
    for row in range(7):
        for column in range(row):
            result[row, column] = result[column, row]


@KERNEL_INSIDE
def _add_point(result, s, s1, s2, sa, sb, sd, lateral, squared, xi, eta):
    """Add a quarter of the second derivatives at a point to the upper half of ``result``."""
    f1, f2, fa, fb = s1 * sa, s2 * sb, 0.5 * s1 * s1, 0.5 * s2 * s2
    c1, c2, cd = lateral * s2 * sd, lateral * s1 * sd, lateral * s1 * s2
    y1, ya = squared * f1, squared * fa
    by_a = (modulus(s, fa, 0.0, ya, fa, 0.0, ya, 0.0, 0.0, 0.0),
            modulus(s, fa, 0.0, ya, fb, 0.0, 0.0, 0.0, 0.0, 0.0),
            modulus(s, fa, 0.0, ya, 0.0, cd, 0.0, 0.0, 0.0, 0.0))
    by_b = (modulus(s, fb, 0.0, 0.0, fb, 0.0, 0.0, 0.0, 0.0, 0.0),
            modulus(s, fb, 0.0, 0.0, 0.0, cd, 0.0, 0.0, 0.0, 0.0))
    by_1 = (modulus(s, fa, 0.0, ya, f1, c1, y1, s1, 0.0, squared * s1),
            modulus(s, fb, 0.0, 0.0, f1, c1, y1, 0.0, 0.0, 0.0),
            modulus(s, 0.0, cd, 0.0, f1, c1, y1, 0.0, lateral * s2, 0.0))
    by_2 = (modulus(s, fa, 0.0, ya, f2, c2, 0.0, 0.0, 0.0, 0.0),
            modulus(s, fb, 0.0, 0.0, f2, c2, 0.0, s2, 0.0, 0.0),
            modulus(s, 0.0, cd, 0.0, f2, c2, 0.0, 0.0, lateral * s1, 0.0))
    m11 = 0.25 * modulus(s, f1, c1, y1, f1, c1, y1, sa, 0.0, squared * sa)
    m12 = 0.25 * modulus(s, f1, c1, y1, f2, c2, 0.0, 0.0, lateral * sd, 0.0)
    m22 = 0.25 * modulus(s, f2, c2, 0.0, f2, c2, 0.0, sb, 0.0, 0.0)
    for i in range(3):
        result[0, i] += 0.25 * by_a[i]
        # s1 moves with p by eta and with a by xi, s2 with q by xi and with b by eta.
        result[i, 3] += 0.25 * eta * by_1[i]
        result[i, 4] += 0.25 * xi * by_2[i]
        result[i, 5] += 0.25 * xi * by_1[i]
        result[i, 6] += 0.25 * eta * by_2[i]
    result[1, 1] += 0.25 * by_b[0]
    result[1, 2] += 0.25 * by_b[1]
    result[2, 2] += 0.25 * modulus(s, 0.0, cd, 0.0, 0.0, cd, 0.0, 0.0, 0.0, 0.0)
    result[3, 3] += eta * eta * m11
    result[3, 4] += eta * xi * m12
    result[3, 5] += eta * xi * m11
    result[3, 6] += eta * eta * m12
    result[4, 4] += xi * xi * m22
    result[4, 5] += xi * xi * m12
    result[4, 6] += xi * eta * m22
    result[5, 5] += xi * xi * m11
    result[5, 6] += xi * eta * m12
    result[6, 6] += eta * eta * m22


@KERNEL
def condense(curvature):
    """Remove the enhanced strains from the Hessian, in its leading (5, 5) part, in place."""
    haa, hab, hbb = curvature[5, 5], curvature[5, 6], curvature[6, 6]
    determinant = haa * hbb - hab * hab
    for i in range(5):
        ta = (curvature[i, 5] * hbb - curvature[i, 6] * hab) / determinant
        tb = (curvature[i, 6] * haa - curvature[i, 5] * hab) / determinant
        for k in range(5):
            curvature[i, k] -= ta * curvature[5, k] + tb * curvature[6, k]


@KERNEL
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


@KERNEL
def shape_hessian(z, strains, by, curvature, length, height, jacobian, result):
    """Fill ``result`` (6, 6) with the Hessian of the mean energy in m, n, g.

    ``curvature`` is condensed and is overwritten; ``jacobian`` (5, 6) is zero or has served here.
    """
    _, _, sd, p, q = strains
    jacobian[0, 0], jacobian[0, 1] = 2.0 * z[0], 2.0 * z[1]
    jacobian[1, 2], jacobian[1, 3] = 2.0 * z[2], 2.0 * z[3]
    jacobian[2, 0], jacobian[2, 1], jacobian[2, 2], jacobian[2, 3] = z[3], -z[2], -z[1], z[0]
    for i in range(6):
        jacobian[3, i] = -p / sd * jacobian[2, i]
        jacobian[4, i] = -q / sd * jacobian[2, i]
    along, across = 1.0 / (sd * length), 1.0 / (sd * height)
    jacobian[3, 2] -= along * z[5]
    jacobian[3, 3] += along * z[4]
    jacobian[3, 4] += along * z[3]
    jacobian[3, 5] -= along * z[2]
    jacobian[4, 0] += across * z[5]
    jacobian[4, 1] -= across * z[4]
    jacobian[4, 4] -= across * z[1]
    jacobian[4, 5] += across * z[0]
    for strain in range(3, 5):
        curvature[strain, 2] -= by[strain] / sd
        curvature[2, strain] -= by[strain] / sd
    _congruence(curvature, jacobian, result)
    by_d = by[2] - (by[3] * p + by[4] * q) / sd
    for axis in range(2):
        result[axis, axis] += 2.0 * by[0]
        result[2 + axis, 2 + axis] += 2.0 * by[1]
    # D = m x n, p D L = g x n and q D H = m x g.
    for value, left, right in ((by_d, 0, 2), (by[3] * along, 4, 2), (by[4] * across, 0, 4)):
        result[left, right + 1] += value
        result[right + 1, left] += value
        result[left + 1, right] -= value
        result[right, left + 1] -= value


@KERNEL
def _congruence(inner, slope, result):
    """Fill ``result`` (6, 6) with slope^T inner slope, of the leading (5, 5) part of ``inner``."""
    result[:] = 0.0
    for i in range(5):
        for column in range(6):
            value = 0.0
            for k in range(5):
                value += inner[i, k] * slope[k, column]
            for row in range(column + 1):
                result[row, column] += slope[i, row] * value
    for row in range(6):
        for column in range(row):
            result[row, column] = result[column, row]
