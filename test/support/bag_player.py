# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Plays a bag as ``ros2 bag play`` does: bytes as they are, in order, each topic as offered."""

import time
from importlib import import_module

from rclpy.node import Node

from dewing_sim.records import mcap_file
from dewing_sim.ros import harness, qos

SETTLE = 0.5            # s: a writer knows of its readers before they know of it


class Player(Node):
    """Publishes the messages of ``path`` on ``topics``; the case is offered latched, as it was."""

    def __init__(self, path, topics, **options):
        super().__init__('player', namespace='dewing', **harness.overrides(None), **options)
        self.messages = [each for each in stored(path) if each[0] in topics]
        self.out = {}
        for topic, kind, _ in self.messages:
            if topic not in self.out:
                package, _, name = kind.split('/')
                self.out[topic] = self.create_publisher(
                    getattr(import_module(f'{package}.msg'), name), topic,
                    qos.LATCHED if topic.endswith('/case') else qos.LOOP)

    def is_heard(self, listeners=1):
        """Return whether every topic has so many subscriptions."""
        return all(each.get_subscription_count() >= listeners for each in self.out.values())

    def play(self, pause=0.006):
        """Publish everything as fast as it is taken, with a pause (s) after the case only."""
        time.sleep(SETTLE)
        for topic, _, data in self.messages:
            while not qos.publish(self.out[topic], data):
                pass
            if topic.endswith('/case'):
                time.sleep(pause)


def stored(path):
    """Yield (topic, kind, bytes) of every message in the order of the file's times."""
    for channel, schema, message in mcap_file.messages(path, mcap_file.Losses()):
        yield channel.topic, schema.name, message.data
