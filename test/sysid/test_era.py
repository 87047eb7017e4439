# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""ERA and OKID on systems whose answer is known."""

import control
import numpy as np
import pytest
from scipy import linalg
from synthetic_plant import matrices

from dewing_sim.errors import BadInput
from dewing_sim.linear.state_space import Matrices
from dewing_sysid import era
from dewing_sysid.hankel import Hankel, leading

GOLDEN = (1.0 + np.sqrt(5.0)) / 2.0


def markov_parameters(a, b, c, samples, d=None):
    """Return h[0] = D, h[k] = C A^(k-1) B, shape (outputs, inputs, samples)."""
    h = np.zeros((c.shape[0], b.shape[1], samples))
    if d is not None:
        h[:, :, 0] = d
    x = b
    for k in range(1, samples):
        h[:, :, k] = c @ x
        x = a @ x
    return h


def reproduced(model, samples):
    return markov_parameters(model.a, model.b, model.c, samples, model.d)


def simulate(a, b, c, u):
    y, x = np.zeros((c.shape[0], u.shape[1])), np.zeros(a.shape[0])
    for k in range(u.shape[1]):
        y[:, k] = c @ x
        x = a @ x + b @ u[:, k]
    return y


def random_stable(seed, order, inputs, outputs):
    rng = np.random.default_rng(seed)
    a = rng.standard_normal((order, order))
    a *= 0.95 / np.abs(np.linalg.eigvals(a)).max()
    return a, rng.standard_normal((order, inputs)), rng.standard_normal((outputs, order))


def mass_spring():
    """Return two coupled masses with two forces and two measured positions, dt = 0.1 s."""
    stiffness, damping = np.array([[6.0, -2.0], [-2.0, 4.0]]), np.array([[1.0, -0.2], [-0.2, 0.5]])
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -damping]])
    b = np.vstack([np.zeros((2, 2)), np.eye(2)])
    step = linalg.expm(0.1 * np.block([[a, b], [np.zeros((2, 6))]]))
    return step[:4, :4], step[:4, 4:], np.eye(2, 4)


def test_fibonacci_is_a_system_of_order_two():
    h = [0.0, 1.0, 1.0]
    while len(h) < 16:
        h.append(h[-1] + h[-2])
    model = era.era(np.array(h)[None, None], 2)
    assert np.sort(np.linalg.eigvals(model.a)) == pytest.approx([1.0 - GOLDEN, GOLDEN])
    assert reproduced(model, 16)[0, 0] == pytest.approx(h)


def test_two_inputs_and_outputs_of_a_mass_spring_system():
    a, b, c = mass_spring()
    h = markov_parameters(a, b, c, 60)
    model = era.era(h, 4)
    assert np.allclose(reproduced(model, 60), h, atol=1e-10)
    assert np.allclose(np.sort_complex(np.linalg.eigvals(model.a)),
                       np.sort_complex(np.linalg.eigvals(a)))


@pytest.mark.parametrize('seed, order, inputs, outputs', [
    (1, 3, 1, 1), (2, 6, 1, 3), (3, 5, 2, 1), (4, 8, 3, 2)])
def test_markov_parameters_of_random_stable_systems(seed, order, inputs, outputs):
    h = markov_parameters(*random_stable(seed, order, inputs, outputs), 50)
    factors = era.factorise(h)
    assert factors.rank == order
    assert np.allclose(reproduced(factors.realise(order), 50), h, atol=1e-9 * np.abs(h).max())


@pytest.mark.parametrize('inputs, outputs', [(1, 1), (1, 3), (2, 2)])
def test_products_with_a_hankel_matrix_are_those_with_its_blocks(inputs, outputs):
    rng = np.random.default_rng(16)
    h = rng.standard_normal((outputs, inputs, 40))
    hankel = Hankel(h, 23, 18)
    matrix = np.block([[h[:, :, i + j] for j in range(18)] for i in range(23)])
    assert hankel.shape == matrix.shape and np.array_equal(hankel.dense(), matrix)
    right, left = (rng.standard_normal(shape) for shape in ((matrix.shape[1], 5),
                                                            (5, matrix.shape[0])))
    np.testing.assert_allclose(hankel @ right, matrix @ right, atol=1e-13)
    np.testing.assert_allclose(left @ hankel, left @ matrix, atol=1e-13)


def test_leading_singular_values_are_those_of_the_whole_matrix():
    h = markov_parameters(*random_stable(17, 12, 1, 2), 401)
    h += 1e-4 * np.random.default_rng(18).standard_normal(h.shape)
    hankel = Hankel(h[:, :, 1:], 200, 200)
    left, values, right = leading(hankel, 12)
    exact = linalg.svdvals(hankel.dense())
    np.testing.assert_allclose(values, exact[:12], rtol=1e-6, atol=1e-4 * exact[0])
    assert np.allclose(left.T @ left, np.eye(12)) and np.allclose(right @ right.T, np.eye(12))


@pytest.mark.parametrize('inputs, outputs', [(1, 1), (1, 3), (2, 2)])
def test_a_long_record_gives_the_same_system(inputs, outputs):
    a, b, c = random_stable(16, 4, inputs, outputs)
    h = markov_parameters(a, b, c, 1000)
    factors = era.factorise(h)
    assert factors.rank == 4
    assert np.allclose(reproduced(factors.realise(4), 1000), h, atol=1e-8 * np.abs(h).max())
    again = era.factorise(h).realise(4)
    assert all(np.array_equal(one, other) for one, other in zip(again, factors.realise(4)))


def test_a_long_record_takes_noise_as_well_as_the_whole_decomposition(monkeypatch):
    """Every sample counts: noise of 1e-4 leaves 7e-5 here, where a stride of 4 left 1e-2."""
    h = markov_parameters(*matrices(1.0e-4), 1200)
    size = np.abs(h).max(axis=2, keepdims=True)
    noisy = h + 1e-4 * size * np.random.default_rng(19).standard_normal(h.shape)
    error = np.linalg.norm((reproduced(era.era(noisy, 8), 1200) - h) / size)
    monkeypatch.setattr(era, 'LARGEST', 600)
    whole = np.linalg.norm((reproduced(era.era(noisy, 8), 1200) - h) / size)
    assert error < 1.2 * whole
    assert error < 1e-4 * np.linalg.norm(h / size)


def test_modes_mirrored_about_a_folding_frequency_are_told_apart():
    """Poles exp(i w), exp(i (2 pi / 4 - w)) are one in every fourth sample of 1000."""
    angles, radius = (0.5, np.pi / 2.0 - 0.5), 0.995
    a = radius * linalg.block_diag(*[[[np.cos(w), -np.sin(w)], [np.sin(w), np.cos(w)]]
                                     for w in angles])
    h = markov_parameters(a, np.array([[1.0], [0.0], [1.0], [0.5]]), np.ones((1, 4)), 1000)
    poles = np.linalg.eigvals(era.era(h, 4).a)
    assert np.sort(np.angle(poles[poles.imag > 0.0])) == pytest.approx(np.sort(angles), abs=1e-8)


def test_as_many_states_as_are_asked_for():
    h = np.random.default_rng(20).standard_normal((1, 1, 700))
    assert era.factorise(h).rank == era.LEADING
    assert era.factorise(h, states=50).rank == era.era(h, 50).order == 50


def test_agreement_with_python_control():
    h = markov_parameters(*random_stable(5, 8, 1, 1), 61)
    ours, theirs = era.era(h, 4), control.eigensys_realization(h, 4, m=30, n=30)[0]
    assert np.allclose(np.sort_complex(np.linalg.eigvals(ours.a)), np.sort_complex(theirs.poles()))
    assert np.allclose(reproduced(ours, 61), markov_parameters(theirs.A, theirs.B, theirs.C, 61))


def test_a_delay_of_one_sample_is_a_pole_at_zero():
    h = np.zeros((1, 1, 12))
    h[0, 0, 1] = 3.0
    model = era.era(h, 1)
    assert model.a[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert (model.c @ model.b)[0, 0] == pytest.approx(3.0)


def test_feed_through_is_kept_apart_from_the_first_markov_parameter():
    a, b, c = random_stable(6, 2, 1, 1)
    h = markov_parameters(a, b, c, 20, d=7.0)
    model = era.era(h, 2)
    assert model.d[0, 0] == 7.0
    assert np.allclose(reproduced(model, 20), h)


def test_a_response_within_one_sample_takes_one_state_more():
    a, b, c = random_stable(15, 4, 1, 2)
    h = markov_parameters(a, b, c, 50)
    h[:, :, 1] += 100.0
    model = era.delayed(era.era(h[:, :, 1:], 4))
    assert model.order == 5
    assert not model.d.any()
    assert np.allclose(reproduced(model, 50), h, atol=1e-9 * np.abs(h).max())


def test_units_of_the_outputs_do_not_change_the_truncated_model():
    a, b, c = random_stable(7, 8, 1, 2)
    h = markov_parameters(a, b, c, 60)
    units = np.array([1.0e-6, 1.0e3])
    plain, scaled = era.era(h, 4), era.era(h * units[:, None, None], 4)
    assert np.allclose(plain.a, scaled.a)
    assert np.allclose(plain.c * units[:, None], scaled.c)


def test_truncation_error_falls_with_order():
    h = markov_parameters(*random_stable(8, 10, 1, 2), 80)
    factors = era.factorise(h)
    errors = [np.linalg.norm(reproduced(factors.realise(n), 80) - h) for n in (2, 4, 6, 8, 10)]
    assert np.all(np.diff(errors) < 0.0)
    assert errors[-1] < 1e-9 * np.linalg.norm(h)


@pytest.mark.parametrize('inputs, outputs', [(1, 1), (1, 3), (2, 2)])
def test_okid_recovers_markov_parameters_from_random_inputs(inputs, outputs):
    a, b, c = random_stable(9, 6, inputs, outputs)
    u = np.random.default_rng(10).standard_normal((inputs, 400))
    h = era.okid(u, simulate(a, b, c, u), 60, lags=12)
    exact = markov_parameters(a, b, c, 60)
    assert np.allclose(h, exact, atol=1e-8 * np.abs(exact).max())


def test_okid_withstands_noise():
    a, b, c = random_stable(11, 4, 1, 1)
    rng = np.random.default_rng(12)
    u = rng.standard_normal((1, 4000))
    y = simulate(a, b, c, u)
    y += 0.01 * y.std() * rng.standard_normal(y.shape)
    exact = markov_parameters(a, b, c, 40)
    error = np.linalg.norm(era.okid(u, y, 40, lags=20) - exact) / np.linalg.norm(exact)
    assert error < 0.02


def test_unstable_poles_are_mirrored_and_reported():
    poles = np.array([1.05, 0.9, 0.0])
    model = Matrices(np.diag(poles), np.ones((3, 1)), np.ones((1, 3)), np.zeros((1, 1)))
    mirrored, originals = era.reflect_unstable(model)
    assert originals == pytest.approx([1.05])
    assert np.sort(np.linalg.eigvals(mirrored.a)) == pytest.approx([0.0, 0.9, 1.0 / 1.05])
    assert era.reflect_unstable(mirrored)[1].size == 0


def test_order_above_the_rank_is_refused_with_the_rank():
    h = markov_parameters(*random_stable(13, 3, 1, 1), 30)
    with pytest.raises(BadInput, match='order = 10 .* rank 3'):
        era.era(h, 10)


def test_a_record_too_short_is_refused():
    with pytest.raises(BadInput, match='2 samples'):
        era.era(np.ones((1, 1, 2)), 1)
    with pytest.raises(BadInput, match='30 samples are too few for 20 observer lags'):
        era.okid(np.ones((1, 30)), np.ones((1, 30)), 10, 20)


def test_silent_and_broken_outputs_are_refused():
    h = markov_parameters(*random_stable(14, 3, 1, 2), 30)
    with pytest.raises(BadInput, match='output 1 is constant'):
        era.era(h * np.array([1.0, 0.0])[:, None, None], 2)
    h[0, 0, 7] = np.nan
    with pytest.raises(BadInput, match='not finite'):
        era.era(h, 2)
    with pytest.raises(BadInput, match='shape'):
        era.era(h[0], 2)
