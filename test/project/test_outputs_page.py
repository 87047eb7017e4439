# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The page of outputs is what the fields of `Outputs` say."""

import re
import runpy
from pathlib import Path

from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema

PROJECT = Path(__file__).parents[2]


def test_the_page_is_that_of_the_schema():
    page = runpy.run_path(str(PROJECT / 'scripts' / 'outputs_table.py'))['page']()
    assert (PROJECT / 'docs' / 'outputs.md').read_text() == page, (
        'run: python scripts/outputs_table.py')


def test_the_pages_on_ros_name_what_is_measured_in_order():
    for page, pattern in (('README.md', r'\| `measurement` \|.*\| every step: (.*) in force'),
                          ('docs/ros.md', r'`measurement`: `name` is ([\w, ]*);')):
        listed = re.search(pattern, (PROJECT / page).read_text())[1]
        words = re.findall(r'\w+', listed)
        assert [word for word in words if word in schema(Outputs).names] == [
            *schema(Outputs).measured], page
