"""What one message of an artefact holds: arrays with their units at one instant."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Dict, Iterator, Mapping, NamedTuple, Tuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas

Array = NDArray[Any]


class Quantity(NamedTuple):
    """A number with its unit."""

    value: float
    unit: str


@dataclass(frozen=True)
class Frame:
    """Arrays by name, with their units, at one instant.

    Points and tables have arrays of one length, grids arrays over their axes, records arrays without axes.
    """

    channel: str
    #: Simulated time [s].
    time_s: float
    arrays: Mapping[str, Array]
    #: Unit of each array; `1` is a pure number. Without entry: the file tells no unit.
    units: Mapping[str, str]
    #: Names of the arrays that are the axes of a grid, in order; none for anything else.
    axes: Tuple[str, ...] = ()
    #: Scalars that belong to a table or grid.
    attributes: Mapping[str, Quantity] = field(default_factory=dict)
    #: The whole message where a tool speaks in its own words (`/source`, `/plate`); empty for all else.
    document: Mapping[str, Any] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Array:
        """An array; `velocity` is put together from `velocity_x`, `velocity_y`, `velocity_z`, `position` from `x`, `y`, `z`."""
        if name in self.arrays:
            return self.arrays[name]
        parts = self._parts(name)
        if all(part in self.arrays for part in parts):
            return np.stack([self.arrays[part] for part in parts], axis=-1)
        there = ", ".join(self.arrays) or "nothing"
        raise KeyError(f"{self.channel} has no '{name}' (its scene does not ask for it?); there is {there}")

    def __contains__(self, name: object) -> bool:
        return name in self.arrays or all(part in self.arrays for part in self._parts(str(name)))

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrays)

    def __len__(self) -> int:
        """Number of points or rows; of nodes for a grid; 1 for a record."""
        for name, values in self.arrays.items():
            if name not in self.axes:
                return int(values.size)
        return 0

    @staticmethod
    def _parts(name: str) -> Tuple[str, str, str]:
        if name == "position":
            return ("x", "y", "z")
        return (f"{name}_x", f"{name}_y", f"{name}_z")

    def unit(self, name: str) -> str:
        """Unit of an array, or of a vector that is put together."""
        return self.units[name] if name in self.arrays else self.units[self._parts(name)[0]]

    def to_pandas(self) -> "pandas.DataFrame":
        """A table of pandas: a row for each point, row or node. Units are in `.attrs["units"]`."""
        import pandas

        columns = {name: np.ravel(values) for name, values in self.arrays.items() if name not in self.axes}
        lengths = {len(values) for values in columns.values()}
        if len(lengths) > 1:
            raise ValueError(f"{self.channel} has arrays of lengths {sorted(lengths)}: no one table holds them")
        index = None
        if self.axes:
            index = pandas.MultiIndex.from_product([self.arrays[a] for a in self.axes], names=list(self.axes))
        # Bytes of a file that may have another order than those of this machine.
        native = {name: values.astype(values.dtype.newbyteorder("=")) for name, values in columns.items()}
        table = pandas.DataFrame(native, index=index)
        table.attrs["units"] = dict(self.units)
        table.attrs["time_s"] = self.time_s
        table.attrs["attributes"] = {name: tuple(q) for name, q in self.attributes.items()}
        return table


def over_time(channel: str, frames: Iterator[Frame]) -> Frame:
    """Many frames as arrays whose first index is time. What a frame does not tell is NaN there."""
    all_frames = list(frames)
    arrays: Dict[str, Array] = {"log_time_s": np.array([frame.time_s for frame in all_frames])}
    units = {"log_time_s": "s"}
    for name in dict.fromkeys(name for frame in all_frames for name in frame.arrays):
        told = [frame.arrays.get(name) for frame in all_frames]
        shapes = {values.shape for values in told if values is not None}
        if len(shapes) > 1:
            raise ValueError(f"{channel}: '{name}' has shapes {sorted(shapes)} over time: ask for its frames")
        missing = np.full(shapes.pop(), np.nan)
        arrays[name] = np.array([missing if values is None else values for values in told])
        units.update((name, frame.units[name]) for frame in all_frames if name in frame.units)
    return Frame(channel, float(arrays["log_time_s"][-1]) if all_frames else 0.0, arrays, units)
