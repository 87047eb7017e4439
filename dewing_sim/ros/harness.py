# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Run nodes without a launch system: one a process, or several in one executor until a condition.

A closed loop in this process::

    with Session() as session:
        simulator = session.add(SimulatorNode, {'run.duration': 0.1})
        session.add(ControllerNode, {'reference.target': 1.05})
        session.spin_until(lambda: simulator.exit_status is not None, timeout=60.0)

The executor is that of events, where rclpy has it: it takes a quarter of the time of the one that
waits on sets. It is spun by `spin_once`: in rclpy 7.1 its ``spin`` delivers nothing, and
`rclpy.spin` now and then misses SIGTERM. The multi-threaded one costs 100 times as much.
"""

import os
import random
import socket
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import inf
from pathlib import Path
from time import monotonic
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock

from dewing_sim.errors import BadInput, DewingError, RunFailed
from dewing_sim.machine import garbage
from dewing_sim.machine.signals import Stop
from dewing_sim.ros import logs, usage

SPIN = 0.2                      # s, longest time without a look at signals and conditions
DOMAINS = range(1, 102)         # usable on every system without clashing with ephemeral ports
DOMAIN_PORT = 22119             # of the domain coordinator of ROS: lock by binding port + domain


def executor_of(context: Context | None = None) -> Executor:
    """Return the fastest single-threaded executor of this rclpy."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def overrides(parameters: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return node options that give ``parameters`` (dotted names) as if on the command line."""
    return dict(automatically_declare_parameters_from_overrides=True, parameter_overrides=[
        Parameter(name, value=value) for name, value in (parameters or {}).items()])


class Session:
    """Nodes that share this process, a ROS context of their own, and one executor."""

    def __init__(self, domain: int | None = None):
        """Join the ROS domain ``domain``, by default that of the environment."""
        os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        logs.provide()
        self.context = Context()
        rclpy.init(args=[], context=self.context, domain_id=domain)
        self.executor = executor_of(self.context)
        self.nodes: list[Node] = []

    def add(self, make: Callable[..., Node], parameters: Mapping[str, Any] | None = None) -> Node:
        """Return the node that ``make(parameters, context=...)`` gives, to be spun here."""
        node = make(parameters, context=self.context)
        self.nodes.append(node)
        self.executor.add_node(node)
        return node

    def spin_until(self, condition: Callable[[], bool], timeout: float = inf) -> None:
        """Spin until ``condition()``; raise `RunFailed` after ``timeout`` s of wall time.

        A signal that asks for the end raises `Interrupted` between two callbacks.
        """
        deadline = monotonic() + timeout
        with Stop(orderly=True) as stop, garbage.Deferred() as collector:
            while not condition():
                now = monotonic()
                collector.look(now)
                remaining = deadline - now
                if remaining <= 0.0:
                    raise RunFailed(f'the condition did not hold within {timeout:g} s')
                self.executor.spin_once(timeout_sec=min(SPIN, remaining))
                stop.check()

    def watch_clock(self) -> 'ClockWatch':
        """Return a node that knows the simulated time published in this domain."""
        return self.add(ClockWatch)

    def __enter__(self) -> 'Session':
        return self

    def __exit__(self, *_error):
        self.executor.shutdown()
        for node in self.nodes:
            node.destroy_node()
        self.context.try_shutdown()


class ClockWatch(Node):
    """Listens to ``/clock``; ``time`` is the latest simulated time in s."""

    def __init__(self, parameters: Mapping[str, Any] | None = None, **options):
        super().__init__('clock_watch', namespace='dewing', **overrides(parameters), **options)
        self.time = 0.0
        self.create_subscription(Clock, '/clock', self._on_clock, 1)

    def _on_clock(self, message: Clock):
        self.time = message.clock.sec + 1.0e-9 * message.clock.nanosec


def main(make: Callable[[], Node], args: Sequence[str] | None = None,
         shipped: Callable[[], Iterable[Any]] = tuple) -> int:
    """Spin the node of this process until it ends or a signal comes; return the exit status.

    The node may have ``exit_status`` (None while it runs) and ``reason``, and ``interrupt()``,
    which is called on SIGINT, SIGTERM and SIGHUP while ROS still works. Bad parameters give one
    sentence on standard error and status 2, failures status 1. ``--help`` lists ``shipped()``.
    """
    status = usage.answer(make, args, shipped)
    return run(lambda: [make], args) if status is None else status


def run(find: Callable[[], Sequence[Callable[[], Node]]],
        args: Sequence[str] | None = None) -> int:
    """Spin the nodes that ``find()`` says how to make, in one executor; see `main`.

    The end of the first is that of all, and its status is returned. Another that ends sooner is
    taken out, as if its process had ended.
    """
    try:
        with Stop() as stop:
            makes = find()
            logs.provide()
            rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
            nodes = [make() for make in makes]
            stop.orderly = True
            return _spin(nodes, stop)
    except (DewingError, OSError, RuntimeError) as error:
        print('dewing:', ' '.join(str(error).split()), file=sys.stderr)
        return 2 if isinstance(error, BadInput) or not rclpy.ok() else 1
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        rclpy.try_shutdown()


def _spin(nodes: list[Node], stop: Stop) -> int:
    executor, (first, *others) = executor_of(), nodes
    for node in nodes:
        executor.add_node(node)
    try:
        with garbage.Deferred() as collector:
            while not stop.asked and _status(first) is None:
                executor.spin_once(timeout_sec=SPIN)
                collector.look(monotonic())
                for node in [each for each in others if _status(each) is not None]:
                    _report_failure(node)
                    others.remove(node)
                    executor.remove_node(node)
                    node.destroy_node()
        for node in (first, *others):
            getattr(node, 'interrupt', lambda: None)()
    finally:
        executor.shutdown()
    return _report_failure(first)


def _status(node: Node) -> int | None:
    return getattr(node, 'exit_status', None)


def _report_failure(node: Node) -> int:
    status = _status(node) or 0
    if status:
        print('dewing:', node.reason, file=sys.stderr)
    return status


@contextmanager
def reserved_domain() -> Iterator[int]:
    """Hold a ROS domain that no other user of this function, or of ROS's coordinator, holds."""
    for domain in random.SystemRandom().sample(DOMAINS, len(DOMAINS)):
        with socket.socket() as lock:
            try:
                lock.bind(('127.0.0.1', DOMAIN_PORT + domain))
            except OSError:
                continue
            yield domain
            return
    raise RunFailed('every ROS domain from 1 to 101 is taken on this machine')


def environment(domain: int, log_folder: str) -> dict[str, str]:
    """Return the environment for a child process: local discovery, one thread, own log folder.

    The child imports the same dewing as this process. Settings that would connect it to other
    machines are left out.
    """
    foreign = ('ROS_LOCALHOST_ONLY', 'ROS_DISCOVERY_SERVER', 'ROS_STATIC_PEERS',
               'FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')
    kept = {name: value for name, value in os.environ.items() if name not in foreign}
    path = filter(None, [str(Path(__file__).parents[2]), os.environ.get('PYTHONPATH')])
    return kept | {
        'PYTHONPATH': os.pathsep.join(path),
        'ROS_DOMAIN_ID': str(domain), 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_LOG_DIR': log_folder, 'OPENBLAS_NUM_THREADS': '1', 'NUMBA_NUM_THREADS': '1',
        'AMENT_PREFIX_PATH': os.environ.get('AMENT_PREFIX_PATH') or sys.prefix}


def start_node(module: str, parameters: Mapping[str, Any], env: Mapping[str, str],
               arguments: Sequence[str] = (), **options) -> subprocess.Popen:
    """Start ``module`` (with a `main`) as a process in a group of its own that ends with this one.

    See `child`. ``arguments`` are further ones of ROS, ``options`` of `Popen`.
    """
    arguments = ['--ros-args', *arguments]
    for name, value in parameters.items():
        arguments += ['-p', f'{name}:={_yaml_word(value)}']
    return subprocess.Popen([sys.executable, '-m', 'dewing_sim.ros.child', module, *arguments],
                            env=dict(env), start_new_session=True, stdin=subprocess.PIPE,
                            **options)


def _yaml_word(value: Any) -> str:
    if isinstance(value, float):
        mantissa, e, exponent = repr(value).partition('e')
        return (mantissa if '.' in mantissa else f'{mantissa}.0') + e + exponent
    return f"'{value}'" if isinstance(value, (str, os.PathLike)) else str(value)
