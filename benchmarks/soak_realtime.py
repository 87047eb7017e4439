# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The shipped real-time wings under control for minutes, in real time, in two processes over DDS.

A first run of some seconds of wall time asks for simulated time as fast as that and finds the
largest rate that the machine holds; the long one flies at that rate, at most at 1. Fails if a run
diverges, or if the camber of the steady wing leaves the target by more than 5 % after the first
tenth. At 8 degrees the wing sheds, and how far its camber swings is only told.
"""

import argparse
import sys
import tempfile
from contextlib import ExitStack

import numpy as np

from dewing_control.settings import ControllerSettings
from dewing_sim import parameters

CASES = {'realtime': 0.05, 'realtime_alpha8': np.inf}    # and how far the camber may wander
CONTROLLER = 'controller_realtime'
PROBE = 1.0                 # s, simulated
RESERVE = 0.9               # of the largest rate found
PATIENCE = 1.0e5            # s


def fly(case: str, duration: float, rate: float) -> tuple[object, np.ndarray, float]:
    """Return the simulator after ``duration`` s at ``rate``, and camber over that at rest.

    The last value is the largest rate that would have been held in its best second.
    """
    from dewing_sim.machine import signals
    from dewing_sim.ros import harness
    from dewing_sim.ros.node import SimulatorNode
    settings = parameters.load(CONTROLLER, ControllerSettings)
    camber, rates = [], {0.0}
    with ExitStack() as stack:
        domain = stack.enter_context(harness.reserved_domain())
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix='dewing-soak-'))
        child = harness.start_node(
            'dewing_control.node', {name: value for name, value, _ in parameters.leaves(settings)},
            harness.environment(domain, folder))
        stack.callback(signals.end, child)
        session = stack.enter_context(harness.Session(domain))
        simulator = session.add(SimulatorNode, {
            'case': case, 'run.mode': 'realtime', 'run.rate': rate, 'run.duration': duration})
        tell, measured = simulator.telemetry.publish, camber.append

        def publish(lockstep):
            measured(lockstep.measurement.camber_mean)
            rates.add(simulator.loop.tempo.found.largest_rate)
            tell(lockstep)
        simulator.telemetry.publish = publish
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    return simulator, np.array(camber) / simulator.identity.camber_mean, max(rates)


def main() -> int:
    """Fly both wings; print what was found and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--minutes', type=float, default=10.0,
                        help='wall time of each wing (default: 10)')
    parser.add_argument('--cases', nargs='+', choices=CASES, default=list(CASES),
                        help='wings (default: both)')
    arguments = parser.parse_args()
    target = parameters.load(CONTROLLER, ControllerSettings).reference.target
    failed = False
    for case in arguments.cases:
        _, _, largest = fly(case, PROBE, 1.0)
        if not largest:
            raise SystemExit(f'{case}: no second long enough to find the rate')
        rate = 1.0 if largest >= 1.0 else RESERVE * largest
        print(f'{case}: the machine holds {largest:.2f}; flown at {rate:.2f}', flush=True)
        simulator, camber, _ = fly(case, 60.0 * arguments.minutes * rate, rate)
        held = camber[len(camber) // 10:] / target - 1.0
        wander = float(np.max(np.abs(held))) if held.size else np.inf
        lockstep = simulator.lockstep
        print(f'{case}: {simulator.reason}; {lockstep.steps} steps, {lockstep.late} answers late, '
              f'{simulator.loop.deadlines.missed} deadlines missed, camber within '
              f'{100.0 * wander:.2f} % of the target', flush=True)
        failed |= bool(simulator.exit_status) or wander > CASES[case]
    return int(failed)


if __name__ == '__main__':
    sys.exit(main())
