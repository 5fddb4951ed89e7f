"""Reads particle frames with nothing of ours: the PyPI packages mcap and mcap-protobuf-support.

usage: read_frames.py FILE.mcap CHANNEL  -> one JSON line that says what was found
"""

import json
import sys

import numpy as np
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

DTYPES = {
    PackedElementField.UINT8: "<u1",
    PackedElementField.INT8: "<i1",
    PackedElementField.UINT16: "<u2",
    PackedElementField.INT16: "<i2",
    PackedElementField.UINT32: "<u4",
    PackedElementField.INT32: "<i4",
    PackedElementField.FLOAT32: "<f4",
    PackedElementField.FLOAT64: "<f8",
}


def columns(cloud):
    """The point cloud as a NumPy record array."""
    dtype = np.dtype(
        {
            "names": [f.name for f in cloud.fields],
            "formats": [DTYPES[f.type] for f in cloud.fields],
            "offsets": [f.offset for f in cloud.fields],
            "itemsize": cloud.point_stride,
        }
    )
    return np.frombuffer(cloud.data, dtype=dtype)


def main(path, channel):
    found = {"frames": 0, "schema": None, "times_s": [], "points": [], "fields": []}
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        metadata = {m.name: m.metadata for m in reader.iter_metadata()}
        for schema, _, message, cloud in reader.iter_decoded_messages(topics=[channel]):
            points = columns(cloud)
            found["frames"] += 1
            found["schema"] = schema.name
            found["times_s"].append(message.log_time * 1e-9)
            found["points"].append(len(points))
            found["fields"] = list(points.dtype.names)
            found["temperature_k"] = [float(points["temperature"].min()), float(points["temperature"].max())]
            found["stamp_s"] = cloud.timestamp.seconds + cloud.timestamp.nanos * 1e-9
            found["frame_id"] = cloud.frame_id
    found["metadata"] = metadata
    print(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
