"""Runs a small scene with each program by our Python package, and compares what it reads from each file, array by array
and to the last bit, with what the program `artefact` writes for NumPy.

usage: use_package.py ROOT PROGRAMS FOLDER ARC.mcap  -> one JSON line that says what was found in each file
"""

import json
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np

import fusionline


def scenes(root, folder, arc):
    """Name, scene, patches and inputs of one file of each kind and form."""
    tests, verify = root / "tests/resume", root / "pipelines/verify"
    mean = {
        "kind": "avg.scene",
        "version": 1,
        "title": "One section",
        "follow": {},
        "sections": [
            {
                "name": "along",
                "first_m": [-0.002, 0.002],
                "second_m": [-0.002, 0.001],
                "cut": {"plane": {"normal": "x", "half_thickness_m": 0.0005}},
            }
        ],
    }
    jet = {"time": {"end_s": 0.002}, "water": {"spacing_m": 0.001}}
    yield "gas", verify / "gas-argon/scene.json", {"temperatures": {"even": {"from_k": 300, "to_k": 3000, "count": 10}}}, {}
    yield "arc", verify / "arc-electrode/scene.json", None, {}
    yield "heat", tests / "heat.json", [{"time": {"end_s": 0.02}}, {"title": "Two patches"}], {}
    yield "field", tests / "field.json", {"eddy_currents": {"transient": {"end_s": 1e-6}}, "output": {"at_s": None}}, {}
    yield "pool", tests / "weld.json", {"time": {"end_s": 0.016}}, {"arc": arc}
    yield "jet", verify / "jet-plate/scene.json", jet, {}
    yield "mean", mean, None, {"frames": folder / "pool.mcap"}


def file_name(channel):
    return channel.lstrip("/").replace("/", "_")


def entry(frame, key):
    """An array by its exported name: `min_m.0` is the first entry of the list `min_m`."""
    name, _, index = key.rpartition(".")
    return entry(frame, name)[..., int(index)] if index.isdigit() and key not in frame else frame[key]


def compare(artefact, program, folder):
    """Number of arrays that are the same in both readers, by form; ends at the first that is not."""
    subprocess.run(
        [program, "export", artefact.path, "--to", "npz", "--out", folder], check=True, stdout=subprocess.DEVNULL
    )
    same = {}
    for name, channel in artefact.channels.items():
        out = file_name(name)
        if (folder / f"{out}.npz").exists():
            pairs = [(artefact.series(name), folder / f"{out}.npz")]
        else:
            pairs = [(f, folder / out / f"{out}_{i:05}.npz") for i, f in enumerate(artefact.frames(name))]
            if len(pairs) != channel.count:
                raise SystemExit(f"{name}: {len(pairs)} frames, {channel.count} are told")
        for frame, path in pairs:
            exported = dict(np.load(path))
            if "log_time_s" not in frame and float(exported.pop("log_time_s")) != frame.time_s:
                raise SystemExit(f"{name}: another time than in {path}")
            for key, values in exported.items():
                ours = frame.attributes[key].value if key in frame.attributes else entry(frame, key)
                if not np.array_equal(np.asarray(ours, dtype=values.dtype), values, equal_nan=True):
                    raise SystemExit(f"{name}: {key} differs from {path}")
                same[channel.form] = same.get(channel.form, 0) + 1
            if channel.form != "words" and (missing := set(frame.arrays) - set(frame.units)):
                raise SystemExit(f"{name}: {missing} without a unit")
    return same


def main(root, programs, folder, arc):
    root, programs, folder = Path(root), Path(programs), Path(folder)
    found = {}
    for name, scene, patch, inputs in scenes(root, folder, arc):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            done = fusionline.run(
                scene, out=folder / f"{name}.mcap", patch=patch, inputs=inputs, threads=1, programs=programs
            )
        artefact = done.artefact
        frame = next(f for c in artefact.channels.values() if c.form in ("points", "table", "grid") for f in artefact.frames(c.name))
        found[name] = {
            "kind": artefact.kind,
            "same": compare(artefact, programs / "artefact", folder / f"{name}-npz"),
            "warned": [done.exit_code == 3, len(told) == 1],
            "patched": artefact.scene["title"],
            "rows": [len(frame), len(frame.to_pandas())],
        }
    pool = fusionline.read(folder / "pool.mcap")
    last = pool["/particles"]
    found["vector"] = [list(last["velocity"].shape), last.unit("velocity"), len(last["id"])]
    balance = pool.series("/balance")
    found["series"] = [len(balance["log_time_s"]), bool(np.all(np.diff(balance["log_time_s"]) > 0))]
    found["words"] = [pool["/plate"].units["spacing_m"], float(pool["/plate"]["spacing_m"]), pool["/plate"].document["direction"]]
    found["refused"] = refusals(root, programs, folder)
    print(json.dumps(found))


def refusals(root, programs, folder):
    """What is said where there is nothing to be read or run."""

    def said(what):
        try:
            what()
        except (fusionline.ArtefactError, fusionline.RunError, KeyError) as e:
            return f"{type(e).__name__}: {e}"
        return "nothing"

    whole = (folder / "pool.mcap").read_bytes()
    (folder / "cut.mcap").write_bytes(whole[: len(whole) // 2])
    turned = bytearray(whole)
    turned[len(whole) // 2] ^= 0xFF
    (folder / "turned.mcap").write_bytes(turned)
    heat = root / "tests/resume/heat.json"
    return {
        "cut": said(lambda: fusionline.read(folder / "cut.mcap")),
        "turned": said(lambda: [list(fusionline.frames(folder / "turned.mcap", c)) for c in ("/particles", "/pool")]),
        "channel": said(lambda: fusionline.read(folder / "pool.mcap")["/points"]),
        "column": said(lambda: fusionline.read(folder / "heat.mcap")["/points"]["pressure"]),
        "scene": said(lambda: fusionline.check(heat, patch={"initial_temperature_k": -1}, programs=programs)),
        "plan": fusionline.check(heat, programs=programs),
    }


if __name__ == "__main__":
    main(*sys.argv[1:])
