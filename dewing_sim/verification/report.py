# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A verification as a table on the terminal and as a page with figures."""

from pathlib import Path

from dewing_sim.files import new_file
from dewing_sim.verification.study import Check, Study
from dewing_sim.verification.suite import Verification

PAGE = 'verification.md'
HEADER = ('name', 'engine', 'ours', 'reference', 'source', 'difference', 'gate', 'pass')
MISSES = '## Known misses'
INTRODUCTION = """# Verification

Written by `dewing verify --out docs --force`; `dewing verify --quick` runs a part of it in about
a minute, and so does `make test`. Lengths are in chords and speeds in free-stream speeds unless a
unit is given. A difference is relative to the reference, or absolute where it has no percent
sign. A row without gate is reported, not judged. A missed gate makes the command exit with
status 1.
"""


def cells(check: Check) -> tuple[str, ...]:
    """Return the columns of `HEADER`."""
    value = f'{check.value:.5g}'
    if check.error is not None:
        value += f' +- {check.error:.2g}'
    reference = '-' if check.reference is None else f'{check.reference:.5g}'
    verdict = '-' if check.gate is None else 'yes' if check.passed else 'MISSED'
    return (check.name, check.engine, value, reference, check.source,
            _difference(check, check.difference, '+'), _difference(check, check.gate), verdict)


def _difference(check: Check, value: float | None, sign: str = '') -> str:
    if value is None:
        return '-'
    if check.scale == 1.0:
        return f'{value:{sign}.2g}'
    return f'{100.0 * value:{sign}.2f} %'


def text_table(checks: list[Check]) -> str:
    """Return aligned columns."""
    rows = [HEADER, *map(cells, checks)]
    widths = [max(map(len, column)) for column in zip(*rows)]
    return '\n'.join('  '.join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
                     for row in rows)


def markdown_table(checks: list[Check]) -> str:
    """Return a Markdown table."""
    rows = [HEADER, ('---',) * len(HEADER), *map(cells, checks)]
    return '\n'.join(f'| {" | ".join(row)} |' for row in rows)


def summary(verification: Verification) -> str:
    """Return one sentence on how many gates were met."""
    gated = [check for check in verification.all_checks if check.gate is not None]
    missed = len(verification.missed)
    return (f'{len(gated) - missed} of {len(gated)} gates met, '
            f'{len(verification.all_checks) - len(gated)} values reported without a gate')


def known_misses(page: str) -> set[tuple[str, str]]:
    """Return (name, engine) of the misses that a page lists."""
    section = page.split(MISSES, 1)[1].split('\n## ', 1)[0]
    rows = [line.strip('| ').split(' | ') for line in section.splitlines()
            if line.startswith('| ')]
    return {(row[0], row[1]) for row in rows[2:]}


def write(verification: Verification, folder: str | Path, overwrite: bool = False) -> Path:
    """Write the page into ``folder`` and its figures into ``folder``/images; return the page."""
    folder = Path(folder)
    parts = [INTRODUCTION, f'{summary(verification)}.\n', f'{MISSES}\n',
             markdown_table(verification.missed) if verification.missed else 'None.', '']
    for study in verification.studies:
        if checks := verification.checks[study.name]:
            parts += [f'## {study.title}\n', f'{study.text}\n', markdown_table(checks), '']
            if study.draw and verification.results[study.name] and not verification.quick:
                image = _draw(study, verification, folder, overwrite)
                parts.append(f'![{study.title}]({image.relative_to(folder).as_posix()})\n')
    with new_file(folder / PAGE, overwrite) as file:
        file.write('\n'.join(parts).encode())
    return folder / PAGE


def image(study: Study) -> str:
    """Return the file of the figure of a study, within the folder of the page."""
    return f'images/verification_{study.name}.png'


def _draw(study: Study, verification: Verification, folder: Path, overwrite: bool) -> Path:
    from matplotlib.figure import Figure
    figure = Figure(figsize=(9.0, 3.6), layout='constrained')
    study.draw(figure, verification.results[study.name])
    path = folder / image(study)
    with new_file(path, overwrite) as file:
        figure.savefig(file, format='png', dpi=110, metadata={'Software': None})
    return path
