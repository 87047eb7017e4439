# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What is computed, each run for a process of its own."""
