# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Show that a change of structure changes no bit of any result.

``bitwise.py run FOLDER`` computes rest states, runs, identifications, tuned gains and a recorded
closed loop through the commands and nodes that users have, so that it does not depend on where
anything stands in the sources. ``bitwise.py compare BEFORE AFTER`` then demands of every array
and number before that it is there after, the same to the last bit. Both folders must come from
one machine: another processor rounds differently. What is new is listed, not judged.
"""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

BIN = Path(sys.executable).parent
TIMES = re.compile(r'seconds|rtf|ms_per_step|compute|overhead|idle|fingerprint|^version$')
SHORT = ('--set', 'numerics.trim_time=2.0')
REALTIME = ('--engine', 'conformal', '--grid', 'realtime', '--dt', '5e-4', *SHORT)
FAST = ('--engine', 'finite_volume', '--grid', 'fast', *SHORT)
SOLID = ('--set', 'membrane.element=solid', '--set', 'membrane.elements=32')
GUST = ('--set', 'gust.shape=sine', '--set', 'gust.vertical=0.02', '--set', 'gust.duration=0.01',
        '--set', 'rigid_motion.shape=one_minus_cosine', '--set', 'rigid_motion.pitch_deg=1.0',
        '--set', 'rigid_motion.heave=1.0e-4')
RUNS = {
    'volume': (*FAST, '--voltage', '300', '--duration', '0.004'),
    'volume_solid': (*FAST, *SOLID, '--voltage', '300', '--duration', '0.004'),
    'volume_pid': (*FAST, '--disturbance', 'fig5', '--controller', 'controller', '--duration',
                   '0.01'),
    'map': (*REALTIME, '--voltage', '300', '--duration', '0.02'),
    'map_negative_voltage_step': (*REALTIME, '--set', 'actuation.voltage=400.0', '--voltage',
                                  '0', '--duration', '0.02'),
    'map_solid': (*REALTIME, *SOLID, '--set', 'membrane.support=middle', '--voltage', '300',
                  '--duration', '0.02'),
    'map_viscous': (*REALTIME, '--set', 'membrane.viscous_share=0.5', '--set',
                    'membrane.viscous_time=0.01', '--voltage', '300', '--duration', '0.02'),
    'map_gust': (*REALTIME, *GUST, '--voltage', '300', '--duration', '0.02'),
    'map_amplifier': (*REALTIME, '--set', 'actuation.amplifier_lag=0.002', '--set',
                      'actuation.amplifier_slew_rate=1.0e+5', '--disturbance', 'fig5',
                      '--voltage', '300', '--duration', '0.02'),
    'map_alpha8': ('--case', 'paper_alpha8', *REALTIME, '--duration', '0.02'),
}
IDENTIFY = ('identify', *REALTIME, '--set', 'experiment.record=4.0', '--set',
            'fresh.record=2.0', '--window', '4.0', '--order', '8', '--set',
            'realisation.unstable_poles=reflect', '--jobs', '1')
LAWS = ('lqg', 'mpc', 'periodic')
BAG_STEPS = 60


def dewing(*arguments: str) -> None:
    """Run a command of ``dewing``; its complaints, if it fails, are on the screen."""
    subprocess.run([BIN / 'dewing', *arguments, '--quiet', '--force'], check=True)


def simulate(folder: Path) -> None:
    """Run every wing of `RUNS` from its rest state, keeping each step and the last state."""
    for name, options in RUNS.items():
        path = str(folder / name)
        dewing('simulate', *options, '--every', '1', '--out', f'{path}.npz', '--json',
               f'{path}.json', '--save-state', f'{path}_state.npz')


def identify(folder: Path) -> None:
    """Record a pulse, realise a model, tune three laws on it and fly with the others."""
    model = str(folder / 'model.npz')
    dewing(*IDENTIFY, '--out', model, '--json', str(folder / 'model.json'), '--records',
           str(folder / 'records.npz'))
    dewing(*IDENTIFY, '--from', str(folder / 'records.npz'), '--out',
           str(folder / 'model_again.npz'))
    for kind in ('pid', 'lqg', 'periodic'):
        dewing('tune', *REALTIME, '--kind', kind, '--model', model, '--duration', '0.05',
               '--ms', '10', '--noise-gain', '1e4', '--saturation', '1',
               '--json', str(folder / f'tune_{kind}.json'), '--out', str(folder / f'tune_{kind}'))
    for kind in LAWS:
        settings = folder / f'{kind}.yaml'
        shipped = (Path(__file__).parents[1] / 'config' / 'controller.yaml').read_text('utf-8')
        settings.write_text(re.sub(r'kind: \w+', f'kind: {kind}', shipped).replace(
            "model: ''", f"model: '{model}'"), 'utf-8')
        dewing('simulate', *REALTIME, '--disturbance', 'fig5', '--controller', str(settings),
               '--duration', '0.03', '--every', '1', '--out', str(folder / f'{kind}.npz'))


def others(folder: Path) -> None:
    """Rigid plates on both engines, a material and a sweep."""
    for name, options in (('volume', ('finite_volume', '--grid', 'fast')),
                          ('map', ('conformal', '--grid', 'realtime'))):
        dewing('plate', '--alpha', '4', '--engine', *options, '--duration', '1.0', '--json',
               str(folder / f'plate_{name}.json'))
    dewing('material', '--json', str(folder / 'material.json'), '--out',
           str(folder / 'material.png'))
    dewing('sweep', *REALTIME, '--vary', 'actuation.voltage=0.0,300.0', '--duration', '0.02',
           '--jobs', '1', '--json', str(folder / 'sweep.json'), '--out', str(folder / 'sweep.nc'))


def fly(folder: Path) -> None:
    """Record simulator, controller and recorder, three processes, into a bag."""
    with tempfile.TemporaryDirectory() as logs:
        environment = dict(os.environ, ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST',
                           ROS_DOMAIN_ID=str(1 + os.getpid() % 100), ROS_LOG_DIR=logs,
                           OPENBLAS_NUM_THREADS='1', NUMBA_NUM_THREADS='1')

        def node(name: str, **parameters: Any) -> subprocess.Popen:
            given = [word for key, value in parameters.items()
                     for word in ('-p', f"{key.replace('__', '.')}:={value}")]
            return subprocess.Popen([BIN / f'dewing_{name}', '--ros-args', *given],
                                    env=environment, stderr=subprocess.DEVNULL)

        bag = folder / 'flight.mcap'
        bag.unlink(missing_ok=True)
        listeners = [node('recorder', output=bag), node('controller')]
        simulator = node('simulator', numerics__engine='conformal', numerics__grid='realtime',
                         numerics__time_step=5.0e-4, numerics__trim_time=2.0,
                         disturbance__pressure=0.015, run__duration=BAG_STEPS * 5.0e-4,
                         run__subscribers=2)
        try:
            if simulator.wait(300.0):
                raise RuntimeError('the simulator failed')
        finally:
            for process in (simulator, *listeners):
                end(process)


def end(process: subprocess.Popen) -> None:
    """Ask a process to end; kill one that does not."""
    process.send_signal(signal.SIGINT)
    try:
        process.wait(60.0)
    except subprocess.TimeoutExpired:
        process.kill()


def values(path: Path) -> Iterator[tuple[str, Any]]:
    """Yield every array, number or message of a result file by name."""
    if path.suffix == '.npz':
        with np.load(path, allow_pickle=False) as file:
            yield from ((name, file[name]) for name in file.files)
    elif path.suffix == '.json':
        yield from leaves('', json.loads(path.read_text('utf-8')))
    elif path.suffix == '.nc':
        from scipy.io import netcdf_file
        with netcdf_file(path, 'r', mmap=False) as file:
            yield from ((name, variable[...].copy()) for name, variable in file.variables.items())
    elif path.suffix == '.mcap':
        yield from messages(path)


def messages(path: Path) -> Iterator[tuple[str, Any]]:
    """Yield the numbers of the loop by topic, name and stamp, whatever their order."""
    from mcap.reader import make_reader
    from rosbags.typesys import Stores, get_typestore
    types = get_typestore(Stores.ROS2_JAZZY)
    with path.open('rb') as file:
        for _, channel, record in make_reader(file).iter_messages(
                ['/dewing/measurement', '/dewing/command']):
            message = types.deserialize_cdr(record.data, 'sensor_msgs/msg/JointState')
            stamp = f'{message.header.stamp.sec}.{message.header.stamp.nanosec:09}'
            for name, value in zip(message.name, [*message.position, *message.effort]):
                yield f'{channel.topic} {name} at {stamp}', value


def leaves(name: str, tree: Any) -> Iterator[tuple[str, Any]]:
    """Yield dotted name and value of what is below ``tree``, times and paths left out."""
    if isinstance(tree, (dict, list)):
        items = tree.items() if isinstance(tree, dict) else enumerate(tree)
        for key, value in items:
            if not TIMES.search(str(key)):
                yield from leaves(f'{name}.{key}' if name else str(key), value)
    elif not (isinstance(tree, str) and '/' in tree):
        yield name, tree


def same(one: Any, other: Any) -> bool:
    """Whether two values are equal to the bit."""
    one, other = np.asarray(one), np.asarray(other)
    return (one.shape == other.shape and one.dtype.kind == other.dtype.kind
            and (one.dtype.kind == 'U' or one.tobytes() == other.tobytes()))


def compare(before: Path, after: Path, renamed: dict[str, str]) -> int:
    """Print what differs and what is new; return 1 if anything differs."""
    wrong, equal, new = [], 0, set()
    for path in sorted(before.rglob('*')):
        if path.suffix not in ('.npz', '.json', '.nc', '.mcap') or path.name == 'metrics.json':
            continue
        twin = after / path.relative_to(before)
        found = dict(values(twin)) if twin.is_file() else {}
        wanted = {renamed.get(name, name): value for name, value in values(path)
                  if not TIMES.search(name)}
        for name, value in wanted.items():
            if name not in found:
                wrong.append(f'{path.name}: {name} is missing')
            elif not same(value, found[name]):
                wrong.append(f'{path.name}: {name} differs')
            else:
                equal += 1
        new |= {f'{path.name}: {name}' for name in found.keys() - wanted.keys()}
    print(*wrong, *(f'new: {name}' for name in sorted(new)), sep='\n')
    print(f'{equal} arrays and numbers are the same to the bit, {len(wrong)} are not')
    return int(bool(wrong) or not equal)


def main() -> int:
    """Compute or compare; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    actions = parser.add_subparsers(dest='action', required=True)
    run = actions.add_parser('run', help='compute everything')
    run.add_argument('folder', type=Path)
    judge = actions.add_parser('compare', help='compare two folders')
    judge.add_argument('before', type=Path)
    judge.add_argument('after', type=Path)
    judge.add_argument('--renamed', action='append', default=[], metavar='OLD=NEW',
                       help='a name that has changed; may be repeated')
    arguments = parser.parse_args()
    if arguments.action == 'compare':
        return compare(arguments.before, arguments.after,
                       dict(pair.split('=') for pair in arguments.renamed))
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for part in (simulate, identify, others, fly):
        print(part.__doc__.partition('\n')[0], flush=True)
        part(arguments.folder)
    return 0


if __name__ == '__main__':
    sys.exit(main())
