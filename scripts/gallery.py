# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Run the examples and draw docs/images/examples/*.png: ``python scripts/gallery.py [NAME ...]``.

`read_bag` records a run first, for which ROS is needed.
"""

import os
import runpy
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

PROJECT = Path(__file__).resolve().parents[1]
EXAMPLES, PICTURES = PROJECT / 'examples', PROJECT / 'docs' / 'images' / 'examples'
BLUE, RED, GREY = '#0072B2', '#D55E00', '#666666'


def loop(figure, found):
    """Draw camber and voltage of a controlled run."""
    run, passive = found['run'], found['passive']
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(run.time, run.camber_mean / passive, color=BLUE)
    above.set_ylabel('camber over passive')
    below.plot(run.time, run.voltage, color=RED)
    below.set_ylabel('voltage (V)')
    below.set_xlabel('time (s)')
    return above, below


def own_disturbance(figure, found):
    """Draw camber and lift after a knock and in a gust."""
    above, below = figure.subplots(2, 1, sharex=True)
    for (name, run), color in zip(found['runs'].items(), (BLUE, RED)):
        above.plot(run.time, run.camber_mean / found['passive'].camber_mean, color=color,
                   label=name)
        below.plot(run.time, run.cl, color=color)
    above.set_ylabel('camber over passive')
    above.legend()
    below.set_ylabel('lift coefficient')
    below.set_xlabel('time (s)')
    return above, below


def own_material(figure, found):
    """Draw tension against stretch, from the sheets of both wings."""
    axes = figure.subplots()
    for (name, wing), color in zip(found['wings'].items(), (GREY, BLUE)):
        stretch, scale = np.linspace(1.0, 2.2, 100), wing.scales.tension
        for voltage, style in ((0.0, '-'), (1000.0, '--')):
            tension = wing.membrane.sheet.respond(stretch, voltage**2).tension
            axes.plot(stretch, scale * tension, style, color=color,
                      label=f'{name.capitalize()}, {voltage:.0f} V')
        axes.plot(1.5, found['rest'][name].tension, 'o', color=color)
    axes.set_xlabel('stretch along the chord (dots: the wings at rest)')
    axes.set_ylabel('tension (N/m)')
    axes.legend()
    return axes,


def pulse_to_bode(figure, found):
    """Draw the Bode plot of the identified camber."""
    above, below = figure.subplots(2, 1, sharex=True)
    camber = found['camber']
    above.loglog(found['frequency'], camber.magnitude, color=BLUE)
    above.axhline(found['gain'], color=GREY, linestyle=':')
    above.set_ylabel('camber over V² (m/V²)')
    below.semilogx(found['frequency'], np.degrees(np.unwrap(camber.phase)), color=RED)
    below.set_ylabel('phase (degrees)')
    below.set_xlabel('frequency (Hz)')
    return above, below


def read_bag(figure, found):
    """Draw the recorded camber and its mean over periods of the disturbance."""
    axes, frame = figure.subplots(), found['frame']
    axes.plot(frame.index, 1.0e6 * frame.camber_mean, color=GREY, label='measured')
    axes.plot(frame.index, 1.0e6 * found['smooth'], color=BLUE, label='mean over 0.1 s')
    axes.set_xlabel('time (s)')
    axes.set_ylabel('mean camber (µm)')
    axes.margins(y=0.2)
    axes.legend(loc='upper center', ncols=2)
    return axes,


def sweep(figure, found):
    """Draw lift against angle of attack."""
    axes, data = figure.subplots(), found['data']
    for voltage, color in zip(data['actuation.voltage'].values, (GREY, BLUE)):
        line = data.cl_mean.sel({'actuation.voltage': voltage})
        axes.plot(data['flow.angle_of_attack_deg'], line, 'o-', color=color,
                  label=f'{voltage:.0f} V')
    axes.set_xlabel('angle of attack (degrees)')
    axes.set_ylabel('lift coefficient')
    axes.legend()
    return axes,


def two_wings(figure, found):
    """Draw camber against the share of V_L^2."""
    axes, shares = figure.subplots(), np.array(found['SHARES'])
    for (name, camber), color in zip(found['camber'].items(), (BLUE, RED)):
        axes.plot(shares, camber / camber[0], 'o-', color=color, label=f'wing {name}')
    fine = np.linspace(0.0, shares[-1], 50)
    axes.plot(fine, 1.0 / (1.0 - fine), ':', color=GREY, label='string, 1/(1 - u)')
    axes.set_xlabel('u = V²/V_L²')
    axes.set_ylabel('camber over that without voltage')
    axes.legend()
    return axes,


DRAWINGS = {'closed_loop': loop, 'own_controller': loop,
            'own_disturbance': own_disturbance, 'own_material': own_material,
            'pulse_to_bode': pulse_to_bode, 'read_bag': read_bag, 'sweep': sweep,
            'two_wings': two_wings}


def draw(name: str) -> Path:
    """Run one example in an empty folder and draw what it found."""
    sys.path.insert(0, str(EXAMPLES))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        sys.argv = [name, *([_recorded()] if name == 'read_bag' else [])]
        found = runpy.run_path(str(EXAMPLES / f'{name}.py'), run_name='__main__')
        os.chdir(PROJECT)
    figure = Figure(figsize=(6.0, 3.6), layout='constrained')
    FigureCanvasAgg(figure)
    for axes in DRAWINGS[name](figure, found):
        axes.grid(alpha=0.3)
    PICTURES.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURES / f'{name}.png', dpi=110)
    return PICTURES / f'{name}.png'


def _recorded() -> str:
    """Return the bag of a disturbed wing, recorded over ROS."""
    from dewing_cli.main import main
    main(['demo', '--engine', 'conformal', '--grid', 'realtime', '--duration', '0.3',
          '--disturbance', 'fig5', '--out', 'demo', '--quiet'])
    return 'demo/open_loop.mcap'


if __name__ == '__main__':
    for chosen in sys.argv[1:] or DRAWINGS:
        print(draw(chosen))
