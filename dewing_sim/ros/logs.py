# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where ROS writes its logs: without a home that can be written to, into a passing folder.

ROS itself does not start for a user who has none, such as any uid in a container. What is logged
goes to standard error as well.
"""

import atexit
import os
import shutil
import tempfile
from pathlib import Path


def provide() -> None:
    """Name a folder in ``ROS_LOG_DIR`` if ROS would find none."""
    if os.environ.get('ROS_LOG_DIR') or os.environ.get('ROS_HOME'):
        return
    try:
        place = Path(os.environ['HOME'], '.ros', 'log')
        place.mkdir(parents=True, exist_ok=True)
        if os.access(place, os.W_OK):
            return
    except (KeyError, OSError):
        pass
    os.environ['ROS_LOG_DIR'] = folder = tempfile.mkdtemp(prefix='dewing-ros-log-')
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
