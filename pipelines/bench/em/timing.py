"""Places to compare at; and a solve that is repeated, with what came out as one line of JSON."""

import json
import resource
import statistics
import time


def lines(scene):
    """Places along the lines of a scene."""
    for line in scene["output"]["lines"]:
        first, last, n = line["from_m"], line["to_m"], line["points"]
        yield line["name"], [[a + (b - a) * k / (n - 1) for a, b in zip(first, last)] for k in range(n)]


def report(version, method, solve):
    """`solve` gives the number of unknowns and a function of no argument that evaluates what is compared; meshing,
    assembly and solution are timed, imports and evaluation are not. A run of less than two seconds is repeated."""
    times = []
    while not times or (times[0] < 2 and len(times) < 3):
        start = time.perf_counter()
        unknowns, evaluate = solve()
        times.append(time.perf_counter() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(
        json.dumps(
            {
                "program": "NGSolve",
                "version": version,
                "method": method,
                "points": unknowns,
                "run_time_s": statistics.median(times),
                "run_time_least_s": min(times),
                "run_time_greatest_s": max(times),
                "repeats": len(times),
                "peak_memory_bytes": peak,
                "values": evaluate(),
            }
        )
    )
