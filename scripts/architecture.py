# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Draw docs/images/architecture.svg: ``python scripts/architecture.py``. Standard library only."""

from pathlib import Path
from xml.sax.saxutils import escape

FILE = Path(__file__).parents[1] / 'docs' / 'images' / 'architecture.svg'
WIDTH, HEIGHT = 880, 430
FONT = 'font-family="Helvetica, Arial, sans-serif"'
# Left, top, width, height, colour, title, lines.
BOXES = (
    (20, 20, 540, 150, '#e8f1fa', 'dewing_sim: the plant', ()),
    (40, 60, 150, 90, '#ffffff', 'fluid', ('finite_volume', 'conformal')),
    (215, 60, 150, 90, '#ffffff', 'interface', ('transfer, added', 'mass, coupling')),
    (390, 60, 150, 90, '#ffffff', 'structure', ('membrane, solid', 'Gent + Maxwell')),
    (20, 220, 260, 80, '#e9f6ec', 'dewing_sysid',
     ('excitation, ERA / OKID:', 'V² to camber and lift')),
    (300, 220, 260, 80, '#fdf0e3', 'dewing_control',
     ('PID, feed-forward, LQG, MPC', 'tuning, comparison')),
    (620, 20, 240, 150, '#f3ecfa', 'ROS 2', ()),
    (640, 55, 200, 28, '#ffffff', '', ('simulator',)),
    (640, 90, 95, 28, '#ffffff', '', ('controller',)),
    (745, 90, 95, 28, '#ffffff', '', ('sysid',)),
    (640, 125, 200, 28, '#ffffff', '', ('recorder',)),
    (620, 220, 240, 80, '#f5f5f5', 'dewing COMMAND',
     ('simulate, verify, identify, tune,', 'compare, sweep, ...')),
    (20, 345, 840, 65, '#fffbe6', 'config/*.yaml',
     ('every physical number in SI: cases, controller, identification; '
      'the schema checks them and describes ROS parameters',)),
)
# From, to, label, place of the label.
ARROWS = (
    ((215, 95), (190, 95), '', None), ((190, 120), (215, 120), '', None),
    ((365, 95), (390, 95), '', None), ((390, 120), (365, 120), '', None),
    ((150, 170), (150, 220), 'responses', (158, 200)),
    ((280, 260), (300, 260), 'A, B, C', (267, 213)),
    ((450, 220), (450, 170), 'V²', (458, 200)),
    ((500, 170), (500, 220), 'camber, lift', (508, 200)),
    ((560, 95), (620, 95), '', None), ((620, 110), (560, 110), '', None),
    ((560, 260), (620, 260), '', None),
    ((400, 345), (400, 300), '', None),
)


def svg() -> str:
    """Return the picture."""
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">',
             '<title>Architecture of dewing</title>',
             '<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" '
             'markerHeight="7" orient="auto"><path d="M0 0 10 5 0 10z" fill="#444"/></marker>'
             '</defs>',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for box in BOXES:
        parts += _box(*box)
    for (x0, y0), (x1, y1), label, place in ARROWS:
        parts.append(f'<path d="M{x0} {y0} {x1} {y1}" stroke="#444" stroke-width="1.5" '
                     'fill="none" marker-end="url(#tip)"/>')
        if place:
            parts.append(_text(*place, label, 12, 'start'))
    return '\n'.join([*parts, '</svg>', ''])


def _box(x, y, width, height, colour, title, lines):
    yield (f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="6" fill="{colour}" '
           'stroke="#444"/>')
    middle = x + width / 2
    if title:
        yield _text(middle, y + 22, title, 15, 'middle', bold=True)
    first = y + 44 if title else y + height / 2 + 5
    for k, line in enumerate(lines):
        yield _text(middle, first + 18 * k, line, 13, 'middle')


def _text(x, y, text, size, anchor, bold=False):
    weight = ' font-weight="bold"' if bold else ''
    return (f'<text x="{x:g}" y="{y:g}" {FONT} font-size="{size}" text-anchor="{anchor}" '
            f'fill="#222"{weight}>{escape(text)}</text>')


if __name__ == '__main__':
    FILE.write_text(svg(), encoding='utf-8')
    print(FILE)
