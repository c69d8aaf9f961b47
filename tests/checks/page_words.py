"""What the pages of the lecture say, calculated again, for frame_numbers.py: WORDS
has for each page parts of its sentences, with # for each number, and what these
are, as RULES has it; a function is asked without arguments."""
import functools
import math

import numpy as np

from slide_formulas import (Record, Step, explicit, line_energy, log_two_cosh,
                            potential, scalar_newton, square)

class Is:
    """A number of which something must hold; words say what."""

    def __init__(self, test, words="so"):
        self.test, self.words = test, words

S4, X4 = square(4)
TURN = 2 * math.pi
TAN = math.tan(math.radians(20))
cached = functools.lru_cache(None)

# ---- the mesh

def polynomials():
    """a, b, c of (n + a)^2 nodes and b n^2 + c n springs, from two squares."""
    one, two = (len(square(n)[0].e) for n in (1, 2))
    b = (two - 2 * one) // 2
    return math.isqrt(len(S4.m)) - 4, b, one - b

def kinds(n):
    b, x = square(n)
    d = np.abs(x[b.e[:, 0]] - x[b.e[:, 1]]) > 1e-9
    return ((d[:, 0] & ~d[:, 1]).sum(), (d[:, 1] & ~d[:, 0]).sum(), d.all(1).sum())

def node(n, i, j):
    x = square(n, stretch=1)[1] * n + n / 2
    return next(k for k in range(len(x)) if np.allclose(x[k], (i, j)))

@cached
def relaxed(steps=50):
    """The default square: x and total energy after each step."""
    x, v, rows = X4, 0 * X4, []
    for _ in range(steps):
        new = Step(S4, x, v, 0.004).minimise(0.01)[1]
        v, x = (new - x) / 0.004, new
        rows.append((x, sum(potential(S4, x).values())
                     + (S4.m[:, None] * v * v).sum() / 2))
    return rows

# ---- one mass, the circle, explicit steps

def euler(method, h=0.5, w=1.0, steps=1):
    x, v, rows = np.array([1.0, 0]), np.array([0, w]), []
    for _ in range(steps):
        if method == "backward-euler":
            v = (v - h * w * w * x) / (1 + (h * w)**2)
            x = x + h * v
        else:
            old, v = v, v - h * w * w * x
            x = x + h * (old if method == "forward-euler" else v)
        rows.append((x, v))
    return rows

def one_step(method):
    return (1, 0, 0, 1, 0.5, *euler(method)[0][0])

def factor(method):
    x, v = euler(method)[0]
    E = (x @ x + v @ v) / 2
    return [Is(lambda one: np.isclose(max(E, 1 / E), one + 0.25))]

def far(h, w, steps):
    return max(np.hypot(*x) for x, _ in euler("symplectic-euler", h, w, steps))

def flies(h):
    return far(h, 1, 400) > 100

def kept(steps):
    rows = euler("symplectic-euler", 0.5, 1, int(steps))
    return np.ptp([x @ x + v @ v - 0.5 * x @ v for x, v in rows]) < 1e-11

@cached
def overflows(h, steps, stretch=1.4, method="symplectic-euler", limit=math.inf):
    """The step in which the square is beyond a limit."""
    b, x = square(4, stretch=stretch)
    v = 0 * x
    for n in range(steps):
        x, v = explicit(b, x, v, h, method)
        if not np.abs(x).max() < limit:
            return n + 1
    return math.inf

def ends(h):
    b, x, v = S4, X4, 0 * X4
    for _ in range(3):
        records, new = Step(b, x, v, h).minimise(0.01)
        v, x = (new - x) / h, new
        if len(records) == 300:
            return False
    return True

# ---- Newton in one variable and on the map

@cached
def tangent():
    return scalar_newton(line_energy(2, 0.3), 2.5, 1e-10)

def bend():  # g"/(2 g') at the root
    root = tangent()[1]
    return 2 * 0.09 * 10 * 6 * root / 2 / line_energy(2, 0.3)(root)[2]

@cached
def swings(start, search=False):
    return scalar_newton(log_two_cosh, start, 1e-10, search)

def converges(start):
    return abs(swings(start)[1]) < 1e-9

def after(n):
    r = swings(2)[0][n - 1]
    return r.x + r.p

BEYOND = Is(lambda x: x < abs(after(2)) < 1.2 * x)
SWINGS = Is(lambda x: x == 1.09 and not converges(x) and sum(
    abs(r.x + r.p) > abs(r.x) for r in swings(x)[0]) >= 7)
LENGTHS = [r.alpha for r in swings(2, True)[0]]

def map_step(x, y, h=0.2):
    """The landscape: two springs of 1.5 m from pins 2 m apart to one mass."""
    b = Record(**{**vars(S4), "m": np.ones(3), "e": np.array([[0, 1], [0, 2]]),
                  "l2": np.full(2, 2.25), "k": np.full(2, 100.0),
                  "pinned": np.array([False, True, True])})
    at = np.array([[x, y], [-1, 0], [1, 0.0]])
    E = Step(b, at, 0 * at, h)
    E.tilde[0] = (0.2, 0.3)
    return E, at

def slope(x, y, way):
    E, at = map_step(x, y)
    return E.direction(at, way)[1]

def plain_updates():
    return map_step(0.6, 0.9)[0].minimise(1e-6, "none", False)[0]

def unsolved():
    E, _ = map_step(0.6, 0.9)
    worst = 0
    for r in plain_updates():
        p = E.direction(r.x, "none")[0].reshape(-1)
        worst = max(worst, np.abs(E.H @ p + E.g)[:2].max() / np.abs(E.g[:2]).max())
    return worst

def saddle(x, y):
    E, _ = map_step(x, y)
    end = E.minimise(0, "none", False, 8)[1]
    p = E.direction(end, "none")[0]
    low, high = np.linalg.eigvalsh(E.H[:2, :2])
    return bool(low < 0 < high and np.abs(p[0]).max() < 1e-9)

@cached
def way_off(h):
    """Of the minimiser for this h: from x_tilde, and from the rest lengths."""
    x = (0.2, 0.3)
    for g in np.geomspace(1e-4, h, 30):
        E, _ = map_step(*x, h=g)
        x = E.minimise(1e-13 / g)[1][0]
    return (np.hypot(x[0] - 0.2, x[1] - 0.3),
            max(abs(np.hypot(x[0] + s, x[1]) - 1.5) for s in (-1, 1)))

# ---- first steps of the square

@cached
def first(n, h, stretch, way, search, tolerance=0.01):
    b, x = square(n, stretch=stretch)
    E = Step(b, x, 0 * x, h)
    records = E.minimise(tolerance, way, search)[0]
    return records, max(float(E.value(r.x + r.alpha * r.p) - E.value(x))
                        for r in records)

def explosion(way="none", search=False):
    return first(3, 0.02, 0.485, way, search)

RISE = Is(lambda x: x < 1.3 * explosion()[1] < 4 * x)

def lengths():
    return [r.alpha for r in first(4, 0.1, 0.2, "clamp", True)[0]]

def squeezed():
    return first(4, 0.02, 0.5, "clamp", True)[0]

def updates(tolerance):
    return first(4, 0.004, 1.4, "clamp", True, tolerance)[0]

def falls(i):
    r = [u.residual for u in updates(1e-6)]
    return r[i] / r[i + 1], 2

def root_curvature(r=1e-3, e=1e-6):  # of 2 (|x| - 1)^2, across
    P = lambda y: 2 * (math.hypot(r, y) - 1)**2
    return (P(e) - 2 * P(0) + P(-e)) / e**2, 4

def one_spring(x, y, k=100.0):
    s = x * x + y * y - 1
    return (k / 2 * s * s, 5), (-2 * k * s * x, 5), (-2 * k * s * y, 5)

# ---- whole runs, played once in long tests: their states by name

PLAYED = {}
RUNS = {"drop": "drop", "slope": "slope", "0.41": "slope --friction 0.41",
        "0.32": "slope --friction 0.32", "dent": "dent", "tear": "tear"}

def of(name, test):
    """Of the states of a run; without them the number is taken as it is."""
    return Is(lambda x: name not in PLAYED or test(PLAYED[name], x), "of " + name)

def gaps(states):
    return min(((s.x - o.o) @ o.n).min() if o.kind == 0 else
               np.hypot(*(s.x - o.o).T).min() - o.radius
               for s in states for o in s.b.obstacles)

def slid(states, run):
    return np.hypot(*(states[300].runs[run].x - states[0].runs[run].x).mean(0))

def broken(states, step):
    return (states[int(step)].b.k == 0).sum() - (states[0].b.k == 0).sum()

def adds_up(states):
    """What backward Euler takes is never below 0, beside all that is booked."""
    lost = [float(s.energy("dissipated")) for s in states]
    return min(np.diff(lost)) > -1e-6 * states[0].size()

@cached
def order(method):
    """Error of 64 steps in 0.064 s over that of 128; by a finer run."""
    b, x0 = square(4, stretch=1.1)

    def end(steps, method):
        x, v, h = x0, 0 * x0, 0.064 / steps
        for _ in range(steps):
            if method in ("forward-euler", "symplectic-euler", "verlet"):
                x, v = explicit(b, x, v, h, method)
                continue
            half = method == "midpoint"
            E = Step(b, x, v / 2 if half else v, h)
            E.w *= 0.25 if half else 1
            u = E.minimise(1e-9)[1] - x
            x, v = (x + 2 * u, 4 * u / h - v) if half else (x + u, u / h)
        return x
    exact = end(1024, "verlet")
    errors = [np.abs(end(n, method) - exact).max() for n in (64, 128)]
    return math.log2(errors[0] / errors[1])

def divides(*methods):
    return Is(lambda n: not PLAYED or all(
        abs(order(m) - math.log2(n)) < 0.2 for m in methods))

FROM_1_0 = "One step from (#, #) with v = (#, #) and h = # leads to (#, #)"
WORDS = {
    "solid": [
        ("With # segments # masses and # springs, with n (n + #)² and #n² + #n:",
         lambda: [4, len(S4.m), len(S4.e), *polynomials()]),
        ("the same # kg", [S4.m.sum()]),
        ("# segments give # masses and # springs", [4, len(S4.m), len(S4.e)]),
        ("have # kg", lambda: [square(7)[0].m.sum()])],
    "mesh": [
        ("node i (n + #) + j", lambda: [node(5, 1, 0) - 5]),
        ("With n = #: # lower left, # upper right", [2, node(2, 0, 0), node(2, 2, 2)]),
        ("# springs are horizontal, # vertical, # diagonal", lambda: kinds(2)),
        ("# segments node # is above node # and node # to its right",
         [2, node(2, 0, 1), node(2, 0, 0), node(2, 1, 0)]),
        ("joins # and #,", lambda: square(2)[0].e[0]),
        ("is # or #.", lambda: sorted(set(square(2)[0].l2.round(9))))],
    "equation": [
        ("the # masses is # kg", [len(S4.m), S4.m[0]]),
        ("after # steps the middle of the square has not moved", [Is(
            lambda n: np.abs(relaxed()[int(n) - 1][0].mean(0)).max() < 1e-12)])],
    "forward": [(FROM_1_0, lambda: one_step("forward-euler")),
                ("the energy by # + h²", lambda: factor("forward-euler"))],
    "symplectic": [
        ("From h = # s on the mass flies away",
         [Is(lambda h: flies(h) and not flies(0.99 * h))]),
        ("through # steps with h = #.", [Is(kept), 0.5])],
    "backward": [(FROM_1_0, lambda: one_step("backward-euler")),
                 ("the energy by # + h²", lambda: factor("backward-euler"))],
    "stability": [
        ("√(# + h²ω²)", [1]),
        ("h = # s each step of forward Euler multiplies the radius by #", lambda: [
            0.02, (np.hypot(*euler("forward-euler", 0.02, TURN)[0][0]), 6)]),
        ("Above #/ω = # s the", [2, 2 / TURN]),
        ("within # percent", [Is(
            lambda p: 0.75 * p < 100 * far(0.02, TURN, 500) - 100 < p)]),
        ("with # s within # m, with # s not for # steps", [
            0.31, Is(lambda m: 0.75 * m < far(0.31, TURN, 1000) < m), 0.33,
            Is(lambda n: far(0.33, TURN, int(n)) > 7)])],
    "explicit": [
        ("h down to # s", [Is(lambda h: overflows(h, 300) == math.inf)]),
        ("h = # s symplectic Euler overflows within # steps, with # s it swings on for "
         "#; backward Euler ends every step with # s and with # s", [
             0.008, Is(lambda n: overflows(0.008, int(n)) <= n), 0.003,
             Is(lambda n: overflows(0.003, int(n)) == math.inf), Is(ends), Is(ends)])],
    "tangent": [
        ("From # six updates reach the root #, and near it each error is g″/(# g′) = # "
         "times", lambda: [Is(lambda x: x == 2.5 and len(tangent()[0]) == 6),
                           (tangent()[1], 6), 2, (bend(), 2)])],
    "newton": [
        ("(#, #) Algorithm 1 needs # updates", lambda: [0.6, 0.9, len(plain_updates())]),
        ("to # digits", [Is(lambda n: unsolved() < 10**-n)]),
        ("from (#, #) it ends on a saddle", lambda: [0.05, -0.05, saddle(0.05, -0.05)])],
    "overshoot": [
        ("from # the first step leads to # and the next one beyond #",
         lambda: [2, after(1), BEYOND]),
        ("nearer to # than # it converges", [
            0, Is(lambda x: converges(x) and not converges(x + 1e-4))]),
        ("From # the first update leads to # and the next beyond #; from # it "
         "converges, from # it makes",
         lambda: [2, (after(1), 5), BEYOND, Is(converges), SWINGS])],
    "explodes": [
        ("E rises to #, nodes fly over a kilometre", [RISE]),
        ("E rises above # and", [RISE]),
        ("tames it: # updates", lambda: [len(explosion("clamp")[0])]),
        ("it converges in # updates", lambda: [len(explosion("clamp")[0])])],
    "dial": [
        ("h = # ms the minimiser is within # mm of x̃, at # s within # mm of rest", [
            1, Is(lambda mm: way_off(1e-3)[0] < 1e-3 * mm), 10,
            Is(lambda mm: way_off(10)[1] < 1e-3 * mm)])],
    "inertia": [("At (#, #) it is # J s²", [0.6, 0.9, (0.4**2 + 0.6**2) / 2])],
    "alpha": [
        ("at α = # it may be", [Is(lambda a: min(lengths()) < a)]),
        ("In the first step α = # would raise E, and one of its updates is made with "
         "α = #", [Is(lambda a: min(lengths()) < a), Is(lambda a: a in lengths())])],
    "algorithm2": [
        ("Begin with α = #", [1]),
        ("From # the first step takes α = #, the second #, all others #",
         [2, LENGTHS[0], LENGTHS[1], Is(lambda x: set(LENGTHS[2:]) == {x})]),
        ("From # the step lengths are #, #, #, #, #, #,", [2, *LENGTHS])],
    "descent": [
        ("negative eigenvalues set to #", [0]),
        ("At (#, #) ∇E·p is above # without and below # with projection; from each of "
         "# starts", [
             0.1, -0.35, Is(lambda s: slope(0.1, -0.35, "none") > s),
             Is(lambda s: slope(0.1, -0.35, "clamp") < s),
             Is(lambda n: n == 17**2 and all(
                 slope(x, y, "clamp") < 0 for x in np.linspace(-1.6, 1.6, 17)
                 for y in np.linspace(-1.6, 1.6, 17)))])],
    "psd": [
        ("replaced by #", [0]), ("set to #", [0]), ("leaves only #", [0]),
        ("above # m nothing is changed, below # m nothing", [1, 1 / math.sqrt(3)]),
        ("has the eigenvalues #, #, and twice", lambda: np.sort(np.abs(
            np.linalg.eigvalsh(np.kron([[1, -1], [-1, 1]], [[3, 1], [1, 2.0]]))))[:2]
         .round(9))],
    "energy": [
        ("smooth even at length #", [0]), ("kink at length #", [0]),
        ("At length # one", [0]), ("the curvature #k along", [4]),
        ("At # mm the curvature across is -2k for P and # k with",
         lambda: [1, root_curvature()])],
    "force": [("At d = (#, #) the energy is # J and the force (#, #) N",
               lambda: [1.2, 0.5, *one_spring(1.2, 0.5)])],
    "potential": [
        ("a # × # block", [2, 2]),
        ("# + # × # triplets fall on # of the # places", [
            2 * len(S4.m), len(S4.e), 16, 4 * (2 * len(S4.e) + len(S4.m)),
            4 * len(S4.m)**2])],
    "algorithm3": [
        ("projects # of # springs, takes # updates with α = #", lambda: [
            Is(lambda n: squeezed()[0].projected[0] <= n <= squeezed()[0].projected[1]),
            len(S4.e), len(squeezed()),
            Is(lambda a: {r.alpha for r in squeezed()} == {a})])],
    "step": [
        ("as in numpy for an n × # array", [2]),
        ("by a factor of #, then of #", lambda: [falls(0), falls(1)]),
        ("up to # m/s, as on", [0.01]),
        ("tolerance of # m/s costs # updates more than # m/s",
         lambda: [1e-6, len(updates(1e-6)) - len(updates(1e-2)), 1e-2])],
    "simulator": [
        ("In # steps every one converges", [Is(lambda n: n == 50 and all(
            b[1] < a[1] for a, b in zip(relaxed(), relaxed()[1:])))])],
    "contact": [
        ("In # steps every one converges, and no node comes nearer to floor or walls "
         "than # mm", [of("drop", lambda s, n: n == 300),
                       of("drop", lambda s, mm: gaps(s[:301]) > 1e-3 * mm)])],
    "friction": [
        ("a slope of #°", [20]), ("tan #° = #", [20, TAN]),
        ("the blocks have #, #, # times it. Above # the second",
         [0.5, 0.9, 1.1, TAN / 0.9]),
        ("In # s the first block slides more than # m along, the last one less than # "
         "cm. With μ = # the second one comes to rest within # cm, with # it does not; "
         "with μ = # the third one slides more than # cm", [
             3, of("slope", lambda s, m: slid(s, 0) > m),
             of("slope", lambda s, cm: slid(s, 2) < cm / 100), 0.41,
             of("0.41", lambda s, cm: slid(s, 1) < cm / 100),
             Is(lambda mu: 0.9 * mu < TAN), 0.32,
             of("0.32", lambda s, cm: slid(s, 2) > cm / 100)])],
    "inelastic": [
        ("After # steps a spring has a plastic strain above #, all", [
            of("dent", lambda s, n: n == 300 and adds_up(s) and gaps(s) > 0),
            of("dent", lambda s, e: np.abs(s[300].n.ep).max() > e)])],
    "fracture": [
        ("In the first # steps no spring breaks, after # steps more than # have", [
            of("tear", lambda s, n: broken(s, n) == 0),
            of("tear", lambda s, n: n == 100),
            of("tear", lambda s, n: broken(s, 100) > n)])],
    "race": [
        ("divides the error by # for the Euler methods, by # for Verlet and midpoint, "
         "by # for AVF of #th order", [
             divides("forward-euler", "symplectic-euler", "backward-euler"),
             divides("verlet", "midpoint"), 16, 4]),
        ("With # ms Verlet explodes after the race, with # ms it does not", [
            Is(lambda ms: overflows(ms / 1e3, 1000, 1.1, "verlet", 10) < math.inf),
            Is(lambda ms: overflows(ms / 1e3, 1000, 1.1, "verlet", 10) == math.inf)])],
    "trust": [
        ("over # powers of ten", [21]),
        ("In # of the # cells every", None),  # see frame_numbers.py
        ("at least # of # converge", [97, 100])],  # the stress tests hold this
}
