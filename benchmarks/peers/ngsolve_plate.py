# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The plate in NGSolve: hybrid discontinuous Galerkin velocities, exactly free of divergence.

H(div)-HDG of third order (Lehrenfeld and Schoeberl 2016) on triangles; the plate is a line of
element edges on which the velocity is given.  About the rigid plate Stokes' operator is factored
once and convection extrapolated (IMEX, second order).  The bending plate deforms the mesh, so that
Oseen's operator is assembled and factored in every step (ALE, BDF2), once a step.
"""

import json
import sys
from time import perf_counter, process_time

import numpy as np
import plate

HINT = 'NGSolve is not installed: pip install ngsolve'
ORDER = 3
FAR = 50.0
PENALTY = 4.0 * ORDER**2
SIZES = {'edge': 0.03, 'plate': 0.03, 'near': 0.15}


def make_mesh():
    """Return triangles within +-50 chords around the line from (0, 0) to (1, 0)."""
    from netgen.geom2d import SplineGeometry
    from ngsolve import Mesh
    geometry = SplineGeometry()
    corners = [geometry.AppendPoint(x, y) for x, y in (
        (-FAR, -FAR), (1.0 + FAR, -FAR), (1.0 + FAR, FAR), (-FAR, FAR))]
    for k, name in enumerate(('inlet', 'outlet', 'outlet', 'inlet')):
        geometry.Append(['line', corners[k], corners[(k + 1) % 4]], leftdomain=1, rightdomain=0,
                        bc=name)
    ring = [geometry.AppendPoint(x, y) for x, y in (
        (-0.5, -0.6), (3.0, -0.6), (3.0, 0.6), (-0.5, 0.6))]
    for k in range(4):
        geometry.Append(['line', ring[k], ring[(k + 1) % 4]], leftdomain=2, rightdomain=1,
                        bc='inside')
    x = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 9)))
    line = [geometry.AppendPoint(u, 0.0, maxh=SIZES['edge' if u in (0.0, 1.0) else 'plate'])
            for u in x]
    for a, b in zip(line, line[1:]):
        geometry.Append(['line', a, b], leftdomain=2, rightdomain=2, bc='wing')
    geometry.SetDomainMaxH(2, SIZES['near'])
    return Mesh(geometry.GenerateMesh(maxh=6.0, grading=0.2))


class Plate:
    """A march in time: `step` until done, `lift` after any step."""

    def __init__(self, moving: bool, dt: float):
        """Set up spaces and forms for one time step (c/U)."""
        import ngsolve as ngs
        self.ngs, self.moving, self.dt = ngs, moving, dt
        self.mesh = mesh = make_mesh()
        fixed = 'wing|inlet'
        self.space = ngs.FESpace([
            ngs.HDiv(mesh, order=ORDER, dirichlet=fixed),
            ngs.TangentialFacetFESpace(mesh, order=ORDER, dirichlet=fixed),
            ngs.L2(mesh, order=ORDER - 1, lowest_order_wb=True)])
        self.stream = ngs.CoefficientFunction((np.cos(plate.ALPHA), np.sin(plate.ALPHA)))
        self.flow = ngs.GridFunction(self.space)
        values = ngs.VectorL2(mesh, order=ORDER)
        self.now, self.before = ngs.GridFunction(values), ngs.GridFunction(values)
        self.shift = [ngs.GridFunction(ngs.VectorH1(mesh, order=2)) for _ in range(3)]
        self.steps = 0
        self._given = np.array([not bit for bit in self.space.FreeDofs()])
        self._unknown = ~self._given
        self._wing = self._facets_of_wing()
        self._explicit_form, self._convection = self._explicit(), None
        self._start()

    def step(self) -> None:
        """Advance by one time step: backward Euler first, then BDF2."""
        first = self.steps == 0
        self.steps += 1
        if self.moving:
            self._move(self.steps * self.dt)
        if self.moving or self.steps <= 2:
            self._factor(first)
        self._solve(self._load(first))

    def lift(self) -> float:
        """Return Cl from the traction on both sides of the plate."""
        ngs, n = self.ngs, self.ngs.specialcf.normal(2)
        u, _, p = self.flow.components
        direction = ngs.CoefficientFunction((-np.sin(plate.ALPHA), np.cos(plate.ALPHA)))
        gradient = ngs.Grad(u)
        traction = p * n - (gradient + gradient.trans) * n / plate.REYNOLDS
        return 2.0 * ngs.Integrate(self._wing * ngs.InnerProduct(traction, direction)
                                   * ngs.dx(element_boundary=True), self.mesh)

    def _start(self) -> None:
        self.flow.components[0].Set(self.stream)
        self._on_wing(self.ngs.CoefficientFunction((0.0, 0.0)))
        for field in (self.now, self.before):
            field.Set(self.stream)

    def _on_wing(self, velocity) -> None:
        """Give the velocity on the plate, and the free stream at the inlet."""
        given = self.flow.vec.CreateVector()
        given[:] = 0.0
        boundary = self.ngs.GridFunction(self.space)
        for where, value in (('wing', velocity), ('inlet', self.stream)):
            for component in boundary.components[:2]:
                component.Set(value, definedon=self.mesh.Boundaries(where))
            given += boundary.vec
        self.flow.vec.FV().NumPy()[self._given] = given.FV().NumPy()[self._given]

    def _facets_of_wing(self):
        """Return 1 on the edges of the plate and 0 on the others."""
        ngs = self.ngs
        marks = ngs.GridFunction(ngs.FacetFESpace(self.mesh, order=0))
        marks.Set(1.0, definedon=self.mesh.Boundaries('wing'))
        return marks

    def _move(self, time: float) -> None:
        """Deform the mesh to the camber at ``time``; the plate moves with the mesh."""
        ngs = self.ngs
        self.mesh.UnsetDeformation()
        self.shift[2].vec.data = self.shift[1].vec
        self.shift[1].vec.data = self.shift[0].vec
        inside = ngs.IfPos(ngs.x * (1.0 - ngs.x), 4.0 * ngs.x * (1.0 - ngs.x), 0.0)
        height = plate.camber(time) * inside * ngs.exp(-ngs.y * ngs.y)
        self.shift[0].Set(ngs.CoefficientFunction((0.0, height)))
        self.mesh.SetDeformation(self.shift[0])
        speed = plate.camber_rate(time) * inside
        self._on_wing(ngs.CoefficientFunction((0.0, speed)))

    def _factor(self, first: bool) -> None:
        """Assemble and factor the operator of Stokes, or of Oseen on the moving mesh."""
        ngs = self.ngs
        (u, uhat, p), (v, vhat, q) = self.space.TnT()
        n, h = ngs.specialcf.normal(2), ngs.specialcf.mesh_size
        nu, rate = 1.0 / plate.REYNOLDS, (1.0 if first else 1.5) / self.dt

        def along(w):
            return w - (w * n) * n

        form = ngs.BilinearForm(self.space, condense=True)
        form += (rate * u * v + nu * ngs.InnerProduct(ngs.Grad(u), ngs.Grad(v))
                 - ngs.div(u) * q - ngs.div(v) * p) * ngs.dx
        form += nu * (ngs.InnerProduct(ngs.Grad(u) * n, along(vhat - v))
                      + ngs.InnerProduct(ngs.Grad(v) * n, along(uhat - u))
                      + PENALTY / h * along(uhat - u) * along(vhat - v)
                      ) * ngs.dx(element_boundary=True)
        if self.moving:
            c = self._carrier(first)
            jump = (c * n) * along(uhat - u)
            form += (ngs.Grad(u) * c) * v * ngs.dx
            form += ngs.IfPos(c * n, jump * along(vhat), jump * along(v)
                              ) * ngs.dx(element_boundary=True)
        form.Assemble()
        self.form = form
        self.inverse = form.mat.Inverse(self.space.FreeDofs(True), 'umfpack')

    def _carrier(self, first: bool):
        """Return the extrapolated velocity relative to the mesh."""
        a, b, c = self.shift
        if first:
            return self.now - (a - b) / self.dt
        return 2.0 * self.now - self.before - (1.5 * a - 2.0 * b + 0.5 * c) / self.dt

    def _explicit(self):
        """Return the form of -(u . grad) u with upwind traces, applied but never assembled."""
        ngs, n = self.ngs, self.ngs.specialcf.normal(2)
        space = self.space.components[0]
        u, v = space.TnT()
        form = ngs.BilinearForm(space, nonassemble=True)
        form += ngs.InnerProduct(ngs.Grad(v) * u, u) * ngs.dx
        form += ((u * n) * (ngs.IfPos(u * n, u, u.Other()) * (v.Other() - v))
                 * ngs.dx(skeleton=True))
        form += (-(u * n) * (ngs.IfPos(u * n, u, self.stream) * v)
                 * ngs.ds('inlet|outlet', skeleton=True))
        return form

    def _load(self, first: bool):
        """Return the right-hand side: past velocities and, about the rigid plate, convection."""
        ngs = self.ngs
        v = self.space.TestFunction()[0]
        load = ngs.LinearForm(self.space)
        past = self.now if first else 2.0 * self.now - 0.5 * self.before
        load += past * v / self.dt * ngs.dx
        load.Assemble()
        if not self.moving:
            older, self._convection = self._convection, self.flow.components[0].vec.CreateVector()
            self._explicit_form.Apply(self.flow.components[0].vec, self._convection)
            part = load.vec[self.space.Range(0)]
            part += self._convection if first else 2.0 * self._convection - older
        return load.vec

    def _solve(self, load) -> None:
        """Solve for the flow with static condensation; given velocities stay."""
        x = self.flow.vec
        x.FV().NumPy()[self._unknown] = 0.0
        load.data -= self.form.mat * x
        load.data += self.form.harmonic_extension_trans * load
        x.data += self.inverse * load
        x.data += self.form.harmonic_extension * x
        x.data += self.form.inner_solve * load
        self.before.vec.data = self.now.vec
        self.now.Set(self.flow.components[0])


def main() -> None:
    """March as the arguments say and print what every step took as JSON."""
    moving, dt, steps = sys.argv[1] == 'moving', float(sys.argv[2]), int(sys.argv[3])
    march = Plate(moving, dt)
    result = {'time': [], 'cl': [], 'wall': [], 'cpu': [], 'unknowns': march.space.ndof}
    wall, cpu = 0.0, 0.0
    for step in range(1, steps + 1):
        start = perf_counter(), process_time()
        march.step()
        wall += perf_counter() - start[0]
        cpu += process_time() - start[1]
        for name, value in (('time', step * dt), ('cl', march.lift()), ('wall', wall),
                            ('cpu', cpu)):
            result[name].append(value)
    print(json.dumps(result))


if __name__ == '__main__':
    main()
