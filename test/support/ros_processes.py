# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulator, controller and recorder of a linear wing as processes over DDS, for the tests."""

import os
import warnings
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import started
from reduced_wing import first_mode

from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_sim import parameters
from dewing_sim.identity import Identity
from dewing_sim.linear import reduced
from dewing_sim.machine.signals import end
from dewing_sim.plant import Measurement
from dewing_sim.records import bag
from dewing_sim.ros import harness

MODULES = dict(simulator='dewing_sim.ros.node', controller='dewing_control.node',
               recorder='dewing_sim.ros.recorder', loop='dewing_control.loop_node',
               sysid='dewing_sysid.node')
PATIENCE = started.PATIENCE
FAREWELL = 60.0             # s, for a process to end before it is killed


# Without it, DDS gives up who does not run for 20 s; a busy machine needs longer for some tests.
PATIENT = """<?xml version="1.0" encoding="UTF-8" ?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="patient" is_default_profile="true"><rtps><builtin><discovery_config>
    <leaseDuration><sec>3600</sec></leaseDuration>
  </discovery_config></builtin></rtps></participant>
</profiles>
"""


class Graph:
    """Starts the executables in one ROS domain, in ``folder``, and stops what is left."""

    def __init__(self, domain, folder, patient=False):
        """Let nobody be given up for not running if ``patient``."""
        self.domain, self.folder, self.processes, self.names = domain, folder, [], []
        folder.mkdir(exist_ok=True)
        self.env = harness.environment(domain, str(folder))
        self.env['PYTHONPATH'] += os.pathsep + str(Path(__file__).parent)    # plants and nodes
        if patient:
            (folder / 'patient.xml').write_text(PATIENT)
            self.env['FASTRTPS_DEFAULT_PROFILES_FILE'] = str(folder / 'patient.xml')
        self.model = folder / 'model.npz'
        reduced.save(self.model, first_mode(disturbance=0.05), overwrite=True)

    def start(self, name, settings=None, **options):
        log = open(self.folder / f'{name}.txt', 'a')
        process = harness.start_node(
            MODULES[name], settings or {}, self.env,
            cwd=self.folder, stdout=log, stderr=log, **options)
        self.processes.append(process)
        self.names.append(name)
        return process

    def simulator(self, **run):
        settings = {'run.plant': 'reduced', 'model': self.model}
        return self.start('simulator', settings | {f'run.{key}': run[key] for key in run})

    def controller(self, settings=None):
        """Start a controller that answers once simulator and recorder listen."""
        return self.start('controller', {'command.subscribers': 2} | (settings or {}))

    def recorder(self):
        self.start('recorder', {'output': self.folder / 'run.mcap'})
        return self.folder / 'run.mcap'

    def wait_until(self, condition):
        """Wait for ``condition()``; fail at once when a process has ended before it holds."""
        started.wait_until(self.alive(condition))

    def alive(self, condition):
        """Return ``condition``, which fails at once when a process has ended before it holds."""
        def check():
            ended = [] if condition() else [
                process for process in self.processes if process.poll() is not None]
            assert not ended or condition(), '\n'.join(
                [f'a process ended with status {ended[0].returncode}',
                 *map(self.said, self.names)])
            return condition()
        return check

    def said(self, name):
        return (self.folder / f'{name}.txt').read_text()

    def stop(self):
        """End what is left, whatever state it is in."""
        for process in self.processes:
            end(process, FAREWELL)


@contextmanager
def graph(folder, patient=False):
    with harness.reserved_domain() as domain:
        result = Graph(domain, folder, patient)
        try:
            yield result
        finally:
            result.stop()


def simulated_time(path):
    """Return the last stamp in a growing bag, 0 before it has any."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)     # the bag is not closed yet
        stamps = [message.header.stamp for _, _, message in bag.read(path, '/dewing/measurement')
                  ] if path.exists() else []
    return stamps[-1].sec + 1.0e-9 * stamps[-1].nanosec if stamps else 0.0


def last_status(path, name='/dewing/simulator'):
    """Return the last diagnostic of a node in a bag and its values."""
    statuses = [status for _, _, message in bag.read(path, '/diagnostics')
                for status in message.status if status.name == name]
    return statuses[-1], {item.key: item.value for item in statuses[-1].values}


def offline(steps, changes=None):
    """Return the measurements of the same loop in this process, columns by name.

    ``changes`` are those of the controller's settings.
    """
    plant = first_mode(disturbance=0.05)
    identity = Identity.of('reduced', plant, plant.rest(), plant.v_squared_max, {})
    law = controller(parameters.load('controller', ControllerSettings, changes), identity)
    rows = [Measurement.of(plant.observe(plant.rest()))]
    rows += [Measurement.of(o) for _, o in closed_loop(plant, plant.rest(), law, steps)]
    return dict(zip(rows[0]._fields, np.array(rows).T))
