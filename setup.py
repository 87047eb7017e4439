# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Install dewing with pip or colcon: one layout serves both.

Console scripts go into ``bin``, where a shell finds ``dewing_simulator``. ``ros2 run dewing
simulator`` looks into ``lib/dewing``: the wrappers in ``scripts`` are installed there as data. The
usual ``install_scripts`` of setup.cfg would put both there under colcon, each executable twice.
"""

from pathlib import Path

from setuptools import find_packages, setup

SOURCE = Path(__file__).resolve().parent        # colcon may run a link to this file
EXECUTABLES = ('simulator', 'controller', 'sysid', 'recorder', 'loop')
ROS_WHEELS = ('; sys_platform == "linux" and platform_machine == "x86_64"'
              ' and python_version < "3.14"')

setup(
    name='dewing',
    version='0.2.0',
    description='Membrane wings of dielectric elastomer in viscous flow, and their control',
    long_description=(SOURCE / 'README.md').read_text(encoding='utf-8'),
    long_description_content_type='text/markdown',
    author='The dewing authors',
    maintainer='The dewing authors',
    license='Apache-2.0',
    python_requires='>=3.10',
    packages=[*find_packages(include=['dewing_*']), 'dewing_config'],
    package_dir={'dewing_config': 'config'},
    package_data={'dewing_config': ['*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/dewing']),
        ('share/dewing', ['package.xml']),
        ('share/dewing/config', [
            f'config/{path.name}' for path in sorted(SOURCE.glob('config/*.*'))
            if path.suffix in ('.yaml', '.rviz', '.json')]),
        ('share/dewing/launch', [
            f'launch/{path.name}' for path in sorted(SOURCE.glob('launch/*.launch.py'))]),
        ('lib/dewing', [f'scripts/{name}' for name in EXECUTABLES]),
    ],
    install_requires=[
        'control>=0.10.2',
        'llvmlite>=0.42',
        'matplotlib>=3.7',
        'mcap>=1.6',
        'numba>=0.59',
        'numpy>=1.23',
        'pyyaml>=6.0',
        'rich>=12.0',
        'rosbags>=0.10',
        'scipy>=1.10',
    ],
    extras_require={
        'ros': [package + ROS_WHEELS for package in (
            'ros-jazzy-rclpy',
            'ros-jazzy-common-interfaces',
            'ros-jazzy-rmw-fastrtps-cpp',
        )],
        'mpc': ['osqp>=1.0'],
        'peers': ['ngsolve>=6.2'],
        'sweep': ['distributed>=2024.1', 'xarray>=2024.1'],
        'docs': [line for line in (SOURCE / 'docs' / 'requirements.txt').read_text().splitlines()
                 if not line.startswith('#')],
        'test': [
            'distributed>=2024.1',
            'hypothesis>=6.60',
            'osqp>=1.0',
            'pandas>=2.0',
            'psutil>=5.9',
            'pytest>=7.4',
            'pytest-timeout>=2.1',
            'xarray>=2024.1',
        ],
        'lint': [
            'flake8>=6.0',
            'ruff>=0.5',
        ],
    },
    entry_points={
        'console_scripts': [
            'dewing = dewing_cli.main:main',
            'dewing_simulator = dewing_sim.ros.node:main',
            'dewing_controller = dewing_control.node:main',
            'dewing_sysid = dewing_sysid.node:main',
            'dewing_recorder = dewing_sim.ros.recorder:main',
            'dewing_loop = dewing_control.loop_node:main',
        ],
    },
    zip_safe=False,
)
