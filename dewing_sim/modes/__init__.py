# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The linear truth about a steady wing: its modes, from differences of its own steps."""
