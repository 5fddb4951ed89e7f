"""The problems by scikit-fem: bilinear elements, whose nodes are as many as our points.

skfem_heat.py PROBLEM POINTS-ALONG-A-SIDE direct|iterative"""

import sys

import numpy as np
import pyamg
import scipy.sparse.linalg as linalg
import skfem
from skfem.helpers import dot, grad

import problems
import timing


@skfem.BilinearForm
def conduction(u, v, w):
    return w.k * dot(grad(u), grad(v))


@skfem.BilinearForm
def mass(u, v, w):
    return u * v


@skfem.BilinearForm
def newton(u, v, w):
    return w.k * dot(grad(u), grad(v)) + w.dk * u * dot(w.t.grad, grad(v))


@skfem.LinearForm
def residual(v, w):
    return w.k * dot(w.t.grad, grad(v))


def linear(matrix, rhs, method):
    """Solves with SuperLU, or by conjugate gradients with smoothed aggregation before them."""
    if method == "direct":
        return linalg.spsolve(matrix.tocsc(), rhs)
    levels = pyamg.smoothed_aggregation_solver(matrix.tocsr())
    x, info = linalg.cg(matrix, rhs, rtol=1e-9, M=levels.aspreconditioner())
    if info != 0:
        raise SystemExit("conjugate gradients did not converge")
    return x


def mesh(n, side=1.0):
    line = np.linspace(0, side, n)
    return skfem.MeshQuad.init_tensor(line, line)


def ends(basis, problem, side=1.0):
    """Nodes at x = 0 and x = side, and a field that holds their temperatures."""
    x = basis.doflocs[0]
    left, right = np.flatnonzero(x < 1e-9), np.flatnonzero(x > side - 1e-9)
    t = np.zeros(basis.N)
    t[left], t[right] = problems.STEADY[problem]["left"], problems.STEADY[problem]["right"]
    return np.concatenate([left, right]), t


def sin_xy(n, method):
    basis = skfem.Basis(mesh(n), skfem.ElementQuad1())
    x, y = basis.global_coordinates()
    k = 1 + problems.STEADY["sin-xy"]["b"] * np.sin(np.pi * x) * np.sin(np.pi * y)
    fixed, t = ends(basis, "sin-xy")
    matrix, rhs, t, free = skfem.condense(conduction.assemble(basis, k=k), x=t, D=fixed)
    t[free] = linear(matrix, rhs, method)
    return *basis.doflocs, t


def exp_t(n, method):
    """Newton with steps halved until the residual falls; its matrix is not symmetric."""
    a = problems.STEADY["exp-t"]["a"]
    basis = skfem.Basis(mesh(n), skfem.ElementQuad1())
    fixed, t = ends(basis, "exp-t")
    t = t + basis.doflocs[0] * (t == 0)
    free = basis.complement_dofs(fixed)

    def off(field):
        at = basis.interpolate(field)
        return residual.assemble(basis, t=at, k=np.exp(a * at))[free], at

    gone, at = off(t)
    first = np.abs(gone).max()
    for _ in range(50):
        k = np.exp(a * at)
        matrix = newton.assemble(basis, t=at, k=k, dk=a * k)[free][:, free]
        step = linalg.spsolve(matrix.tocsc(), -gone)
        part = 1.0
        while True:
            trial = t.copy()
            trial[free] += part * step
            left, seen = off(trial)
            if np.abs(left).max() < np.abs(gone).max() or part < 1e-3:
                break
            part /= 2
        t, gone, at = trial, left, seen
        if np.abs(gone).max() < 1e-10 * first:
            return *basis.doflocs, t
    raise SystemExit("Newton did not converge")


def robin(n, method):
    """Crank-Nicolson after two damped halves, steps of the spacing's share of the time."""
    p = problems.ROBIN
    basis = skfem.Basis(mesh(n, p["side"]), skfem.ElementQuad1())
    cooled = basis.mesh.facets_satisfying(lambda x: (x > p["side"] * (1 - 1e-9)).any(axis=0))
    edge = skfem.FacetBasis(basis.mesh, skfem.ElementQuad1(), facets=cooled)
    m = p["heat_capacity"] * mass.assemble(basis)
    k = conduction.assemble(basis, k=p["conductivity"]) + p["coefficient"] * mass.assemble(edge)
    dt = p["end"] / (2 * (n - 1))
    t = np.full(basis.N, p["start"])
    first, later = linalg.splu((m + dt / 4 * k).tocsc()), linalg.splu((m + dt / 2 * k).tocsc())
    for _ in range(4):
        t = first.solve(m @ t)
    for _ in range(2 * (n - 1) - 1):
        t = later.solve(m @ t - dt / 2 * (k @ t))
    return *basis.doflocs, t


if __name__ == "__main__":
    problem, n, method = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    solve = {"exp-t": exp_t, "sin-xy": sin_xy, "robin": robin}[problem]
    names = {"direct": "SuperLU", "iterative": "CG with PyAMG"}
    timing.report("scikit-fem", skfem.__version__, names[method], problem, lambda: solve(n, method))
