# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What controllers are compared on."""

from dataclasses import dataclass, field
from typing import Any

from dewing_sim.inputs.disturbance import DISTURBANCES
from dewing_sim.parameters import Disturbance


@dataclass(frozen=True)
class Scenario:
    """A wing, a disturbance and a target."""

    meaning: str
    changes: dict[str, Any] = field(default_factory=dict)   # of the case
    target: float = 1.10                # of the passive camber
    rate: float = 2.0                   # 1/s, of the reference
    told: float = 10.0                  # Hz, the frequency that controllers are told
    noise: float = 0.0                  # standard deviation, of the passive camber
    second: Disturbance | None = None
    case: str = ''                      # another shipped case
    settings: str = ''                  # other shipped settings, of the PID and all others
    delay: int = 0                      # steps by which commands take effect late, told
    jitter: float = 0.0                 # share of them that comes a step later still


def _tone(frequency: float) -> dict[str, Any]:
    return {**DISTURBANCES['fig5'], 'disturbance.frequency': frequency}


def _gust(speed: float) -> dict[str, Any]:
    """Return a vertical 1 - cos gust of 0.1 s, four chords long, near the end of a run."""
    return {'numerics.engine': 'conformal', 'gust.shape': 'one_minus_cosine',
            'gust.vertical': speed, 'gust.start': 0.22, 'gust.duration': 0.1}


def _late(meaning: str, delay: int, jitter: float = 0.0) -> Scenario:
    """Return Fig. 5 in steps of 5e-4 s with late commands."""
    return Scenario(f'Fig. 5 in steps of 0.5 ms, {meaning}', FIG5, case='realtime',
                    settings='controller_realtime', delay=delay, jitter=jitter)


FIG5 = DISTURBANCES['fig5']
SCENARIOS = {
    'fig5': Scenario('10 Hz disturbance, target 1.10 (paper, Fig. 5)', FIG5),
    'target_1': Scenario('the same, target 1.00', FIG5, 1.00),
    'target_097': Scenario('the same, target 0.97: V^2 would have to be negative', FIG5, 0.97),
    'below': Scenario('the same, target 0.93: out of reach most of the time', FIG5, 0.93),
    'step': Scenario('step of the target to 1.10, undisturbed', rate=1.0e5),
    'hz5': Scenario('disturbance of 5 Hz, told', _tone(5.0), told=5.0),
    'hz20': Scenario('disturbance of 20 Hz, told', _tone(20.0), told=20.0),
    'hz40': Scenario('disturbance of 40 Hz, told', _tone(40.0), told=40.0),
    'hz13': Scenario('disturbance of 13 Hz, controllers told 10 Hz', _tone(13.0)),
    'two_tone': Scenario('disturbance of 10 and 25 Hz, half each, told 10 Hz',
                         {'disturbance.pressure': 0.0075, 'disturbance.frequency': 10.0},
                         second=Disturbance(0.0075, 25.0)),
    'gust_up': Scenario('vertical 1 - cos gust of 0.6 % U, target 1.10', _gust(0.007)),
    'gust_down': Scenario('vertical 1 - cos gust of -1.6 % U, target 1.10', _gust(-0.02)),
    'noise': Scenario('Fig. 5 with sensor noise of 0.1 %', FIG5, noise=1.0e-3),
    'mismatch_chord': Scenario('Fig. 5, chord 10 % longer',
                               {**FIG5, 'membrane.chord': 0.033}),
    'mismatch_slack': Scenario('Fig. 5, tension 10 % lower',
                               {**FIG5, 'membrane.shear_modulus': 1.8e4,
                                'actuation.voltage_limit': 1150.0}),
    'mismatch_tight': Scenario('Fig. 5, tension 10 % higher',
                               {**FIG5, 'membrane.shear_modulus': 2.2e4}),
    'alpha8': Scenario('shedding at 8 degrees, target 1.10: the camber exceeds it by itself',
                       told=24.0, case='paper_alpha8'),
    'alpha8_high': Scenario('the same, target 1.90', target=1.90, rate=5.0, told=24.0,
                            case='paper_alpha8'),
    'late0': _late('commands in time', 0),
    'late1': _late('commands one step late', 1),
    'late2': _late('commands two steps late', 2),
    'jitter': _late('commands one step late, a tenth of them two', 1, 0.1),
    'alpha8_late1': Scenario(
        'shedding at 8 degrees in steps of 0.5 ms, commands one step late', told=24.0,
        case='realtime_alpha8', settings='controller_realtime', delay=1),
}
QUICK = ('fig5', 'target_1', 'below', 'step')
