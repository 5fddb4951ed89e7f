"""What `skfem_spot.py` reads of a scene of poolsph: the numbers of a spot weld, and nothing else."""

import math

import numpy as np

# The scene's own keys: a reference holds for these alone.
KEYS = ["density_kg_m3", "bodies", "faces", "source", "flow", "marangoni", "buoyancy", "lorentz", "heat", "torches"]
FUNCTIONS = {"exp": np.exp, "sqrt": np.sqrt, "pi": math.pi}


def digest(scene):
    """What a reference is made for."""
    return {"end_s": scene["time"]["end_s"], **{key: scene[key] for key in KEYS if key in scene}}


class Spot:
    """A spot weld. `sign` is that of the slope of the tension, `wider` multiplies the radius of the plate, `melts_over` is the range of
    melting [K]."""

    def __init__(self, scene, sign=1.0, wider=1.0, melts_over=40.0):
        heat, flow = scene["heat"], scene["flow"]
        torch, box = scene["torches"][0], scene["bodies"][0]["shape"]["box"]
        self.end = scene["time"]["end_s"]
        self.density = scene["density_kg_m3"]
        self.start = scene["bodies"][0]["temperature_k"]
        self.radius, self.depth = wider * box["max_m"][0], -box["min_m"][2]
        self.conductivity = heat["thermal_conductivity_w_m_k"]
        self.capacity = heat["specific_heat_j_kg_k"]
        self.melting, self.latent = heat["melting"]["point_k"], heat["melting"]["latent_heat_j_kg"]
        # The front of melting would jump from node to node if all melted at one temperature.
        self.melts_over = melts_over
        self.viscosity, self.gravity = flow["viscosity_pa_s"], -flow["gravity_m_s2"][2]
        self.slope = sign * abs(scene["marangoni"]["slope_n_m_k"])
        self.expansion = scene["buoyancy"]["expansion_1_k"]
        self.reference = scene["buoyancy"]["reference_k"]
        # That of the whole plate, of which the scene has a quarter; R holds 95 % of the heat.
        self.power = torch["power_w"]
        self.sigma = torch["shape"]["gaussian"]["radius_m"] / math.sqrt(6)
        self.lorentz = scene.get("lorentz", {}).get("force_n_m3", [0, 0])
        self.measure_radius = 1.25e-3

    def flux(self, r):
        """q(r) [W/m2]."""
        peak = self.power / (2 * math.pi * self.sigma**2)
        return peak * np.exp(-(r**2) / (2 * self.sigma**2))

    def enthalpy(self, temperature):
        """That of the solid [J/kg]."""
        return self.capacity * temperature

    def temperature(self, enthalpy):
        """T(h) [K], and its slope [kg K/J]."""
        first = self.melting - 0.5 * self.melts_over
        mixed = self.capacity + self.latent / self.melts_over
        beyond = enthalpy - self.capacity * first
        within = np.clip(beyond, 0, mixed * self.melts_over)
        temperature = first + within / mixed + (beyond - within) / self.capacity
        return temperature, np.where(beyond == within, 1 / mixed, 1 / self.capacity)

    def molten(self, enthalpy):
        """Part of the latent heat."""
        temperature, _ = self.temperature(enthalpy)
        return np.clip((temperature - self.melting) / self.melts_over + 0.5, 0, 1)

    def force(self, r, z, temperature):
        """Force density outwards and upwards [N/m3]."""
        radial, axial = (_formula(part, r, z) for part in self.lorentz)
        lifted = self.density * self.gravity * self.expansion * (temperature - self.reference)
        return radial, axial + lifted


def _formula(text, r, z):
    """A number or a formula of the scene, at distances from the axis and heights."""
    if not isinstance(text, dict):
        return np.full_like(r, float(text))
    return eval(text["expr"].replace("^", "**"), {"__builtins__": {}}, {**FUNCTIONS, "r": r, "z": z})
