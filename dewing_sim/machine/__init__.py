# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How the computer is used: compiled kernels, their cache, memory."""
