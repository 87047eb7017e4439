# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The closed loop over ROS 2, recorded and drawn."""
