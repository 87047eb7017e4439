# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a module in a process that ends with its parent: ``-m dewing_sim.ros.child MODULE``.

However the parent ends, killed even, the pipe to standard input closes, and the node ends in
order, as on SIGTERM.
"""

import importlib
import os
import signal
import sys
import threading


def follow() -> None:
    """Wait for the end of the parent, and end as on SIGTERM."""
    os.read(0, 1)
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == '__main__':
    threading.Thread(target=follow, daemon=True).start()
    sys.exit(importlib.import_module(sys.argv.pop(1)).main())
