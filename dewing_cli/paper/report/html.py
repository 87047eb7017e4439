# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One HTML file with everything inside: figures as data URIs, no script, no link to a server."""

import base64
import html
from typing import Any

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report.page import STYLE
from dewing_cli.paper.report.section import Figure, Row, Section, Table
from dewing_cli.paper.report.sections import PAPER

CITATION = ('S. Buoso and R. Palacios, <i>Reduced-order modelling and feedback control of '
            'integrally actuated membrane wings</i>, IFASD-2015-072')
COLUMNS = ('quantity', 'paper', 'ours', '± mean', '± numerics', 'difference', 'explanation')
SMALLEST = 1.0e-4           # error worth stating
QUICK = ('Quick version: coarse grids, short starts and short averages. Its numbers show that '
         'everything runs; quote those of the full version.')


def page(plan: Plan, sections: list[Section], record: dict[str, Any]) -> str:
    """Return the report."""
    body = [_head(plan, sections, record), _contents(sections), _table_of_rows(sections)]
    for number, section in enumerate(sections, 1):
        if number == len(PAPER) + 1:
            body.append('<h2 class="part">Beyond the paper</h2>')
        body.append(_section(number, section))
    body.append(_appendix(plan, record))
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'<title>dewing: the paper, computed anew</title>\n<style>{STYLE}</style>\n</head>\n'
            f'<body>\n<main>\n{"".join(body)}</main>\n</body>\n</html>\n')


def _text(value: str) -> str:
    return html.escape(value, quote=False)


def _head(plan: Plan, sections: list[Section], record: dict[str, Any]) -> str:
    engine = plan.engine.replace('_', '-')
    notes = [f'<p class="quick">{QUICK}</p>'] if plan.quick else []
    notes += [f'<p class="failed">The run {_text(name)} failed: {_text(reason)}</p>'
              for name, reason in record['failures'].items()]
    return (f'<header><p class="kicker">dewing {_text(record["version"])}</p>'
            '<h1>A membrane wing of dielectric elastomer, computed anew</h1>'
            f'<p class="lead">Every result of section 3 of {CITATION}, from the flow solver '
            'to the closed loop, and what the paper leaves open.</p>'
            f'<p class="facts">Engine {engine} on grid {plan.extent.grids[plan.engine]}; '
            f'{plan.other.replace("_", "-")} on {plan.extent.grids[plan.other]} beside it. '
            f'{len(plan.runs)} runs.</p>{"".join(notes)}{_film(sections)}</header>\n')


def _film(sections: list[Section]) -> str:
    """Return the film of the flow, with which the page opens."""
    return ''.join(_figure(figure) for section in sections for figure in section.figures
                   if figure.kind == 'gif')


def _contents(sections: list[Section]) -> str:
    items = ''.join(f'<li><a href="#{section.name}">{_text(section.title)}</a></li>'
                    for section in sections)
    return f'<nav><ol>{items}</ol></nav>\n'


def _table_of_rows(sections: list[Section]) -> str:
    rows = ''.join(_row(row) for section in sections for row in section.rows)
    head = ''.join(f'<th>{name}</th>' for name in COLUMNS)
    return ('<section id="table"><h2>The paper and ours</h2>'
            '<p>"± mean" is the standard error of an average in time, from eight blocks. '
            '"± numerics" is the largest change with grid, time step and engine. The bar shows '
            'the difference from the paper; grey is within 5 %.</p>'
            f'<div class="wide"><table class="rows"><thead><tr>{head}</tr></thead>'
            f'<tbody>{rows}</tbody></table></div></section>\n')


def _row(row: Row) -> str:
    unit = f' {row.unit}' if row.unit else ''
    cells = [f'<td>{_text(row.quantity)}</td>',
             f'<td class="n">{"&lt; " if row.bound else ""}{_number(row.paper, unit)}</td>',
             f'<td class="n"><b>{_number(row.ours, unit)}</b></td>',
             f'<td class="n">{_number(row.error, unit, 2)}</td>',
             f'<td class="n">{_number(row.spread, unit, 2)}</td>', _difference(row),
             f'<td>{_text(row.explanation)}</td>']
    return f'<tr>{"".join(cells)}</tr>'


def _number(value: float | None, unit: str, digits: int = 4) -> str:
    if value is None or (digits == 2 and abs(value) < 1.0e-12):
        return '–'
    if digits == 2 and abs(value) < SMALLEST:
        return f'&lt; {SMALLEST:g}'
    return f'{value:.{digits}g}'.replace('-', '−') + unit


def _difference(row: Row) -> str:
    share = row.difference
    if share is None:
        return '<td class="n">–</td>'
    width = min(abs(share), 0.5) * 100.0
    kind = 'near' if abs(share) <= 0.05 else 'far'
    text = f'{100.0 * share:+.1f} %'.replace('-', '−')
    return (f'<td class="n">{text}<span class="bar {kind}" style="width:{width:.1f}%"></span>'
            '</td>')


def _section(number: int, section: Section) -> str:
    parts = [f'<h2><span class="number">{number}</span>{_text(section.title)}</h2>']
    parts += [f'<p>{_text(text)}</p>' for text in section.text]
    parts += [_figure(figure) for figure in section.figures if figure.kind != 'gif']
    parts += [_table(table) for table in section.tables]
    if section.series:
        files = ', '.join(f'<code>csv/{_text(name)}.csv</code>' for name in _files(section))
        parts.append(f'<p class="series">Series: {files}</p>')
    return f'<section id="{section.name}">{"".join(parts)}</section>\n'


def _files(section: Section) -> list[str]:
    from dewing_cli.paper.report.record import file_name
    return [file_name(name) for name in section.series]


def _figure(figure: Figure) -> str:
    data = base64.b64encode(figure.data).decode()
    caption = _text(figure.caption)
    alternative = html.escape(figure.caption)
    return (f'<figure><img alt="{alternative}" src="data:image/{figure.kind};base64,{data}">'
            f'<figcaption>{caption}</figcaption></figure>')


def _table(table: Table) -> str:
    head = ''.join(f'<th>{_text(name)}</th>' for name in table.header)
    body = ''.join('<tr>' + ''.join(f'<td>{_text(cell)}</td>' for cell in row) + '</tr>'
                   for row in table.rows)
    return (f'<div class="wide"><table><caption>{_text(table.caption)}</caption>'
            f'<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>')


def _appendix(plan: Plan, record: dict[str, Any]) -> str:
    cases = ''.join(f'<details><summary>Case of the runs at {degrees} degrees</summary>'
                    f'<pre>{_text(plan.runs[run].case)}</pre></details>'
                    for degrees, run in ((4, 'rest'), (8, 'shed')))
    command = f'dewing paper{" --quick" if plan.quick else ""} --engine {plan.engine} --out DIR'
    return ('<section id="again"><h2>Computed again</h2>'
            f'<p><code>{command}</code> makes this page anew. Finished runs are kept in '
            '<code>DIR/runs</code> and used again while case, options and code are unchanged; '
            'numbers are in <code>DIR/paper.json</code> and <code>DIR/csv</code>. This time the '
            f'runs that were not there yet took {record["seconds"]:.0f} s.</p>{cases}</section>\n')
