# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow at 8 degrees: a still of either engine, and a film of one period of shedding."""

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report.section import Figure, Found, Section


def section(plan: Plan, found: Found) -> Section:
    """Return the pictures; the film opens the page."""
    result, other = found['film conformal'], found['film finite_volume']
    factor = result.values['exaggeration']
    label = (f'vorticity (blue clockwise, red counter-clockwise), streamlines and the membrane; '
             f'deflections are drawn {factor:g} times as large.')
    return Section(
        'picture', 'The flow at 8 degrees',
        ['The stream comes from the left. A vortex rolls up behind the leading edge, grows over '
         'the suction side and leaves with one of the opposite sense from the trailing edge, '
         'some 25 times a second. dewing plot FILE draws any saved state like this.',
         'Both engines are shown, because they differ: the central differences of the finite '
         'volumes leave waves of the size of a cell in the coarse grid above the wake, which '
         'the conformal engine does not have. They are an error of this engine. They are '
         'carried away by the stream; how little they change the loads is seen where the '
         'engines stand side by side above.'],
        [Figure('flow', f'Conformal engine, one instant: {label}', result['still'].tobytes()),
         Figure('flow_volumes', f'Finite volumes, one instant: {label}', other['still'].tobytes()),
         Figure('shedding', f'About one period of shedding, conformal engine: {label}',
                result['film'].tobytes(), 'gif')])
