"""A file that a stage wrote: what it is, its channels, and their frames one after another."""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from struct import error as StructError
from typing import Any, Dict, Iterator, Mapping, Union

import zstandard
from google.protobuf.message import DecodeError
from mcap.exceptions import McapError
from mcap.reader import McapReader, make_reader
from mcap_protobuf.decoder import DecoderFactory

from . import message as decode
from .frame import Frame, Quantity, over_time

PathLike = Union[str, "os.PathLike[str]"]

#: Kinds that this package knows, with their major version.
KINDS = {
    "arc-source": 1,
    "gas-table": 1,
    "mean-fields": 1,
    "particle-frames": 1,
    "jet-frames": 1,
    "preview": 1,
    "point-fields": 1,
}


class ArtefactError(Exception):
    """A file that is damaged, unfinished, of another program or of a newer version."""


@dataclass(frozen=True)
class Channel:
    """What a channel carries."""

    name: str
    #: `points`, `grid`, `table`, `record`, or `words` where a tool speaks in its own JSON.
    form: str
    #: Number of messages.
    count: int
    #: Unit of each column.
    units: Mapping[str, str]


@dataclass(frozen=True)
class Artefact:
    """A whole file; nothing but its summary is read before frames are asked for."""

    path: Path
    #: What it is: `particle-frames`, `arc-source`, ...
    kind: str
    #: Version of the kind, `major.minor`.
    version: str
    tool: str
    tool_version: str
    #: The scene as it ran, patches applied.
    scene: Mapping[str, Any]
    #: SHA-256 of each input by name.
    inputs: Mapping[str, str]
    channels: Mapping[str, Channel]

    def frames(self, channel: str) -> Iterator[Frame]:
        """The frames of a channel one after another; one at a time is in memory."""
        return _frames(self, self._must_have(channel))

    def __getitem__(self, channel: str) -> Frame:
        """The last frame of a channel."""
        last = None
        for last in self.frames(channel):
            pass
        if last is None:
            raise ArtefactError(f"{self.path}: {channel} holds nothing")
        return last

    def __contains__(self, channel: object) -> bool:
        return channel in self.channels

    def series(self, channel: str) -> Frame:
        """The numbers of a channel of records, or of a tool's own words, as arrays over time (`log_time_s`)."""
        form = self._must_have(channel).form
        if form not in ("record", "words"):
            raise ArtefactError(f"{self.path}: {channel} holds {form}, no numbers over time: ask for its frames")
        return over_time(channel, self.frames(channel))

    @property
    def record(self) -> Dict[str, Any]:
        """The run record beside the file: time, memory, warnings, closing totals."""
        beside = self.path.with_suffix(".run.json")
        try:
            found = json.loads(beside.read_text(encoding="utf-8"))
        except (OSError, ValueError) as e:
            raise ArtefactError(f"{beside}: {e}") from e
        return dict(found)

    def _must_have(self, channel: str) -> Channel:
        if channel not in self.channels:
            there = ", ".join(self.channels) or "none"
            raise KeyError(f"{self.path} has no channel '{channel}'; there are {there}")
        return self.channels[channel]


def read(path: PathLike) -> Artefact:
    """Opens a file that a stage wrote."""
    path = Path(path)
    with _reader(path) as reader:
        records = {m.name: m.metadata for m in reader.iter_metadata()}
        if "fusionline" not in records:
            raise ArtefactError(f"{path}: an MCAP file, but none of Fusionline: no metadata record 'fusionline'")
        header = records["fusionline"]
        _must_be_known(path, header)
        summary = reader.get_summary()
        if summary is None or summary.statistics is None:
            raise ArtefactError(f"{path}: no summary: {_UNFINISHED}")
        channels: Dict[str, Channel] = {}
        for number, channel in summary.channels.items():
            schema = summary.schemas[channel.schema_id].name
            count = summary.statistics.channel_message_counts.get(number, 0)
            units = json.loads(channel.metadata.get("units", "{}"))
            channels[channel.topic] = Channel(channel.topic, _form(schema), count, units)
    return Artefact(
        path,
        header["kind"],
        header["version"],
        header["tool"],
        header["tool_version"],
        json.loads(header["scene"]),
        json.loads(header["inputs"]),
        channels,
    )


def frames(path: PathLike, channel: str) -> Iterator[Frame]:
    """The frames of a channel of a file one after another."""
    return read(path).frames(channel)


_UNFINISHED = "the run has not finished, or the file was cut short; `artefact recover` saves what is whole"


def _must_be_known(path: Path, header: Mapping[str, str]) -> None:
    kind, version = header["kind"], header["version"]
    if kind not in KINDS:
        raise ArtefactError(f"{path}: kind '{kind}' is unknown; known are {', '.join(sorted(KINDS))}")
    if int(version.split(".")[0]) > KINDS[kind]:
        raise ArtefactError(f"{path}: {kind} {version} is newer than {KINDS[kind]}.x, which this package reads")
    found = hashlib.sha256(header["scene"].encode()).hexdigest()
    if found != header["scene_sha256"]:
        raise ArtefactError(f"{path}: the scene has hash {found}, recorded is {header['scene_sha256']}")


def _form(schema: str) -> str:
    forms = {decode.POINTS: "points", decode.GRID: "grid", decode.TABLE: "table", decode.RECORD: "record"}
    return forms.get(schema, "words")


@contextmanager
def _reader(path: Path) -> Iterator[McapReader]:
    """A reader that compares checksums. What goes wrong in it names the file."""
    if path.suffix in (".part", ".checkpoint"):
        raise ArtefactError(f"{path}: {_UNFINISHED}")
    with open(path, "rb") as file:
        try:
            yield make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        except (McapError, DecodeError, StructError, EOFError, ValueError, zstandard.ZstdError) as e:
            raise ArtefactError(f"{path}: damaged: {e or type(e).__name__}; {_UNFINISHED}") from e


def _frames(artefact: Artefact, channel: Channel) -> Iterator[Frame]:
    name, path = channel.name, artefact.path
    beside = f"{name}/attributes"
    attributes = _attributes(path, beside) if channel.form == "grid" and beside in artefact else iter(())
    with _reader(path) as reader:
        messages = reader.iter_messages(topics=[name])
        if channel.form in ("points", "grid"):
            decoded = ((c, m, d) for _, c, m, d in reader.iter_decoded_messages(topics=[name]))
        else:
            decoded = ((c, m, None) for _, c, m in messages)
        for said, message, cloud in decoded:
            time_s = message.log_time / 1e9
            if channel.form == "points":
                yield decode.points(name, time_s, cloud, channel.units)
            elif channel.form == "grid":
                yield decode.grid(name, time_s, cloud, said.metadata, next(attributes, {}))
            elif channel.form == "table":
                yield decode.table(name, time_s, message.data)
            elif channel.form == "record":
                yield decode.record(name, time_s, message.data)
            else:
                yield decode.words(name, time_s, message.data)


def _attributes(path: Path, channel: str) -> Iterator[Mapping[str, Quantity]]:
    """The scalars that belong to each grid, in the order of the grids."""
    with _reader(path) as reader:
        for _, _, message in reader.iter_messages(topics=[channel]):
            record = decode.record(channel, message.log_time / 1e9, message.data)
            yield {name: Quantity(float(v), record.units[name]) for name, v in record.arrays.items()}
