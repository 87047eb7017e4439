# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the README lists is what there is."""

import re
import runpy
from pathlib import Path

from dewing_cli import main as cli
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema

PROJECT = Path(__file__).parents[2]
README = (PROJECT / 'README.md').read_text()


def test_the_table_of_parameters_is_that_of_the_schema():
    rows = runpy.run_path(str(PROJECT / 'scripts' / 'parameter_table.py'))['rows']()
    between = README.partition('<!-- parameters')[2].partition('<!-- end of parameters')[0]
    assert between.splitlines()[1:] == rows


def test_every_command_is_listed():
    assert set(re.findall(r'^\| `dewing (\w+)', README, re.M)) == set(cli.command_modules())


def test_every_linked_page_exists():
    links = [link for link in re.findall(r'(?<!!)\[[^]]*\]\(([^)]+)\)', README)
             if not link.startswith('http')]
    assert links and all((PROJECT / link).is_file() for link in links)


def test_every_published_topic_is_listed():
    sources = ''.join((PROJECT / path).read_text() for path in (
        'dewing_sim/ros/node.py', 'dewing_sim/ros/question.py', 'dewing_sim/ros/telemetry.py',
        'dewing_control/node.py'))
    topics = re.findall(r"create_publisher\(\w+, '(/?\w+)'", sources)
    topics += re.findall(r"channel\(\s*'(/?\w+)'", sources)
    topics += [each.topic for each in schema(Outputs).quantities if each.topic]
    listed = re.search(r'\| topic \|.*?\n\n', README, re.S).group()
    assert topics and all(f'`{topic}`' in listed for topic in topics)
