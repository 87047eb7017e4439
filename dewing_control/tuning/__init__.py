# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The search for gains, and its proof on the wing."""
