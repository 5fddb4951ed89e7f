"""Reads grids with nothing of ours: the PyPI packages mcap, mcap-protobuf-support and
foxglove-schemas-protobuf.

usage: read_grid.py FILE.mcap CHANNEL  -> one JSON line that says what was found in the last grid
"""

import json
import sys

import numpy as np
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from read_frames import DTYPES


def turned(q, v):
    """The vectors `v` turned by a quaternion."""
    u = np.array([q.x, q.y, q.z])
    t = 2.0 * np.cross(u, v)
    return v + q.w * t + np.cross(u, t)


def centres(grid, rows):
    """Where the centre of each cell is in space, as Foxglove's documentation of `Grid` says."""
    i, j = np.indices((rows, grid.column_count))
    plane = [(j + 0.5) * grid.cell_size.x, (i + 0.5) * grid.cell_size.y, 0.0 * i]
    p = grid.pose.position
    return np.array([p.x, p.y, p.z]) + turned(grid.pose.orientation, np.stack(plane, axis=-1))


def main(path, channel_name):
    found = {"schema": None, "times_s": []}
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages(topics=[channel_name]):
            # What the descriptor in the file makes of the bytes is what the published class makes.
            grid = Grid.FromString(message.data)
            if grid.SerializeToString(deterministic=True) != decoded.SerializeToString(deterministic=True):
                raise SystemExit("the descriptor in the file is not that of foxglove.Grid")
            unknown = [f.number for f in grid.DESCRIPTOR.fields if decoded.DESCRIPTOR.fields_by_number[f.number].name != f.name]
            if unknown:
                raise SystemExit(f"fields {unknown} have other names")
            found["schema"] = schema.name
            found["times_s"].append(message.log_time * 1e-9)
            found["stamp_s"] = grid.timestamp.seconds + grid.timestamp.nanos * 1e-9
    rows = len(grid.data) // grid.row_stride
    dtype = np.dtype(
        {
            "names": [f.name for f in grid.fields],
            "formats": [DTYPES[f.type] for f in grid.fields],
            "offsets": [f.offset for f in grid.fields],
            "itemsize": grid.cell_stride,
        }
    )
    cells = np.ndarray((rows, grid.column_count), dtype, grid.data, 0, (grid.row_stride, grid.cell_stride))
    found["frame_id"] = grid.frame_id
    found["shape"] = list(cells.shape)
    found["units"] = json.loads(channel.metadata["units"])
    found["centres"] = centres(grid, rows).reshape(-1, 3).tolist()
    found["values"] = {name: cells[name].ravel().tolist() for name in dtype.names}
    print(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
