# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The plant: a dielectric-elastomer membrane wing in a Navier-Stokes flow."""
