# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The linear models that controllers are designed on, and their loops."""
