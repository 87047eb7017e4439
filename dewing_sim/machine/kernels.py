# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How the flow kernels are compiled, IEEE division without checks, cached on disk; and scratch.

What keeps a loop in SIMD lanes, found with the remarks of the compiler: the inner loop runs along
the last axis of each array, 64 values or more.  Before a loop the compiler compares the places of
all arrays; beyond some ten it gives up.  A loop that carries values from line to line would fail
that test, which is made once for all lines: take the lines from an array of indices, and it is
made for each line.  Arrays are not exchanged by name in a loop; two rows of one array take turns.
"""

import math
from types import FunctionType
from typing import Any, Callable

import numba
import numpy as np
from numba.core import sigutils
from numba.core.ccallback import CFunc
from numba.core.dispatcher import Dispatcher
from numba.extending import register_jitable

from dewing_sim.machine import content
from dewing_sim.machine.kernel_cache import KernelCache

PAGE = 512                  # doubles in 4 KB
KERNELS: list[FunctionType] = []    # what `compiled` has compiled, for profiles


def compiled(**options: Any) -> Callable[[FunctionType], Any]:
    """Return a decorator that compiles with ``options`` of numba, and keeps the result on disk."""
    def decorate(function: FunctionType) -> Any:
        made = numba.njit(**options)(function)
        KERNELS.append(function)
        if isinstance(made, Dispatcher):        # not so under NUMBA_DISABLE_JIT
            made._cache = KernelCache(function, made.targetoptions)
        return made
    return decorate


# Without error_model='numpy' every division carries a branch and no loop becomes SIMD.
kernel = compiled(error_model='numpy')
# A division by zero raises.
checked_kernel = compiled()
# Sums become SIMD only where they may be added up in another order.
summing_kernel = compiled(error_model='numpy', fastmath={'reassoc', 'nsz'})
# A part of one kernel. Compiled by itself, it would be compiled once more within its caller.
stage = numba.njit(inline='always', error_model='numpy')
# A part of several kernels: compiled once in each that calls it, and not kept by itself.
part = numba.njit(error_model='numpy')
# A kernel and a part that make no array. Numba counts the references to each array of a tuple that
# one stage hands to the next, which costs more than a line of a field; not so here.
LEAN = {'error_model': 'numpy', '_nrt': False}
lean_kernel = compiled(**LEAN)
# Python must not call the part: to make that possible would double the time to compile it.
lean_part = numba.njit(**LEAN, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def formula(function: FunctionType) -> FunctionType:
    """Let a function be plain in Python, and compiled inside what is compiled."""
    options = {'error_model': 'numpy'}
    setattr(function, content.OPTIONS, options)
    return register_jitable(**options)(function)


def c_function(function: FunctionType, signature: Any) -> CFunc:
    """Compile for other compiled code to call by address; keep the result on disk."""
    options = {'error_model': 'numpy'}
    made = CFunc(function, sigutils.normalize_signature(signature), locals={}, options=options)
    made._cache = KernelCache(function, options)
    made.compile()
    return made


def scratch(count: int, *shape: int) -> list[np.ndarray]:
    """Return arrays of zeros that start at different places of a page.

    A processor takes a load for one of what it has just stored at the same place of another page,
    and waits: fields of a whole number of pages would cost up to twice the time.
    """
    size = math.prod(shape)
    stride = (size + PAGE - 1) // PAGE * PAGE + PAGE // count // 8 * 8
    block = np.zeros(count * stride)
    return [block[k * stride:k * stride + size].reshape(shape) for k in range(count)]
