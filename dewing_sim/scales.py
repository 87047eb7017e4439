# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""SI to dimensionless groups and back: the only place where units are converted.

Lengths are in chords c, velocities in free-stream speeds U, densities in air densities rho, so
time is in c/U, pressure in rho U^2 and force per unit span in rho U^2 c.
"""

from dataclasses import dataclass

from dewing_sim.parameters import Flow


@dataclass(frozen=True)
class Scales:
    """Reference length (m), speed (m/s), density (kg/m^3) and kinematic viscosity (m^2/s)."""

    length: float
    speed: float
    density: float
    viscosity: float

    @classmethod
    def of(cls, flow: Flow, chord: float) -> 'Scales':
        """Return the scales of a wing of the given chord (m) in ``flow``."""
        return cls(chord, flow.speed, flow.density, flow.kinematic_viscosity)

    @property
    def reynolds(self) -> float:
        """Re = U c / nu."""
        return self.speed * self.length / self.viscosity

    @property
    def time(self) -> float:
        """Convective time c / U in s."""
        return self.length / self.speed

    @property
    def pressure(self) -> float:
        """Pressure scale rho U^2 in Pa: twice the dynamic pressure."""
        return self.density * self.speed**2

    @property
    def tension(self) -> float:
        """Tension scale rho U^2 c in N/m, also that of force per unit span."""
        return self.pressure * self.length

    @property
    def surface_density(self) -> float:
        """Surface density scale rho c in kg/m^2."""
        return self.density * self.length
