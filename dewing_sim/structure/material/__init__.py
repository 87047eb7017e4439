# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The elastomer: energy, stresses, viscosity, limits."""
