# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on a wing, as functions of time."""
