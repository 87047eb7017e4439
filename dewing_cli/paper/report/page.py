# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The look of the report, on screen and on paper."""

STYLE = """
:root { --ink: #1d2733; --soft: #5d6b7a; --line: #dfe4ea; --blue: #0072b2; --orange: #d55e00;
  --paper: #ffffff; --wash: #f5f7f9; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--wash); color: var(--ink);
  font: 16px/1.6 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif; }
main { max-width: 1040px; margin: 0 auto; padding: 0 24px 64px; background: var(--paper); }
header { padding: 56px 0 24px; border-bottom: 3px solid var(--ink); }
h1 { font-size: 2.2rem; line-height: 1.2; margin: 0 0 12px; letter-spacing: -0.02em; }
h2 { font-size: 1.35rem; line-height: 1.3; margin: 48px 0 12px; }
h2.part { margin-top: 72px; padding-top: 16px; border-top: 3px solid var(--ink);
  font-size: 1.6rem; }
p { max-width: 46rem; margin: 0 0 12px; }
.kicker { color: var(--blue); font-weight: 600; margin: 0 0 4px; }
.lead { font-size: 1.15rem; }
.facts, .series, figcaption, caption { color: var(--soft); font-size: 0.9rem; }
.quick { background: #fff4e0; border-left: 4px solid #e69f00; padding: 10px 14px;
  max-width: none; }
.failed { background: #fdeaea; border-left: 4px solid #c0392b; padding: 10px 14px;
  max-width: none; }
nav ol { columns: 2; column-gap: 40px; padding-left: 22px; margin: 20px 0 0; }
nav a { color: var(--blue); text-decoration: none; }
nav a:hover { text-decoration: underline; }
.number { color: var(--soft); font-weight: 400; margin-right: 12px; }
figure { margin: 20px 0; }
figure img { max-width: 100%; height: auto; display: block; }
figcaption { margin-top: 6px; max-width: 46rem; }
.wide { overflow-x: auto; margin: 16px 0; }
table { border-collapse: collapse; font-size: 0.88rem; line-height: 1.4; min-width: 60%; }
caption { text-align: left; padding-bottom: 6px; }
th { text-align: left; vertical-align: bottom; border-bottom: 2px solid var(--ink);
  padding: 4px 12px 4px 0; font-weight: 600; }
td { border-bottom: 1px solid var(--line); padding: 5px 12px 5px 0; vertical-align: top;
  font-variant-numeric: tabular-nums; }
td.n { white-space: nowrap; }
table.rows { width: 100%; }
table.rows td:first-child { min-width: 15rem; }
table.rows td:last-child { color: var(--soft); min-width: 16rem; }
.bar { display: block; height: 4px; margin-top: 3px; border-radius: 2px; min-width: 1px; }
.near { background: #b6bfc9; }
.far { background: var(--orange); }
code, pre { font: 0.86em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
pre { background: var(--wash); padding: 14px; overflow-x: auto; }
details { margin: 10px 0; }
summary { cursor: pointer; color: var(--blue); }
@media (max-width: 640px) { nav ol { columns: 1; } h1 { font-size: 1.7rem; } }
@media print {
  @page { size: A4; margin: 16mm 14mm; }
  body { background: none; font-size: 10pt; }
  main { max-width: none; padding: 0; }
  header { padding-top: 0; }
  h2 { break-after: avoid; }
  figure, tr { break-inside: avoid; }
  .wide { overflow: visible; }
  table { font-size: 7.5pt; }
  td, th { padding-right: 6px; }
  table.rows td:first-child, table.rows td:last-child { min-width: 0; }
  details { display: none; }
}
"""
