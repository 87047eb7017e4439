# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Finite volumes on a membrane-following staggered grid."""
