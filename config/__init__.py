# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The shipped parameter files, installed as the package ``dewing_config``."""
