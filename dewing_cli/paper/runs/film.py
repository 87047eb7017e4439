# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow about the wing, as a still and as a film."""

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Mapping

import numpy as np

from dewing_cli.figures import flow as flow_figure
from dewing_cli.paper.runs.flight import case_of, cost, trimmed
from dewing_cli.paper.runs.result import Result, Tick
from dewing_sim.inputs.base import Inputs
from dewing_sim.wing import Wing

FRAME_COST = 400.0          # ms to draw one


@dataclass(frozen=True)
class Film:
    """``duration`` s from the rest state in ``frames`` frames."""

    case: str                       # YAML
    duration: float
    frames: int
    exaggeration: float = 20.0

    needs = ()

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return cost(case_of(self.case), self.duration) + self.frames * FRAME_COST

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Return the files ``still`` (PNG) and ``film`` (GIF) as arrays of bytes."""
        wing = Wing(case_of(self.case))
        shown = list(self._pictures(wing, tick))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / 'film.gif'
            flow_figure.animate(self._drawn(shown, tick), path)
            film = path.read_bytes()
        still = flow_figure.png(flow_figure.figure(shown[0]))
        return Result({'frames': self.frames, 'exaggeration': self.exaggeration},
                      {'still': _bytes(still), 'film': _bytes(film)})

    def _drawn(self, shown: list[Any], tick: Tick) -> Iterator[Any]:
        for frame, picture in enumerate(shown):
            tick(0.8 + 0.2 * frame / self.frames)
            yield picture

    def _pictures(self, wing: Wing, tick: Tick) -> Iterator[Any]:
        state = trimmed(wing, tick, 0.4)
        steps = max(1, round(self.duration / self.frames / wing.dt))
        for frame in range(self.frames):
            yield flow_figure.picture(wing, state, self.exaggeration)
            for _ in range(steps):
                state = wing.step(state, Inputs(state.v_squared))
            tick(0.4 + 0.4 * frame / self.frames)


def _bytes(data: bytes) -> np.ndarray:
    return np.frombuffer(data, dtype=np.uint8)
