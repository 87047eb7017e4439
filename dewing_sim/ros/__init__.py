# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The rim to ROS 2: nodes, messages, services and how they are run."""
