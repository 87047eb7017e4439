# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fourier transforms along the strip, of fields and of lines."""
