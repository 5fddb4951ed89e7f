"""The potential of a dielectric sphere by NGSolve: continuous elements of any order on curved tetrahedra.

potential.py SCENE.json ORDER SIZE THREADS: SIZE is that of the elements beside the sphere over its radius. The
scene is one of emfield with one sphere in a box, its potential held on the walls; fields are told along its lines."""

import json
import sys

import ngsolve as ng
from netgen.occ import Box, Glue, OCCGeometry, Pnt, Sphere

import timing
from timing import lines


def main(scene, order, size, threads):
    body = scene["bodies"][0]
    radius = body["shape"]["sphere"]["radius_m"]
    low, high = (scene["domain"]["box"][key] for key in ("min_m", "max_m"))
    # In radii: a mesh in micrometres is below the tolerances of its maker.
    formula = scene["electrostatics"]["outer"][0]["potential_v"]["expr"].replace("^", "**")
    place = {"x": radius * ng.x, "y": radius * ng.y, "z": radius * ng.z, "__builtins__": {}}
    held = eval(formula, place)

    def solve():
        ball = Sphere(Pnt(0, 0, 0), 1)
        ball.mat("body")
        ball.maxh = size
        room = Box(Pnt(*(v / radius for v in low)), Pnt(*(v / radius for v in high)))
        room.faces.name = "wall"
        air = room - ball
        air.mat("air")
        mesh = ng.Mesh(OCCGeometry(Glue([ball, air])).GenerateMesh(maxh=4, grading=0.4))
        mesh.Curve(order)
        space = ng.H1(mesh, order=order, dirichlet="wall")
        u, v = space.TnT()
        ratio = mesh.MaterialCF({"body": body["relative_permittivity"]}, default=1)
        form = ng.BilinearForm(ratio * ng.grad(u) * ng.grad(v) * ng.dx, condense=True)
        before = ng.Preconditioner(form, "bddc")
        found = ng.GridFunction(space)
        found.Set(held, ng.BND)
        right = ng.LinearForm(space).Assemble()
        form.Assemble()
        ng.solvers.BVP(form, right, found, before, maxsteps=500, tol=1e-10, print=False)
        field = -ng.grad(found) / radius

        def evaluate():
            told = {}
            for name, places in lines(scene):
                at = [mesh(*(v / radius for v in p)) for p in places]
                told[name] = [
                    {"potential": found(p)} | {f"electric_field_{k}": e for k, e in zip("xyz", field(p))} for p in at
                ]
            return {"lines": told}

        return space.ndof, evaluate

    ng.SetNumThreads(threads)
    with ng.TaskManager():
        timing.report(ng.__version__, f"H1 of order {order}", solve)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        main(json.load(file), int(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]))
