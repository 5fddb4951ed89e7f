"""The clamped bar of `solid-bar` for programs of other people: its numbers, its lattice, its first period."""

import json
import math
import resource
import time


class Bar:
    """The numbers of a scene."""

    def __init__(self, told):
        solid = told["solids"][0]
        box = solid["body"]["box"]
        self.low, self.high = box["min_m"], box["max_m"]
        self.density = solid["density_kg_m3"]
        self.youngs = solid["elastic"]["youngs_modulus_pa"]
        self.poisson = solid["elastic"]["poisson_ratio"]
        self.formula = solid["velocity_m_s"][1]["expr"]
        self.end = told["time"]["end_s"]

    def box(self, rows):
        return self.low, self.high, (self.high[1] - self.low[1]) / rows

    def velocity(self, place):
        names = {name: getattr(math, name) for name in ("sin", "cos", "sinh", "cosh")}
        return [0.0, eval(self.formula, {"__builtins__": {}}, {**names, "x": max(place[0], 0.0)}), 0.0]


class Course:
    """The way of the tip over time: it begins at rest, and its period ends where it comes by again in the same direction."""

    def __init__(self, end):
        self.end, self.before, self.passed, self.period = end, (0.0, 0.0), False, None

    def add(self, now, way):
        then, there = self.before
        self.passed = self.passed or way < 0.0
        if self.passed and there < 0.0 <= way:
            self.period = then + (now - then) * there / (there - way)
        self.before = (now, way)

    def ended(self):
        return self.period is not None or self.before[0] > 1.5 * self.end


def scene(path):
    with open(path) as file:
        return Bar(json.load(file))


def lattice(low, high, spacing):
    counts = [round((b - a) / spacing) for a, b in zip(low, high)]
    return [
        [a + (n + 0.5) * spacing for a, n in zip(low, (i, j, k))]
        for k in range(counts[2])
        for j in range(counts[1])
        for i in range(counts[0])
    ]


def timed(march, scene):
    """The course of a march and the seconds of it alone."""
    course, start = Course(scene.end), time.perf_counter()
    march(course)
    return course, time.perf_counter() - start


def tell(program, version, method, count, course):
    """Prints size, run time and period."""
    course, spent = course
    told = {
        "program": program,
        "version": version,
        "method": method,
        "points": count,
        "run_time_s": spent,
        "run_time_least_s": spent,
        "run_time_greatest_s": spent,
        "repeats": 1,
        "peak_memory_bytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
        "period_s": course.period and float(course.period),
    }
    print(json.dumps(told))


def report(program, version, method, count, scene, march):
    """Times the march alone."""
    tell(program, version, method, count, timed(march, scene))
