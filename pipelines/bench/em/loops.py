"""A conducting sphere among coaxial loops by NGSolve: edge elements for the reaction potential, the field of the
loops given exactly.

loops.py SCENE.json ORDER SIZE THREADS: SIZE is that of the elements in the sphere over its skin depth. The scene is one
of emfield with one conducting sphere about the origin and coaxial loops; told are the lift as the integral of
J x B over the sphere and on the loops, the heat, and the flux density along its lines."""

import json
import math
import sys

import ngsolve as ng
import numpy as np
from netgen.occ import Box, Glue, OCCGeometry, Pnt, Sphere

import timing
from timing import lines

MU0 = 4e-7 * math.pi
# Degrees of solid harmonics: (2.5 / 3.8)^32 is 1.5e-6.
DEGREES = 32
# Conductivity of air over that of the body: it gauges the potential.
GAUGE = 1e-6


def filaments(coils):
    """Thin loops that stand for thick ones whose current is spread evenly: radius, height, current."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    for coil in (c["loop"] for c in coils):
        wire = coil.get("wire_radius_m", 0)
        for node, weight in zip(nodes, weights):
            r = 0.5 * wire * (1 + node)
            share = weight * 0.5 * (1 + node)
            for angle in 2 * np.pi * np.arange(12) / 12:
                yield (
                    coil["radius_m"] + r * np.cos(angle),
                    coil["centre_m"][2] + r * np.sin(angle),
                    coil["current_a"] * share / 12,
                )


def harmonics(coils):
    """Coefficients c_n of the potential around the axis: sum of c_n r^n P_n^1 near the origin."""
    found = np.zeros(DEGREES)
    for radius, height, current in filaments(coils):
        d = math.hypot(radius, height)
        x, sine = height / d, radius / d
        before, now = 0.0, sine
        for n in range(1, DEGREES + 1):
            found[n - 1] += 0.5 * MU0 * current * sine * now / (n * (n + 1) * d**n)
            before, now = now, ((2 * n + 1) * x * now - (n + 1) * before) / n
    return found


def polynomial(coefficients, scale):
    """F of the potential (-y, x, 0) F of the loops: its coefficients by powers of z and of s = x^2 + y^2, lengths in
    units of `scale`.

    r^n P_n^1 is rho q_n with q_(n+1) = ((2n+1) z q_n - (n+1) r^2 q_(n-1)) / n."""
    count = len(coefficients)
    before, now = np.zeros((2, count + 2, count // 2 + 2))
    now[0, 0] = 1
    total = np.zeros_like(now)
    for n, c in enumerate(coefficients, 1):
        total += c * scale ** (n - 1) * now
        after = np.zeros_like(now)
        after[1:] += (2 * n + 1) / n * now[:-1]
        after[2:] -= (n + 1) / n * before[:-2]
        after[:, 1:] -= (n + 1) / n * before[:, :-1]
        before, now = now, after
    return total[:count, : count // 2 + 1]


def function(table):
    """A polynomial in z and s by Horner's rule."""
    s = ng.x * ng.x + ng.y * ng.y
    total = ng.CoefficientFunction(0)
    for column in table.T[::-1]:
        inner = ng.CoefficientFunction(0)
        for value in np.trim_zeros(column, "b")[::-1]:
            inner = inner * ng.z + float(value)
        total = total * s + inner
    return total


def source(coefficients, scale):
    """Potential and flux density of the loops."""
    table = polynomial(coefficients, scale)
    powers = [np.arange(n) for n in table.shape]
    f = function(table)
    along = function((powers[0][:, None] * table)[1:])
    out = function((powers[1] * table)[:, 1:])
    s = ng.x * ng.x + ng.y * ng.y
    potential = scale * ng.CoefficientFunction((-ng.y * f, ng.x * f, 0))
    flux = ng.CoefficientFunction((-ng.x * along, -ng.y * along, 2 * f + 2 * s * out))
    return potential, flux


def main(scene, order, size, threads):
    body = scene["bodies"][0]
    radius, sigma = body["shape"]["sphere"]["radius_m"], body["conductivity_s_m"]
    omega = 2 * math.pi * scene["eddy_currents"]["harmonic"]["frequency_hz"]
    coils = scene["eddy_currents"]["coils"]
    skin = math.sqrt(2 / (omega * MU0 * sigma)) / radius
    half = scene["domain"]["box"]["max_m"][0] / radius
    given, flux = source(harmonics(coils), radius)
    # Lengths in radii: curl curl A + j q A = -j q A_s.
    q = 1j * omega * MU0 * sigma * radius**2

    def solve():
        ball = Sphere(Pnt(0, 0, 0), 1)
        ball.mat("body")
        ball.maxh = size * skin
        room = Box(Pnt(-half, -half, -half), Pnt(half, half, half))
        room.faces.name = "wall"
        air = room - ball
        air.mat("air")
        mesh = ng.Mesh(OCCGeometry(Glue([ball, air])).GenerateMesh(maxh=0.4 * half, grading=0.4))
        mesh.Curve(order + 1)
        # Gradients of high order are of no use in air; in the body they keep div A = 0.
        conducts = [material == "body" for material in mesh.GetMaterials()]
        space = ng.HCurl(mesh, order=order, complex=True, dirichlet="wall", gradientdomains=conducts)
        u, v = space.TnT()
        rate = mesh.MaterialCF({"body": q}, default=GAUGE * q)
        form = ng.BilinearForm(space, symmetric=True, condense=True)
        form += ng.curl(u) * ng.curl(v) * ng.dx + rate * u * v * ng.dx
        before = ng.Preconditioner(form, "bddc")
        right = ng.LinearForm(space)
        right += -q * given * v * ng.dx("body", bonus_intorder=4)
        form.Assemble()
        right.Assemble()
        found = ng.GridFunction(space)
        ng.solvers.BVP(form, right, found, before, maxsteps=800, tol=1e-8, print=False)
        whole = found + given
        current = -1j * omega * sigma * whole
        total = ng.curl(found) / radius + flux

        def evaluate():
            def over(f):
                return ng.Integrate(f * ng.dx("body", bonus_intorder=4), mesh) * radius**3

            across = current[0] * ng.Conj(total)[1] - current[1] * ng.Conj(total)[0]
            heat = ng.InnerProduct(current, current) / sigma
            totals = {"force_volume_z": over(across).real, "power_volume": over(heat).real}
            totals["force_coil_z"] = coil_lift(mesh, ng.curl(found) / radius, coils, radius)
            told = {}
            for name, places in lines(scene):
                # Just within the surface: elements beyond it hold there as well.
                inside = [[v * min(1, 0.999999 * radius / math.dist(p, (0, 0, 0))) for v in p] if any(p) else p for p in places]
                told[name] = [named(total(mesh(*(v / radius for v in p)))) for p in inside]
            return {"lines": told, "totals": totals}

        return space.ndof, evaluate

    ng.SetNumThreads(threads)
    with ng.TaskManager():
        timing.report(ng.__version__, f"edge elements of order {order}", solve)


def named(flux):
    """Components of a flux density by the names of columns."""
    parts = zip("xyz", flux)
    return {f"magnetic_flux_density_{p}_{k}": v for k, c in parts for p, v in (("real", c.real), ("imag", c.imag))}


def coil_lift(mesh, reaction, coils, radius):
    """The opposite of the force on the loops, by the flux density of the reaction on them."""
    total = 0.0
    for coil in (c["loop"] for c in coils):
        count = 48
        for angle in 2 * np.pi * np.arange(count) / count:
            at = [coil["radius_m"] * np.cos(angle), coil["radius_m"] * np.sin(angle), coil["centre_m"][2]]
            value = reaction(mesh(*(v / radius for v in at)))
            outward = value[0].real * np.cos(angle) + value[1].real * np.sin(angle)
            total += 2 * np.pi * coil["radius_m"] * coil["current_a"] * outward / count
    return total


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        main(json.load(file), int(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]))
