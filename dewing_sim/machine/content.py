# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a compiled function is made of: its bytecode and that of all it calls, and constants.

Numba takes the values of global names when it compiles. A compiled function is therefore out of
date as soon as its own instructions, a constant that it names, or any of this in a function that
it calls, directly or not, has changed; and only then: comments, docstrings, places of lines, and
times of files have no part in it.
"""

import enum
import hashlib
import sys
from types import CodeType, FunctionType, ModuleType
from typing import Any, Iterator

import llvmlite
import numpy as np
from numba.core import config, types
from numba.core.dispatcher import Dispatcher

OPTIONS = '_compiled_with'      # attribute of plain functions that are compiled in their callers
# Named, not read: numba or the language knows these.
FOREIGN = {'llvmlite', 'numba', 'numpy', 'scipy', *sys.stdlib_module_names}
SWITCHES = ('BOUNDSCHECK', 'OPT', 'LOOP_VECTORIZE', 'SLP_VECTORIZE')    # of numba's environment


def digest(function: FunctionType, options: dict[str, Any]) -> str:
    """Return a hash of what ``function``, compiled with ``options`` of numba, computes."""
    reader = _Reader()
    reader.reference(function, options)
    lines = [llvmlite.__version__, *(str(getattr(config, name, None)) for name in SWITCHES),
             *reader.lines()]
    return hashlib.sha256('\n'.join(lines).encode('utf-8', 'surrogatepass')).hexdigest()


class _Reader:
    """Goes from function to function; each is read once, so that they may call each other."""

    def __init__(self):
        self._numbers: dict[int, int] = {}
        self._waiting: list[tuple[FunctionType, Any]] = []

    def reference(self, function: FunctionType, options: Any) -> str:
        """Return a name for ``function``, which is read later."""
        if id(function) not in self._numbers:
            self._numbers[id(function)] = len(self._numbers)
            self._waiting.append((function, options))
        return f'function {self._numbers[id(function)]}'

    def lines(self) -> Iterator[str]:
        """Read functions until none is left."""
        for function, options in self._waiting:         # grows meanwhile
            yield f'{self.value(options)} {self._function(function)}'

    def _function(self, function: FunctionType) -> str:
        code, documented = function.__code__, function.__doc__ is not None
        codes = list(_codes(code))
        names = dict.fromkeys(name for part in codes for name in part.co_names)
        around = {}
        for name, cell in zip(code.co_freevars, function.__closure__ or ()):
            try:
                around[name] = cell.cell_contents
            except ValueError:
                continue                # not yet filled
        around |= {name: function.__globals__[name] for name in names
                   if name in function.__globals__}
        constants = [self.value(constant) for part in codes
                     for constant in part.co_consts[documented and part is code:]
                     if not isinstance(constant, CodeType)]
        instructions = [(part.co_code, part.co_names, part.co_varnames, part.co_freevars,
                         part.co_argcount, part.co_kwonlyargcount, part.co_flags)
                        for part in codes]
        named = [f'{name} = {self.value(value, names)}' for name, value in around.items()]
        defaults = self.value((function.__defaults__, function.__kwdefaults__))
        return f'{instructions} {constants} {named} {defaults}'

    def value(self, value: Any, names: Any = ()) -> str:
        """Describe a value; of a module of ours, only what is called one of ``names``."""
        if isinstance(value, (tuple, list)):
            return f'{_kind(value)}({[self.value(item) for item in value]})'
        if isinstance(value, (set, frozenset)):
            return f'{_kind(value)}({sorted(map(self.value, value))})'
        if isinstance(value, dict):
            return f'dict({sorted((str(key), self.value(item)) for key, item in value.items())})'
        if isinstance(value, np.ndarray):
            return f'{value.dtype} {value.shape} {value.strides} {value.tobytes()!r}'
        if isinstance(value, ModuleType):
            return self._module(value, names)
        if isinstance(value, types.ExternalFunction):
            return f'{value.symbol} {value.sig}'
        if isinstance(value, type):
            return _class(value)
        if isinstance(value, Dispatcher):
            return self.reference(value.py_func, value.targetoptions)
        inner = getattr(value, 'py_func', getattr(value, '__wrapped__', value))
        if isinstance(inner, FunctionType):
            if _foreign(inner.__module__):
                return f'{inner.__module__}.{inner.__qualname__}'
            return self.reference(inner, getattr(inner, OPTIONS, None))
        if isinstance(value, (bool, int, float, complex, str, bytes, np.generic, types.Type)):
            return f'{_kind(value)} {value!r}'
        return _kind(value)             # nothing that numba takes for a constant

    def _module(self, module: ModuleType, names: Any) -> str:
        if _foreign(module.__name__):
            return module.__name__
        found = {name: vars(module)[name] for name in names if name in vars(module)}
        rest = [name for name in names if name not in found]
        return f'{[(name, self.value(value, rest)) for name, value in found.items()]}'


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Yield a function's code and that of the functions inside."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _foreign(module: str | None) -> bool:
    return module is None or module.partition('.')[0] in FOREIGN


def _kind(value: Any) -> str:
    return f'{type(value).__module__}.{type(value).__qualname__}'


def _class(kind: type) -> str:
    """Describe a class: a named tuple by its fields, an enumeration by its members."""
    parts = getattr(kind, '_fields', '')
    if issubclass(kind, enum.Enum):
        parts = [(member.name, member.value) for member in kind]
    return f'{kind.__module__}.{kind.__qualname__}{parts}'


def classes(signature: Any) -> tuple[str, ...]:
    """Return what is known of the named tuples among the arguments of a ``signature``."""
    return tuple(_class(kind) for kind in _instance_classes(getattr(signature, 'args', signature)))


def _instance_classes(arguments: Any) -> Iterator[type]:
    for argument in arguments:
        if isinstance(argument, types.StructRef):
            yield from _instance_classes(argument.field_dict.values())
        if isinstance(argument, types.BaseTuple):
            if isinstance(argument, types.BaseNamedTuple):
                yield argument.instance_class
            yield from _instance_classes(argument.types)
