# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command ``dewing`` and the applications behind it."""
