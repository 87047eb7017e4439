# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The pulse experiment of the paper's Fig. 4, and the runs that a model has not seen."""

from dataclasses import dataclass
from typing import Mapping

from dewing_cli.paper.runs.flight import case_of, convective_time, cost
from dewing_cli.paper.runs.result import Result, Tick
from dewing_cli.paper.runs.watched import TRIM_SHARE, Watched
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.identity import Identity
from dewing_sysid import experiment, plan
from dewing_sysid.experiment import Record
from dewing_sysid.settings import Settings

FIELDS = ('v_squared', 'outputs', 'baseline')


@dataclass(frozen=True)
class Experiments:
    """All runs of an identification about the rest state, one after the other."""

    case: str                       # YAML
    settings: str                   # YAML of config/sysid.yaml

    needs = ()

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        settings, case = parameters.from_yaml(self.settings, Settings), case_of(self.case)
        times = 3.0 * settings.experiment.record + 2.0 * settings.fresh.record
        return cost(case, times * convective_time(case))

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Run; the arrays are those of the records, ``RUN/FIELD``."""
        built = build_wing(case_of(self.case), lambda done, total: tick(TRIM_SHARE * done / total))
        planned = plan.make(parameters.from_yaml(self.settings, Settings), built.identity)
        total, done, outputs = sum(map(len, planned.inputs.values())), 0, {}
        for name, v_squared in planned.inputs.items():
            before = done
            plant = Watched(built.plant, total,
                            lambda share, before=before: tick(share + _later(before / total)))
            outputs[name] = experiment.run(plant, built.rest, planned.names, v_squared)
            done += len(v_squared)
        records = planned.records(outputs)
        values = {'dt': planned.dt, 'operating_v_squared': planned.operating_v_squared,
                  'names': list(planned.names), 'runs': list(records),
                  'identity': built.identity.to_yaml()}
        return Result(values, {f'{run}/{field}': getattr(record, field)
                               for run, record in records.items() for field in FIELDS})


def _later(share: float) -> float:
    return (1.0 - TRIM_SHARE) * share


def records(result: Result, names: tuple[str, ...] | None = None) -> dict[str, Record]:
    """Return the records by run, of the outputs ``names`` only if these are given."""
    known = tuple(result.values['names'])
    names = names or known
    rows = [known.index(name) for name in names]
    return {run: Record(result.values['dt'], result[f'{run}/v_squared'],
                        result[f'{run}/outputs'][rows], result[f'{run}/baseline'][rows],
                        result.values['operating_v_squared'], names)
            for run in result.values['runs']}


def identity(result: Result) -> Identity:
    """Return the identity of the wing that was excited."""
    return Identity.from_yaml(result.values['identity'])
