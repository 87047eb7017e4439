# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What is shown of it."""
