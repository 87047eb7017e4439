# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parts named by module and name: found beside the package, in the working folder, or refused."""

import sys

import pytest

from dewing_sim.errors import BadInput
from dewing_sim.schema import plugins


def test_a_part_of_an_installed_package_is_found():
    assert plugins.load('dewing_sim.errors:BadInput', 'kind') is BadInput


def test_a_part_in_the_working_folder_is_found(tmp_path, monkeypatch):
    (tmp_path / 'my_part.py').write_text('class Law:\n    gain = 3.0\n')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, 'path', list(sys.path))
    assert plugins.load('my_part:Law', 'kind').gain == 3.0
    sys.modules.pop('my_part')


@pytest.mark.parametrize('word, reason', [
    ('law', 'is not of the form package.module:Name'),
    ('no_such_package.module:Law', 'cannot be imported .ModuleNotFoundError'),
    ('dewing_sim.errors:Law', 'the module dewing_sim.errors has no Law')])
def test_what_is_not_there_is_refused_in_one_sentence(word, reason):
    with pytest.raises(BadInput, match=f'kind = .{word}.*{reason}'):
        plugins.load(word, 'kind')
