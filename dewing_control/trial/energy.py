# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The electrical energy of a membrane wing, per metre of span.

The electrodes are a capacitor of C = eps eps_r int ds/h, an output of the wing: s is the deformed
arc, h the thickness that balances the Maxwell stress. While V jumps C stays, while C changes V is
held, so a step of the simulation takes from an ideal source

    dE = C (V^2 - V_before^2)/2 + V^2 (C_after - C),

of which V^2 (C_after - C)/2 becomes mechanical work and the rest is stored. With charge recovery
the source takes back what is negative; without, that is lost.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Energy:
    """Energies in J/m."""

    net: float                  # taken from the source with full recovery of charge
    gross: float                # without recovery
    stored: float               # change of C V^2/2
    work: float                 # done on the membrane by the field

    @classmethod
    def of(cls, v_squared: np.ndarray, capacitances: np.ndarray) -> 'Energy':
        """Return the energies of a run.

        ``v_squared`` (n,) is V^2 of each sample; ``capacitances`` (n,) is C at its end. The run
        begins after the first sample.
        """
        before, after = capacitances[:-1], capacitances[1:]
        held, last = v_squared[1:], v_squared[:-1]
        charging = 0.5 * before * (held - last)
        holding = held * (after - before)
        return cls(
            float(np.sum(charging + holding)),
            float(np.sum(np.maximum(charging, 0.0) + np.maximum(holding, 0.0))),
            0.5 * float(v_squared[-1] * after[-1] - v_squared[0] * before[0]),
            0.5 * float(np.sum(holding)))
