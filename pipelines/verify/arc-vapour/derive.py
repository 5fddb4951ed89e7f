"""Derives the sources of the manufactured vapour with SymPy, writes scene.json and upwind.patch.json.

The fields (SI, a cylinder of 1 m by 1 m at one temperature):
  Y   = 3/10 + r^2 (1 - z^3) / 5                 rho = 2 / (1 + Y), mu = m (1 + Y), Gamma = d (1 + Y)^2
  psi = r^2 (2 - r^2) (1 + z^2) / 4              rho u = curl of psi / r, free of divergence
  p   = 2 r^2 z^2
The stress is 2 mu sym(grad u). Run from the repository root: python3 pipelines/verify/arc-vapour/derive.py
"""
import json
import pathlib

from sympy import Rational, diff, expand, factor, simplify, symbols

r, z = symbols("r z", positive=True)
Y = Rational(3, 10) + r**2 * (1 - z**3) / 5
RHO = 2 / (1 + Y)
PSI = r**2 * (2 - r**2) * (1 + z**2) / 4
UR, UZ = simplify(-diff(PSI, z) / r / RHO), simplify(diff(PSI, r) / r / RHO)
P = 2 * r**2 * z**2
VISCOSITY = Rational("0.2")


def expr(e):
    e = simplify(e)
    return {"expr": min((str(s) for s in (e, factor(e), expand(e))), key=len).replace("**", "^")}


def divergence(vr, vz):
    return diff(r * vr, r) / r + diff(vz, z)


def forces():
    mu = VISCOSITY * (1 + Y)
    trr, ttt, tzz = 2 * mu * diff(UR, r), 2 * mu * UR / r, 2 * mu * diff(UZ, z)
    trz = mu * (diff(UR, z) + diff(UZ, r))
    fr = divergence(RHO * UR * UR, RHO * UZ * UR) + diff(P, r)
    fr -= diff(r * trr, r) / r - ttt / r + diff(trz, z)
    fz = divergence(RHO * UR * UZ, RHO * UZ * UZ) + diff(P, z)
    fz -= diff(r * trz, r) / r + diff(tzz, z)
    return fr, fz


def vapour(diffusion):
    """Diffusion and source for Gamma = diffusion (1 + Y)^2."""
    product = RHO * Rational(diffusion) * (1 + Y) ** 2
    source = divergence(RHO * UR * Y, RHO * UZ * Y)
    source -= divergence(product * diff(Y, r), product * diff(Y, z))
    return {"expr": f"{diffusion}*(1 + Y)^2"}, expr(source)


def sides(key, value):
    return {"outer": [{key: value}], "bottom": [{key: value}], "top": [{key: value}]}


radial, axial = forces()
law, source = vapour("0.2")
SCENE = {
    "$schema": "../../../schemas/arcfvm.scene.v1.json",
    "kind": "arcfvm.scene",
    "version": 1,
    "title": "Manufactured vapour in a flow whose density and viscosity follow it",
    "domain": {"r_m": [0, 1], "z_m": [0, 1]},
    "grid": {"r": 0.1, "z": 0.1},
    "gas": {"given": {
        "density_kg_m3": {"expr": "2/(1 + Y)"},
        "viscosity_pa_s": {"expr": "0.2*(1 + Y)"},
        "iron_diffusion_m2_s": law,
        "molar_mass_kg_mol": 0.04,
    }},
    "flow": {
        "edges": sides("velocity_m_s", [expr(UR), expr(UZ)]),
        "force_radial_n_m3": expr(radial),
        "force_axial_n_m3": expr(axial),
    },
    "vapour": {"edges": sides("iron_mass_fraction", expr(Y)), "source_kg_m3_s": source},
    "iterate": {"tolerance": 1e-9},
}
law, source = vapour("0.0001")
UPWIND = {"gas": {"given": {"iron_diffusion_m2_s": law}}, "vapour": {"source_kg_m3_s": source}}
folder = pathlib.Path(__file__).parent
(folder / "scene.json").write_text(json.dumps(SCENE, indent=2) + "\n")
(folder / "upwind.patch.json").write_text(json.dumps(UPWIND, indent=2) + "\n")
