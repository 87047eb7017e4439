# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The map from the half-strip to the outside of the membrane, and the axes it moves in."""
