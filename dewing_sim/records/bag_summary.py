# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag holds, in numbers and in a figure."""

from pathlib import Path
from typing import Any

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.files import new_file
from dewing_sim.identity import Identity
from dewing_sim.records import bag
from dewing_sim.records.mcap_file import Losses
from dewing_sim.records.runs import DECODED, JOINTS, Run, Splitter


def summary(path: str | Path) -> dict[str, Any]:
    """Return topics with types and counts, durations, runs, the plant, the last status of nodes.

    ``wall_s`` is the span of arrivals. ``runs`` of measurements are told apart wherever the stamps
    start again; ``simulated_s`` and ``steps_missing``, the steps between the first and the last of
    a run that the bag lacks, are sums over them. ``losses`` are sentences on what could not be
    read. Raises `BadInput` if ``path`` is not a bag or is empty.
    """
    contents = _Contents(path)
    if not contents.topics:
        raise BadInput(f'{path}: no messages' + ''.join(
            f'; {sentence}' for sentence in contents.losses.sentences()))
    result = {'file': str(path), 'wall_s': contents.wall,
              'topics': dict(sorted(contents.topics.items())), 'status': contents.status}
    for plant in contents.plants.values():
        result['plant'] = {'name': plant.plant, 'dt': plant.dt, 'version': plant.version}
    runs = [_described(topic, number, run, contents.plants.get(_namespace(topic)))
            for topic, splitter in contents.measured.items()
            for number, run in enumerate(splitter.runs, start=1)]
    if runs:
        result |= {'runs': runs, 'simulated_s': sum(run['to_s'] - run['from_s'] for run in runs)}
    if runs and all('steps_missing' in run for run in runs):
        result['steps_missing'] = sum(run['steps_missing'] for run in runs)
    return result | {'losses': contents.losses.sentences()}


class _Contents:
    """A bag read once."""

    def __init__(self, path: str | Path):
        self.losses = Losses()
        self.topics: dict[str, dict[str, Any]] = {}
        self.status: dict[str, str] = {}
        self.plants: dict[str, Identity] = {}
        self.measured: dict[str, Splitter] = {}
        arrivals: list[int] = []
        for topic, received, message in bag.read(path, losses=self.losses):
            arrivals[1:] = [received]
            self._count(topic, message.__msgtype__)
            self._take(topic, message)
        self.wall = 1.0e-9 * (arrivals[-1] - arrivals[0]) if arrivals else 0.0
        for (topic, reason), number in self.losses.messages.items():
            if topic and reason not in (NO_IDENTITY, *DECODED):
                kind = self.losses.kinds.get(topic, '')
                entry = self._count(topic, kind, number)
                entry['undecoded'] = entry.get('undecoded', 0) + number

    def _count(self, topic: str, kind: str, number: int = 1) -> dict[str, Any]:
        entry = self.topics.setdefault(topic, {'type': kind, 'messages': 0})
        entry['messages'] += number
        return entry

    def _take(self, topic: str, message: Any) -> None:
        """Keep what a message says of the plant, a node or a run."""
        if topic.endswith('/case') and message.__msgtype__ == TEXT:
            try:
                self.plants[_namespace(topic)] = Identity.from_yaml(message.data)
            except BadInput:
                self.losses.messages[topic, NO_IDENTITY] += 1
        elif topic == '/diagnostics' and message.__msgtype__ == DIAGNOSTICS:
            self.status |= {item.name: item.message for item in message.status}
        elif topic.endswith('/measurement') and message.__msgtype__ == JOINTS:
            self.measured.setdefault(topic, Splitter(topic, self.losses)).add(message)


TEXT, DIAGNOSTICS = 'std_msgs/msg/String', 'diagnostic_msgs/msg/DiagnosticArray'
NO_IDENTITY = 'do not say who a plant is'


def _namespace(topic: str) -> str:
    return topic.rpartition('/')[0]


def _described(topic: str, number: int, run: Run, plant: Identity | None) -> dict[str, Any]:
    known = {'topic': topic, 'run': number, 'from_s': 1.0e-9 * run.stamps[0],
             'to_s': 1.0e-9 * run.stamps[-1], 'samples': len(run.stamps)}
    return known if plant is None else known | {'steps_missing': run.missing(plant.dt)}


def lines(found: dict[str, Any]) -> list[str]:
    """Return a `summary` as text."""
    text = [f"{found['file']}: {found['wall_s']:.1f} s of wall time"]
    if 'plant' in found:
        plant = found['plant']
        text.append(f"plant {plant['name']}, time step {plant['dt']:g} s, "
                    f"dewing {plant['version']}")
    if 'simulated_s' in found:
        text.append(f"{found['simulated_s']:g} s of simulated time{_missing(found)}")
    if len(found.get('runs', ())) > 1:
        text += [f"run {run['run']} of {run['topic']}: {run['from_s']:g} to {run['to_s']:g} s, "
                 f"{run['samples']} samples{_missing(run)}" for run in found['runs']]
    text += [f"{name:26}{entry['messages']:>9}  {entry['type']}"
             for name, entry in found['topics'].items()]
    text += [f'{name}: {said}' for name, said in found['status'].items()]
    return text + [f'lost: {sentence}' for sentence in found['losses']]


def _missing(counted: dict[str, Any]) -> str:
    return f", {counted['steps_missing']} steps missing" if 'steps_missing' in counted else ''


def draw(path: str | Path, out: str | Path, overwrite: bool = False, run: int | None = None,
         ) -> dict[str, float]:
    """Draw camber and voltage of the measurements in a bag into a PNG; return their ranges.

    ``run`` counts from 1 and must be given if there are several; raises `BadInput` otherwise.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    series = bag.series(path, '/dewing/measurement', run)
    if not {'camber_mean', 'v_squared'} <= series.keys():
        raise BadInput(f'{path}: the plant measured {", ".join(series)}; camber_mean and '
                       'v_squared are drawn')
    voltage = np.sqrt(series['v_squared'])
    figure = Figure(figsize=(7.0, 5.0), layout='constrained')
    FigureCanvasAgg(figure)
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(series['time'], 1.0e6 * series['camber_mean'], color='#0072B2')
    above.set_ylabel('mean camber (um)')
    below.plot(series['time'], voltage, color='#D55E00')
    below.set_ylabel('voltage (V)')
    below.set_xlabel('time (s)')
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0.0)
    with new_file(out, overwrite) as file:
        figure.savefig(file, dpi=200, format='png')
    return dict(camber_mean_min=float(series['camber_mean'].min()),
                camber_mean_max=float(series['camber_mean'].max()),
                v_min=float(voltage.min()), v_max=float(voltage.max()))
