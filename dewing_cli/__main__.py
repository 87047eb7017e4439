# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m dewing_cli`` is the command ``dewing``."""

import sys

from dewing_cli.main import main

sys.exit(main())
