# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Times of steps, of laps through the ROS graph, and of what no program can beat."""
