# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which runs the report needs, in full and quick."""

from dataclasses import dataclass
from typing import Any

from dewing_cli.paper.runs.controlled import Controlled
from dewing_cli.paper.runs.designed import Designed
from dewing_cli.paper.runs.experiments import Experiments
from dewing_cli.paper.runs.film import Film
from dewing_cli.paper.runs.flight import Flight, case_of, convective_time
from dewing_cli.paper.runs.result import Run
from dewing_control.law.registry import LAWS, installed
from dewing_control.model.identified import CHANGES
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.fluid import engines
from dewing_sim.identity import loss_of_tension
from dewing_sim.inputs.disturbance import DISTURBANCES
from dewing_sim.parameters import Case

ENGINES = engines.NAMES             # each is computed beside the other
REYNOLDS = 2500.0
CHORDS = (0.025, 0.030, 0.035, 0.040, 0.050)    # m
THICKNESSES = (5.0e-5, 5.0e-4)                  # m: as printed, and as 5 kV would need
KIND = {'pid_tuned': 'pid'}                     # others are named by their kind
CONTROLLERS = ('open_loop', *KIND, *(kind for kind in LAWS if kind not in KIND.values()))
TARGETS = {'fig5': 1.10, 'target_1': 1.00, 'target_097': 0.97}
FILM = 0.0406                                   # s, a period of shedding


@dataclass(frozen=True)
class Extent:
    """How much is computed: grids by engine, times in c/U unless they are in s."""

    grids: dict[str, str]
    trim: float
    rest: float                     # recorded at 4 degrees
    shed: float                     # recorded at 8 degrees
    variant: float                  # the same on other grids and time steps
    loop: float                     # s
    averaged: float                 # s
    long: float                     # s
    frames: int
    variants: tuple[tuple[float, str, str, float], ...]     # degrees, engine, grid, dt in s
    scenarios: tuple[str, ...]
    chords: tuple[float, ...]
    shares: tuple[float, ...]       # of V_L, steady at 8 degrees
    swings: tuple[float, ...]       # of the shedding frequency, at 8 degrees
    held: tuple[float, ...]         # of the mean passive camber, at 8 degrees
    tuning: bool


FULL = Extent(
    grids={'finite_volume': 'standard', 'conformal': 'standard'},
    trim=30.0, rest=5.0, shed=60.0, variant=40.0, loop=0.4, averaged=0.2, long=2.0, frames=24,
    variants=(
        (4.0, 'finite_volume', 'fast', 1.0e-4), (4.0, 'finite_volume', 'standard', 1.0e-4),
        (4.0, 'finite_volume', 'standard', 5.0e-5), (4.0, 'finite_volume', 'fine', 5.0e-5),
        (4.0, 'conformal', 'realtime', 1.0e-4), (4.0, 'conformal', 'standard', 1.0e-4),
        (4.0, 'conformal', 'reference', 1.0e-4),
        (8.0, 'finite_volume', 'fast', 5.0e-5), (8.0, 'finite_volume', 'standard', 1.0e-4),
        (8.0, 'finite_volume', 'standard', 5.0e-5), (8.0, 'finite_volume', 'standard', 2.5e-5),
        (8.0, 'conformal', 'realtime', 5.0e-5), (8.0, 'conformal', 'standard', 1.0e-4),
        (8.0, 'conformal', 'standard', 5.0e-5), (8.0, 'conformal', 'reference', 5.0e-5)),
    scenarios=('fig5', 'target_1', 'target_097'), chords=CHORDS, shares=(0.25, 0.5, 0.7),
    swings=(0.5, 1.0, 2.0), held=(1.0, 1.3), tuning=True)
QUICK = Extent(
    grids={'finite_volume': 'fast', 'conformal': 'realtime'},
    trim=12.0, rest=3.0, shed=24.0, variant=12.0, loop=0.3, averaged=0.1, long=0.6, frames=12,
    variants=(
        (4.0, 'finite_volume', 'fast', 1.0e-4), (4.0, 'conformal', 'realtime', 1.0e-4),
        (4.0, 'conformal', 'standard', 1.0e-4),
        (8.0, 'finite_volume', 'fast', 1.0e-4), (8.0, 'conformal', 'realtime', 1.0e-4),
        (8.0, 'conformal', 'realtime', 2.0e-4)),
    scenarios=('fig5',), chords=(0.025, 0.030, 0.050), shares=(0.5,), swings=(1.0,), held=(1.3,),
    tuning=False)


@dataclass(frozen=True)
class Variant:
    """A wing on one grid with one time step (s), and the flight that has it."""

    degrees: float
    engine: str
    grid: str
    dt: float
    flight: str

    @property
    def label(self) -> str:
        """Grid and time step in words."""
        return f'{self.engine.replace("_", "-")} {self.grid}, dt {1.0e4 * self.dt:g}e-4 s'


@dataclass(frozen=True)
class Scan:
    """A choice that the paper leaves open, and its flights at 4 and 8 degrees."""

    label: str
    chord: float                    # m
    thickness: float                # m
    rest: str
    shed: str


@dataclass(frozen=True)
class Plan:
    """All runs by name, and how sections find theirs."""

    quick: bool
    engine: str
    extent: Extent
    runs: dict[str, Run]
    variants: tuple[Variant, ...]
    scans: tuple[Scan, ...]

    @property
    def other(self) -> str:
        """The engine that is not the main one."""
        return ENGINES[1 - ENGINES.index(self.engine)]

    def case(self, run: str) -> Case:
        """Return the case of a run."""
        return case_of(self.runs[run].case)


def make(engine: str, quick: bool, extent: Extent | None = None) -> Plan:
    """Return the plan on the main ``engine``."""
    extent = extent or (QUICK if quick else FULL)
    other = ENGINES[1 - ENGINES.index(engine)]
    runs: dict[str, Run] = {}
    for suffix, solver in (('', engine), (' other', other)):
        runs |= {f'rest{suffix}': Flight(_case('paper', solver, extent), extent.rest),
                 f'shed{suffix}': Flight(_case('paper_alpha8', solver, extent), extent.shed)}
    variants = tuple(_variant(runs, extent, *which) for which in extent.variants)
    scans = tuple(_scan(runs, extent, chord, THICKNESSES[0]) for chord in extent.chords)
    scans += (_scan(runs, extent, 0.030, THICKNESSES[1]),)
    case = _case('paper', engine, extent)
    runs['experiments'] = Experiments(case, _yaml('sysid', CHANGES))
    runs['design'] = Designed('experiments', _settings({}), extent.tuning)
    runs |= _loops(engine, extent) | _shedding_control(engine, extent)
    for name, frames in (('conformal', extent.frames), ('finite_volume', 1)):
        runs[f'film {name}'] = Film(_case('paper_alpha8', name, extent), FILM, frames)
    return Plan(quick, engine, extent, runs, variants, scans)


def _case(name: str, engine: str, extent: Extent, changes: dict[str, Any] | None = None) -> str:
    changes = {'numerics.engine': engine, 'numerics.grid': extent.grids[engine],
               'numerics.trim_time': extent.trim, **(changes or {})}
    return parameters.to_yaml(parameters.load(name, Case, changes))


def _yaml(name: str, changes: dict[str, Any]) -> str:
    from dewing_sysid.settings import Settings
    return parameters.to_yaml(parameters.load(name, Settings, changes))


def _settings(changes: dict[str, Any]) -> str:
    return parameters.to_yaml(parameters.load('controller', ControllerSettings, changes))


def _variant(runs: dict[str, Run], extent: Extent, degrees: float, engine: str, grid: str,
             dt: float) -> Variant:
    """Return a variant of the grid study; its flight is shared where there is one already."""
    shipped = 'paper' if degrees == 4.0 else 'paper_alpha8'
    case = _case(shipped, engine, extent, {'numerics.grid': grid, 'numerics.time_step': dt})
    for name, run in runs.items():
        if isinstance(run, Flight) and run.case == case:
            return Variant(degrees, engine, grid, dt, name)
    variant = Variant(degrees, engine, grid, dt, f'{degrees:g} deg {engine} {grid} {dt:g}')
    runs[variant.flight] = Flight(case, extent.rest if degrees == 4.0 else extent.variant)
    return variant


def _scan(runs: dict[str, Run], extent: Extent, chord: float, thickness: float) -> Scan:
    """Return a wing of another chord or thickness, on the coarse conformal grid."""
    paper = parameters.load('paper')
    speed = REYNOLDS * paper.flow.kinematic_viscosity / chord
    dt = 1.0e-4 * (chord / 0.030)**2            # the same in c/U
    changes = {'numerics.grid': 'realtime', 'numerics.time_step': dt, 'flow.speed': speed,
               'membrane.chord': chord, 'membrane.initial_thickness': thickness}
    label = f'{1.0e3 * chord:g} mm, {1.0e3 * thickness:g} mm'
    scan = Scan(label, chord, thickness, f'scan {label} 4 deg', f'scan {label} 8 deg')
    sample = 2.0 * dt
    runs[scan.rest] = Flight(_case('paper', 'conformal', extent, changes), extent.rest,
                             sample, 2.0 * sample)
    runs[scan.shed] = Flight(_case('paper_alpha8', 'conformal', extent, changes),
                             extent.variant, sample, 2.0 * sample)
    return scan


def _loops(engine: str, extent: Extent) -> dict[str, Run]:
    """Return the wing at 4 degrees under its disturbances, open and closed."""
    fig5 = _case('paper', engine, extent, DISTURBANCES['fig5'])
    printed = _case('paper', engine, extent, DISTURBANCES['printed'])

    def flown(case: str, changes: dict | None, model: str = '', time: float = extent.loop):
        settings = '' if changes is None else _settings(changes)
        return Controlled(case, settings, time, min(extent.averaged, 0.5 * time), model)

    runs: dict[str, Run] = {'fig5/open_loop': flown(fig5, None)}
    for scenario in extent.scenarios:
        for name in _installed():
            if name == 'open_loop':
                continue
            kind = KIND.get(name, name)
            changes = {'kind': kind, 'reference.target': TARGETS[scenario]}
            model = 'design' if LAWS[kind].needs_model else ''
            runs[f'{scenario}/{name}'] = flown(fig5, changes, model)
    runs |= {'printed/open_loop': flown(printed, None), 'printed/pid_tuned': flown(printed, {}),
             'largest/pid_tuned': flown(fig5, {'reference.output': 'camber_max'}),
             'long/pid_tuned': flown(fig5, {}, time=extent.long)}
    runs |= {f'gains/{name}': Controlled(fig5, _settings({}), extent.loop, 0.5 * extent.loop,
                                         reading=name)
             for name in ('as_printed', 'kd_times_3000')}
    return runs


def _installed() -> tuple[str, ...]:
    """Return the controllers that can run here: some laws need more than dewing itself."""
    return tuple(name for name in CONTROLLERS
                 if name == 'open_loop' or installed(KIND.get(name, name)))


def _shedding_control(engine: str, extent: Extent) -> dict[str, Run]:
    """Return the wing at 8 degrees under steady, swinging and fed back V^2."""
    case = _case('paper_alpha8', engine, extent)
    slack = loss_of_tension(case_of(case))**0.5
    duration = 0.5 * extent.shed
    runs: dict[str, Run] = {
        f'alpha8/steady {share:g}': Flight(case, duration, voltage=round(share * slack, 1))
        for share in extent.shares}
    runs |= {f'alpha8/swing {ratio:g}': Flight(
        case, duration, voltage=round(0.5 * slack, 1), swing=1.0, frequency=ratio, lock='shed')
        for ratio in extent.swings}
    time = duration * convective_time(case_of(case))
    for target in extent.held:
        runs[f'alpha8/held {target:g}'] = Controlled(
            case, _settings({'reference.target': target}), time, 0.6 * time)
    return runs
