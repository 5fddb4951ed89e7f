"""Collapse of a column of water by plane potential flow: boundary elements, marched in time.

Lengths in a (foot of the column), time T = n t sqrt(g/a), so that gravity is 1/n^2; the column is n^2 high.
The wall x = 0 and the floor y = 0 are mirrors: with w = z^2 the Green function of the quarter plane is
ln|w - w'| + ln|w - conj w'|, so only the free surface has nodes. (A tank of length L: w = sin^2(pi z / 2L), up to a factor.)
Surface, potential and normal velocity are cubic splines of chord length. It has two pieces, top and face, which meet at
a corner with two normal velocities; the extra equation is that both pieces give one velocity along n1 + n2.

    python3 potential_flow.py checks        a standing wave; the first acceleration against its series
    python3 potential_flow.py run 2 0.05    a column twice as high as wide, nodes 0.05 apart; 1: as high as wide

It needs numpy and scipy. potential_flow.json holds what it gave.
"""
import json, sys, time
import numpy as np
from scipy.interpolate import BSpline, CubicSpline, CubicHermiteSpline
from scipy.sparse import block_diag, csr_matrix


def gauss(n):
    """Places and weights on 0..1."""
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (x + 1), 0.5 * w


COARSE = gauss(4)
u, wu = gauss(20)
P = 4  # points gathered at both ends of the element, for the logarithm and for near sheets
FINE = (u**P / (u**P + (1 - u)**P), wu * P * (u * (1 - u))**(P - 1) / (u**P + (1 - u)**P)**2)


class Piece:
    """Splines through nodes z, phi; ends 'wall' (mirror in x), 'corner' or 'tip'."""

    def __init__(self, z, phi, ends):
        self.z, self.phi, self.ends = z, phi, ends
        s = self.s = np.concatenate(([0], np.cumsum(np.abs(np.diff(z)))))
        even = tuple((1, 0.0) if e == 'wall' else 'not-a-knot' for e in ends)
        odd = tuple((2, 0.0) if e == 'wall' else 'not-a-knot' for e in ends)
        self.x, self.y, self.p = CubicSpline(s, z.real, bc_type=odd), CubicSpline(s, z.imag, bc_type=even), CubicSpline(s, phi, bc_type=even)
        self.knots = np.concatenate(([s[0]] * 4, s[2:-2], [s[-1]] * 4))

    def at(self, s):
        return self.x(s) + 1j * self.y(s), self.x(s, 1) + 1j * self.y(s, 1), self.p(s)

    def rule(self, rule):
        """Points of all elements: place, dz with weight, potential, matrix of the basis."""
        h = np.diff(self.s)
        s = (self.s[:-1, None] + h[:, None] * rule[0]).ravel()
        z, dz, p = self.at(s)
        return z, dz * (h[:, None] * rule[1]).ravel(), p, self.basis(s)

    def basis(self, s):
        return BSpline.design_matrix(np.clip(s, self.s[0], self.s[-1]), self.knots, 3)


class Plane:
    """w(z) and its derivative: quarter plane, or tank of length L."""

    def __init__(self, length=None):
        self.k = None if length is None else np.pi / (2 * length)

    def w(self, z):
        return z * z if self.k is None else (np.sin(self.k * z) / self.k)**2

    def dw(self, z):
        return 2 * z if self.k is None else np.sin(2 * self.k * z) / self.k

    def copies(self, z):
        c = [z, z.conj(), -z, -z.conj()]
        return c if self.k is None else c + [v + np.pi / self.k for v in (-z, -z.conj())]


def velocity(pieces, plane):
    """Complex velocity at the nodes of each piece, and the normal velocities' kinetic energy."""
    def joined(rule):
        parts = [p.rule(rule) for p in pieces]
        return [np.concatenate([q[k] for q in parts]) for k in range(3)] + [block_diag([q[3] for q in parts], format='csr')]
    zq, dz, pq, basis = joined(COARSE)
    zf, dzf, pf, basis_f = joined(FINE)
    m, mf = len(COARSE[0]), len(FINE[0])
    first = [0] + [1] * (len(pieces) - 1)
    zc = np.concatenate([p.z[f:] for p, f in zip(pieces, first)])
    pc = np.concatenate([p.phi[f:] for p, f in zip(pieces, first)])
    wc = plane.w(zc)

    def kernels(z, dz, wc):
        w = plane.w(z)
        a, b = w - wc, w - wc.conj()
        ab = a * b
        return np.log(np.abs(ab) * 1e-4) * np.abs(dz), (1j * dz * plane.dw(z) * (a + b) / ab).real
    g, h = kernels(zq[None, :], dz[None, :], wc[:, None])
    ends = [np.stack([p.z[:-1], p.z[1:]]) for p in pieces]
    lo, hi = np.concatenate([e[0] for e in ends]), np.concatenate([e[1] for e in ends])
    mid, long = 0.5 * (lo + hi), np.abs(hi - lo)
    away = np.min([np.abs(c[:, None] - mid[None, :]) for c in plane.copies(zc)], axis=0)
    near = away < 2.0 * long[None, :]
    g.reshape(len(zc), -1, m)[near] = 0
    h.reshape(len(zc), -1, m)[near] = 0
    rhs = h @ pq - h.sum(1) * pc
    matrix = (basis.T @ g.T).T
    row, element = np.nonzero(near)
    column = element[:, None] * mf + np.arange(mf)
    gf, hf = kernels(zf[column], dzf[column], wc[row][:, None])
    rhs += np.bincount(row, (hf * (pf[column] - pc[row][:, None])).sum(1), len(zc))
    rows = np.repeat(row, mf)
    matrix += (csr_matrix((gf.ravel(), (rows, column.ravel())), (len(zc), len(zf))) @ basis_f).toarray()
    tangent, along = [], []
    for p in pieces:
        d = p.x(p.s, 1) + 1j * p.y(p.s, 1)
        tangent.append(d / np.abs(d))
        along.append(p.p(p.s, 1) / np.abs(d))
    if len(pieces) == 2:  # one velocity at the corner along n1 + n2
        n1 = len(pieces[0].z)
        ta, tb = tangent[0][-1], tangent[1][0]
        d = 1j * (ta + tb)
        dot = lambda a, b: (a * b.conjugate()).real
        extra = np.zeros(matrix.shape[1])
        extra[n1 - 1], extra[n1] = dot(1j * ta, d), -dot(1j * tb, d)
        matrix = np.vstack([matrix, extra])
        rhs = np.append(rhs, -along[0][-1] * dot(ta, d) + along[1][0] * dot(tb, d))
    c = np.linalg.solve(matrix, rhs)
    q_f = basis_f @ c
    kinetic = 0.5 * np.sum(pf * q_f * np.abs(dzf))
    out, at, normal = [], 0, []
    for p, t, a in zip(pieces, tangent, along):
        q = p.basis(p.s) @ c[at:at + len(p.z)]
        at += len(p.z)
        normal.append(q)
        out.append((a + 1j * q) * t)
    if len(pieces) == 2:
        out[0][-1] = out[1][0] = 0.5 * (out[0][-1] + out[1][0])
    for p, v in zip(pieces, out):
        for e, k in zip(p.ends, (0, -1)):
            if e == 'wall':
                v[k] = 1j * v[k].imag
            if e == 'tip':
                v[k] = v[k].real
    return out, kinetic, normal


def sums(pieces, gravity):
    """Area and potential energy."""
    area = energy = 0.0
    for p in pieces:
        z, dz, *_ = p.rule(FINE)
        area += np.sum(z.imag * dz.real)
        energy += gravity * np.sum(0.5 * z.imag**2 * dz.real)
    return area, energy


def step(pieces, plane, gravity, dt, first):
    """Runge-Kutta of order 4 over dt; `first` is the velocity at the start."""
    z0, p0 = [p.z for p in pieces], [p.phi for p in pieces]
    sz, sp = [0 * z for z in z0], [0 * p for p in p0]
    now, v = pieces, first
    for part, weight in ((0.5, 1), (0.5, 2), (1.0, 2), (None, 1)):
        rate = [0.5 * np.abs(v)**2 - gravity * p.z.imag for v, p in zip(v, now)]
        sz = [a + weight / 6 * b for a, b in zip(sz, v)]
        sp = [a + weight / 6 * b for a, b in zip(sp, rate)]
        if part is not None:
            now = [Piece(z + part * dt * a, q + part * dt * b, p.ends) for z, q, a, b, p in zip(z0, p0, v, rate, pieces)]
            v, *_ = velocity(now, plane)
    return [Piece(z + dt * a, q + dt * b, p.ends) for z, q, a, b, p in zip(z0, p0, sz, sp, pieces)]


def regrid(pieces, size):
    """Nodes anew on each piece with spacing size(arc length from the tip)."""
    out, behind = [], 0.0
    for p in reversed(pieces):
        s = np.linspace(0, p.s[-1], 40 * len(p.s))
        s = np.unique(np.concatenate([s, (p.s[:-1, None] + np.diff(p.s)[:, None] * np.arange(8) / 8).ravel()]))
        z = p.at(s)[0]
        arc = np.concatenate(([0], np.cumsum(np.abs(np.diff(z)))))
        to_tip = arc[-1] - arc + behind
        density = 1 / size(to_tip)
        count = np.concatenate(([0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(arc))))
        n = max(6, int(np.ceil(count[-1])))
        where = np.interp(np.linspace(0, count[-1], n + 1), count, s)
        where[0], where[-1] = p.s[0], p.s[-1]
        z, _, q = p.at(where)
        z[0], z[-1], q[0], q[-1] = p.z[0], p.z[-1], p.phi[0], p.phi[-1]
        out.append(Piece(z, q, p.ends))
        behind += arc[-1]
    return out[::-1]


def collapse(n2, h0, end_z=None, courant=0.5, tip0=0.02, grading=2.0, levels=(), quiet=False, keep=(), limit_s=1e9):
    """Runs a column of height n2. Rows: T, Z, front speed, area error, energy error, tip angle, nodes, x at heights."""
    gravity, plane = 1.0 / n2, Plane()
    end_z = end_z or (4.85 if n2 == 2 else 6.0)
    top = np.linspace(0, 1, 5) + 1j * n2
    face = 1 + 1j * np.linspace(n2, 0, 9)
    pieces = [Piece(top, 0 * top.real, ('wall', 'corner')), Piece(face, 0 * face.real, ('corner', 'tip'))]
    area0, energy0 = sums(pieces, gravity)
    t, rows, shapes, start = 0.0, [], [], time.time()
    keep = list(keep)
    while True:
        z_front = pieces[1].z[-1].real
        tip = h0 * np.clip(0.5 * (z_front - 1), tip0, 0.25)
        pieces = regrid(pieces, lambda s: np.minimum(h0, tip + grading * h0 * s))
        v, kinetic, _ = velocity(pieces, plane)
        area, potential = sums(pieces, gravity)
        face = pieces[1]
        angle = -np.degrees(np.angle(face.x(face.s[-1], 1) + 1j * face.y(face.s[-1], 1)))
        s = np.linspace(0, face.s[-1], 4000)
        fx, fy = face.x(s), face.y(s)
        last = [np.nonzero(fy >= y)[0][-1] for y in levels]  # where the surface last crosses these heights
        heights = [fx[i] + (fx[i + 1] - fx[i]) * (fy[i] - y) / (fy[i] - fy[i + 1]) for i, y in zip(last, levels)]
        rows.append([t, z_front, v[1][-1].real, area / area0 - 1, (kinetic + potential) / energy0 - 1, angle, sum(len(p.z) for p in pieces) - 1] + heights)
        if not quiet and len(rows) % 50 == 1:
            print(f'n2={n2} h0={h0} T={t:.4f} Z={z_front:.5f} u={rows[-1][2]:.4f} dA={rows[-1][3]:.1e} dE={rows[-1][4]:.1e} angle={angle:.1f} N={rows[-1][6]} {time.time()-start:.0f}s', flush=True)
        if keep and t >= keep[0] - 1e-12:
            shapes.append((t, np.concatenate([p.z for p in pieces])))
            keep.pop(0)
        if z_front > end_z or not np.isfinite(z_front) or abs(rows[-1][4]) > 0.05 or time.time() - start > limit_s:
            return np.array(rows), shapes
        dt = min(min(np.min(np.abs(np.diff(p.z)) / np.maximum(1e-9, np.maximum(np.abs(a[1:]), np.abs(a[:-1])))) for p, a in zip(pieces, v)) * courant,
                 0.25 * np.sqrt(min(np.min(np.abs(np.diff(p.z))) for p in pieces) / gravity))
        if keep and t < keep[0] < t + dt:
            dt = keep[0] - t
        pieces = step(pieces, plane, gravity, dt, v)
        t += dt


def front_at(rows, times):
    """Z at times, by Hermite splines of the rows."""
    return CubicHermiteSpline(rows[:, 0], rows[:, 1], rows[:, 2])(times)


def wave(nodes, amplitude=1e-3, depth=0.5, steps=40):
    """Standing wave, half a wave long, in a tank of length 1: error of its period by the crest's return, over steps of T/steps."""
    x = np.linspace(0, 1, nodes)
    z = x + 1j * (depth + amplitude * np.cos(np.pi * x))
    pieces, plane = [Piece(z, 0 * x, ('wall', 'wall'))], Plane(1.0)
    omega = np.sqrt(np.pi * np.tanh(np.pi * depth))
    dt, worst = 2 * np.pi / omega / steps, 0.0
    area0, _ = sums(pieces, 1.0)
    for k in range(1, steps + 1):
        v, *_ = velocity(pieces, plane)
        pieces = step(pieces, plane, 1.0, dt, v)
        p = pieces[0]
        even = np.linspace(0, 1, 201)
        s = np.interp(even, p.x(np.linspace(0, p.s[-1], 4001)), np.linspace(0, p.s[-1], 4001))
        mode = 2 * np.trapezoid((p.y(s) - depth) * np.cos(np.pi * even), even)
        worst = max(worst, abs(mode / amplitude - np.cos(omega * k * dt)))
    return worst, sums(pieces, 1.0)[0] / area0 - 1


def first_instant(n2, h0, tip0=0.02, grading=2.0):
    """Acceleration of the face at t = 0+ against the series of the linear problem; worst error beyond y."""
    top, face = np.linspace(0, 1, 5) + 1j * n2, 1 + 1j * np.linspace(n2, 0, 9)
    pieces = [Piece(top, -top.imag, ('wall', 'corner')), Piece(face, -face.imag, ('corner', 'tip'))]
    tip = h0 * tip0
    pieces = regrid(pieces, lambda s: np.minimum(h0, tip + grading * h0 * s))
    a = velocity(pieces, Plane())[0]
    y = pieces[1].z.imag[1:-1]
    k = (np.arange(1, 200001) - 0.5) * np.pi
    exact = np.array([np.sum(2 / k * np.exp(-k * v) * (1 - np.exp(-2 * k * (n2 - v))) / (1 + np.exp(-2 * k * n2))) for v in y])
    error = np.abs(a[1].real[1:-1] - exact)
    tops = a[0].imag[0]
    exact_top = -1 + np.sum(2 / k * (-1.0)**np.arange(len(k)) / np.cosh(np.minimum(k * n2, 700)))
    return len(y), error[y > 0.01].max(), error.max(), y[np.argmax(error)], tops - exact_top


if __name__ == '__main__':
    what = sys.argv[1]
    if what == 'checks':
        for n in (11, 21, 41, 81):
            print('wave', n, wave(n, steps=80))
        for n in (21,):
            print('wave amplitude', [(a, wave(n, a, steps=80)[0]) for a in (1e-2, 1e-3, 1e-4)])
        for n2 in (2, 1):
            for h in (0.1, 0.05, 0.025):
                print('t=0+', n2, h, first_instant(n2, h))
    else:
        n2, h0 = int(sys.argv[2]), float(sys.argv[3])
        more = json.loads(sys.argv[4]) if len(sys.argv) > 4 else {}
        name = more.pop('name', f'run-{n2}-{h0:g}')
        rows, shapes = collapse(n2, h0, levels=(1 / 24, 1 / 36, 1 / 48, 1 / 12, 1 / 18), keep=(0.5, 1, 1.5, 2, 2.5, 3), **more)
        np.savez(f'{name}.npz', rows=rows, **{f'shape{t:.1f}': z for t, z in shapes})
        print('end', rows[-1])
