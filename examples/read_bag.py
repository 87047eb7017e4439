# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Read a bag with pandas: ``python read_bag.py out/demo/open_loop.mcap``, after `dewing demo`."""

import sys

import pandas

from dewing_sim.records import bag

frame = pandas.DataFrame(bag.series(sys.argv[1], '/dewing/measurement')).set_index('time')
frame['voltage'] = frame.pop('v_squared')**0.5
period = round(0.1 / (frame.index[1] - frame.index[0]))         # steps of a disturbance of 10 Hz
smooth = frame.camber_mean.rolling(period, center=True).mean()
frame.to_csv('run.csv')

print(frame.describe().loc[['mean', 'min', 'max']].T)
print(f'camber averaged over periods: {smooth.min():.4e} to {smooth.max():.4e} m')
