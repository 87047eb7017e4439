# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Section 3 of the paper, computed anew: runs, sections made of them, and one report.

A run (`flight`, `controlled`, `experiments`, `designed`, `film`) computes for up to minutes and
is kept on disk; a section draws figures, tables and rows from finished runs within seconds.
"""
