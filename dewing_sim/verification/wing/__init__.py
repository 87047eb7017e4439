# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Studies of the coupled wing."""
