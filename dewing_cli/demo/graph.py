# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes as processes of their own in a ROS domain of their own, and a session to look on."""

import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from subprocess import Popen
from typing import Any

from dewing_sim.errors import RunFailed
from dewing_sim.machine.signals import Stop, end
from dewing_sim.ros import harness

SIMULATOR = 'dewing_sim.ros.node'
GLANCE = 0.2                # s between two looks at the processes


@dataclass(frozen=True)
class Graph:
    """Processes that end with ``stack``; what they print goes into ``folder``."""

    stack: ExitStack
    folder: Path
    domain: int

    def start(self, module: str, settings: Mapping[str, Any]) -> Popen:
        """Start the node of ``module`` with parameters by dotted name."""
        log = self.stack.enter_context(open(self.folder / f'{module}.txt', 'wb'))
        process = harness.start_node(
            module, settings, harness.environment(self.domain, str(self.folder)),
            stdout=log, stderr=log)
        self.stack.callback(end, process)
        return process

    def session(self) -> harness.Session:
        """Return a session in the same domain."""
        return self.stack.enter_context(harness.Session(self.domain))

    def wait(self, name: str, simulator: Popen, session: harness.Session, stop: Stop,
             look: Callable[[], None]) -> None:
        """Call ``look`` now and then until ``simulator`` ends or ``stop`` is asked for.

        Raises `RunFailed` with its last words if it fails.
        """
        while simulator.poll() is None and not stop.asked:
            session.executor.spin_once(timeout_sec=GLANCE)
            look()
        if simulator.poll():
            said = (self.folder / f'{SIMULATOR}.txt').read_text('utf-8', 'replace')
            lines = said.strip().splitlines()
            raise RunFailed(f"{name}: {lines[-1] if lines else 'the simulator failed'}")


@contextmanager
def graph() -> Iterator[Graph]:
    """Reserve a domain, and end every process that was started in it."""
    with ExitStack() as stack:
        domain = stack.enter_context(harness.reserved_domain())
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix='dewing-demo-'))
        yield Graph(stack, Path(folder), domain)
