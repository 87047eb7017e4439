# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Modules that take long to import or need not be there: imported where they are used only."""

# Not scipy.special, which scipy.fft brings: the identification transforms with it.
SLOW = {'control', 'distributed', 'matplotlib', 'mcap', 'mcap_ros2', 'osqp', 'rich', 'rosbags',
        'scipy.integrate', 'scipy.optimize', 'scipy.signal', 'scipy.stats', 'xarray'}
