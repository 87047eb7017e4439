# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of ``dewing``, one module each.

The docstring of a module is its help; ``add_arguments(parser)`` declares its options and
``run(arguments)`` returns the exit status or None for success. Modules are imported to build the
help, so they import what is slow inside `run`.
"""
