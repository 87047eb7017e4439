# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every physical parameter of a wing in a flow, in SI units.

The dataclasses are documentation, check and ROS descriptors in one; `parameters` reads them from
files.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from dewing_sim.fluid import engines
from dewing_sim.schema import Numbers, choice, count, numbers, real
from dewing_sim.schema.relations import Bound


@dataclass(frozen=True)
class Flow:
    """The air that meets the wing."""

    density: float = real('kg/m^3', 'air density', 1.0e-2, 1.0e4)
    kinematic_viscosity: float = real('m^2/s', 'air kinematic viscosity', 1.0e-8, 1.0e-2)
    speed: float = real('m/s', 'free-stream speed', 1.0e-3, 100.0)
    angle_of_attack_deg: float = real('deg', 'angle of attack of the chord', -15.0, 15.0)

    @property
    def angle_of_attack(self) -> float:
        """Angle of attack in radians."""
        return math.radians(self.angle_of_attack_deg)

    @property
    def dynamic_pressure(self) -> float:
        """Dynamic pressure q = rho U^2 / 2 in Pa."""
        return 0.5 * self.density * self.speed**2


@dataclass(frozen=True)
class Membrane:
    """The dielectric-elastomer membrane, pinned at leading and trailing edge."""

    chord: float = real('m', 'distance between the pinned edges', 1.0e-3, 1.0)
    initial_thickness: float = real('m', 'thickness before prestretch', 1.0e-6, 1.0e-2)
    prestretch: float = real('-', 'chordwise prestretch lambda_p', 1.0, 8.0)
    prestretch_lateral: float = real('-', 'spanwise prestretch lambda_z', 0.5, 8.0)
    density: float = real('kg/m^3', 'elastomer density', 10.0, 1.0e4)
    shear_modulus: float = real('Pa', 'Gent shear modulus mu', 1.0e2, 1.0e8)
    gent_limit: float = real('-', 'Gent limit Jm of I1 - 3', 1.0, 1.0e6)
    law: str = choice('law of elasticity; shear_modulus and gent_limit are those of gent',
                      'gent', 'ogden', 'mooney_rivlin', open=True, default='gent')
    constants: Numbers = numbers('constants of another law than gent, by name')
    bulk_modulus: float = real('Pa', 'K of the volumetric energy K (J-1)^2', 1.0e4, 1.0e12)
    relative_permittivity: float = real('-', 'eps_r of the elastomer', 1.0, 1.0e3)
    element: str = choice('two-node membrane, or solid elements through the thickness',
                          'membrane', 'solid')
    support: str = choice('where solid elements are pinned at the edges', 'lower', 'middle')
    elements: int = count('elements along the chord', 4, 2000)
    viscous_share: float = real(
        '-', 'modulus of the relaxing branch over mu, 0: elastic', 0.0, 100.0)
    viscous_time: float = real('s', 'relaxation time of that branch', 1.0e-6, 1.0e6)


@dataclass(frozen=True)
class Numerics:
    """How the equations are solved."""

    engine: str = choice('flow solver; auto: conformal wherever it has been verified',
                         *engines.NAMES, 'auto', open=True)
    grid: str = choice('flow grid preset of the engine', *engines.GRIDS, of='engine')
    time_step: float = real('s', 'time step dt', 1.0e-8, 1.0e-1)
    coupling_tolerance: float = real(
        '-', 'relative change of the membrane shape between coupling iterations', 1.0e-12, 1.0e-1)
    coupling_iterations: int = count('most coupling iterations in a step', 1, 100)
    trim_time: float = real(
        '-', 'convective times c/U marched from the flow start to the rest state', 0.0, 1.0e3)


@dataclass(frozen=True)
class Actuation:
    """The electrodes."""

    voltage: float = real('V', 'voltage of the rest state', 0.0, 1.0e5)
    voltage_limit: float = real('V', 'largest admissible voltage', 0.0, 1.0e5)
    slack_margin: float = real(
        '-', 'share of V^2 at the loss of tension of the present shape that no command reaches, '
        '0: no clip', 0.0, 0.9, default=0.05)
    breakdown_field: float = real(
        'V/m', 'true field above which a breakdown is warned about', 1.0e5, 1.0e10)
    amplifier_slew_rate: float = real(
        'V/s', 'fastest change of the amplifier, 0: no limit', 0.0, 1.0e9)
    amplifier_lag: float = real('s', 'first-order lag of the amplifier, 0: none', 0.0, 10.0)

    relations = (Bound('voltage', 'voltage_limit'),)


@dataclass(frozen=True)
class Disturbance:
    """Uniform wall pressure P (1 - cos 2 pi f t), paper eq. 11, pressing the camber down."""

    pressure: float = real('-', 'amplitude P as a fraction of q', -10.0, 10.0)
    frequency: float = real('Hz', 'frequency f', 0.0, 1.0e4)


COURSES = ('none', 'ramp', 'one_minus_cosine', 'sine')


@dataclass(frozen=True)
class Gust:
    """A gust that is uniform in space and meets the wing as a whole (engine ``conformal``)."""

    shape: str = choice('course in time; none: still air', *COURSES)
    vertical: float = real('m/s', 'amplitude upwards, across the free stream', -100.0, 100.0)
    horizontal: float = real('m/s', 'amplitude along the free stream', -100.0, 100.0)
    start: float = real('s', 'time at which it begins', 0.0, 1.0e4)
    duration: float = real(
        's', 'time of the ramp, length of 1 - cos, period of the sine', 1.0e-6, 1.0e4)


@dataclass(frozen=True)
class RigidMotion:
    """Heave and pitch of the whole wing together (engine ``conformal``)."""

    shape: str = choice('course in time; none: held in place', *COURSES)
    heave: float = real('m', 'amplitude of the heave, upwards', -10.0, 10.0)
    pitch_deg: float = real('deg', 'amplitude of the pitch, nose up', -30.0, 30.0)
    pivot: float = real('-', 'x/c of the point about which it pitches', -1.0, 2.0)
    start: float = real('s', 'time at which it begins', 0.0, 1.0e4)
    duration: float = real(
        's', 'time of the ramp, length of 1 - cos, period of the sine', 1.0e-6, 1.0e4)

    @property
    def pitch(self) -> float:
        """Amplitude of the pitch in radians."""
        return math.radians(self.pitch_deg)


def _lasts(name: str) -> tuple[Bound, Bound]:
    """Return the bounds of a course in time, which is sampled once a step.

    A course of less than two steps falls between them; a sine of just two meets its zeros only.
    """
    def at_least(steps: int, holds: Callable[[str], bool], if_: str) -> Bound:
        return Bound(f'{name}.duration', 'numerics.time_step', f'{steps} {{}}',
                     lambda dt: steps * dt, lambda case: holds(getattr(case, name).shape),
                     f'{name}.shape is {if_}', least=True)

    return (at_least(2, lambda shape: shape != 'none', 'not none'),
            at_least(4, lambda shape: shape == 'sine', 'sine'))


@dataclass(frozen=True)
class Case:
    """A complete description of one wing in one flow."""

    flow: Flow
    membrane: Membrane
    numerics: Numerics
    actuation: Actuation
    disturbance: Disturbance
    gust: Gust
    rigid_motion: RigidMotion

    ros_node = 'simulator'
    # A disturbance beyond the Nyquist frequency of the steps would act as a slower one.
    relations = (
        Bound('disturbance.frequency', 'numerics.time_step', '1/(2 {})',
              lambda dt: 0.5 / dt, lambda case: case.disturbance.pressure != 0.0,
              'disturbance.pressure is not 0'),
        *_lasts('gust'), *_lasts('rigid_motion'))
