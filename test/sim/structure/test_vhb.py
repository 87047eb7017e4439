# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The energy and the Prony series against measured relaxation of VHB 4910."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import nnls

from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.material.law import deviatoric
from dewing_sim.structure.material.viscosity import Prony

MEASURED = np.loadtxt(Path(__file__).parents[2] / 'reference' / 'vhb4910_relaxation.csv',
                      delimiter=',', skiprows=5)
AFTER = np.array([1.0, 10.0, 100.0, 1800.0])     # s
TIMES = (1.0, 10.0, 100.0, 1000.0)              # of the branches, s
RAMP = 80
CALIBRATION, PREDICTION = MEASURED[[1, 3, 5, 6]], MEASURED[[0, 2, 4, 7]]


def dev(stretch, limit):
    """Return S_11 and S_22 of a uniaxially stretched incompressible strip with mu = 1."""
    along, across, _ = deviatoric(stretch ** 2, 1.0 / stretch, 0.0, 1.0 / stretch,
                                  Gent(1.0, limit).constants(0.0, 0.0))
    return np.array([[along], [across]])


def nominal(stress, stretch):
    """Return the nominal stress; the pressure keeps the sides free."""
    return stretch * stress[0, 0] - stress[1, 0] / stretch ** 2


def responses(stretch, ramp, limit):
    """Return the stresses at `AFTER` of the elastomer and of each branch, (4, 5), with mu = 1."""
    columns = [np.full(AFTER.size, nominal(dev(stretch, limit), stretch))]
    for time in TIMES:
        branch = Prony((1.0,), (time,))
        memory = branch.relaxed(dev(1.0, limit))
        for k in range(1, RAMP + 1):
            reached = dev(1.0 + (stretch - 1.0) * k / RAMP, limit)
            memory = branch.remember(memory, reached, ramp / RAMP)
        columns.append(nominal(memory[0], stretch) * np.exp(-AFTER / time))
    return np.stack(columns, axis=1)


def relative(rows, limit):
    """Return the responses over the measured stresses, (4 rows, 5)."""
    return np.concatenate([responses(*row[:2], limit) / row[2:, None] for row in rows])


def rms(error):
    return np.sqrt(np.mean(error ** 2))


def fitted(rows, limit):
    """Return the moduli of elastomer and branches, in kPa, and the errors of the fit."""
    matrix = relative(rows, limit)
    moduli, _ = nnls(matrix, np.ones(len(matrix)))
    return moduli, matrix @ moduli - 1.0


def test_stresses_at_other_stretches_follow_from_a_fit_at_four():
    moduli, error = fitted(CALIBRATION, 1000.0)
    assert rms(error) < 0.07
    others = relative(PREDICTION, 1000.0) @ moduli - 1.0
    assert rms(others) < 0.10
    assert np.abs(others[4:]).max() < 0.06      # all but stretch 1.5


def test_the_long_term_modulus_is_half_the_paper_s():
    moduli, error = fitted(MEASURED, 1000.0)
    assert moduli[0] == pytest.approx(10.3, abs=0.1)
    assert rms(error) < 0.08


def test_the_paper_s_gent_limit_is_too_low_for_large_stretches():
    _, error = fitted(MEASURED, 100.0)
    assert 0.15 < rms(error) < 0.20
    _, error = fitted(MEASURED[:4], 100.0)
    assert rms(error) < 0.12
