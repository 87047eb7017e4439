# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers of V^2, the closed loop and the command line."""
