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


def summary(path: str | Path) -> dict[str, Any]:
    """Return topics with types and counts, durations, the plant and the last status of nodes.

    ``simulated_s`` is the span of the stamps of measurements, ``wall_s`` that of arrivals;
    ``steps_missing`` counts the steps between its first and last measurement that the bag lacks.
    Raises `BadInput` if ``path`` is not a bag.
    """
    topics: dict[str, dict[str, Any]] = {}
    status: dict[str, str] = {}
    plant, first, last = None, None, None
    for topic, received, message in bag.read(path):
        entry = topics.setdefault(topic, {'type': message.__msgtype__, 'messages': 0})
        entry['messages'] += 1
        first, last = received if first is None else first, received
        if topic.endswith('/case'):
            plant = Identity.from_yaml(message.data)
        elif topic == '/diagnostics':
            status |= {item.name: item.message for item in message.status}
    if first is None:
        raise BadInput(f'{path}: no messages')
    result = {'file': str(path), 'wall_s': 1.0e-9 * (last - first),
              'topics': dict(sorted(topics.items())), 'status': status}
    if plant is not None:
        result['plant'] = {'name': plant.plant, 'dt': plant.dt, 'version': plant.version}
    for topic in topics:
        if topic.endswith('/measurement'):
            time = bag.series(path, topic)['time']
            result['simulated_s'] = float(time[-1] - time[0])
            if plant is not None:
                result['steps_missing'] = round(result['simulated_s'] / plant.dt) + 1 - len(time)
    return result


def lines(found: dict[str, Any]) -> list[str]:
    """Return a `summary` as text."""
    text = [f"{found['file']}: {found['wall_s']:.1f} s of wall time"]
    if 'plant' in found:
        plant = found['plant']
        text.append(f"plant {plant['name']}, time step {plant['dt']:g} s, "
                    f"dewing {plant['version']}")
    if 'simulated_s' in found:
        missing = f", {found['steps_missing']} steps missing" if 'steps_missing' in found else ''
        text.append(f"{found['simulated_s']:g} s of simulated time{missing}")
    text += [f"{name:26}{entry['messages']:>9}  {entry['type']}"
             for name, entry in found['topics'].items()]
    return text + [f'{name}: {said}' for name, said in found['status'].items()]


def draw(path: str | Path, out: str | Path, overwrite: bool = False) -> dict[str, float]:
    """Draw camber and voltage of the measurements in a bag into a PNG; return their ranges."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    series = bag.series(path, '/dewing/measurement')
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
