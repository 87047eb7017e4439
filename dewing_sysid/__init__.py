# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Identification of linear models from the responses of a plant."""
