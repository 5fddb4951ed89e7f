"""Derives the sources of the manufactured solution with SymPy and writes scene.json.

The fields (SI, a cylinder of 1 m by 1 m):
  T   = 1000 + 100 r^2 (1 - z^3)                 rho = 1000 / T, mu = T m, k = T c
  psi = r^2 (2 - r^2) (1 + z^2) / 4              rho u = curl of psi / r, free of divergence
  p   = 2 r^2 z^2                                phi = z + r^4 z^2 / 10, sigma = T
The stress is 2 mu sym(grad u). Run from the repository root: python3 pipelines/verify/arc-mms/derive.py
"""
import json
import pathlib

from sympy import Rational, Symbol, diff, expand, factor, integrate, simplify, symbols

r, z = symbols("r z", positive=True)
MU0 = Symbol("MU0")
T = 1000 + 100 * r**2 * (1 - z**3)
RHO, SIGMA, CP = 1000 / T, T, 10
PSI = r**2 * (2 - r**2) * (1 + z**2) / 4
UR, UZ = simplify(-diff(PSI, z) / r / RHO), simplify(diff(PSI, r) / r / RHO)
P = 2 * r**2 * z**2
PHI = z + r**4 * z**2 / 10


def shortest(e):
    e = simplify(e)
    return min((str(s) for s in (e, factor(e), expand(e))), key=len).replace("**", "^")


def text(e):
    magnetic = expand(simplify(e)).coeff(MU0, 1)
    rest = shortest(e.subs(MU0, 0))
    return f"{rest} + 1.25663706212e-6*({shortest(magnetic)})" if magnetic != 0 else rest


def expr(e):
    return {"expr": text(e)}


def divergence(vr, vz):
    return diff(r * vr, r) / r + diff(vz, z)


def sources(viscosity, conductivity):
    """Sources for mu = viscosity T and k = conductivity T."""
    mu, k = Rational(viscosity) * T, Rational(conductivity) * T
    jr, jz = -SIGMA * diff(PHI, r), -SIGMA * diff(PHI, z)
    b = MU0 * integrate(expand(jz * r), (r, 0, r)) / r
    trr, ttt, tzz = 2 * mu * diff(UR, r), 2 * mu * UR / r, 2 * mu * diff(UZ, z)
    trz = mu * (diff(UR, z) + diff(UZ, r))
    fr = divergence(RHO * UR * UR, RHO * UZ * UR) + diff(P, r) + jz * b
    fr -= diff(r * trr, r) / r - ttt / r + diff(trz, z)
    fz = divergence(RHO * UR * UZ, RHO * UZ * UZ) + diff(P, z) - jr * b
    fz -= diff(r * trz, r) / r + diff(tzz, z)
    h = CP * (T - 300)
    q = divergence(RHO * UR * h, RHO * UZ * h) - divergence(k * diff(T, r), k * diff(T, z))
    q -= (jr**2 + jz**2) / SIGMA
    return {
        "gas": {"given": {
            "viscosity_pa_s": {"expr": f"{viscosity}*T"},
            "thermal_conductivity_w_m_k": {"expr": f"{conductivity}*T"},
        }},
        "current": {"source_a_m3": expr(divergence(jr, jz))},
        "flow": {"force_radial_n_m3": expr(fr), "force_axial_n_m3": expr(fz)},
        "heat": {"source_w_m3": expr(q)},
    }


def merge(a, b):
    for key, value in b.items():
        a[key] = merge(a[key], value) if isinstance(value, dict) and isinstance(a.get(key), dict) else value
    return a


def sides(key, value):
    return {"outer": [{key: value}], "bottom": [{key: value}], "top": [{key: value}]}


SCENE = {
    "$schema": "../../../schemas/arcfvm.scene.v1.json",
    "kind": "arcfvm.scene",
    "version": 1,
    "title": "Manufactured solution of all fields",
    "domain": {"r_m": [0, 1], "z_m": [0, 1]},
    "grid": {"r": 0.1, "z": 0.1},
    "gas": {"given": {
        "density_kg_m3": {"expr": "1000/T"},
        "specific_heat_j_kg_k": CP,
        "electric_conductivity_s_m": {"expr": "T"},
    }},
    "current": {"edges": sides("voltage_v", expr(PHI))},
    "flow": {"edges": sides("velocity_m_s", [expr(UR), expr(UZ)])},
    "heat": {"edges": sides("temperature_k", expr(T))},
    "start": {"temperature_k": 1000},
    "iterate": {"tolerance": 1e-9},
}
folder = pathlib.Path(__file__).parent
central = sources("0.0002", "0.01")
upwind = sources("0.0000001", "0.000001")
(folder / "scene.json").write_text(json.dumps(merge(SCENE, central), indent=2) + "\n")
(folder / "upwind.patch.json").write_text(json.dumps(upwind, indent=2) + "\n")
