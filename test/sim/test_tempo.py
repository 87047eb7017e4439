# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Times of steps and answers become percentiles, and a sentence when a rate is not held."""

import pytest

from dewing_sim.tempo import Speed, Tempo

DT = 1.0e-3


def run(tempo, steps, period, step, lap=0.0, ago=0, began=10.0, lateness=0.0):
    """Let steps begin every ``period``, take ``step`` and be answered ``lap`` after they began."""
    for k in range(steps):
        now = began + k * period
        tempo.begin(now, now - lateness if tempo.rate else None)
        tempo.made(now + step)
        if lap:
            tempo.answered(now + lap, ago)
    tempo.close(began + steps * period)
    return tempo.found


def test_a_lock_step_has_laps_and_no_jitter():
    found = run(Tempo(DT), 1000, period=2.0e-3, step=1.5e-3, lap=2.0e-3)
    assert found == pytest.approx(Speed(0.5, 2.0, 2.0, 0.0, 0.0, 0.5))


def test_a_rate_that_is_held_gives_no_warning():
    tempo = Tempo(DT, 1.0)
    found = run(tempo, 1000, period=DT, step=0.3e-3, lap=0.5e-3, lateness=0.1e-3)
    assert found == pytest.approx(Speed(1.0, 0.5, 0.5, 0.1, 0.1, 2.0)) and not tempo.caution


def test_answers_one_step_late_are_told_with_what_would_hold():
    tempo = Tempo(DT, 1.0)
    found = run(tempo, 1000, period=DT, step=0.6e-3, lap=0.25e-3, ago=1)
    assert found.lap_ms_p50 == pytest.approx(1.25) and found.largest_rate == pytest.approx(0.8)
    assert tempo.caution == (
        'run.rate = 1 is not held: 100% of the steps began late or without their answer, which '
        'acts when it comes; a step takes 0.6 ms, a lap 1.25 ms; 0.8 would hold, or steps of '
        '1.25 ms')


def test_the_warning_stays_the_same_until_the_rate_is_held_again():
    tempo = Tempo(DT, 1.0)
    run(tempo, 1000, period=DT, step=0.6e-3, lap=0.25e-3, ago=1)
    told = tempo.caution
    run(tempo, 1000, period=DT, step=0.7e-3, lap=0.55e-3, ago=1, began=11.0)
    assert tempo.caution == told
    run(tempo, 1000, period=DT, step=0.3e-3, lap=0.5e-3, began=12.0)
    run(tempo, 1000, period=DT, step=0.3e-3, lap=0.5e-3, began=13.0)
    assert not tempo.caution


def test_without_a_controller_only_late_steps_count():
    tempo = Tempo(DT, 1.0)
    run(tempo, 1000, period=DT, step=0.6e-3)
    assert not tempo.caution and tempo.found.largest_rate == pytest.approx(1.0 / 0.6)
    run(tempo, 1000, period=2.0 * DT, step=1.9e-3, began=20.0, lateness=1.5 * DT)
    assert 'a step takes 1.9 ms; 0.53 would hold' in tempo.caution


def test_a_short_window_and_a_pause_are_left_out():
    tempo = Tempo(DT, 1.0)
    assert run(tempo, 100, period=DT, step=0.6e-3) == Speed()
    tempo.forget()
    found = run(tempo, 1000, period=DT, step=0.5e-3, began=99.0)
    assert found.rtf_now == pytest.approx(1.0)


def test_an_answer_to_what_is_long_past_is_no_lap():
    assert run(Tempo(DT, 1.0), 1000, period=DT, step=0.5e-3, lap=0.7e-3, ago=99).lap_ms_p50 == 0.0


def test_a_few_steps_are_no_window_and_stalls_are_not_blamed_on_the_run():
    tempo = Tempo(DT, 0.01)
    assert run(tempo, 40, period=0.1, step=2.0e-3, lap=3.0e-3) == Speed()
    tempo = Tempo(DT, 0.01)
    run(tempo, 60, period=0.1, step=2.0e-3, lap=3.0e-3, lateness=0.2)
    assert 'a lap 3 ms; what holds it up is not the run itself' in tempo.caution
