# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Files of results are checked together, before anything is computed."""

import os
import threading
from pathlib import Path

import numpy as np
import pytest

from dewing_cli import main as cli
from dewing_cli import outputs
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.files import check_free, new_file

pytestmark = pytest.mark.usefixtures('own_folder')

ENDLESS = ['--duration', '1e4', '--quiet']       # if it were begun
TWICE = {
    'simulate': ['simulate', *ENDLESS, '--out', 'a', '--json', 'a'],
    'a state': ['simulate', *ENDLESS, '--out', 'a', '--save-state', './a'],
    'over a link': ['simulate', *ENDLESS, '--out', 'link', '--json', 'a'],
    'within a file': ['simulate', *ENDLESS, '--out', 'a', '--json', 'a/b.json'],
    'plate': ['plate', '--alpha', '4', *ENDLESS, '--dcp', 'a', '--json', 'a'],
    'material': ['material', '--out', 'a', '--json', 'a/stress.png'],
    'sweep': ['sweep', '--vary', 'flow.speed=1.0,1.1', *ENDLESS, '--out', 'a', '--json', 'a'],
    'identify': ['identify', '--records', 'a', '--mat', 'a'],
    'figures': ['identify', '--figures', 'a', '--out', 'a/poles.png'],
    'compare': ['compare', '--out', 'a', '--json', 'a/metrics.json'],
    'tune': ['tune', '--out', 'a', '--json', 'a/model.npz'],
    'paper': ['paper', '--out', 'a', '--json', 'a/paper.json'],
    'verify': ['verify', '--out', 'a', '--json', 'a/verification.md'],
    'bag': ['bag', 'plot', 'bag.mcap', '--out', 'a', '--json', 'a'],
}


def refused(capsys, arguments):
    """Return the sentence with which a command refuses its arguments."""
    assert cli.main([str(each) for each in arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == '' and captured.err.count('\n') == 1
    return captured.err


@pytest.mark.parametrize('command', TWICE)
@pytest.mark.parametrize('more', [[], ['--force']])
def test_two_results_in_one_file_are_refused(capsys, command, more):
    os.symlink('a', 'link')
    sentence = refused(capsys, [*TWICE[command], *more])
    assert 'are the same file' in sentence or 'one is a folder' in sentence
    assert os.listdir() == ['link']


@pytest.mark.parametrize('arguments', [
    ['simulate', '--case', 'in.yaml', '--json', 'in.yaml'],
    ['sweep', '--case', 'in.yaml', '--vary', 'flow.speed=1.0', '--out', 'in.yaml'],
    ['bag', 'info', 'in.yaml', '--json', 'in.yaml'],
    ['identify', '--from', 'in.yaml', '--out', 'in.yaml']])
def test_what_a_command_reads_is_not_written_over(capsys, arguments):
    text = parameters.to_yaml(parameters.load('paper'))
    Path('in.yaml').write_text(text)
    assert 'is a file that the command reads' in refused(capsys, [*arguments, '--force'])
    assert Path('in.yaml').read_text() == text


@pytest.mark.parametrize('option', ['--out', '--json', '--save-state'])
@pytest.mark.parametrize('path, complaint', [
    (255 * 'x' + '.npz', 'a name of 259 bytes is too long: at most 255'),
    ('new/' + 130 * 'é' + '/x', 'a name of 260 bytes is too long: at most 255'),
    (40 * ('x' * 120 + '/') + 'x', 'cannot be written (File name too long)'),
    ('file/below', 'is not a folder that can be written to'),
    ('', ' is a folder'), ('circle', 'is a link that leads in circles'),
    ('/proc/dewing.npz', '/proc is not a folder that can be written to'),
    ('socket', 'is neither a file nor a stream')])
def test_what_cannot_be_written_is_refused_before_the_run(capsys, option, path, complaint):
    import socket
    Path('file').touch()
    os.symlink('circle', 'circle')
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind('socket')
        assert complaint in refused(capsys, ['simulate', *ENDLESS, option, path, '--force'])


def test_the_longest_name_is_written():
    with new_file(255 * 'x') as file:
        file.write(b'1')
    assert [path.name for path in Path().iterdir()] == [255 * 'x']


def test_links_are_followed_and_stay():
    Path('folder').mkdir()
    Path('folder/old').write_bytes(b'old')
    os.symlink('folder/old', 'link')
    os.symlink('folder/new', 'dangling')
    with pytest.raises(BadInput, match='^link exists'):
        check_free('link')
    for name in ('link', 'dangling'):
        with new_file(name, overwrite=name == 'link') as file:
            file.write(b'1')
        assert Path(name).is_symlink() and Path(name).read_bytes() == b'1'
    assert sorted(os.listdir('folder')) == ['new', 'old']


def test_a_device_is_written_to_and_stays_one():
    with new_file('/dev/null', overwrite=True) as file:
        np.savez_compressed(file, a=np.ones(3))
    assert Path('/dev/null').is_char_device()


def test_a_pipe_gets_the_whole_file():
    os.mkfifo('pipe')
    found = []
    reader = threading.Thread(target=lambda: found.append(Path('pipe').read_bytes()))
    reader.start()
    with new_file('pipe') as file:
        np.savez_compressed(file, a=np.ones(3))
    reader.join(10.0)
    assert found[0][:2] == b'PK' and Path('pipe').is_fifo()


def test_an_open_descriptor_is_appended_to():
    with open('file', 'wb') as file:
        file.write(b'before ')
        file.flush()
        with new_file(f'/dev/fd/{file.fileno()}') as stream:
            stream.write(b'after')
    assert Path('file').read_bytes() == b'before after'


def test_streams_may_serve_twice_and_files_may_not():
    outputs.claim({'--out': '/dev/null', '--json': '/dev/null', '--mat': None})
    with pytest.raises(BadInput, match='^--json ./a and --out a are the same file'):
        outputs.claim({'--out': 'a', '--json': './a'})


def test_a_sweep_needs_a_file(capsys):
    assert '--out /dev/null is no file' in refused(
        capsys, ['sweep', '--vary', 'flow.speed=1.0', *ENDLESS, '--out', '/dev/null'])
