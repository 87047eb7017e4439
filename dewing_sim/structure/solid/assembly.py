# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Forces, tangent and energies of a strip of solid elements, per unit deformed span."""

import math

import numpy as np

from dewing_sim.structure.material.elastomer import energy
from dewing_sim.structure.material.law import deviatoric
from dewing_sim.structure.solid.element import (
    BALANCED,
    GAUSS,
    condense,
    gradient,
    hessian,
    relax,
)
from dewing_sim.structure.solid.shape import (
    KERNEL,
    NODES,
    measures,
    second_order_area,
    shape,
    shape_gradient,
    shape_hessian,
)


@KERNEL
def add_force(force, slope, k, length, height, lateral):
    """Add the gradient of the energy per unit span of element k to the nodal forces."""
    volume = length * height / lateral
    for node in range(4):
        for axis in range(2):
            force[2 * k + node, axis] += volume * (
                NODES[0, node] * slope[axis] / length
                + NODES[1, node] * slope[2 + axis] / height
                + NODES[2, node] * slope[4 + axis])


@KERNEL
def add_stiffness(band, curvature, k, length, height, lateral, equation, half):
    """Add the Hessian of the energy per unit span of element k to a band (2 w + 1, m).

    ``half`` (6, 8) is overwritten.
    """
    volume = length * height / lateral
    width = band.shape[0] // 2
    scale = (1.0 / length, 1.0 / height, 1.0)
    for node in range(4):
        m, n, g = NODES[0, node] * scale[0], NODES[1, node] * scale[1], NODES[2, node]
        for row in range(6):
            for axis in range(2):
                half[row, 2 * node + axis] = volume * (
                    m * curvature[row, axis] + n * curvature[row, 2 + axis]
                    + g * curvature[row, 4 + axis])
    for node in range(4):
        m, n, g = NODES[0, node] * scale[0], NODES[1, node] * scale[1], NODES[2, node]
        for axis in range(2):
            row = equation[4 * k + 2 * node + axis]
            if row < 0:
                continue
            for j in range(8):
                column = equation[4 * k + j]
                if column >= 0:
                    band[width + row - column, column] += (
                        m * half[axis, j] + n * half[2 + axis, j] + g * half[4 + axis, j])


@KERNEL
def respond(position, held, length, height, lateral, field, constants):
    """Return nodal forces (2(n+1), 2), tension and thinning of elements (n,), status, element.

    The tension is the force through a cross-section, negative if it pushes. ``held`` (3, 4n) is a
    viscous overstress at the integration points, see `element`.
    """
    n = length.size
    force, tension, thinning = np.zeros(position.shape), np.empty(n), np.empty(n)
    for k in range(n):
        z = shape(position, k, length[k], height)
        strains = measures(z, length[k], height)
        a, b, status = relax(strains, held, k, lateral, field, constants)
        if status != BALANCED:
            return force, tension, thinning, status, k
        by = gradient(strains, held, k, a, b, lateral, field, constants)
        slope = shape_gradient(z, strains, by, length[k], height)
        tension[k] = math.copysign(height / lateral * math.hypot(slope[0], slope[1]),
                                   slope[0] * z[0] + slope[1] * z[1])
        thinning[k] = strains[2] / math.sqrt(strains[0])
        add_force(force, slope, k, length[k], height, lateral)
    return force, tension, thinning, BALANCED, -1


@KERNEL
def stiffness(position, held, length, height, lateral, field, constants, equation,
              before, band):
    """Add the tangent to ``band`` (2 w + 1, m); return status and element.

    ``equation`` (4 (n+1),) numbers the free coordinates and is negative at pins. ``before`` is
    the position from which Newton's last step came, or ``position`` for the exact tangent.
    """
    inner, jacobian = np.empty((8, 8)), np.zeros((6, 6))
    curvature, half = np.empty((6, 6)), np.empty((6, 8))
    for k in range(length.size):
        z = shape(position, k, length[k], height)
        strains = measures(z, length[k], height)
        a, b, status = relax(strains, held, k, lateral, field, constants)
        if status != BALANCED:
            return status, k
        excess = second_order_area(z, shape(before, k, length[k], height))
        by = gradient(strains, held, k, a, b, lateral, field, constants)
        hessian(strains, held, k, a, b, lateral, field, constants, excess, inner)
        condense(inner)
        shape_hessian(z, strains, by, inner, length[k], height, jacobian, curvature)
        add_stiffness(band, curvature, k, length[k], height, lateral, equation, half)
    return BALANCED, -1


@KERNEL
def energies(position, held, length, height, lateral, field, constants):
    """Return the elastic and the electrostatic energy eps J E^2 / 2 per unit span."""
    elastic, electric = 0.0, 0.0
    for k in range(length.size):
        strains = measures(shape(position, k, length[k], height), length[k], height)
        sa, sb, sd, p, q, _ = strains
        a, b, _ = relax(strains, held, k, lateral, field, constants)
        volume = 0.25 * length[k] * height / lateral
        for point in range(4):
            xi = GAUSS if point & 1 else -GAUSS
            eta = GAUSS if point & 2 else -GAUSS
            s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
            i1 = s1 * s1 * sa + s2 * s2 * sb + lateral * lateral
            j = lateral * s1 * s2 * sd
            y_squared = lateral * lateral * field * s1 * s1 * sa
            elastic += volume * energy(i1, j, 0.0, lateral, constants)
            electric += volume * 0.5 * constants.eps * y_squared / j
    return elastic, electric


@KERNEL
def deviatoric_stresses(position, held, length, height, lateral, field, constants):
    """Return S_11, S_22, S_12 of the law at the integration points, (3, 4n)."""
    stresses = np.empty((3, 4 * length.size))
    for k in range(length.size):
        strains = measures(shape(position, k, length[k], height), length[k], height)
        sa, sb, _, p, q, sg = strains
        a, b, _ = relax(strains, held, k, lateral, field, constants)
        for point in range(4):
            xi = GAUSS if point & 1 else -GAUSS
            eta = GAUSS if point & 2 else -GAUSS
            s1, s2 = 1.0 + xi * a + eta * p, 1.0 + eta * b + xi * q
            found = deviatoric(s1 * s1 * sa, s2 * s2 * sb, s1 * s2 * sg,
                               lateral * lateral, constants)
            for i in range(3):
                stresses[i, 4 * k + point] = found[i]
    return stresses
