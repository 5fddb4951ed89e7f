"""The problems by FiPy: cell-centred volumes, as many as our points.

fipy_heat.py PROBLEM CELLS-ALONG-A-SIDE direct|iterative"""

import os
import sys

METHOD = sys.argv[3] if __name__ == "__main__" else "direct"
os.environ["FIPY_SOLVERS"] = "scipy"

import fipy
import numpy as np

import problems
import timing


def solver():
    if METHOD == "direct":
        return fipy.LinearLUSolver(tolerance=1e-10, iterations=10)
    from fipy.solvers.scipy.preconditioners import ILUPreconditioner

    return fipy.LinearCGSolver(tolerance=1e-9, iterations=5000, precon=ILUPreconditioner())


def grid(n, side=1.0):
    return fipy.Grid2D(nx=n, ny=n, dx=side / n, dy=side / n)


def held(mesh, problem):
    t = fipy.CellVariable(mesh=mesh, value=0.0)
    t.constrain(problems.STEADY[problem]["left"], mesh.facesLeft)
    t.constrain(problems.STEADY[problem]["right"], mesh.facesRight)
    return t


def sin_xy(n):
    mesh = grid(n)
    t = held(mesh, "sin-xy")
    x, y = mesh.faceCenters
    k = 1 + problems.STEADY["sin-xy"]["b"] * np.sin(np.pi * x) * np.sin(np.pi * y)
    fipy.DiffusionTerm(coeff=fipy.FaceVariable(mesh=mesh, value=k)).solve(var=t, solver=solver())
    return *np.array(mesh.cellCenters), np.array(t)


def exp_t(n):
    """Sweeps with the conductivity of the last temperature, FiPy's own way. At a held face it is taken half
    way between face and cell: taken at the face itself, as FiPy would, it is of first order."""
    a, mesh = problems.STEADY["exp-t"]["a"], grid(n)
    t = held(mesh, "exp-t")
    t.setValue(mesh.cellCenters[0])
    k = fipy.FaceVariable(mesh=mesh)
    outer = np.array(mesh.exteriorFaces)
    within = np.array(mesh.faceCellIDs)[0][outer]
    for _ in range(200):
        before = np.array(t)
        middle = np.array(t.faceValue)
        middle[outer] = 0.5 * (middle[outer] + before[within])
        k.setValue(np.exp(a * middle))
        fipy.DiffusionTerm(coeff=k).solve(var=t, solver=solver())
        if np.abs(np.array(t) - before).max() < 1e-10:
            return *np.array(mesh.cellCenters), np.array(t)
    raise SystemExit("the sweeps did not converge")


def robin(n):
    """Steps of the spacing's share of the time, Crank-Nicolson by halves, two damped first."""
    p = problems.ROBIN
    mesh = grid(n, p["side"])
    t = fipy.CellVariable(mesh=mesh, value=p["start"], hasOld=True)
    cooled = mesh.facesRight | mesh.facesTop
    half = p["side"] / n / 2
    through = 1 / (1 / p["coefficient"] + half / p["conductivity"])
    inner = fipy.FaceVariable(mesh=mesh, value=p["conductivity"])
    inner.setValue(0.0, where=cooled)
    # What leaves a cell through its cooled faces, per volume and kelvin.
    loss = (cooled * through * mesh.faceNormals).divergence
    spatial = fipy.DiffusionTerm(coeff=inner) - fipy.ImplicitSourceTerm(coeff=loss)
    explicit = fipy.ExplicitDiffusionTerm(coeff=inner) - loss * t.old
    storing = fipy.TransientTerm(coeff=p["heat_capacity"])
    steps = 2 * (n - 1)
    dt = p["end"] / steps
    damped, centred = storing == spatial, storing == 0.5 * spatial + 0.5 * explicit
    for equation, step in [(damped, dt / 4)] * 4 + [(centred, dt)] * (steps - 1):
        t.updateOld()
        equation.solve(var=t, dt=step, solver=solver())
    return *np.array(mesh.cellCenters), np.array(t)


if __name__ == "__main__":
    problem, n = sys.argv[1], int(sys.argv[2])
    solve = {"exp-t": exp_t, "sin-xy": sin_xy, "robin": robin}[problem]
    names = {"direct": "SuperLU", "iterative": "CG with ILU"}
    timing.report("FiPy", fipy.__version__, names[METHOD], problem, lambda: solve(n))
