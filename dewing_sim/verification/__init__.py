# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The solvers against independent codes and closed forms: what `dewing verify` runs."""
