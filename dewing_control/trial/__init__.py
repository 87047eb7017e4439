# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers flown on wings and compared."""
