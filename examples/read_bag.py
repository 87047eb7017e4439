# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Read a bag with pandas: ``python read_bag.py out/demo/closed_loop.mcap``, after `dewing demo`."""

import sys

import pandas

from dewing_sim.records import bag

path = sys.argv[1]
frame = pandas.DataFrame(bag.series(path, '/dewing/measurement')).set_index('time')
frame['voltage'] = frame.pop('v_squared')**0.5
print(frame.describe().loc[['mean', 'min', 'max']].T)
smooth = frame.camber_mean.rolling(50, center=True).mean()      # over 50 steps
print(f'camber after the first tenth of a second: {smooth.loc[0.1:].mean():.3e} m')
