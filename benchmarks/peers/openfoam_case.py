# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The dictionaries of the OpenFOAM case.

An H-grid of 65 000 cells, +-50 chords.  The plate is an opening of no thickness between the blocks
above and below it, whose corners at half chord are doubled so that their faces stay apart.
"""

from pathlib import Path

import numpy as np
import plate

FAR = 50.0
THICKNESS = 0.1             # of the single layer of cells
# Cells along x, the smallest and its end of the block: before, on two halves of, and behind.
ALONG = ((66, 0.003, 'last', FAR), (74, 0.003, 'first', 0.5), (56, 0.003, 'last', 0.5),
         (96, 0.003, 'first', FAR))
ACROSS = (112, 0.002, FAR)
OUTER_CORRECTORS = 2


def write_case(folder: Path, moving: bool, dt: float, steps: int) -> None:
    """Write the case of the rigid or the bending plate, with its shape at every step."""
    files = {
        'system/blockMeshDict': block_mesh(), 'system/controlDict': control(moving, dt, steps),
        'system/fvSchemes': SCHEMES, 'system/fvSolution': SOLUTION,
        'constant/transportProperties':
            f'transportModel Newtonian;\nnu [0 2 -1 0 0 0 0] {1.0 / plate.REYNOLDS};',
        '0/U': velocity('movingWallVelocity; value uniform (0 0 0)' if moving else 'noSlip'),
        '0/p': PRESSURE,
    }
    if moving:
        files |= {'constant/turbulenceProperties': 'simulationType laminar;',
                  'constant/dynamicMeshDict': DYNAMIC_MESH, '0/pointDisplacement': DISPLACEMENT}
    for name, text in files.items():
        kind = 'volVectorField' if name == '0/U' else 'volScalarField' if name == '0/p' else (
            'pointVectorField' if name == '0/pointDisplacement' else 'dictionary')
        _write(folder / name, _header(kind, Path(name).name) + text)
    if moving:
        write_shapes(folder, dt, steps)


def expansion(cells: int, smallest: float, length: float) -> float:
    """Return the largest over the smallest cell of a geometric progression."""
    low, high = 1.0 + 1.0e-9, 2.0
    for _ in range(100):
        ratio = 0.5 * (low + high)
        total = smallest * (ratio**cells - 1.0) / (ratio - 1.0)
        low, high = (ratio, high) if total < length else (low, ratio)
    return ratio**(cells - 1)


def block_mesh() -> str:
    """Return the mesh: four blocks along the chord, below and above."""
    places = [(x, y) for y in (-FAR, 0.0, FAR) for x in (-FAR, 0.0, 0.5, 1.0, 1.0 + FAR)]
    places.append((0.5, 0.0))                                   # the upper side at half chord
    count, columns, doubled = len(places), len(ALONG) + 1, 7
    blocks, wing, far = [], [], []
    for row in range(2):
        for column, (cells, smallest, end, length) in enumerate(ALONG):
            a = columns * row + column
            corners = [a, a + 1, a + 1 + columns, a + columns]
            if row:
                corners = [count - 1 if vertex == doubled else vertex for vertex in corners]
            faces = [(p, q, q + count, p + count)
                     for p, q in zip(corners, corners[1:] + corners[:1])]   # from below, around
            along, across = expansion(cells, smallest, length), expansion(*ACROSS)
            blocks.append(
                f'hex ({_words([*corners, *(vertex + count for vertex in corners)])}) '
                f'({cells} {ACROSS[0]} 1) simpleGrading '
                f'({along if end == "first" else 1.0 / along} '
                f'{across if row else 1.0 / across} 1)')
            if column in (1, 2):
                wing.append(faces[0 if row else 2])
            far += [faces[2 if row else 0]]
            far += [faces[3]] * (column == 0) + [faces[1]] * (column == len(ALONG) - 1)
    vertices = [f'({x} {y} {z})' for z in (0.0, THICKNESS) for x, y in places]
    return (f'scale 1;\nvertices ({_words(vertices)});\nblocks ({_words(blocks)});\nedges ();\n'
            f'defaultPatch {{ name sides; type empty; }}\nboundary (\n'
            f'wing {{ type wall; faces ({_faces(wing)}); }}\n'
            f'far {{ type patch; faces ({_faces(far)}); }}\n);\nmergePatchPairs ();\n')


def control(moving: bool, dt: float, steps: int) -> str:
    """Return the control dictionary, with Cl after every step."""
    lift = (-np.sin(plate.ALPHA), np.cos(plate.ALPHA), 0.0)
    drag = (np.cos(plate.ALPHA), np.sin(plate.ALPHA), 0.0)
    return (f'application {"pimpleFoam" if moving else "icoFoam"};\n'
            f'startFrom startTime; startTime 0; stopAt endTime; endTime {steps * dt};\n'
            f'deltaT {dt}; writeControl timeStep; writeInterval {10 * steps};\n'
            'writePrecision 10; timePrecision 10; runTimeModifiable false; adjustTimeStep no;\n'
            'functions { lift { type forceCoeffs; libs ("libforces.so"); patches (wing);\n'
            'rho rhoInf; rhoInf 1; magUInf 1; lRef 1; '
            f'Aref {THICKNESS}; CofR (0.25 0 0); pitchAxis (0 0 1);\n'
            f'liftDir ({_words(lift)}); dragDir ({_words(drag)});\n'
            'writeControl timeStep; writeInterval 1; } }\n')


def velocity(wing: str) -> str:
    """Return the velocity that starts everywhere as the free stream."""
    stream = f'({np.cos(plate.ALPHA)} {np.sin(plate.ALPHA)} 0)'
    return (f'dimensions [0 1 -1 0 0 0 0];\ninternalField uniform {stream};\n'
            f'boundaryField {{ wing {{ type {wing}; }} sides {{ type empty; }}\n'
            f'far {{ type freestreamVelocity; freestreamValue uniform {stream}; }} }}\n')


def write_shapes(folder: Path, dt: float, steps: int) -> None:
    """Write the displacement of the plate at every step, which OpenFOAM reads as a table."""
    table = folder / 'constant' / 'boundaryData' / 'wing'
    x = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 801)))
    points = [f'({u} 0 {z})' for z in (0.0, THICKNESS) for u in x]
    _write(table / 'points', f'({_words(points)})\n')
    for step in range(steps + 2):
        y = plate.camber(step * dt) * plate.parabola(np.concatenate((x, x)))
        _write(table / f'{step * dt:.10g}' / 'pointDisplacement',
               f'({_words(f"(0 {height} 0)" for height in y)})\n')


def _header(kind: str, name: str) -> str:
    return f'FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n'


def _words(items) -> str:
    return ' '.join(str(item) for item in items)


def _faces(faces) -> str:
    return ' '.join(f'({_words(face)})' for face in faces)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding='utf-8')


PRESSURE = """dimensions [0 2 -2 0 0 0 0];
internalField uniform 0;
boundaryField { wing { type zeroGradient; } sides { type empty; }
far { type freestreamPressure; freestreamValue uniform 0; } }
"""
DISPLACEMENT = """dimensions [0 1 0 0 0 0 0];
internalField uniform (0 0 0);
boundaryField { sides { type empty; } far { type fixedValue; value uniform (0 0 0); }
wing { type timeVaryingMappedFixedValue; mapMethod nearest; value uniform (0 0 0); } }
"""
DYNAMIC_MESH = """dynamicFvMesh dynamicMotionSolverFvMesh;
motionSolverLibs ("libfvMotionSolvers.so");
motionSolver displacementLaplacian;
displacementLaplacianCoeffs { diffusivity quadratic inverseDistance (wing); }
"""
SCHEMES = """ddtSchemes { default backward; }
gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) Gauss linear;
div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""
SOLUTION = f"""solvers {{
"p.*" {{ solver GAMG; smoother DICGaussSeidel; tolerance 1e-6; relTol 0.01; }}
pFinal {{ $p; solver GAMG; smoother DICGaussSeidel; tolerance 1e-6; relTol 0; }}
"pcorr.*" {{ solver GAMG; smoother DICGaussSeidel; tolerance 1e-3; relTol 0; }}
"U.*" {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }}
"cellDisplacement.*" {{ solver GAMG; smoother GaussSeidel; tolerance 1e-8; relTol 0; }} }}
PISO {{ nCorrectors 2; nNonOrthogonalCorrectors 0; }}
PIMPLE {{ nOuterCorrectors {OUTER_CORRECTORS}; nCorrectors 2; nNonOrthogonalCorrectors 0;
moveMeshOuterCorrectors no; correctPhi no; }}
"""
