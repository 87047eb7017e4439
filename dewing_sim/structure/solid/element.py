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
depends on A = m.m, B = n.n, D = m x n, p and q: rotations drop out. A viscous overstress H that
a time step holds, of the second Piola-Kirchhoff kind, adds H : F^T F / 2 to the energy, by which
it depends on G = m.n too.
"""

import math

from dewing_sim.structure.material.elastomer import Slopes, modulus, slopes, stress
from dewing_sim.structure.solid.shape import KERNEL, KERNEL_INSIDE

BALANCED, LOCKED, INVERTED, UNBALANCED = 0, 1, 2, 3
GAUSS = math.sqrt(1.0 / 3.0)
_CORRECTIONS = 25
_LAST_CORRECTION = 1.0e-6       # Newton's next would be about its square


@KERNEL_INSIDE
def _held_at(held, k, point):
    """Return H_11, H_22, H_12 of element k at a point."""
    i = 4 * k + point
    return held[0, i], held[1, i], held[2, i]


@KERNEL
def relax(strains, held, k, lateral, field, constants):
    """Return the enhanced strains a, b that minimise the energy of element k, and a status.

    ``field`` is (V / H)^2, ``held`` (3, 4n) the overstress H_11, H_22, H_12 at the points. Newton
    from the incompressible first-order solution a = -q, b = -p.
    ``constants`` are `Elastomer.constants`.
    """
    sa, sb, sd, p, q, sg = strains
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
            s = slopes(i1, j, electric * s1 * s1, lateral, constants)
            if not s.f > 0.0:           # the law locks up or fails
                return a, b, LOCKED
            f1, c1, y1 = s1 * sa, j / s1, s1 * electric
            f2, c2 = s2 * sb, j / s2
            h11, h22, h12 = _held_at(held, k, point)
            ra += xi * (stress(s, f1, c1, y1) + h11 * f1 + h12 * s2 * sg)
            rb += eta * (stress(s, f2, c2, 0.0) + h22 * f2 + h12 * s1 * sg)
            haa += xi * xi * (modulus(s, f1, c1, y1, f1, c1, y1, sa, 0.0, electric) + h11 * sa)
            hab += xi * eta * (modulus(s, f1, c1, y1, f2, c2, 0.0, 0.0, lateral * sd, 0.0)
                               + h12 * sg)
            hbb += eta * eta * (modulus(s, f2, c2, 0.0, f2, c2, 0.0, sb, 0.0, 0.0) + h22 * sb)
        determinant = haa * hbb - hab * hab
        da = (hab * rb - hbb * ra) / determinant
        db = (hab * ra - haa * rb) / determinant
        a, b = a + da, b + db
        if abs(da) + abs(db) < _LAST_CORRECTION:
            return a, b, BALANCED
    return a, b, UNBALANCED


@KERNEL_INSIDE
def _relieved(s, pressure):
    """Return slopes less a pressure, for second derivatives only."""
    return Slopes(s.f, s.c - pressure, s.y, s.ff, s.fc, s.cc, s.yc)


@KERNEL
def gradient(strains, held, k, a, b, lateral, field, constants):
    """Return the derivatives of the mean energy by A, B, D, p, q, G, with relaxed a and b."""
    sa, sb, sd, p, q, sg = strains
    squared = lateral * lateral * field
    by_a, by_b, by_d, by_p, by_q, by_g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for point in range(4):
        xi = GAUSS if point & 1 else -GAUSS
        eta = GAUSS if point & 2 else -GAUSS
        s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
        area = lateral * s1 * s2
        s = slopes(s1 * s1 * sa + s2 * s2 * sb + lateral * lateral, area * sd,
                   squared * s1 * s1 * sa, lateral, constants)
        h11, h22, h12 = _held_at(held, k, point)
        by_a += 0.125 * s1 * s1 * (stress(s, 1.0, 0.0, squared) + h11)
        by_b += 0.125 * s2 * s2 * (s.f + h22)
        by_d += 0.25 * area * s.c
        by_p += 0.25 * eta * (stress(s, s1 * sa, lateral * s2 * sd, squared * s1 * sa)
                              + h11 * s1 * sa + h12 * s2 * sg)
        by_q += 0.25 * xi * (stress(s, s2 * sb, lateral * s1 * sd, 0.0)
                             + h22 * s2 * sb + h12 * s1 * sg)
        by_g += 0.25 * h12 * s1 * s2
    return by_a, by_b, by_d, by_p, by_q, by_g


@KERNEL
def hessian(strains, held, k, a, b, lateral, field, constants, excess, result):
    """Fill ``result`` (8, 8) with the Hessian of the mean energy in A, B, D, p, q, G, a, b.

    It takes the pressure of the volume that D - ``excess`` makes: zero for the exact Hessian, see
    `shape.second_order_area` for Newton's method.
    """
    sa, sb, sd, p, q, sg = strains
    result[:] = 0.0
    squared = lateral * lateral * field
    for point in range(4):
        xi = GAUSS if point & 1 else -GAUSS
        eta = GAUSS if point & 2 else -GAUSS
        s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
        area = s1 * s2 * lateral
        s = slopes(s1 * s1 * sa + s2 * s2 * sb + lateral * lateral, area * sd,
                   squared * s1 * s1 * sa, lateral, constants)
        settled = _relieved(s, 2.0 * constants.bulk * area * excess)
        _add_point(result, settled, s1, s2, sa, sb, sd, lateral, squared, xi, eta)
        _add_held(result, _held_at(held, k, point), s1, s2, sa, sb, sg, xi, eta)
    for row in range(8):
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
    for i in range(3):
        result[0, i] += 0.25 * by_a[i]
        # s1 moves with p by eta and with a by xi, s2 with q by xi and with b by eta.
        result[i, 3] += 0.25 * eta * by_1[i]
        result[i, 4] += 0.25 * xi * by_2[i]
        result[i, 6] += 0.25 * xi * by_1[i]
        result[i, 7] += 0.25 * eta * by_2[i]
    result[1, 1] += 0.25 * by_b[0]
    result[1, 2] += 0.25 * by_b[1]
    result[2, 2] += 0.25 * modulus(s, 0.0, cd, 0.0, 0.0, cd, 0.0, 0.0, 0.0, 0.0)
    _add_stretches(result, modulus(s, f1, c1, y1, f1, c1, y1, sa, 0.0, squared * sa),
                   modulus(s, f1, c1, y1, f2, c2, 0.0, 0.0, lateral * sd, 0.0),
                   modulus(s, f2, c2, 0.0, f2, c2, 0.0, sb, 0.0, 0.0), xi, eta)


@KERNEL_INSIDE
def _add_held(result, held, s1, s2, sa, sb, sg, xi, eta):
    """Add what a held overstress does to the second derivatives at a point."""
    h11, h22, h12 = held
    result[0, 3] += 0.25 * eta * h11 * s1
    result[0, 6] += 0.25 * xi * h11 * s1
    result[1, 4] += 0.25 * xi * h22 * s2
    result[1, 7] += 0.25 * eta * h22 * s2
    result[3, 5] += 0.25 * eta * h12 * s2
    result[5, 6] += 0.25 * xi * h12 * s2
    result[4, 5] += 0.25 * xi * h12 * s1
    result[5, 7] += 0.25 * eta * h12 * s1
    _add_stretches(result, h11 * sa, h12 * sg, h22 * sb, xi, eta)


@KERNEL_INSIDE
def _add_stretches(result, by_11, by_12, by_22, xi, eta):
    """Add second derivatives by s1 and s2 to those by p, q, a, b."""
    along, cross = 0.25 * xi * xi, 0.25 * xi * eta      # xi^2 and eta^2 are equal
    result[3, 3] += along * by_11
    result[3, 4] += cross * by_12
    result[3, 6] += cross * by_11
    result[3, 7] += along * by_12
    result[4, 4] += along * by_22
    result[4, 6] += along * by_12
    result[4, 7] += cross * by_22
    result[6, 6] += along * by_11
    result[6, 7] += cross * by_12
    result[7, 7] += along * by_22


@KERNEL
def condense(curvature):
    """Remove the enhanced strains from the Hessian, in its leading (6, 6) part, in place."""
    haa, hab, hbb = curvature[6, 6], curvature[6, 7], curvature[7, 7]
    determinant = haa * hbb - hab * hab
    for i in range(6):
        ta = (curvature[i, 6] * hbb - curvature[i, 7] * hab) / determinant
        tb = (curvature[i, 7] * haa - curvature[i, 6] * hab) / determinant
        for k in range(6):
            curvature[i, k] -= ta * curvature[6, k] + tb * curvature[7, k]
