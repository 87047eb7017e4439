# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What can go wrong, with the numbers a user needs to put it right."""


class DewingError(Exception):
    """Base of every error that dewing raises on purpose: one clear sentence, no traceback."""


class BadInput(DewingError):
    """A value given by the user is unusable; commands end with exit status 2."""


class RunFailed(DewingError):
    """A computation stopped; commands end with exit status 1.

    ``state`` is the last good state (or None) and may be saved and restarted.
    """

    def __init__(self, message: str, state=None):
        super().__init__(message)
        self.state = state


class NotConverged(RunFailed):
    """An iteration (coupling, Newton, trim) did not reach its tolerance."""


class Diverged(RunFailed):
    """A field or a load became non-finite or left every physical bound."""


class Slack(RunFailed):
    """The membrane lost its tension: voltage or prestretch leave the model's range."""
