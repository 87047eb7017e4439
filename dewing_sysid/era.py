# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Eigensystem realisation of Markov parameters, paper eq. 7-9, and OKID for arbitrary inputs.

Conventions: x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k]; Markov parameters h[0] = D,
h[k] = C A^(k-1) B, stored with shape (outputs, inputs, samples); rows of signals are channels.
"""

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from dewing_sim.errors import BadInput
from dewing_sim.linear.state_space import Matrices
from dewing_sysid.hankel import Hankel, leading


@dataclass(frozen=True)
class HankelFactors:
    """The singular value decomposition H0 = U S V^T of paper eq. 8 and the shifted H1.

    Realisations of every order up to its rank follow from one decomposition, for which
    `control.eigensys_realization` makes one each, of the whole matrix; and python-control has
    Hankel singular values in continuous time only.
    """

    left: np.ndarray                    # U, (outputs rows, rank)
    singular_values: np.ndarray         # diagonal of S, descending
    right: np.ndarray                   # V^T, (rank, inputs columns)
    shifted: np.ndarray | Hankel        # H1
    direct: np.ndarray                  # D, (outputs, inputs)
    scale: np.ndarray                   # by which each output was divided, (outputs,)

    @property
    def rank(self) -> int:
        """Return the numerical rank of H0."""
        floor = max(self.shifted.shape) * np.finfo(float).eps * self.singular_values[0]
        return int(np.sum(self.singular_values > floor))

    def realise(self, order: int) -> Matrices:
        """Return the balanced realisation of ``order`` states (paper eq. 9).

        A = S^-1/2 U^T H1 V S^-1/2, B and C the first columns and rows of S^1/2 V^T and U S^1/2.
        Raises `BadInput` if ``order`` is not between 1 and the rank of H0.
        """
        if not 1 <= order <= self.rank:
            raise BadInput(f'order = {order} cannot be realised: the Hankel matrix has rank '
                           f'{self.rank}, take 1 to {self.rank}')
        outputs, inputs = self.direct.shape
        root = np.sqrt(self.singular_values[:order])
        left, right = self.left[:, :order], self.right[:order]
        a = (left.T @ self.shifted @ right.T) / np.outer(root, root)
        b = root[:, None] * right[:, :inputs]
        c = left[:outputs] * root * self.scale[:, None]
        return Matrices(a, b, c, self.direct)


LARGEST = 150                           # block rows and columns decomposed as a whole
LEADING = 30                            # singular values sought of larger matrices


def factorise(markov: np.ndarray, rows: int | None = None, states: int = LEADING,
              ) -> HankelFactors:
    """Decompose the Hankel matrix of ``markov`` (outputs, inputs, samples), h[0] = D first.

    Block (i, j) is h[1 + i + j] in H0 and the sample after it in H1; ``rows`` is half of what the
    record holds by default. Up to `LARGEST` block rows and columns all singular values are
    computed, of larger matrices the leading ``states``: 5 ms for 1000 samples of three outputs,
    17 ms for 4000.
    Outputs are divided by their root mean square first, so that metres and lift coefficients
    weigh alike in the truncation.
    Raises `BadInput` for a record that is too short, not finite or without response.
    """
    h = np.asarray(markov, dtype=float)
    if h.ndim != 3:
        raise BadInput(f'Markov parameters of shape {h.shape}: expected (outputs, inputs, '
                       'samples)')
    samples = h.shape[2]
    blocks = samples - 1
    rows = blocks // 2 if rows is None else rows
    columns = blocks - rows
    if rows < 1 or columns < 1:
        raise BadInput(f'{samples} samples do not fill a Hankel matrix of {max(rows, 1)} block '
                       f'rows: at least {max(rows, 1) + 2} are needed')
    if not np.isfinite(h).all():
        raise BadInput('Markov parameters contain values that are not finite')
    scale = np.sqrt(np.mean(h[:, :, 1:]**2, axis=(1, 2)))
    if not scale.all():
        raise BadInput(f'output {int(np.argmin(scale))} is constant: nothing to identify')
    scaled = h / scale[:, None, None]
    first, shifted = (Hankel(scaled[:, :, begin:], rows, columns) for begin in (1, 2))
    if blocks > 2 * LARGEST:
        return HankelFactors(*leading(first, states), shifted, h[:, :, 0], scale)
    return HankelFactors(*linalg.svd(first.dense(), full_matrices=False), shifted.dense(),
                         h[:, :, 0], scale)


def era(markov: np.ndarray, order: int, rows: int | None = None) -> Matrices:
    """Return the ERA model of ``order`` states; see `factorise` and `HankelFactors.realise`."""
    return factorise(markov, rows, max(LEADING, order)).realise(order)


def delayed(realisation: Matrices) -> Matrices:
    """Return the model whose input arrives one sample later; D moves into C.

    x'[k] = (x[k], u[k-1]): A' = [[A, B], [0, 0]], B' = (0, I), C' = [C, D], D' = 0.  Markov
    parameters realised from the second sample on, then delayed, keep an instantaneous response
    (lift by the added mass of a membrane that V^2 kicks) out of the truncated Hankel matrix.
    """
    order, inputs = realisation.b.shape
    a = np.zeros((order + inputs, order + inputs))
    a[:order] = np.hstack([realisation.a, realisation.b])
    b = np.vstack([np.zeros((order, inputs)), np.eye(inputs)])
    return Matrices(a, b, np.hstack([realisation.c, realisation.d]),
                    np.zeros_like(realisation.d))


def okid(u: np.ndarray, y: np.ndarray, samples: int, lags: int) -> np.ndarray:
    """Estimate Markov parameters from arbitrary inputs through an observer.

    Least squares on y[k] = sum_i (alpha_i u[k-i] + beta_i y[k-i]), i = 1..lags, then
    h[k] = alpha_k + sum_i beta_i h[k-i] (Juang, Phan, Horta, Longman 1993,
    doi:10.2514/3.21006), with D = 0 and the system at rest before the first sample.

    u: (inputs, N), y: (outputs, N); returns (outputs, inputs, samples).
    Raises `BadInput` if the record is too short for the unknowns or holds no response.
    """
    inputs, outputs, length = u.shape[0], y.shape[0], y.shape[1]
    unknowns = lags * (inputs + outputs)
    if length < unknowns + 1:
        raise BadInput(f'{length} samples are too few for {lags} observer lags '
                       f'({unknowns} unknowns an output)')
    scales = np.concatenate([np.abs(u).max(axis=1), np.abs(y).max(axis=1)])
    if not scales.all():
        raise BadInput('an input or output is constant: nothing to identify')
    signals = np.vstack([u, y]) / scales[:, None]
    past = np.zeros((lags, inputs + outputs, length))
    for lag in range(1, lags + 1):
        past[lag - 1, :, lag:] = signals[:, :-lag]
    weights = linalg.lstsq(past.reshape(unknowns, length).T, signals[inputs:].T,
                           lapack_driver='gelsy')[0].T
    blocks = weights.reshape(outputs, lags, inputs + outputs)
    markov = _unroll(blocks[:, :, :inputs], blocks[:, :, inputs:], samples)
    return markov * scales[inputs:, None, None] / scales[None, :inputs, None]


def _unroll(alpha: np.ndarray, beta: np.ndarray, samples: int) -> np.ndarray:
    """Return Markov parameters of the recursion with alpha, beta of (outputs, lags, .)."""
    outputs, lags, inputs = alpha.shape
    h = np.zeros((samples, outputs, inputs))
    for k in range(1, samples):
        if k <= lags:
            h[k] = alpha[:, k - 1]
        for i in range(1, min(k, lags) + 1):
            h[k] += beta[:, i - 1] @ h[k - i]
    return h.transpose(1, 2, 0)


def reflect_unstable(realisation: Matrices) -> tuple[Matrices, np.ndarray]:
    """Mirror eigenvalues outside the unit circle to 1 / conj(z); return also the originals.

    The second value, empty for a stable model, is what must be reported.
    """
    eigenvalues, vectors = np.linalg.eig(realisation.a)
    outside = np.abs(eigenvalues) > 1.0
    if not outside.any():
        return realisation, eigenvalues[outside]
    moved = eigenvalues.copy()
    moved[outside] = 1.0 / eigenvalues[outside].conj()
    a = (vectors * moved) @ np.linalg.inv(vectors)
    return realisation._replace(a=a.real), eigenvalues[outside]
