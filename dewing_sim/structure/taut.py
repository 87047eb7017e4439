# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The tension that every structure of a prestretched sheet must keep."""

import math

import numpy as np

from dewing_sim.errors import Slack


class Taut:
    """Checks shared by structures with a ``sheet``, ``stretch``, ``tension`` and ``elements``."""

    def require_taut(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` with element, tension and voltages if any tension is not positive."""
        tension = self.tension(position, v_squared)
        k = int(np.argmin(tension))
        if tension[k] > 0.0:
            return
        self._raise_slack(k, tension[k], position, v_squared)

    def require_bearable(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` if V^2 takes all tension at the typical stretch of ``position``."""
        stretch = float(np.median(self.stretch(position)))
        tension = float(self.sheet.respond([stretch], v_squared).tension[0])
        if tension <= 0.0:
            self._raise_slack(self.elements // 2, tension, position, v_squared)

    def _raise_slack(self, k: int, tension: float, position: np.ndarray, v_squared: float):
        limit = self.sheet.loss_of_tension_v_squared(self.stretch(position)[k])
        raise Slack(f'slack membrane: element {k} has tension {tension:.6g} at '
                    f'{math.sqrt(v_squared):.6g} V and loses it at {math.sqrt(limit):.6g} V; '
                    'lower the voltage or raise the prestretch')
