# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A sweep: lift against angle of attack with and without voltage, from a labelled netCDF file."""

import xarray

from dewing_cli.main import main

if __name__ == '__main__':          # the processes of the sweep import this file
    main(['sweep', '--case', 'soft', '--engine', 'conformal', '--grid', 'realtime',
          '--dt', '5.0e-5', '--duration', '0.01', '--out', 'sweep.nc',
          '--vary', 'flow.angle_of_attack_deg=-4.0,0.0,2.0,4.0',
          '--vary', 'actuation.voltage=0.0,400.0'])
    with xarray.open_dataset('sweep.nc') as data:
        print(data[['cl_mean', 'camber_mean']].to_dataframe())
