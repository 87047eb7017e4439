# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Names that are the same in every namespace, told apart by it: frames and hardware.

Topics and services are relative, and so the ROS graph tells two wings apart. Frames and the
``hardware_id`` of diagnostics are plain words that share one space.
"""

DEFAULT = '/dewing'         # namespace in which a frame keeps its plain name


def frame(namespace: str, name: str) -> str:
    """Return the frame ``name`` of a node in ``namespace``: ``wing``, or ``wing1/wing``."""
    return name if namespace == DEFAULT else f'{namespace}/{name}'.strip('/')


def hardware(namespace: str) -> str:
    """Return what diagnostics name as the hardware of a node in ``namespace``."""
    return namespace.strip('/') or DEFAULT.strip('/')
