"""Reads the artefacts of Fusionline as arrays with units, and runs its programs.

    import fusionline

    pool = fusionline.read("build/gmaw-quick/pool.mcap")
    for frame in pool.frames("/particles"):
        print(frame.time_s, frame["temperature"].max(), frame.units["temperature"])
"""

from .artefact import Artefact, ArtefactError, Channel, frames, read
from .frame import Frame, Quantity
from .program import Run, RunError, check, run

__all__ = [
    "Artefact",
    "ArtefactError",
    "Channel",
    "Frame",
    "Quantity",
    "Run",
    "RunError",
    "check",
    "frames",
    "read",
    "run",
]
