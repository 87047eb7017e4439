# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From the nodes of a solid element to its strains, and derivatives the way back.

`solid_element` explains m, n, g and the strains A, B, D, p, q, G.
"""

import numpy as np

from dewing_sim.machine.kernels import compiled

# Sums may be reordered and divisions by zero need no check: twice as fast.
_OPTIONS = {'error_model': 'numpy', 'fastmath': {'contract', 'reassoc', 'arcp'}}
KERNEL = compiled(**_OPTIONS)
KERNEL_INSIDE = compiled(inline='always', **_OPTIONS)
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
    """Return A, B, D, p, q, G."""
    d = z[0] * z[3] - z[1] * z[2]
    return (z[0] * z[0] + z[1] * z[1], z[2] * z[2] + z[3] * z[3], d,
            (z[4] * z[3] - z[5] * z[2]) / (d * length),
            (z[0] * z[5] - z[1] * z[4]) / (d * height), z[0] * z[2] + z[1] * z[3])


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


@KERNEL
def shape_gradient(z, strains, by, length, height):
    """Return the gradient of the mean energy in m, n, g, (6,)."""
    _, _, sd, p, q, _ = strains
    by_d = by[2] - (by[3] * p + by[4] * q) / sd
    by_p, by_q = by[3] / (sd * length), by[4] / (sd * height)
    result = np.empty(6)
    result[0] = 2.0 * by[0] * z[0] + by_d * z[3] + by_q * z[5]
    result[1] = 2.0 * by[0] * z[1] - by_d * z[2] - by_q * z[4]
    result[2] = 2.0 * by[1] * z[2] - by_d * z[1] - by_p * z[5]
    result[3] = 2.0 * by[1] * z[3] + by_d * z[0] + by_p * z[4]
    result[4] = by_p * z[3] - by_q * z[1]
    result[5] = -by_p * z[2] + by_q * z[0]
    for axis in range(2):
        result[axis] += by[5] * z[2 + axis]
        result[2 + axis] += by[5] * z[axis]
    return result


@KERNEL
def shape_hessian(z, strains, by, curvature, length, height, jacobian, result):
    """Fill ``result`` (6, 6) with the Hessian of the mean energy in m, n, g.

    ``curvature`` is condensed and is overwritten; ``jacobian`` (6, 6) is zero or has served here.
    """
    _, _, sd, p, q, _ = strains
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
    for axis in range(2):
        jacobian[5, axis], jacobian[5, 2 + axis] = z[2 + axis], z[axis]
    for strain in range(3, 5):
        curvature[strain, 2] -= by[strain] / sd
        curvature[2, strain] -= by[strain] / sd
    _congruence(curvature, jacobian, result)
    by_d = by[2] - (by[3] * p + by[4] * q) / sd
    for axis in range(2):
        result[axis, axis] += 2.0 * by[0]
        result[2 + axis, 2 + axis] += 2.0 * by[1]
        result[axis, 2 + axis] += by[5]
        result[2 + axis, axis] += by[5]
    # D = m x n, p D L = g x n and q D H = m x g.
    for value, left, right in ((by_d, 0, 2), (by[3] * along, 4, 2), (by[4] * across, 0, 4)):
        result[left, right + 1] += value
        result[right + 1, left] += value
        result[left + 1, right] -= value
        result[right, left + 1] -= value


@KERNEL
def _congruence(inner, slope, result):
    """Fill ``result`` (6, 6) with slope^T inner slope, of the leading (6, 6) part of ``inner``."""
    result[:] = 0.0
    for i in range(6):
        for column in range(6):
            value = 0.0
            for k in range(6):
                value += inner[i, k] * slope[k, column]
            for row in range(column + 1):
                result[row, column] += slope[i, row] * value
    for row in range(6):
        for column in range(row):
            result[row, column] = result[column, row]
