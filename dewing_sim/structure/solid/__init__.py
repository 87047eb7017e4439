# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Solid elements through the thickness of the sheet."""
