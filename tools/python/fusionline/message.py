"""The bytes of one message, as `tools/harness/artefact/FORMAT.md` describes them, to a frame."""

from __future__ import annotations

import json
from typing import Any, Dict, Iterator, Mapping, Optional, Tuple

import numpy as np

from .frame import Array, Frame, Quantity

POINTS = "foxglove.PointCloud"
GRID = "foxglove.Grid"
TABLE = "fusionline.table.v1"
RECORD = "fusionline.record.v1"

#: Numbers of Foxglove's `NumericType`.
_TYPES = {1: "<u1", 2: "<i1", 3: "<u2", 4: "<i2", 5: "<u4", 6: "<i4", 7: "<f4", 8: "<f8"}

#: Units by the end of a key, longest first: a key that tells a dimensional number ends in its unit.
_ENDINGS = {
    "a_m2_k2": "A/(m2 K2)",
    "percent": "%",
    "kg_m3_s": "kg/(m3 s)",
    "mol_m_s": "mol/(m s)",
    "j_mol_k": "J/(mol K)",
    "kg_m2_s": "kg/(m2 s)",
    "w_m2_k": "W/(m2 K)",
    "j_kg_k": "J/(kg K)",
    "m2_k_w": "m2 K/W",
    "kg_mol": "kg/mol",
    "mol_m3": "mol/m3",
    "w_m_k": "W/(m K)",
    "n_m_k": "N/(m K)",
    "j_mol": "J/mol",
    "kg_m3": "kg/m3",
    "kg_m2": "kg/m2",
    "m2_s2": "m2/s2",
    "rad_s": "rad/s",
    "w_m3": "W/m3",
    "w_m2": "W/m2",
    "j_kg": "J/kg",
    "j_m3": "J/m3",
    "j_m2": "J/m2",
    "kg_s": "kg/s",
    "m3_s": "m3/s",
    "m2_s": "m2/s",
    "m_s2": "m/s2",
    "a_m3": "A/m3",
    "a_m2": "A/m2",
    "c_m3": "C/m3",
    "c_m2": "C/m2",
    "n_m3": "N/m3",
    "n_m2": "N/m2",
    "wb_m": "Wb/m",
    "pa_s": "Pa s",
    "pa_m": "Pa/m",
    "1_m3": "1/m3",
    "w_m": "W/m",
    "w_k": "W/K",
    "j_m": "J/m",
    "j_k": "J/K",
    "m_s": "m/s",
    "a_m": "A/m",
    "n_m": "N/m",
    "v_m": "V/m",
    "s_m": "S/m",
    "h_m": "H/m",
    "f_m": "F/m",
    "k_s": "K/s",
    "k_m": "K/m",
    "1_k": "1/K",
    "1_s": "1/s",
    "1_m": "1/m",
    "rad": "rad",
    "deg": "deg",
    "mol": "mol",
    "m3": "m3",
    "m2": "m2",
    "kg": "kg",
    "pa": "Pa",
    "hz": "Hz",
    "m": "m",
    "s": "s",
    "k": "K",
    "j": "J",
    "w": "W",
    "a": "A",
    "v": "V",
    "n": "N",
    "t": "T",
    "c": "C",
}


def points(channel: str, time_s: float, cloud: Any, units: Mapping[str, str]) -> Frame:
    """A point cloud: a column for each of its fields."""
    layout = _layout(cloud.fields, cloud.point_stride)
    rows = np.frombuffer(cloud.data, dtype=layout)
    arrays = {name: np.ascontiguousarray(rows[name]) for name in layout.names or ()}
    return Frame(channel, time_s, arrays, dict(units))


def grid(
    channel: str, time_s: float, cells: Any, metadata: Mapping[str, str], attributes: Mapping[str, Quantity]
) -> Frame:
    """A grid of equal cells. Its axes stand in the metadata of the channel."""
    axes = json.loads(metadata["axes"])
    arrays: Dict[str, Array] = {axis["name"]: np.array(axis["values"], dtype=float) for axis in axes}
    shape = tuple(len(axis["values"]) for axis in axes)
    layout = _layout(cells.fields, cells.cell_stride)
    if len(cells.data) != shape[0] * shape[1] * cells.cell_stride or cells.column_count != shape[1]:
        raise ValueError(f"{channel}: its cells are not those of its axes, {shape[0]} by {shape[1]}")
    nodes = np.frombuffer(cells.data, dtype=layout).reshape(shape)
    for name in layout.names or ():
        arrays[name] = np.ascontiguousarray(nodes[name])
    units = {**json.loads(metadata.get("units", "{}")), **{axis["name"]: axis["unit"] for axis in axes}}
    return Frame(channel, time_s, arrays, units, tuple(axis["name"] for axis in axes), attributes)


def table(channel: str, time_s: float, data: bytes) -> Frame:
    """A table over one index, or a grid with cells that differ."""
    said = json.loads(data)
    shape = tuple(said["shape"])
    axes = said.get("axes", [])
    arrays: Dict[str, Array] = {axis["name"]: np.array(axis["values"], dtype=float) for axis in axes}
    for column in said["columns"]:
        arrays[column["name"]] = np.array(column["values"], dtype=float).reshape(shape)
    units = {series["name"]: series["unit"] for series in [*axes, *said["columns"]]}
    attributes = {name: Quantity(q["value"], q["unit"]) for name, q in said["attributes"].items()}
    return Frame(channel, time_s, arrays, units, tuple(axis["name"] for axis in axes), attributes)


def record(channel: str, time_s: float, data: bytes) -> Frame:
    """Named scalars."""
    values = json.loads(data)["values"]
    arrays = {entry["name"]: np.array(float(entry["value"])) for entry in values}
    return Frame(channel, time_s, arrays, {entry["name"]: entry["unit"] for entry in values})


def words(channel: str, time_s: float, data: bytes) -> Frame:
    """What a tool says in its own words: its numbers and lists of numbers as arrays, all of it as `document`.

    Names of what lies deeper are paths joined by full stops.
    """
    said = json.loads(data)
    document = said if isinstance(said, dict) else {"value": said}
    arrays = dict(_deep("", document))
    units = {name: unit for name in arrays if (unit := unit_of_key(name)) is not None}
    return Frame(channel, time_s, arrays, units, document=document)


def _deep(path: str, value: Any) -> Iterator[Tuple[str, Array]]:
    numbers = _numbers(value)
    if numbers is not None:
        yield path, numbers
    elif isinstance(value, (dict, list)):
        for key, below in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _deep(f"{path}.{key}" if path else str(key), below)


def unit_of_key(key: str) -> Optional[str]:
    """The unit in which a key ends: `spacing_m` is in m. None where it ends in none that is known."""
    for ending, unit in _ENDINGS.items():
        if key.endswith("_" + ending):
            return unit
    return None


def _layout(fields: Any, stride: int) -> "np.dtype[Any]":
    return np.dtype(
        {
            "names": [f.name for f in fields],
            "formats": [_TYPES[f.type] for f in fields],
            "offsets": [f.offset for f in fields],
            "itemsize": stride,
        }
    )


def _numbers(value: Any) -> Optional[Array]:
    """A number, or nested lists of them that make an array; else None."""
    if isinstance(value, bool) or not isinstance(value, (int, float, list)) or value == []:
        return None
    try:
        values = np.array(value)
    except ValueError:
        return None
    return values if values.dtype.kind in "iuf" else None
