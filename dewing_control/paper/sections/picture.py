# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow at 8 degrees: a still, and a film of one period of shedding."""

from dewing_control.paper.plan import Plan
from dewing_control.paper.section import Figure, Found, Section


def section(plan: Plan, found: Found) -> Section:
    """Return both pictures."""
    result = found['film']
    factor = result.values['exaggeration']
    label = (f'vorticity (blue clockwise, red counter-clockwise), streamlines and the membrane; '
             f'deflections are drawn {factor:g} times as large.')
    return Section(
        'picture', 'The flow at 8 degrees',
        ['The stream comes from the left. A vortex rolls up behind the leading edge, grows over '
         'the suction side and leaves with one of the opposite sense from the trailing edge, '
         'some 25 times a second. dewing plot STATE draws any saved state like this.'],
        [Figure('flow', f'One instant: {label}', result['still'].tobytes()),
         Figure('shedding', f'About one period of shedding: {label}', result['film'].tobytes(),
                'gif')])
