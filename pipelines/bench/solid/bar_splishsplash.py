"""SPlisHSPlasH, elastic particles of Kugelstadt et al. (2021), on the clamped bar of `solid-bar`.

    bar_splishsplash.py SCENE.json ROWS: the scene of the case, rows through the thickness.
    Prints size, run time and the first period as JSON. Numbers are those of its method's own defaults, without viscosity; the step is
    1/500 of a period; the clamp is three layers of particles behind the face. The method of Kee et al. (2023) found no steady period of
    swings this small with any of the tolerances tried.
"""

import json
import os
import pathlib
import sys
import tempfile
import time

# The package brings a library of its own for windows, which does not fit that of the system beside it.
SYSTEM = "/lib/x86_64-linux-gnu/libGLdispatch.so.0"
if os.path.exists(SYSTEM) and SYSTEM not in os.environ.get("LD_PRELOAD", ""):
    os.environ["LD_PRELOAD"] = SYSTEM
    os.execv(sys.executable, [sys.executable, *sys.argv])

import importlib.metadata

import pysplishsplash as sph

import bar

TITLE = "Kugelstadt et al. 2021"

scene, rows = bar.scene(sys.argv[1]), int(sys.argv[2])
low, high, spacing = scene.box(rows)
first = [low[0] - 2.5 * spacing, low[1] + 0.5 * spacing, low[2] + 0.5 * spacing]
last = [b - 0.5 * spacing for b in high]
told = {
    "Configuration": {
        "timeStepSize": scene.end / 1.5 / 500,
        "particleRadius": 0.5 * spacing,
        "numberOfStepsPerRenderUpdate": 1,
        "simulationMethod": 0,
        "gravitation": [0, 0, 0],
        "cflMethod": 0,
        "stopAt": 2.0 * scene.end,
        "enableZSort": False,
        "boundaryHandlingMethod": 2,
        "WCSPH": {"stiffness": 0, "exponent": 1},
    },
    "Materials": [
        {
            "id": "Fluid",
            "density0": scene.density,
            "elasticityMethod": 3,
            "viscosityMethod": 0,
            TITLE: {
                "youngsModulus": scene.youngs,
                "poissonsRatio": scene.poisson,
                "fixedBoxMin": [low[0] - 1, -1, -1],
                "fixedBoxMax": [low[0], 1, 1],
                "alpha": 0.1,
                "massIterations": 1,
                "maxNeighbors": -1,
            },
        }
    ],
    "FluidBlocks": [
        {"denseMode": 0, "start": [x - spacing for x in first], "end": [x + spacing for x in last]}
    ],
}
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder, "scene.json")
    path.write_text(json.dumps(told))
    # It talks on stdout, which is kept for what is told at the end.
    kept = os.dup(1)
    os.dup2(2, 1)
    base = sph.Exec.SimulatorBase()
    base.init(useGui=False, sceneFile=str(path), outputDir=folder, stateFile="", param="", initialPause=False)
    base.initSimulation()
    model = sph.Simulation.getCurrent().getFluidModel(0)
    count = model.numActiveParticles()
    places = [model.getPosition(a) for a in range(count)]
    wanted = bar.lattice([low[0] - 3 * spacing, *low[1:]], high, spacing)
    assert count == len(wanted), (count, len(wanted))
    off = max(abs(a - b) for x, y in zip(sorted(map(tuple, places)), sorted(wanted)) for a, b in zip(x, y))
    assert off < 1e-3 * spacing, f"another lattice, by {off} m"
    tip = [a for a, place in enumerate(places) if place[0] > high[0] - 0.6 * spacing]
    rest = sum(places[a][1] for a in tip) / len(tip)
    clock = sph.TimeManager.getCurrent()

    course, times = bar.Course(scene.end), []

    def look():
        times.append((time.perf_counter(), clock.getTime()))
        if len(times) == 1:
            # Speeds that are set before the first step are forgotten.
            for a, place in enumerate(places):
                model.setVelocity(a, [0.0, 0.0, 0.0] if place[0] < low[0] else scene.velocity(place))
            return
        now = sum(float(model.getPosition(a)[1]) for a in tip) / len(tip) - rest
        course.add(clock.getTime() - times[0][1], now)
        if course.ended():
            base.setValueFloat(base.STOP_AT, 1e-9)

    base.setTimeStepCB(look)
    base.runSimulation()
    spent = times[-1][0] - times[0][0]
    os.dup2(kept, 1)
    bar.tell("SPlisHSPlasH", importlib.metadata.version("pysplishsplash"), TITLE, count, (course, spent))
    sys.stdout.flush()
    # It ends by a fault of its own where its windows never were.
    os._exit(0)
