"""Calls the programs: a scene, patches and inputs in, an artefact out."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, List, Mapping, Optional, Sequence, Union

from .artefact import Artefact, PathLike, read

#: A JSON Merge Patch (RFC 7386): a file, or what would stand in it.
Patch = Union[PathLike, Mapping[str, Any]]
Patches = Union[Patch, Sequence[Patch], None]

#: Exit code of a run that finished with warnings that matter.
WARNED = 3


class RunError(Exception):
    """A program that found no result. `exit_code` as the programs tell it: 1 failed, 2 usage or scene, 130 interrupted."""

    def __init__(self, exit_code: int, said: str) -> None:
        super().__init__(said)
        self.exit_code = exit_code


@dataclass(frozen=True)
class Run:
    """A run that finished."""

    artefact: Artefact
    #: 0, or 3 with warnings that matter.
    exit_code: int
    warnings: List[str]


def run(
    scene: Union[PathLike, Mapping[str, Any]],
    *,
    out: PathLike,
    patch: Patches = None,
    inputs: Optional[Mapping[str, PathLike]] = None,
    threads: Optional[int] = None,
    resume: bool = False,
    programs: Optional[PathLike] = None,
) -> Run:
    """Runs a scene to `out` with the program that its `kind` names.

    Warnings that matter (exit 3) are Python warnings as well. Raises `RunError` where there is no result.
    """
    with _command("run", scene, patch, inputs, programs) as command:
        command += ["--out", os.fspath(out), "--progress", "none"]
        command += ["--threads", str(threads)] if threads is not None else []
        command += ["--resume"] if resume else []
        Path(out).parent.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, WARNED):
        raise RunError(done.returncode, done.stderr.strip())
    artefact = read(out)
    told = [str(warning) for warning in artefact.record["warnings"]]
    if done.returncode == WARNED:
        warnings.warn(f"{artefact.path}: " + "; ".join(told or ["finished with warnings"]), stacklevel=2)
    return Run(artefact, done.returncode, told)


def check(
    scene: Union[PathLike, Mapping[str, Any]],
    *,
    patch: Patches = None,
    inputs: Optional[Mapping[str, PathLike]] = None,
    programs: Optional[PathLike] = None,
) -> str:
    """The plan of a scene: stages, points, memory, limits, time. Runs nothing; raises `RunError` on a faulty scene."""
    with _command("check", scene, patch, inputs, programs) as command:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, WARNED):
        raise RunError(done.returncode, done.stderr.strip())
    return done.stdout


@contextmanager
def _command(
    action: str,
    scene: Union[PathLike, Mapping[str, Any]],
    patch: Patches,
    inputs: Optional[Mapping[str, PathLike]],
    programs: Optional[PathLike],
) -> Iterator[List[str]]:
    """The command line; scenes and patches that are no files are files while it runs."""
    patches: List[Patch] = []
    if isinstance(patch, (str, os.PathLike, Mapping)):
        patches = [patch]
    elif patch is not None:
        patches = list(patch)
    with tempfile.TemporaryDirectory(prefix="fusionline-") as folder:
        place = _file(scene, Path(folder) / "scene.json")
        command = [os.fspath(_program(_tool(place), programs)), action, os.fspath(place)]
        for n, one in enumerate(patches):
            command += ["--patch", os.fspath(_file(one, Path(folder) / f"{n}.patch.json"))]
        for name, path in (inputs or {}).items():
            command += ["--input", f"{name}={os.fspath(path)}"]
        yield command


def _file(what: Union[PathLike, Mapping[str, Any]], place: Path) -> Path:
    if isinstance(what, Mapping):
        place.write_text(json.dumps(what, indent=1), encoding="utf-8")
        return place
    return Path(what)


def _tool(scene: Path) -> str:
    """The program that a scene is for: `heatsph.scene` is for heatsph."""
    try:
        kind = str(json.loads(scene.read_text(encoding="utf-8")).get("kind", ""))
    except (ValueError, AttributeError) as e:
        raise RunError(2, f"{scene}: no scene: {e}") from e
    if not kind.endswith(".scene"):
        raise RunError(2, f"{scene}: kind '{kind}' names no program; a scene says, for example, heatsph.scene")
    return kind[: -len(".scene")]


def _program(name: str, programs: Optional[PathLike]) -> Path:
    """Where a program is: in `programs`, in the folder that FUSIONLINE_PROGRAMS names, in `target/release` here or
    above, on the path."""
    said = programs or os.environ.get("FUSIONLINE_PROGRAMS")
    here = Path.cwd()
    folders = [Path(said)] if said else [up / "target" / "release" for up in (here, *here.parents)]
    for folder in folders:
        if (folder / name).is_file():
            return folder / name
    found = None if said else shutil.which(name)
    if found is None:
        where = os.fspath(said) if said else "target/release here or above, or on the path"
        raise RunError(2, f"there is no {name} in {where}: `make programs` builds it; programs=FOLDER says where it is")
    return Path(found)
