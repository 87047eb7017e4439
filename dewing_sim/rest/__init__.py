# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The state a run starts from, and its file."""
