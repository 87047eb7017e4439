# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Vorticity on a conformal map that follows the membrane."""
