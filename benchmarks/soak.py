# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Many lock-steps of a linear plant: memory of every process, and steps lost.

Fails if the resident memory of a process grows by more than 5 % after the first tenth of the run,
in which queues and caches fill, or if a step is lost.
"""

import argparse
import os
import re
import sys
from pathlib import Path

from roundtrip import CONFIGURATIONS, run

SAMPLES = 50
GROWTH = 0.05


def resident(pid: int) -> float:
    """Return the resident memory of a process in MiB."""
    status = Path(f'/proc/{pid}/status').read_text(encoding='ascii')
    return int(re.search(r'VmRSS:\s+(\d+)', status).group(1)) / 1024.0


def main() -> int:
    """Run; print the memory and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--steps', type=int, default=1_000_000,
                        help='lock-steps (default: a million)')
    parser.add_argument('--configuration', default='two_processes', choices=CONFIGURATIONS)
    arguments = parser.parse_args()
    every, memory = max(arguments.steps // SAMPLES, 1), []

    def watch(step, processes):
        if step % every == 0:
            pids = [os.getpid(), *(process.pid for process in processes)]
            memory.append([resident(pid) for pid in pids])
            print(f'{step:9} steps', *(f'{size:8.1f} MiB' for size in memory[-1]), flush=True)

    found = run(CONFIGURATIONS[arguments.configuration], arguments.steps, watch)
    settled = memory[len(memory) // 10]
    growth = max(last / first - 1.0 for first, last in zip(settled, memory[-1]))
    lost = arguments.steps - found['steps']
    print(f"{found['steps']} steps, {lost} lost, {found['stale']} stale, median "
          f"{found['median_ms']:.3f} ms, memory {100.0 * growth:+.1f} %")
    return int(lost != 0 or growth > GROWTH)


if __name__ == '__main__':
    sys.exit(main())
