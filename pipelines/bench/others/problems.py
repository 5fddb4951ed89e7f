"""The problems that all programs solve, their exact solutions, and the one error that all are judged by:
the greatest error at a program's own points, as a part of the range of the solution."""

import numpy as np

STEADY = {
    # Rong and Kisu (2010), section 2.2: k = exp(a T), T = 0 at x = 0 and 1 at x = 1.
    "exp-t": {"a": 4.0, "left": 0.0, "right": 1.0},
    # Section 2.1: k = 1 + 2 sin(pi x) sin(pi y), T = 10 at x = 0 and 0 at x = 1.
    "sin-xy": {"b": 2.0, "left": 10.0, "right": 0.0},
}
# Section 2.3 in SI: insulated at x = 0 and y = 0, convection at x = L and y = L; ambient 0.
ROBIN = {
    "side": 0.1,
    "conductivity": 100.0,
    "heat_capacity": 1e6,
    "coefficient": 1000.0,
    "start": 100.0,
    "end": 8.0,
}


def exact(problem, x, y):
    """The exact temperature at places."""
    if problem == "exp-t":
        a = STEADY[problem]["a"]
        return np.log1p(np.expm1(a) * x) / a
    if problem == "sin-xy":
        return Spectral().at(x, y)
    if problem == "robin":
        return ROBIN["start"] * _slab(x) * _slab(y)
    raise SystemExit(f"there is no problem '{problem}'")


def error(problem, x, y, temperature):
    """Greatest error as a part of the range of the solution."""
    spans = {"exp-t": 1.0, "sin-xy": 10.0, "robin": ROBIN["start"]}
    return float(np.abs(temperature - exact(problem, x, y)).max() / spans[problem])


def _slab(x):
    """A slab that starts at 1, insulated at 0 and cooled at L: its series, eqs 8 to 10."""
    side, biot = ROBIN["side"], ROBIN["coefficient"] * ROBIN["side"] / ROBIN["conductivity"]
    fourier = ROBIN["conductivity"] / ROBIN["heat_capacity"] * ROBIN["end"] / side**2
    total = np.zeros_like(x)
    for n in range(40):
        low, high = n * np.pi, (n + 0.5) * np.pi
        sign = (-1) ** n
        for _ in range(60):  # z tan z = Bi
            z = 0.5 * (low + high)
            if sign * (z * np.sin(z) - biot * np.cos(z)) > 0:
                high = z
            else:
                low = z
        weight = 4 * np.sin(z) / (2 * z + np.sin(2 * z))
        total += weight * np.exp(-z * z * fourier) * np.cos(z * x / side)
    return total


class Spectral:
    """sin-xy by Chebyshev collocation, which shares nothing with the programs."""

    def __init__(self, n=40):
        c, self.x = _chebyshev(n)
        m, eye = n + 1, np.eye(n + 1)
        dx, dy = np.kron(c, eye), np.kron(eye, c)
        xx, yy = np.meshgrid(self.x, self.x, indexing="ij")
        k = (1 + STEADY["sin-xy"]["b"] * np.sin(np.pi * xx) * np.sin(np.pi * yy)).ravel()
        matrix = dx @ (k[:, None] * dx) + dy @ (k[:, None] * dy)
        rhs = np.zeros(m * m)
        flat_x, flat_y = xx.ravel(), yy.ravel()
        for rows, operator in [((flat_y == 0) | (flat_y == 1), dy)]:
            matrix[rows] = operator[rows]
        for at, value in [(0.0, STEADY["sin-xy"]["left"]), (1.0, STEADY["sin-xy"]["right"])]:
            rows = flat_x == at
            matrix[rows], rhs[rows] = np.eye(m * m)[rows], value
        self.values = np.linalg.solve(matrix, rhs).reshape(m, m)

    def at(self, x, y):
        """By barycentric interpolation, exact for the polynomial; in blocks, for it is dense."""
        out = np.empty(len(x))
        for part in np.array_split(np.arange(len(x)), max(1, len(x) // 20000)):
            a, b = self._weights(x[part]), self._weights(y[part])
            out[part] = np.einsum("pi,ij,pj->p", a, self.values, b, optimize=True)
        return out

    def _weights(self, at):
        n = len(self.x) - 1
        w = (-1.0) ** np.arange(n + 1)
        w[[0, -1]] *= 0.5
        gap = at[:, None] - self.x[None, :]
        hit = np.abs(gap) < 1e-14
        gap[hit] = 1.0
        parts = w / gap
        rows = hit.any(axis=1)
        parts[rows] = hit[rows]
        return parts / parts.sum(axis=1, keepdims=True)


def _chebyshev(n):
    """Differentiation matrix and points on 0 to 1 (Trefethen 2000, program 6)."""
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.where((np.arange(n + 1) % n) == 0, 2.0, 1.0) * (-1.0) ** np.arange(n + 1)
    gap = x[:, None] - x[None, :]
    d = np.outer(c, 1 / c) / (gap + np.eye(n + 1))
    d -= np.diag(d.sum(axis=1))
    points = 0.5 * (1 + x)
    points[0], points[-1] = 1.0, 0.0
    return 2 * d, points
