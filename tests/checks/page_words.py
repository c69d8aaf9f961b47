"""What the pages of the lecture say, calculated again, for frame_numbers.py: WORDS
has for each page parts of its sentences, with # for each number, and what these
are, as RULES has it; a function is asked without arguments.  CLAIMS has the numbers
of what tests/unit/test_pages.c holds, in their order."""
import functools
import math

import numpy as np

from slide_formulas import (Step, log_two_cosh, scalar_newton, square,
                            symplectic_euler)

class Is:
    """A number of which something must hold; words say what."""

    def __init__(self, test, words="so"):
        self.test, self.words = test, words

S4 = square(4)[0]
TURN = 2 * math.pi
TAN = math.tan(math.radians(20))
cached = functools.lru_cache(None)

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

def flies(h):
    """Whether symplectic Euler takes a mass with w = 1 away."""
    x, v, most = np.array([1.0, 0]), np.array([0, 1.0]), 0
    for _ in range(400):
        v = v - h * x
        x = x + h * v
        most = max(most, np.hypot(*x))
    return most > 100

def swings_on(h):
    """Whether symplectic Euler keeps the square for 300 steps."""
    b, x = square(4)
    v = 0 * x
    for _ in range(300):
        x, v = symplectic_euler(b, x, v, h)
    return bool(np.isfinite(x).all())

@cached
def overshoot(start, search=False):
    return scalar_newton(log_two_cosh, start, 1e-10, search)

def converges(start):
    return abs(overshoot(start)[1]) < 1e-9

def after(n):
    r = overshoot(2)[0][n - 1]
    return r.x + r.p

LENGTHS = [r.alpha for r in overshoot(2, True)[0]]

@cached
def first(n, h, stretch, way="clamp", search=True, tolerance=0.01):
    """The first step of a square: its updates, and how far E rises."""
    b, x = square(n, stretch=stretch)
    E = Step(b, x, 0 * x, h)
    records = E.minimise(tolerance, way, search)[0]
    return records, max(float(E.value(r.x + r.alpha * r.p) - E.value(x))
                        for r in records)

def rise(x):
    return x < 1.3 * first(3, 0.02, 0.485, "none", False)[1] < 4 * x

def falls(i):
    r = [u.residual for u in first(4, 0.004, 1.4, tolerance=1e-6)[0]]
    return r[i] / r[i + 1], 2

WORDS = {
    "solid": [
        ("With # segments # masses and # springs, with n (n + #)² and #n² + #n:",
         lambda: [4, len(S4.m), len(S4.e), *polynomials()]),
        ("the same # kg", [S4.m.sum()])],
    "mesh": [
        ("node i (n + #) + j", lambda: [node(5, 1, 0) - 5]),
        ("With n = #: # lower left, # upper right", [2, node(2, 0, 0), node(2, 2, 2)]),
        ("# springs are horizontal, # vertical, # diagonal", lambda: kinds(2))],
    "symplectic": [("From h = # s on the mass flies away",
                    [Is(lambda h: flies(h) and not flies(0.99 * h))])],
    "stability": [("√(# + h²ω²)", [1]), ("Above #/ω = # s the", [2, 2 / TURN])],
    "explicit": [("h down to # s", [Is(swings_on)])],
    "overshoot": [
        ("from # the first step leads to # and the next one beyond #",
         lambda: [2, after(1), Is(lambda x: x < abs(after(2)) < 1.2 * x)]),
        ("nearer to # than # it converges", [
            0, Is(lambda x: converges(x) and not converges(x + 1e-4))])],
    "explodes": [
        ("E rises to #, nodes fly over a kilometre", [Is(rise)]),
        ("tames it: # updates", lambda: [len(first(3, 0.02, 0.485, "clamp", False)[0])])],
    "alpha": [("at α = # it may be", [
        Is(lambda a: min(r.alpha for r in first(4, 0.1, 0.2)[0]) < a)])],
    "algorithm2": [
        ("Begin with α = #", [1]),
        ("From # the first step takes α = #, the second #, all others #",
         [2, LENGTHS[0], LENGTHS[1], Is(lambda x: set(LENGTHS[2:]) == {x})])],
    "descent": [("negative eigenvalues set to #", [0])],
    "psd": [
        ("replaced by #", [0]),
        ("above # m nothing is changed, below # m nothing", [1, 1 / math.sqrt(3)])],
    "energy": [("smooth even at length #", [0]), ("kink at length #", [0]),
               ("At length # one", [0])],
    "potential": [("a # × # block", [2, 2])],
    "step": [
        ("as in numpy for an n × # array", [2]),
        ("by a factor of #, then of #", lambda: [falls(0), falls(1)]),
        ("up to # m/s, as on", [0.01])],
    "friction": [
        ("a slope of #°", [20]), ("tan #° = #", [20, TAN]),
        ("the blocks have #, #, # times it. Above # the second",
         [0.5, 0.9, 1.1, TAN / 0.9])],
    "trust": [("over # powers of ten", [21])],
}

CLAIMS = {
    "solid": "4 25 72 1000", "mesh": "2 1 0 3 0 3 1/4 1/2", "equation": "25 40 50",
    "forward": "1 0 0 1 0.5 1 0.5 1", "symplectic": "1000 0.5",
    "backward": "1 0 0 1 0.5 0.8 0.4 1",
    "stability": "0.02 1.00786 4 0.31 7 0.33 10", "explicit": "0.008 20 0.003 1000 0.008 1",
    "tangent": "2.5 1.17799 2 0.95", "newton": "0.6 0.9 1 5 12 0.05 -0.05",
    "overshoot": "2 -11.645 3e9 1.08 1.09", "explodes": "10^{16} 5", "minimise": "",
    "parts": "", "dial": "1 1 10 1", "inertia": "0.6 0.9 0.26", "alpha": "1 1/8",
    "algorithm2": "2 1/4 1/2 1 1 1 1", "descent": "0.1 -0.35 0.1 -0.1 289",
    "psd": "0 0 3 0", "energy": "4 1 -2 -3996", "force": "1.2 0.5 23.805 -165.6 -69",
    "potential": "50 72 16 676 2500", "algorithm3": "52 72 5 1",
    "step": "10^{-6} 2 10^{-2}", "simulator": "50", "contact": "300 1",
    "friction": "3 7 2 0.41 6 0.4 0.32 50", "inelastic": "300 0.05",
    "fracture": "20 100 100", "race": "2 4 16 4 8 4", "trust": "280 550 97 100",
}
