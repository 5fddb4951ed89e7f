"""A spot weld with a flat surface by scikit-fem: the reference of the case `flow-spot`.

    skfem_spot.py solve SCENE.json [--cell 1e-4] [--step 2e-2] [--sign -1] [--fields FILE.npz]
    skfem_spot.py reference SCENE.json OUT.json     all runs of the reference, for both signs of the slope
    skfem_spot.py conduction SCENE.json             the heat alone beside its closed form

    rho (dh/dt + u . grad h) = div(k grad T)                    latent heat over 40 K about the melting point
    rho (du/dt + u . grad u) = div(2 mu D(u)) - grad p + F,  div u = 0
    F = rho g beta (T - T_ref) e_z + j x B                      Boussinesq, Lorentz force as the scene says
    mu du_r/dz = dgamma/dT dT/dr,  u_z = 0,  -k dT/dz = q(r)    on the flat top

in r and z, insulated and closed all around. All numbers come from the scene. Heat: bilinear elements with lumped
mass, upon the enthalpy of the nodes. Flow: Taylor-Hood (Q2, Q1). Both implicit, of first order in time. What holds less
than half of its latent heat stands still, as particles do: a great drag stops it."""

import argparse
import json
import math

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg
import skfem
from skfem.helpers import ddot, div, dot, grad, sym_grad

from spot_scene import Spot, digest

# Drag of what stands still [kg/(m3 s)]: the flow enters sqrt(mu/drag) deep.
DRAG = 1e9
# Rows of solid cells about the pool in which the flow is sought too.
AROUND = 4
# The finest cells and steps of a reference [m, s].
FINEST = 1.4e-4
STEP = 2e-2
# Part of the latent heat around one half over which the drag sets in.
BLUR = 0.1


@skfem.BilinearForm
def mass(u, v, w):
    return u * v * w.x[0]


@skfem.BilinearForm
def conducting(t, v, w):
    return dot(grad(t), grad(v)) * w.x[0]


@skfem.BilinearForm
def carrying(h, v, w):
    return dot(w.u, grad(h)) * v * w.x[0]


@skfem.LinearForm
def heating(v, w):
    return w.flux * v * w.x[0]


@skfem.BilinearForm
def inertia(u, v, w):
    return dot(u, v) * w.x[0]


@skfem.BilinearForm
def friction(u, v, w):
    hoop = u[0] * v[0] / w.x[0]
    return 2 * (ddot(sym_grad(u), sym_grad(v)) * w.x[0] + hoop)


@skfem.BilinearForm
def drifting(u, v, w):
    return (w.drag * u + w.density * dot(w.u, grad(u))) * v * w.x[0]


@skfem.BilinearForm
def spreading(u, q, w):
    return q * (div(u) * w.x[0] + u[0])


@skfem.LinearForm
def pushing(v, w):
    return (w.radial * v[0] + w.axial * v[1]) * w.x[0]


@skfem.LinearForm
def pulling(v, w):
    return w.slope * w.t.grad[0] * v[0] * w.x[0]


def line(end, fine, cell):
    """Nodes from 0 to `end`, even as far as `fine`, then each cell a sixth longer than the last."""
    inner = max(1, round(fine / cell))
    nodes = list(np.linspace(0, fine, inner + 1))
    size = fine / inner
    while nodes[-1] < end - 1e-12:
        size *= 7 / 6
        nodes.append(nodes[-1] + size)
    outer = np.array(nodes[inner:])
    outer = fine + (outer - fine) * (end - fine) / (outer[-1] - fine)
    return np.concatenate([nodes[:inner], outer])


class Weld:
    """The spot on one mesh. The corner of `fine` [m, m] holds the pool; the flow is sought there alone."""

    def __init__(self, spot, cell, fine=(8e-3, 6e-3)):
        self.spot, self.fine = spot, fine
        radial = line(spot.radius, fine[0], cell)
        axial = -line(spot.depth, fine[1], cell)[::-1]
        self.mesh = skfem.MeshQuad.init_tensor(radial, axial)
        self.radial, self.axial = radial, axial
        self._heat_parts()
        self._flow_parts()

    def _heat_parts(self):
        spot = self.spot
        self.heat = skfem.Basis(self.mesh, skfem.ElementQuad1())
        top = self.mesh.facets_satisfying(lambda x: x[1] > -1e-9)
        edge = skfem.FacetBasis(self.mesh, skfem.ElementQuad1(), facets=top, intorder=8)
        self.load = heating.assemble(edge, flux=spot.flux(edge.global_coordinates()[0]))
        self.lumped = spot.density * np.asarray(mass.assemble(self.heat).sum(axis=1)).ravel()
        self.conduct = spot.conductivity * conducting.assemble(self.heat)
        self.enthalpy = np.full(self.heat.N, spot.enthalpy(spot.start))

    def _flow_parts(self):
        spot = self.spot
        centres = self.mesh.p[:, self.mesh.t].mean(axis=1)
        inside = np.flatnonzero((centres[0] < self.fine[0]) & (centres[1] > -self.fine[1]))
        vector = skfem.ElementVector(skfem.ElementQuad2())
        self.flow = skfem.Basis(self.mesh, vector, elements=inside, intorder=4)
        # Drag and drift act on both components alike.
        self.scalar = self.flow.with_element(skfem.ElementQuad2())
        self.places = [self._component(0), self._component(1)]
        self.pressure = self.flow.with_element(skfem.ElementQuad1())
        self.warm = self.flow.with_element(skfem.ElementQuad1())
        top = self.mesh.facets_satisfying(
            lambda x: (x[1] > -1e-9) & (x[0] < self.fine[0])
        )
        self.top = skfem.FacetBasis(self.mesh, vector, facets=top, intorder=4)
        self.top_heat = self.top.with_element(skfem.ElementQuad1())
        self.inertia = spot.density * inertia.assemble(self.flow)
        self.friction = spot.viscosity * friction.assemble(self.flow)
        self.spread = spreading.assemble(self.flow, self.pressure)
        x, vertical = self.flow.doflocs, np.asarray(self.places[1].sum(axis=1)).ravel() > 0
        wall = (x[0] > self.fine[0] - 1e-9) | (x[1] < -self.fine[1] + 1e-9)
        axis = (x[0] < 1e-9) & ~vertical
        lid = (x[1] > -1e-9) & vertical
        self.moves = ~(wall | axis | lid)
        self.velocity = np.zeros(self.flow.N)

    def _component(self, number):
        """Ones where a degree of freedom of the scalar is that of a component of the vector."""
        both = [(self.flow.nodal_dofs, self.scalar.nodal_dofs), (self.flow.facet_dofs, self.scalar.facet_dofs)]
        both.append((self.flow.interior_dofs, self.scalar.interior_dofs))
        rows = np.concatenate([vector[number::2].ravel() for vector, _ in both])
        columns = np.concatenate([scalar.ravel() for _, scalar in both])
        shape = (self.flow.N, self.scalar.N)
        return sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=shape)

    def molten(self):
        return self.spot.molten(self.enthalpy)

    def warm_up(self, dt):
        """An implicit step of the heat, by Newton upon the enthalpy."""
        spot, before = self.spot, self.enthalpy
        carry = 0
        if np.any(self.velocity):
            u = self.flow.interpolate(self.velocity)
            carry = spot.density * carrying.assemble(self.warm, u=u)
        stores = sparse.diags(self.lumped / dt)
        for _ in range(60):
            temperature, slope = spot.temperature(self.enthalpy)
            off = (self.lumped / dt) * (self.enthalpy - before) + self.conduct @ temperature - self.load
            off = off + (carry @ self.enthalpy if np.any(self.velocity) else 0)
            matrix = stores + carry + self.conduct @ sparse.diags(slope)
            change = linalg.splu(matrix.tocsc()).solve(-off)
            self.enthalpy = self.enthalpy + change
            if np.abs(change).max() < 1e-7 * spot.latent:
                return
        raise SystemExit("the heat did not converge: shorten the step")

    def flow_on(self, dt):
        """An implicit step of the flow, carried along by the velocity before it."""
        spot = self.spot
        temperature, _ = spot.temperature(self.enthalpy)
        molten = self.warm.interpolate(self.molten())
        if molten.max() < 0.5:
            return
        solid = np.clip((0.5 + BLUR - molten) / (2 * BLUR), 0, 1)
        u = self.flow.interpolate(self.velocity)
        drift = drifting.assemble(self.scalar, u=u, drag=DRAG * solid, density=spot.density)
        drift = sum(place @ drift @ place.T for place in self.places)
        kelvin = self.warm.interpolate(temperature)
        x = self.flow.global_coordinates()
        radial, axial = spot.force(x[0], x[1], kelvin)
        push = pushing.assemble(self.flow, radial=radial, axial=axial)
        pull = pulling.assemble(self.top, slope=spot.slope, t=self.top_heat.interpolate(temperature))
        matrix = self.inertia / dt + self.friction + drift
        right = self.inertia @ self.velocity / dt + push + pull
        free_u, free_p = self._free()
        a = matrix[free_u][:, free_u]
        b = self.spread[free_p][:, free_u]
        whole = sparse.bmat([[a, -b.T], [-b, None]]).tocsc()
        solved = linalg.spsolve(whole, np.concatenate([right[free_u], np.zeros(len(free_p))]))
        self.velocity = np.zeros(self.flow.N)
        self.velocity[free_u] = solved[: len(free_u)]

    def _free(self):
        """Unknown velocities and pressures: of the molten cells and some around them. All others stand still."""
        cells = self.warm.element_dofs
        node = self.molten() > 0
        for _ in range(AROUND):
            active = node[cells].any(axis=0)
            node[cells[:, active]] = True
        velocity = np.zeros(self.flow.N, dtype=bool)
        velocity[self.flow.element_dofs[:, active]] = True
        velocity[self.flow.element_dofs[:, ~active]] = False
        pressure = np.unique(self.pressure.element_dofs[:, active])
        # A pressure that is the same everywhere moves nothing: one node holds it.
        return np.flatnonzero(velocity & self.moves), pressure[1:]

    def stored(self):
        """Heat above that of the start [J], of the whole turn."""
        return 2 * math.pi * self.lumped @ (self.enthalpy - self.spot.enthalpy(self.spot.start))

    def front(self):
        """Depth of the front of melting under each node of the top within the circle of measure, and its radius at the top [m]."""
        temperature = self._grid(self.spot.temperature(self.enthalpy)[0])
        near = np.flatnonzero(self.radial < self.spot.measure_radius * (1 + 1e-9))
        down = [self._beyond(-self.axial[::-1], temperature[i, ::-1]) for i in near]
        return self.radial[near], np.array(down), self._beyond(self.radial, temperature[:, -1])

    def _beyond(self, places, temperature):
        """Where along a line, from the pool outwards, the temperature falls to that of melting; 0 where it is below it."""
        hot = temperature > self.spot.melting
        if not hot[0]:
            return 0.0
        first = int(np.argmin(hot))
        part = (temperature[first - 1] - self.spot.melting) / (temperature[first - 1] - temperature[first])
        return float(places[first - 1] + part * (places[first] - places[first - 1]))

    def _grid(self, nodal):
        """Values of nodes by r and z."""
        order = np.lexsort((self.heat.doflocs[1], self.heat.doflocs[0]))
        return nodal[order].reshape(len(self.radial), len(self.axial))

    def speeds(self):
        """u at the corners of the mesh, r and z [m/s]."""
        dofs = self.flow.nodal_dofs
        return self._grid(self.velocity[dofs[0]]), self._grid(self.velocity[dofs[1]])

    def measured(self):
        radii, depth, wide = self.front()
        fit = np.polyfit(radii**2, depth, 1, w=np.sqrt(radii + 1e-9))
        ur, uz = self.speeds()
        temperature, _ = self.spot.temperature(self.enthalpy)
        return {
            "depth_m": float(fit[1]),
            "half_width_m": wide,
            "speed_m_s": float(np.hypot(ur, uz).max()),
            "surface_speed_m_s": float(np.abs(ur[:, -1]).max()),
            "centre_k": float(self._grid(temperature)[0, -1]),
            "molten_m3": float(2 * math.pi / self.spot.density * self.lumped @ self.molten()),
        }


def solve(spot, cell, dt, fields=None):
    """The weld, at its end and at twenty times on the way."""
    weld = Weld(spot, cell)
    steps = round(spot.end / dt)
    course = []
    for step in range(1, steps + 1):
        weld.warm_up(dt)
        weld.flow_on(dt)
        if step % (steps // 20) == 0:
            course.append({"time_s": step * dt, **weld.measured()})
    molten = weld._grid(weld.molten())
    edge = (weld.radial > 0.95 * weld.fine[0])[:, None] | (weld.axial < -0.95 * weld.fine[1])[None, :]
    if (molten[edge] > 0).any():
        raise SystemExit("the pool reaches the end of the fine mesh")
    if fields:
        temperature, _ = spot.temperature(weld.enthalpy)
        ur, uz = weld.speeds()
        np.savez(fields, r=weld.radial, z=weld.axial, t=weld._grid(temperature), ur=ur, uz=uz, molten=molten)
    off = weld.stored() / (spot.power * spot.end) - 1
    run = {"cell_m": cell, "step_s": dt, "energy_off": off, "at_end": at_end(course), "course": course}
    print(json.dumps(run["at_end"]), flush=True)
    return run


def at_end(course):
    """Depth, width and volume by a line through the last quarter, at the end; speeds as its mean."""
    end = course[-1]["time_s"]
    late = [row for row in course if row["time_s"] > 0.75 * end]
    times = [row["time_s"] - end for row in late]
    grown = ("depth_m", "half_width_m", "molten_m3")
    values = {key: [row[key] for row in late] for key in late[0] if key != "time_s"}
    return {
        key: float(np.polyfit(times, value, 1)[1] if key in grown else np.mean(value))
        for key, value in values.items()
    }


# The runs of a reference: what differs from the finest, by its name.
OTHERS = {
    "cells_1.4_times": {"cell": 2e-4},
    "cells_2_times": {"cell": 2.8e-4},
    "cells_2_times_steps_half": {"cell": 2.8e-4, "step": 1e-2},
    "cells_1.4_times_range_half": {"cell": 2e-4, "melts_over": 20.0},
    "cells_2_times_plate_1.2_times": {"cell": 2.8e-4, "wider": 1.2},
}


def reference(scene, out):
    """Both signs: the finest run, and how much other cells, steps, ranges and plates change it."""
    methods = {}
    for name, sign in (("outward", -1), ("inward", 1)):
        def run(cell=FINEST, step=STEP, **other):
            print(name, cell, step, other, flush=True)
            return solve(Spot(scene, sign=sign, **other), cell, step)

        finest = run()
        others = {key: run(**other) for key, other in OTHERS.items()}
        keep = ("cell_m", "step_s", "energy_off", "at_end")
        methods[name] = {**finest, "others": {key: {k: r[k] for k in keep} for key, r in others.items()}}
    written(scene, methods, out)


def written(scene, methods, out):
    """Writes what the case reads."""
    made = "pipelines/bench/others/skfem_spot.py"
    with open(out, "w") as file:
        json.dump({"made_by": made, "scene": digest(scene), "methods": methods}, file, indent=1)
        file.write("\n")


def conduction(scene):
    """Heat alone in a half space, which never melts, beside Carslaw and Jaeger (1959): the centre of a Gaussian spot."""
    for cell, dt in ((2e-4, 1e-2), (1e-4, 5e-3), (1e-4, 2.5e-3)):
        spot = Spot(scene, sign=1)
        spot.melting, spot.end = 1e9, 1.0
        weld = Weld(spot, cell)
        for _ in range(round(spot.end / dt)):
            weld.warm_up(dt)
        found = weld.measured()["centre_k"] - spot.start
        spread = 2 * spot.conductivity / (spot.density * spot.capacity) * spot.end
        exact = spot.power / (math.pi**1.5 * spot.conductivity * spot.sigma * math.sqrt(2))
        exact *= math.atan(math.sqrt(spread) / spot.sigma)
        print(json.dumps({"cell_m": cell, "step_s": dt, "rise_k": found, "exact_k": exact, "off": found / exact - 1}))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("what", choices=["solve", "reference", "conduction"])
    parser.add_argument("scene")
    parser.add_argument("out", nargs="?")
    parser.add_argument("--cell", type=float, default=FINEST)
    parser.add_argument("--step", type=float, default=STEP)
    parser.add_argument("--sign", type=float, default=1)
    parser.add_argument("--wider", type=float, default=1)
    parser.add_argument("--fields")
    given = parser.parse_args()
    with open(given.scene) as file:
        scene = json.load(file)
    if given.what == "solve":
        solve(Spot(scene, given.sign, given.wider), given.cell, given.step, given.fields)
    elif given.what == "reference":
        reference(scene, given.out)
    else:
        conduction(scene)


if __name__ == "__main__":
    main()
