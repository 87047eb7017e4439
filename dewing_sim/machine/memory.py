# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Keep the memory of field arrays in the process.

A step makes new arrays and drops old ones.  By default glibc returns such blocks to the kernel,
which hands them out again page by page: about a hundred page faults and a third of a step's time.
"""

import ctypes

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3     # from malloc.h
KEPT = 1 << 28                              # bytes


def keep_freed_arrays() -> None:
    """Raise the thresholds of glibc's allocator; elsewhere do nothing."""
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError, TypeError):
        return
    mallopt(MMAP_THRESHOLD, KEPT)
    mallopt(TRIM_THRESHOLD, KEPT)
