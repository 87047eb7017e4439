# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of a structure in time, and its equilibria."""
