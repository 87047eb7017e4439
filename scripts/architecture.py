# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Draw docs/images/architecture.svg: ``python scripts/architecture.py``. Standard library only."""

from pathlib import Path
from xml.sax.saxutils import escape

FILE = Path(__file__).parents[1] / 'docs' / 'images' / 'architecture.svg'
WIDTH, HEIGHT = 880, 520
FONT = 'font-family="Helvetica, Arial, sans-serif"'
# Left, top, width, height, colour, title, lines.
BOXES = (
    (20, 20, 580, 190, '#e8f1fa', 'dewing_sim: the plant', ()),
    (40, 55, 540, 36, '#ffffff', '', ('inputs: V², wall pressure, gust, motion of the wing',)),
    (40, 120, 160, 76, '#ffffff', 'fluid', ('finite_volume,', 'conformal')),
    (230, 120, 160, 76, '#ffffff', 'coupling', ('iteration, transfer,', 'added mass')),
    (420, 120, 160, 76, '#ffffff', 'structure', ('membrane, solid,', 'laws of elasticity')),
    (20, 255, 270, 76, '#e9f6ec', 'dewing_sysid',
     ('excitation, ERA / OKID:', 'V² to camber and lift')),
    (330, 255, 270, 76, '#fdf0e3', 'dewing_control',
     ('PID, learnt, LQG, MPC, your own;', 'tuning, comparison')),
    (20, 371, 580, 56, '#f5f5f5', 'dewing_cli: the command dewing',
     ('simulate, verify, identify, tune, compare, sweep, paper, demo',)),
    (660, 20, 200, 407, '#f3ecfa', 'ROS 2', ()),
    (680, 90, 160, 36, '#ffffff', '', ('simulator',)),
    (680, 275, 160, 36, '#ffffff', '', ('sysid, controller',)),
    (680, 371, 160, 36, '#ffffff', '', ('recorder: bags',)),
    (20, 452, 840, 56, '#fffbe6', 'config/*.yaml',
     ('every physical number in SI: cases, controller, identification; '
      'the schema checks them and describes ROS parameters',)),
)
# From, to, label, place of the label.
ARROWS = (
    ((310, 91), (310, 120), '', None),
    ((230, 145), (200, 145), '', None), ((200, 170), (230, 170), '', None),
    ((390, 145), (420, 145), '', None), ((420, 170), (390, 170), '', None),
    ((155, 210), (155, 255), 'responses', (163, 238)),
    ((290, 293), (330, 293), 'model', (292, 286)),
    ((430, 255), (430, 210), 'V²', (438, 238)),
    ((500, 210), (500, 255), 'camber, lift', (508, 238)),
    ((155, 371), (155, 331), '', None), ((465, 371), (465, 331), '', None),
    ((600, 108), (680, 108), '', None), ((680, 118), (600, 118), '', None),
    ((600, 293), (680, 293), '', None),
    ((745, 275), (745, 126), 'V²', (722, 205)), ((775, 126), (775, 275), 'outputs', (782, 205)),
    ((760, 311), (760, 371), 'all topics', (767, 345)),
    ((440, 452), (440, 427), '', None),
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
