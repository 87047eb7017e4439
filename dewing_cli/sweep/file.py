# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The results of a sweep as one netCDF file, with one dimension for each varied parameter.

``xarray.open_dataset(FILE)`` gives the metrics by name over the varied values. Points without a
result hold the fill value of netCDF, never a NaN. The inputs of each point are kept as a hash, so
that a sweep goes on where it was left.
"""

from pathlib import Path
from typing import Any

import numpy as np

from dewing_cli.sweep.sweep import DONE, LOST, METRICS, MISSING, STATUS, Result, Sweep
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.files import new_file
from dewing_sim.identity import version

TITLE = 'dewing sweep'
FILL = 9.969209968386869e36     # NC_FILL_DOUBLE, which netCDF tools read as missing

MISSING_EXTRA = "dewing sweep needs xarray: pip install 'dewing[sweep]'"


def require_extra() -> None:
    """Raise `BadInput` unless xarray is installed."""
    try:
        import xarray  # noqa: F401
    except ImportError:
        raise BadInput(MISSING_EXTRA) from None


class Table:
    """The results of a sweep so far, as arrays over its axes."""

    def __init__(self, sweep: Sweep):
        """Start with every point missing."""
        self.sweep = sweep
        self.status = np.full(sweep.shape, MISSING, np.int8)
        self.reason = np.full(sweep.shape, '', object)
        self.fingerprint = np.full(sweep.shape, '', object)
        self.values = {name: np.full(sweep.shape, np.nan) for name in METRICS}

    def put(self, index: tuple[int, ...], fingerprint: str, result: Result) -> None:
        """Enter the result of a point; raise `RunFailed` for a number that is not finite."""
        for name, value in result.metrics.items():
            if not np.isfinite(value):
                raise RunFailed(f'{name} = {value} at point {index} is not finite')
            self.values[name][index] = value
        self.status[index], self.reason[index] = result.status, result.reason
        self.fingerprint[index] = fingerprint

    def result(self, index: tuple[int, ...]) -> Result:
        """Return what was entered for a point."""
        metrics = {name: float(values[index]) for name, values in self.values.items()
                   if np.isfinite(values[index])}
        return Result(int(self.status[index]), self.reason[index], metrics)

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the file, which is replaced at once or not at all."""
        data = self._dataset()
        encoding = {name: {'_FillValue': FILL} for name in METRICS}
        content = data.to_netcdf(engine='scipy', format='NETCDF3_64BIT', encoding=encoding)
        with new_file(path, overwrite) as file:
            file.write(content)

    def _dataset(self) -> Any:
        import xarray
        keys = [axis.key for axis in self.sweep.axes]
        names = ', '.join(f'{code} {name}' for code, name in enumerate(STATUS))
        columns = {name: (keys, self.values[name], {'units': unit, 'long_name': meaning})
                   for name, (unit, meaning) in METRICS.items()}
        columns['status'] = keys, self.status, {'long_name': names}
        columns['reason'] = keys, self.reason.astype(str)
        columns['fingerprint'] = keys, self.fingerprint.astype(str)
        return xarray.Dataset(
            columns, {axis.key: list(axis.values) for axis in self.sweep.axes},
            {'title': TITLE, 'version': version(), 'case': parameters.to_yaml(self.sweep.base),
             'duration': self.sweep.duration, 'averaged_from': self.sweep.skip})


def resume(sweep: Sweep, path: str | Path, retry: bool = False) -> Table:
    """Return the table of ``sweep`` with the points that the file at ``path`` already has.

    A point is taken over if its inputs and the code are the same; with ``retry`` failed ones are
    not. Raises `BadInput` unless the file is of a sweep over the same parameters of the same case
    and has no values that ``sweep`` leaves out: nothing computed is lost without permission.
    """
    stored = _read(path)
    try:
        return _taken_over(sweep, stored, path, retry)
    except (KeyError, IndexError, ValueError, TypeError, OverflowError) as error:
        raise BadInput(_NO_SWEEP.format(path, f' ({type(error).__name__}: {error})')) from None


def _taken_over(sweep: Sweep, stored: Any, path: str | Path, retry: bool) -> Table:
    table = Table(sweep)
    places = _places(sweep, stored, path)
    current = {point.index: sweep.fingerprint(point) for point in sweep.points}
    for old, new in places.items():
        result = _stored_result(stored, old)
        unusable = {MISSING, LOST} | (set() if not retry else set(range(len(STATUS))) - {DONE})
        if str(stored['fingerprint'].values[old]) == current[new] and (
                result.status not in unusable):
            table.put(new, current[new], result)
    return table


def _read(path: str | Path) -> Any:
    import xarray
    try:
        stored = xarray.load_dataset(path, engine='scipy', mmap=False)
    except Exception as error:      # xarray and scipy raise whatever a damaged file provokes
        raise BadInput(_NO_SWEEP.format(path, f' ({type(error).__name__})')) from None
    if stored.attrs.get('title') != TITLE:
        raise BadInput(_NO_SWEEP.format(path, ''))
    return stored


_NO_SWEEP = '{}: not a file of a sweep{}; --force writes over it'


def _places(sweep: Sweep, stored: Any, path: str | Path) -> dict[tuple, tuple]:
    """Return where each stored point lies in ``sweep``."""
    keys = [axis.key for axis in sweep.axes]
    if list(stored['status'].dims) != keys:
        raise BadInput(f'{path} varies {", ".join(map(str, stored["status"].dims))}, not '
                       f'{", ".join(keys)}; --force starts anew')
    _require_same(sweep, stored, path)
    along = []
    for axis in sweep.axes:
        old = stored[axis.key].values.tolist()
        left_out = [value for value in old if value not in axis.values]
        if left_out:
            raise BadInput(f'{path} also holds {axis.key} = {left_out[0]}; '
                           'name that value too, or start anew with --force')
        along.append([axis.values.index(value) for value in old])
    return {old: tuple(places[k] for places, k in zip(along, old))
            for old in np.ndindex(*(len(places) for places in along))}


def _require_same(sweep: Sweep, stored: Any, path: str | Path) -> None:
    """Raise `BadInput` if the sweeps differ in anything that is not varied."""
    varied = [axis.key for axis in sweep.axes]
    before = {name: value for name, value, _ in parameters.leaves(
        parameters.from_yaml(stored.attrs['case'], origin=str(path)))}
    now = {name: value for name, value, _ in parameters.leaves(sweep.base)}
    before |= {'duration': stored.attrs['duration'], 'skip': stored.attrs['averaged_from']}
    now |= {'duration': sweep.duration, 'skip': sweep.skip}
    for name, value in now.items():
        if name not in varied and before[name] != value:
            raise BadInput(f'{path} was computed with {name} = {before[name]}, not {value}; '
                           '--force starts anew')


def _stored_result(stored: Any, index: tuple[int, ...]) -> Result:
    metrics = {name: float(stored[name].values[index]) for name in METRICS
               if name in stored and np.isfinite(stored[name].values[index])}
    return Result(int(stored['status'].values[index]), str(stored['reason'].values[index]),
                  metrics)
