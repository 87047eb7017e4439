# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The one linear model, and the plant that it makes."""
