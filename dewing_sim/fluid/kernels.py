# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How the flow kernels are compiled: IEEE division without checks, cached on disk."""

import numba

# Without error_model='numpy' every division carries a branch and no loop becomes SIMD.
kernel = numba.njit(cache=True, error_model='numpy')
# Sums become SIMD only where they may be added up in another order.
summing_kernel = numba.njit(cache=True, error_model='numpy', fastmath={'reassoc', 'nsz'})
