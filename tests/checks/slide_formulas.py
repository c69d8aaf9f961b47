"""The slides' formulas once more, for checks/frame_numbers.py: energies, gradients,
Hessians, projection, Newton's method, the steps of the methods.  Nothing here
is taken from the sources; energies are in extended precision."""
import math
from types import SimpleNamespace as Record

import numpy as np

LONG = np.longdouble
GIVEN = ("h stiffness tolerance stretch side density mu damping slip_speed yield_strain"
         " hardening segments gravity").split()

def square(n, side=1.0, density=1000.0, k=1e5, stretch=1.4):
    """square_mesh.py of the slides: nodes, springs, masses, lengths."""
    node = np.array([(i, j) for i in range(n + 1) for j in range(n + 1)])
    at = lambda i, j: i * (n + 1) + j
    e = [(at(i, j), at(i + 1, j)) for i in range(n) for j in range(n + 1)]
    e += [(at(i, j), at(i, j + 1)) for i in range(n + 1) for j in range(n)]
    for i in range(n):
        for j in range(n):
            e += [(at(i, j), at(i + 1, j + 1)), (at(i + 1, j), at(i, j + 1))]
    x = side * (node / n - 0.5)
    e = np.array(e)
    d = x[e[:, 0]] - x[e[:, 1]]
    count = len(x)
    body = Record(m=np.full(count, density * side**2 / count), e=e, g=np.zeros(2),
                  l2=(d * d).sum(1), k=np.full(len(e), float(k)), rest=x,
                  pinned=np.zeros(count, bool), omega2=0.0, cells=None,
                  obstacles=[], hand=None, yield_strain=0, hardening=0, eta=0)
    return body, x * (stretch, 1)

def f_barrier(s):
    inside = s < 1
    s = np.where(inside, s, 1)
    return np.where(inside, (s - 1) * np.log(s), 0)

def f_slope(s):
    return np.log(s) + 1 - 1 / s if s < 1 else 0.0

def f_bend(s):
    return (1 + s) / s**2 if s < 1 else 0.0

D_CELL = np.zeros((4, 6))
D_CELL[:, 2:] = np.eye(4)
D_CELL[:2, :2] = D_CELL[2:, :2] = -np.eye(2)
S_CELL = np.array([[0, 0, 0, 1], [0, 0, -1, 0], [0, -1, 0, 0], [1, 0, 0, 0.0]])
Q_CELL = D_CELL.T @ S_CELL @ D_CELL

def strains(b, x):
    d = x[b.e[:, 0]] - x[b.e[:, 1]]
    q = (d * d).sum(1)
    return d, q, (q - b.l2) / b.l2

def law(b, E, n=None):
    """V(E), V', V'' of each spring: elastic, plastic (n.ep, n.kappa: what has
    flowed so far), damped (n.E: strain at the step's start, n.theta)."""
    ep = n.ep if n is not None and b.yield_strain else 0
    e = E - ep
    V, tau, bend = e * e / 2, e, np.ones_like(e)
    if b.yield_strain:
        over = abs(e) - (b.yield_strain + b.hardening * n.kappa)
        over = np.where(over > 0, over, 0)
        flow = 1 / (1 + b.hardening)
        V = V - over**2 * flow / 2
        tau = tau - np.sign(e) * flow * over
        bend = np.where(over > 0, 1 - flow, 1)
        V = V + b.hardening * n.kappa**2 / 2
    if n is not None and getattr(n, "theta", 0):
        V = V + n.theta * (E - n.E)**2 / 2
        tau = tau + n.theta * (E - n.E)
        bend = bend + n.theta
    return V, tau, bend

def touching(b, x):
    """Pairs within d_hat: obstacle, node, gap, direction to the node, |x - x_b|."""
    for o in b.obstacles:
        if o.kind == 0:
            r, d = np.full(len(x), math.inf), (x - o.o) @ o.n
        else:
            way = x - (x[o.node] if o.node >= 0 else o.o)
            r = np.sqrt((way * way).sum(1))
            d = r - o.radius
        if o.other >= 0:
            d[o.other] -= o.ball_radius
        near = d < b.d_hat
        if o.node >= 0:
            near[o.node] = False
        else:
            near &= ~b.pinned
        for i in np.flatnonzero(near):
            yield o, i, d[i], o.n if o.kind == 0 else way[i] / r[i], r[i]

def cell_J(b, x):
    whole = (b.k[b.sides] > 0).all(1)
    y = x[b.cells[whole]].reshape(-1, 6)
    return y, np.einsum("ti,ij,tj->t", y, Q_CELL, y) / 2 / (2 * b.area), whole

def potential(b, x, n=None):
    """P(x) by its parts, J."""
    x = np.asarray(x, LONG)
    V = law(b, strains(b, x)[2], n)[0]
    part = dict(elastic=(b.k * b.l2 * V).sum(), contact=LONG(0), hand=LONG(0),
                gravity=-(b.m[:, None] * b.g * x).sum())
    part["elastic"] += b.omega2 * (b.m * (x * x).sum(1)).sum() / 2
    for o, i, d, _, _ in touching(b, x):
        part["contact"] += b.c * f_barrier(d / b.d_hat)
    if b.cells is not None:
        part["contact"] += b.c_cell * f_barrier(cell_J(b, x)[1] / 0.4).sum()
    if b.hand is not None:
        d = x[int(b.hand[0])] - b.hand[2:]
        part["hand"] = b.hand[1] * (d * d).sum() / 2
    return part

def blocks(b, x, n=None):
    """What P is made of: nodes, gradient, Hessian of each kind of piece."""
    d, q, E = strains(b, x)
    _, tau, bend = law(b, E, n)
    dd = d[:, :, None] * d[:, None, :]
    H = (2 * b.k / b.l2)[:, None, None] * (
        (b.l2 * tau)[:, None, None] * np.eye(2) + (2 * bend)[:, None, None] * dd)
    sign = np.array([[1, -1], [-1, 1]])
    yield (b.e, np.concatenate([f := (2 * b.k * tau)[:, None] * d, -f], 1),
           np.einsum("ab,sij->saibj", sign, H).reshape(-1, 4, 4))
    if b.omega2:
        i = np.arange(len(x))[:, None]
        yield (i, b.omega2 * b.m[:, None] * x,
               b.omega2 * b.m[:, None, None] * np.eye(2))
    if b.hand is not None:
        i = int(b.hand[0])
        yield (np.array([[i]]), b.hand[1] * (x[i] - b.hand[2:])[None],
               b.hand[1] * np.eye(2)[None])
    for o, i, dist, u, r in touching(b, x):
        s, c = dist / b.d_hat, b.c / b.d_hat
        h2 = c / b.d_hat * f_bend(s) * np.outer(u, u)
        if r < math.inf:
            h2 = h2 + c * f_slope(s) / r * (np.eye(2) - np.outer(u, u))
        g = c * f_slope(s) * u
        if o.node >= 0:
            yield (np.array([[i, o.node]]), np.concatenate([g, -g])[None],
                   np.kron(sign, h2)[None])
        else:
            yield np.array([[i]]), g[None], h2[None]
    if b.cells is not None:
        y, J, whole = cell_J(b, x)
        near = J < 0.4
        y, s = y[near], J[near] / 0.4
        gJ = y @ Q_CELL / (2 * b.area)
        f1 = b.c_cell / 0.4 * np.array([f_slope(a) for a in s])
        f2 = b.c_cell / 0.16 * np.array([f_bend(a) for a in s])
        yield (b.cells[whole][near], f1[:, None] * gJ,
               f2[:, None, None] * gJ[:, :, None] * gJ[:, None, :]
               + f1[:, None, None] * Q_CELL / (2 * b.area))

def friction(b, n, x, h):
    """Pairs of the step's start (n.x, obstacles n.body): W, gradient, t t^T."""
    rows = []
    for o, i, d, u, _ in touching(n.body, n.x):
        if not o.mu > 0:
            continue
        now = b.obstacles[o.number]
        t = np.array([-u[1], u[0]])
        weight = -o.mu * n.body.c / n.body.d_hat * f_slope(d / n.body.d_hat)
        ball = x[o.node] - n.x[o.node] if o.node >= 0 else 0 * u
        carry = h * (t @ now.v)
        y, e = t @ (x[i] - n.x[i] - ball) - carry, b.slip_speed * h
        a = min(abs(y) / e, 1)
        value = abs(y) - e / 3 if a == 1 else y * y / e * (1 - a / 3)
        rows.append(Record(o=o, i=i, t=t, weight=weight, y=y, carry=carry,
                           value=value, slope=np.sign(y) * a * (2 - a),
                           bend=2 / e * max(0, 1 - a)))
    return rows

def projected(H, way):
    """Eigenvalues below 0 set to 0, or with "abs" to their size; how many
    blocks had one: at least, most."""
    low, V = np.linalg.eigh(H)
    size = np.abs(low).max(1)
    sure = (low[:, 0] < -1e-9 * size).sum()
    most = sure + ((np.abs(low[:, 0]) <= 1e-9 * size) & (size > 0)).sum()
    rough = (low[:, 0] < -1e-12 * size)[:, None, None]
    P = np.einsum("nij,nj,nkj->nik", V, 
                  abs(low) if way == "abs" else np.maximum(low, 0), V)
    return np.where(rough, P, H), sure, most

class Step:
    """E of one step of backward Euler, from x and v at its start."""

    def __init__(self, b, x, v, h, ep=None, kappa=None, before=None):
        self.b, self.h, self.w, self.x_n = b, h, h * h, x
        self.tilde, self.start = x + h * v + self.w * b.g, x.copy()
        self.free = np.repeat(~b.pinned, 2)
        self.n = Record(ep=ep, kappa=kappa, x=x, body=before or b,
                        E=strains(b, x)[2], theta=b.eta / h)

    def rubs(self, x):
        return friction(self.b, self.n, x, self.h) if self.b.obstacles else []

    def value(self, x):
        x = np.asarray(x, LONG)
        du = (x - self.tilde)[~self.b.pinned]
        part = potential(self.b, x, self.n)
        P = part["elastic"] + part["contact"] + part["hand"]
        P += sum(r.weight * r.value for r in self.rubs(x))
        return (self.b.m[~self.b.pinned][:, None] * du * du).sum() / 2 + self.w * P

    def change(self, x, p, alpha):
        """E(x + alpha p) - E(x), springs and inertia without cancellation."""
        b = self.b
        if b.obstacles or b.cells is not None or b.yield_strain:
            x, p = np.asarray(x, LONG), np.asarray(p, LONG)
            return self.value(x + alpha * p) - self.value(x)
        x, p, alpha = np.asarray(x, LONG), np.asarray(p, LONG), LONG(alpha)
        m = b.m[:, None]
        sum_ = (m * p * (alpha * (x - self.tilde) + alpha**2 * p / 2))
        sum_ = sum_[~b.pinned].sum()
        d, _, E = strains(b, x)
        q = p[b.e[:, 0]] - p[b.e[:, 1]]
        D = (2 * alpha * (d * q).sum(1) + alpha**2 * (q * q).sum(1)) / b.l2
        for part, E0 in (1, 0), (self.n.theta, self.n.E):
            sum_ += self.w * part * (b.k * b.l2 * ((E - E0) * D + D * D / 2)).sum()
        x0 = x + alpha * p / 2 # the field's energy is a parabola
        sum_ += self.w * alpha * b.omega2 * (m * p * x0).sum()
        if b.hand is not None:
            i = int(b.hand[0])
            sum_ += self.w * b.hand[1] * (
                alpha * p[i] * (x[i] - b.hand[2:]) + alpha**2 * p[i]**2 / 2).sum()
        return sum_

    def direction(self, x, way="clamp"):
        """p, its slope, and how many blocks were projected: least, most."""
        b, size = self.b, 2 * len(x)
        g = (b.m[:, None] * (x - self.tilde)).reshape(-1)
        H = np.diag(np.repeat(b.m, 2))
        counts = np.zeros(2, int)
        pieces = list(blocks(b, x, self.n))
        for r in self.rubs(x):
            i = [r.i] + ([r.o.node] if r.o.node >= 0 else [])
            t = np.concatenate([r.t, -r.t][:len(i)])
            pieces.append((np.array([i]), (r.weight * r.slope * t)[None],
                           (r.weight * r.bend * np.outer(t, t))[None]))
        f = self.free
        if way == "on-demand":  # where the Hessian as it is will not do
            p, slope, _ = self.direction(x, "none")
            try:
                np.linalg.cholesky(self.H[np.ix_(f, f)])
                return p, slope, counts
            except np.linalg.LinAlgError:
                pass
        for nodes, gradient, hessian in pieces:
            if not len(nodes):
                continue
            if way != "none":
                hessian, least, most = projected(hessian, way)
                counts += (least, most)
            at = (2 * nodes[:, :, None] + np.arange(2)).reshape(len(nodes), -1)
            np.add.at(g, at, self.w * gradient)
            np.add.at(H, (at[:, :, None], at[:, None, :]), self.w * hessian)
        p = np.zeros(size)
        p[f] = -np.linalg.solve(H[np.ix_(f, f)], g[f])
        self.g, self.H = g, H
        return p.reshape(-1, 2), float(g[f] @ p[f]), counts

    def residual(self, p):
        return np.abs(p).sum(1).max() / self.h

    def minimise(self, tolerance, way="clamp", search=True, most=300):
        """Algorithm 3: a record of each update."""
        x, records = self.start.copy(), []
        while len(records) < most:
            p, slope, counts = self.direction(x, way)
            r = Record(x=x, p=p, slope=slope, residual=self.residual(p),
                       alpha=1.0, projected=counts)
            if not r.residual > tolerance:
                break
            while search and self.change(x, p, r.alpha) > 0 and r.alpha > 1e-20:
                r.alpha /= 2
            if r.alpha < 1e-20:
                r.alpha = 0
                return records + [r], x
            r.change = self.change(x, p, r.alpha)
            x = x + r.alpha * p
            records.append(r)
        return records, x

def force(b, x, n=None):
    """m g - grad P, N."""
    f = b.m[:, None] * b.g * np.ones_like(x)
    for nodes, gradient, _ in blocks(b, x, n):
        for k in range(nodes.shape[1]):
            np.add.at(f, nodes[:, k], -gradient[:, 2 * k:2 * k + 2])
    return f

def acceleration(b, x):
    return np.where(b.pinned[:, None], 0, force(b, x) / b.m[:, None])

def symplectic_euler(b, x, v, h):
    v = v + h * acceleration(b, x)
    return x + h * v, v

def scalar_newton(f, x, tolerance, search=False, most=60):
    """Algorithm 1 in one variable; f gives value, slope, curvature."""
    records = []
    while True:
        value, g, H = f(x)
        p = -g / H if H else math.inf
        if not math.isfinite(p) or abs(g) <= tolerance or len(records) == most:
            return records, x, p
        alpha = 1.0
        while search and f(x + alpha * p)[0] - value > 0 and alpha > 1e-20:
            alpha /= 2
        records.append(Record(x=x, p=p, alpha=alpha, slope=g * p,
                              change=f(x + alpha * p)[0] - value))
        x = x + alpha * p

def log_two_cosh(x):
    c = math.cosh(x) if abs(x) < 700 else math.inf
    return abs(x) + math.log1p(math.exp(-2 * abs(x))), math.tanh(x), 1 / c / c

def line_energy(target, h, m=1.0, k=10.0, l2=1.0):
    def E(x):
        s = x * x / l2 - 1
        return (m / 2 * (x - target)**2 + h * h * l2 * k / 2 * s * s,
                m * (x - target) + 2 * h * h * k * x * s,
                m + 2 * h * h * k * (3 * x * x / l2 - 1))
    return E
