# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Flow and membrane, solved together."""
