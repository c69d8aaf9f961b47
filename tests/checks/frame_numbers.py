#!/usr/bin/env python3
"""frame_numbers.py PROGRAM [long]: every number that the frames say, calculated
again from the states they show, by the formulas of slide_formulas.py.

PROGRAM (unit/texts.c) plays what plan() says and writes states and drawn texts.
RULES say what a number is: "total # kJ": a function of the frame.  Its answer is
a list with an item for each #: a whole number, a number (three digits), a tuple
(number, digits, slack: what the state cannot tell), or Is(test, words); True or
False are of the words.  A number that no rule takes fails, and so does one that is
not the true value, rounded to the digits shown.  To change a text, change its row
in RULES or, for the words of pages, in page_words.py."""
import functools
import json
import math
import re
import subprocess
import sys

import numpy as np

from slide_formulas import (GIVEN, LONG, Record, Step, blocks, force, friction,
                            line_energy, log_two_cosh, potential, scalar_newton,
                            square, strains, touching)
from page_words import CLAIMS, WORDS, Is, flies

NUMBER = (r"(1/\d+|[-+]?(?:10\^\{-?\d+\}|\d+(?:\.\d+)?"
          r"(?:·10\^\{-?\d+\}|e[-+]?\d+)?|∞))")
UP = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
EM = 21  # pixels, in frames of this size
np.seterr(all="ignore")  # explosions leave the range of a double

def plain(text):
    """Minus signs and powers of ten in one way of writing."""
    text = text.replace("−", "-").replace("\u00a0", " ")
    return re.sub("10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)",
                  lambda m: "10^{%s}" % m[1].translate(UP), text)

def value(token):
    if token.startswith("1/"):
        return 1 / int(token[2:])
    token = token.replace("∞", "inf").replace("·10^{", "e")
    return float(token.replace("10^{", "1e").replace("}", ""))

def between(low, high):
    return Is(lambda x: low <= x <= high, "%g ... %g" % (low, high))

def near(shown, true, digits=3, slack=0.0, unit=0):
    """Whether a number is the true one, rounded to so many digits or a unit."""
    if math.isinf(shown) or math.isinf(true):
        return shown == true
    size = max(abs(true), abs(shown))
    if not unit and size > 0:
        unit = 10.0**(math.floor(math.log10(size)) - digits + 1)
    return abs(shown - true) <= unit / 2 * (1 + 2e-9) + 4e-15 * size + slack

def judge(token, item):
    """None, or what should stand there."""
    shown = value(token)
    if isinstance(item, Is):
        return None if item.test(shown) else item.words
    if isinstance(item, (int, np.integer)):
        return None if shown == item else str(item)
    item = item if isinstance(item, tuple) else (item,)
    item = (float(item[0]),) + item[1:]
    return None if near(shown, *item) else "%.12g" % item[0]

SQUARES = "square unprojected explosion hang drop squeeze dent".split()
MEASURED = Is(lambda x: x >= 0, "measured")
BEFORE = Is(lambda x: not math.isnan(x), "told of a step before")

# ---- states

def body_of(given, run=0):
    """What a state was made with."""
    b = Record(**dict(zip(GIVEN, given["given"])))
    b.m, b.l2, b.k = (np.array(given[name], float) for name in ("m", "l2", "k"))
    b.e = np.array(given["e"], int).reshape(-1, 2)
    b.g, n = np.array(given["g"], float), len(b.m)
    b.pinned = np.array(given["pinned"] or [0] * n, bool)
    b.omega2 = given["omega2"][0]
    b.hand = np.array(given["hand"]) if "hand" in given else None
    b.cells, b.eta = None, b.damping
    if "cells" in given:
        b.cells = np.array(given["cells"], int).reshape(-1, 3)
        b.sides = np.array(given["sides"], int).reshape(-1, 3)
        b.area, b.c_cell = given["shape"]
    b.obstacles = []
    for o in given["obstacles"]:
        row = o["b"]
        if row[0] == run:
            b.obstacles.append(Record(
                kind=row[1], o=np.array(row[2:4]), n=np.array(row[4:6]),
                radius=row[6], mu=row[7], node=int(row[8]), other=-1,
                v=np.array(row[9:11]), number=len(b.obstacles), ball_radius=0))
    balls = [o for o in b.obstacles if o.node >= 0]
    for o in b.obstacles:
        if balls and o is not balls[0]:
            o.other, o.ball_radius = balls[0].node, balls[0].radius
    b.d_hat, b.c = given.get("barrier", (0, 0))
    return b

class State:
    """Positions and velocities after a step, and the ledger up to there."""

    def __init__(self, raw):
        self.raw, self.step, self.scene = raw, raw["state"], raw["scene"]
        self.b = body_of(raw)
        self.h = self.b.h
        self.runs = [Record(method=r["method"],
                            x=np.array(r["x"], float).reshape(-1, 2),
                            v=np.array(r["v"], float).reshape(-1, 2))
                     for r in raw["runs"]]
        self.x, self.v = self.runs[0].x, self.runs[0].v
        springs = len(self.b.l2)
        self.n = Record(ep=np.zeros(springs), kappa=np.zeros(springs))
        self.lost = dict.fromkeys("plastic fracture friction damping".split(), 0)
        self.work, self.time, self.before = 0, 0, None
        self.cells, self.made = {tuple(raw["cell"])}, self

    @functools.cached_property
    def parts(self):
        part = potential(self.b, self.x, self.n)
        v = np.asarray(self.v, LONG)
        part["kinetic"] = (self.b.m[:, None] * v * v).sum() / 2
        part["total"] = sum(part.values())
        return part

    def first(self):
        if self.scene in SQUARES:  # the mesh is the slides'
            b, own = self.b, square(int(self.b.segments), self.b.side,
                                    self.b.density, self.b.stiffness)[0]
            if not all(np.allclose(getattr(b, name), getattr(own, name), 1e-12, 0)
                       for name in ("m", "e", "l2", "k")):
                sys.exit("not ok numbers: the mesh of %s" % self.scene)
        self.start = self.parts["total"]
        return self

    def changed(self, old):
        """The same step with other numbers: what that did is work."""
        self.__dict__.update(n=old.n, lost=old.lost, time=old.time,
                             start=old.start, before=old.before, made=old.made,
                             cells=self.cells | old.cells)
        if len(self.n.ep) != len(self.b.l2):
            return self.first()
        self.work = old.work + self.parts["total"] - old.parts["total"]
        return self

    def after(self, old):
        """What a step from the old state has cost for good."""
        b, h, u = self.b, self.h, self.x - old.x
        self.start, self.time = old.start, old.time + h
        self.lost, self.before = dict(old.lost), old
        self.cells = self.cells | old.cells
        whole = body_of(self.raw)
        whole.k = self.whole_k(old)
        E = strains(whole, self.x)[2]
        if b.yield_strain:
            e = E - old.n.ep
            over = abs(e) - (b.yield_strain + b.hardening * old.n.kappa)
            gamma = np.where(over > 0, over, 0) / (1 + b.hardening)
            self.n.ep = old.n.ep + np.sign(e) * gamma
            self.n.kappa = old.n.kappa + gamma
            self.lost["plastic"] += (b.k * b.l2 * b.yield_strain * gamma).sum()
        if b.eta > 0:
            rate = E - strains(b, old.x)[2]
            self.lost["damping"] += (b.k * b.l2 * b.eta / h * rate**2).sum()
        start = Record(x=old.x, body=old.b)
        rubs = friction(b, start, old.x + h * self.v, h) if b.obstacles else []
        self.lost["friction"] += sum(r.weight * r.slope * r.y for r in rubs)
        if (b.k != whole.k).any():
            self.lost["fracture"] += (
                sum(potential(whole, self.x, self.n).values())
                - sum(potential(b, self.x, self.n).values()))
        work = -sum(r.weight * r.slope * r.carry for r in rubs)
        for o, _, d, n, _ in touching(whole, self.x):
            c = -b.c / b.d_hat
            work += c * (np.log(d / b.d_hat) + 1 - b.d_hat / d) * h * (n @ o.v)
        held = b.pinned & (u != 0).any(1)
        if held.any():  # reaction times way
            r = b.m[:, None] * (u - h * old.v - h * h * b.g) / (h * h)
            for nodes, gradient, _ in blocks(whole, self.x, old.n):
                for k in range(nodes.shape[1]):
                    np.add.at(r, nodes[:, k], gradient[:, 2 * k:2 * k + 2])
            work += (r * u)[held].sum()
        self.work = old.work + work
        return self

    def energy(self, name):
        lost = sum(self.lost.values())
        if name in self.lost:
            return self.lost[name]
        if name == "work":
            return self.work
        if name == "dissipated":
            return self.start + self.work - self.parts["total"] - lost
        return self.parts[name]

    def size(self):
        """What all energies are rounded beside."""
        return float(max(abs(p) for p in self.parts.values()) + abs(self.start)
                     + (self.b.m * np.abs(self.x @ self.b.g)).sum()
                     + 1e-12 * (self.b.k * self.b.l2).sum())

    def minimisation(self, run=0):
        """E of the step that led here, with the numbers of then."""
        made, old = self.made, self.before
        b = body_of(made.raw, run)
        b.k = made.whole_k(old)
        h, x, v = made.h, old.runs[run].x, old.runs[run].v
        E = Step(b, x, v, h, old.n.ep, old.n.kappa, body_of(old.raw, run))
        E.start[b.pinned] = self.runs[run].x[b.pinned]  # pins are moved first
        method = made.runs[run].method
        if method == "midpoint":
            E.w, E.tilde = h * h / 4, x + h / 2 * v
        if method == "bdf2" and old.runs[0].method == "bdf2":
            E.w = 4 / 9 * h * h
            E.tilde = (4 * x - old.before.x) / 3 + 2 * h / 9 * (4 * v - old.before.v)
        if method == "sdirk2":
            g = 1 - math.sqrt(0.5)
            E.w, E.tilde = (g * h)**2, x + g * h * v
            u = (E.minimise(self.b.tolerance)[1] - x) / (g * h)
            E.tilde = x + (1 - g) * h * u + g * h * (v + (1 - g) / g * (u - v))
        return E

    def whole_k(self, old):
        """Before springs broke, at the end of the step from the old state."""
        return np.where((self.b.k == 0) & (old.b.k > 0), self.b.stiffness, self.b.k)

    def with_numbers(self, given, mu=None):
        """The same state with other numbers: what that did is work."""
        raw, ratio = dict(self.raw), given[1] / self.raw["given"][1]
        raw.update(given=given, k=[ratio * k for k in raw["k"]],
                   obstacles=[{"b": [*o["b"][:7], m, *o["b"][8:]]} for o, m in zip(
                       raw["obstacles"], mu or [o["b"][7] for o in raw["obstacles"]])])
        return State(raw).changed(self)

class Frame:
    """Texts, and the states and the place in a step that they speak of."""

    def __init__(self, raw, states):
        self.raw, self.states, self.name = raw, states, raw["frame"]
        self.page, self.lane = self.name.split()[0], raw["active"]
        self.step = raw["step"]
        self.s = states[self.lane, self.step]
        pane = raw["panes"][self.lane]
        self.trace = Record(**pane["trace"]) if "trace" in pane else None
        self.x = np.array(pane["x"], float).reshape(-1, 2)
        self.scale, self.clamp = pane["stage"][1], self.s.raw["filter"]
        self.turns, self.rounds = {}, {}

    def turn(self, name):
        """How often this was asked: texts that come in an order."""
        self.turns[name] = self.turns.get(name, 0) + 1
        return self.turns[name]

    # ---- a step in time

    @functools.cached_property
    def minimisation(self):
        return self.s.minimisation()

    def round(self, x):
        """p, slope, projected at an iterate of the step."""
        if x.tobytes() not in self.rounds:
            self.rounds[x.tobytes()] = self.minimisation.direction(x, self.clamp)
        return self.rounds[x.tobytes()]

    @property
    def iterate(self):
        x = np.array(self.trace.x, float).reshape(-1, 2)
        held = self.minimisation.b.pinned
        if self.trace.i == 0 and held.any():  # they are moved before it begins
            x[held] = self.s.x[held]
        return x

    def projected(self):
        return between(*(self.round(self.iterate)[2] if self.trace else
                         self.descent[0][-1].projected))

    def residual(self):
        """What the loop tests, and what digits of the state make of it."""
        if not self.trace:
            return self.descent[3], 1e-15
        over = self.trace.line in (0, 8) and not self.trace.given_up
        x, E = self.s.x if over else self.iterate, self.minimisation
        return E.residual(self.round(x)[0]), 1e-13 * np.abs(x).max() / E.h

    def alpha(self):
        if not self.trace:
            return self.descent[0][-1].alpha
        return self.trace.first[0] * 2.0**(1 - max(self.trace.trials, 1))

    def change(self):
        """Of E by alpha p, and what rounding makes of it."""
        if not self.trace:
            return self.descent[0][-1].change, 1e-15
        E, x = self.minimisation, self.iterate
        change = float(E.change(x, self.round(x)[0], self.alpha()))
        rough = E.b.obstacles or E.b.yield_strain
        return change, 1e-15 * abs(float(E.value(x))) if rough else 1e-9 * abs(change)

    # ---- searches: landscape, overshoot, tangent, dial

    def function(self, x):
        if self.s.scene == "overshoot":
            return log_two_cosh(x)
        return line_energy(self.s.raw["target"][0], self.s.h)(x)

    @functools.cached_property
    def descent(self):
        """The last update, x now, p there, what is tested there."""
        x, raw, made = self.s.x, self.s.raw, self.s.made.raw
        search, records = made["search"] != "none", []
        old = self.states[self.lane, self.step - 1].x if self.step else None
        if self.s.scene != "landscape":
            x = float(x[0, 0])
            if self.step:
                start = float(old[0, 0])
                records = scalar_newton(self.function, start, 0, search, 1)[0]
            p = scalar_newton(self.function, x, 0, search, 0)[2]
            return records, x, p, abs(self.function(x)[1])
        if self.step:
            E = self.landscape(old, made)
            records = E.minimise(0, made["filter"], search, 1)[0]
        E = self.landscape(x, raw)
        p = E.direction(x, self.clamp)[0]
        plain = self.clamp == raw["search"] == "none"  # Algorithm 1
        return records, x, p, np.hypot(*E.g[:2]) if plain else E.residual(p)

    def landscape(self, x, raw, h=None):
        """The parts of E on the map."""
        parts = raw["parts"][0]
        b = Record(**{**vars(self.s.b), "m": (parts & 1) * self.s.b.m})
        E = Step(b, x, 0 * x, h or self.s.h)
        E.w *= parts >> 1
        E.tilde[0] = raw["target"]
        return E

    def part(self, x, parts=None):
        """E at a place of the map, J s^2: 1 inertia, 2 elasticity, 3 both."""
        parts = self.s.raw["parts"][0] if parts is None else parts
        at, d = self.s.x.copy(), np.array(x) - self.s.raw["target"]
        at[0] = x
        P = potential(self.s.b, at)["elastic"]
        return (parts & 1) * self.s.b.m[0] * (d @ d) / 2 + (
            parts >> 1) * self.s.h**2 * P

    def slope_of(self, way):
        return self.landscape(self.s.x, self.s.raw).direction(self.s.x, way)[1]

    @functools.cached_property
    def minimiser(self):
        """For this h, from x_tilde, by longer and longer steps."""
        x, both = self.s.x.copy(), {**self.s.raw, "parts": [3]}
        x[0] = both["target"]
        for h in np.geomspace(1e-3, self.s.h, 25):
            x = self.landscape(x, both, h).minimise(1e-13 / h)[1]
        return x[0]

# ---- what helps the rules

UNITS = {"TJ": 1e12, "GJ": 1e9, "MJ": 1e6, "kJ": 1e3, "J": 1, "mJ": 1e-3,
         "µJ": 1e-6}
# The row: what stands before a number is its name; its digits.
SETTINGS = {"h": ("h", 4), "k": ("stiffness", 6), "stretch": ("stretch", 6),
            "segments": ("segments", 9), "ε": ("tolerance", 6), "μ": ("mu", 6),
            "η": ("damping", 6)}
ROUND = Is(lambda x: ("%e" % x)[:8] in ("1.000000", "2.000000", "5.000000"),
           "1, 2 or 5 times a power of ten")
POWER = Is(lambda x: ("%e" % x)[:8] == "1.000000", "a power of ten")
MARK = Is(lambda x: x in (0.01, 0.1, 1, 10), "a mark")
H_RACE = [8 / 2**i for i in range(7)]

def energy(f, name, unit):
    """A curve's value in the legend; None where it has another meaning."""
    if "Euler" not in name:
        return [(f.s.energy(name) / unit, 3, 2e-14 * f.s.size() / unit)]
    if f.raw["lanes"] > 1:
        return None
    E = mass_energies(f, name)[0]
    return [(E / unit, 3, 1e-13 * E / unit)]

def mass_energies(f, name=None):
    """Before and after the next step of one mass."""
    run = f.s.runs[0] if name is None else next(
        r for r in f.s.runs if r.method == name.lower().replace(" ", "-"))
    x, v, _, new_x, new_v, _ = mass_step(run, f.s.h, f.s.b.omega2)
    return (x @ x + v @ v) / 2, (new_x @ new_x + new_v @ new_v) / 2

def mass_step(run, h, w):
    """x, v, a, x', v' and the velocity that carries the mass."""
    x, v = run.x[0], run.v[0]
    if run.method == "backward-euler":
        new_v = (v - h * w * x) / (1 + h * h * w)
        return x, v, -w * (x + h * new_v), x + h * new_v, new_v, new_v
    new_v = v - h * w * x
    used = v if run.method == "forward-euler" else new_v
    return x, v, -w * x, x + h * used, new_v, used

def mass_line(f):
    """The first of these lines is that of v', the second that of x'."""
    x, v, a, new_x, new_v, used = mass_step(f.s.runs[0], f.s.h, f.s.b.omega2)
    row = (v, a, new_v) if f.turn("mass") == 1 else (x, used, new_x)
    tiny = lambda p: [(p[0], 3, 1e-15), (p[1], 3, 1e-15)]
    return tiny(row[0]) + [f.s.h] + tiny(row[1]) + tiny(row[2])

def arrow_energies(f, name=None):
    E, new = mass_energies(f, name)
    return [(E, 4), (new, 4), (new / E, 4)]

def speed(f, shown):
    """60 frames a second, 2^s steps a frame."""
    power = 2.0**round(math.log2(shown / (60 * f.s.h)))
    return near(shown, 60 * f.s.h * power, 2)

def searched(f, how):
    """Whether alpha may be taken, as the words say."""
    change, slack = f.change()
    return bool((change > slack) == ("refused" in how)) or f.s.raw["search"] == "none"

def residual(f, sign):
    true, slack = f.residual()
    return [(true, 3, slack), bool((true > f.s.b.tolerance) == (sign == ">")),
            f.s.b.tolerance]

def alpha(f, how=""):
    return [f.alpha()] + ([searched(f, how)] if how and f.trace else [])

TOLD = set()  # of this run: it stays while the run goes on

def outcomes(f, was, had, now, has):
    """E and updates of the step with both settings, calculated twice."""
    rows, made = [], f.s.made
    told = (was, had, now, has)
    if told in TOLD or any(o.v.any() for o in f.s.b.obstacles):
        return [BEFORE] * 4
    TOLD.add(told)
    for words in was, now:
        way, search, s = f.clamp, f.s.raw["search"] != "none", f.s
        name = words.split(" ")[0]
        if "projection" in words:
            way = "none" if words == "no projection" else words.split()[-1]
        elif name in SETTINGS:  # with this number from its start
            numbers, at = list(made.raw["given"]), GIVEN.index(SETTINGS[name][0])
            factor = value(words.split(" ")[1]) / numbers[at]
            numbers[at] *= factor
            mu = [o["b"][7] * (factor if name == "μ" else 1)
                  for o in made.raw["obstacles"]]
            s = made.with_numbers(numbers, mu)
            s.made, s.before = s, made.before.with_numbers(numbers, mu)
        else:
            search = words != "full step"
        if f.trace is None:
            start = f.descent[0][-1].x
            rows += [scalar_newton(f.function, start, 0, search, 1)[0][0].change, 1]
            continue
        changes, updates, size = [], 0, 0
        for run in range(len(f.s.runs)):
            E = s.minimisation(run)
            records, x = E.minimise(s.b.tolerance, way, search)
            changes.append(float(E.value(x) - E.value(E.start)))
            updates, size = updates + len(records), size + abs(E.value(E.start))
        rows += [(sum(changes), 3, 1e-15 * size), updates]
    return rows

def explosion(f):
    E = f.minimisation
    records, x = E.minimise(f.s.b.tolerance, f.clamp, f.s.raw["search"] != "none")
    rises = [float(E.value(r.x + r.alpha * r.p) - E.value(E.x_n)) for r in records]
    return [int(np.argmax(rises)) + 1, len(records), max(rises),
            (max(np.abs(r.x).max() for r in records), 4)]

def overflow(f):
    """The first step that is none, and the last one of a size to be drawn."""
    size = [np.ptp(f.states[f.lane, n].x, axis=0).max()
            for n in range(f.raw["newest"] + 1)]
    return [len(size), max(n for n, a in enumerate(size) if a < 10 * size[0])]

def folded(f):
    """Cells with a triangle that has turned over, in any of the panes."""
    counts, n = [], int(f.s.b.segments)
    cross = lambda d, e: d[0] * e[1] - d[1] * e[0]
    for pane in f.raw["panes"]:
        x = np.array(pane["x"], LONG).reshape(-1, 2)
        area = lambda p, q, r: cross(x[q] - x[p], x[r] - x[p])
        corner = [(a, a + n + 1, a + n + 2, a + 1) for a in range(n * (n + 1))
                  if a % (n + 1) < n]
        counts.append(sum(area(a, b, c) < 0 or area(a, c, d) < 0
                          for a, b, c, d in corner))
    return [Is(lambda n: n in counts, str(counts))]

def contact_force(f):
    """1, 2 or 5 times a power of ten, the next one above the largest force."""
    most = 0
    for r, run in enumerate(f.s.runs):
        b = body_of(f.s.raw, r)
        for o, i, d, n, _ in touching(b, f.x if r == 0 else run.x):
            push = -b.c / b.d_hat * (math.log(d / b.d_hat) + 1 - b.d_hat / d)
            t = np.array([-n[1], n[0]])
            v = run.v[i] - (run.v[o.node] if o.node >= 0 else o.v)
            a = min(abs(t @ v) / b.slip_speed, 1)
            most = max(most, push * math.hypot(1, o.mu * a * (2 - a)))
    power = 10.0**math.floor(math.log10(most))
    return [power * next(m for m in (1, 2, 5, 10) if most <= m * power * (1 + 1e-9))]

def block(f, how):
    """A block on its slope: they are told in the order of the runs."""
    r = f.turn("slope") - 1
    b, run = body_of(f.s.raw, r), f.s.runs[r]
    o = b.obstacles[0]
    slope = -o.n[0] / o.n[1]
    slips = [abs(np.array([-n[1], n[0]]) @ run.v[i])
             for w, i, d, n, _ in touching(b, run.x) if w.mu > 0]
    slides = bool(slips) and min(slips) >= b.slip_speed
    return [(0.5, 0.9, 1.1)[r], o.mu / slope, math.degrees(math.atan(slope)),
            (how == "slides") == slides]

def vector(f, name):
    """What the note of a node says."""
    if f.s.scene == "dial":
        return [(x, 0, 0, 1e-4) for x in f.minimiser]
    i, b = f.raw["hover"][1], f.s.b
    if name == "f":
        true, size = force(b, f.x, f.s.n)[i], b.k.max()
    elif name == "v":
        true, size = f.s.v[i], 1
    elif name == "{xt}":
        known = f.trace and f.trace.i >= 0 and f.s.runs[0].method == "backward-euler"
        true = f.minimisation.tilde[i] if known else f.x[i] + f.s.h * f.s.v[i]
        size = 1
    else:
        true, size = f.x[i], 1
    slack = 1e-14 * np.abs(f.x).max() * size
    return [(true[0], 3, slack), (true[1], 3, slack)]

def strain(f):
    s = f.raw["hover"][1]
    q = strains(f.s.b, f.x.astype(LONG))[1][s]
    return [f.s.b.l2[s], (100 * (np.sqrt(q / f.s.b.l2[s]) - 1), 3, 1e-12)]

def spring(f):
    """The scene of one spring."""
    b, d = f.s.b, f.s.x[0] - f.s.x[1]
    r, l2, k = np.hypot(*d), b.l2[0], b.k[0]
    s = (r * r - l2) / l2
    return Record(d=d, r=r, l=math.sqrt(l2), k=k, s=s, P=l2 * k / 2 * s * s,
                  f=-2 * k * s * d, along=2 * k / l2 * (3 * r * r - l2),
                  across=2 * k / l2 * (r * r - l2))

def curvatures(f):
    """Of P, then of the energy with the root."""
    a = spring(f)
    if f.turn("curvature") == 1:
        return [(a.along, 4), (a.across, 4)]
    return [(4 * a.k, 4), (4 * a.k * (1 - a.l / a.r), 4)]

def update(f):
    """The last update of a search, or the one to come: number, x, p, alpha."""
    records, x, p, _ = f.descent
    return ((f.step - 1, records[-1].x, records[-1].p, records[-1].alpha)
            if records else (0, x, p, 1))

def iterate(f, end=False):
    n, x, p, a = update(f)
    first = not end and f.turn("x") == 1
    return [n, (x, 8)] if first else [n + 1, (x + a * p, 8)]

def f_at(f, end=False):
    n, x, p, a = update(f)
    return f.function(x + a * p if end else x)

@functools.lru_cache(None)
def cell_updates(h, k, segments, stretch, tolerance):
    """Three steps of a cell of the map."""
    b, x = square(int(segments), k=k, stretch=stretch)
    v, updates = 0 * x, 0
    for _ in range(3):
        records, new = Step(b, x, v, h).minimise(tolerance)
        v, x, updates = (new - x) / h, new, updates + len(records)
    return updates

@functools.lru_cache(None)
def idle(column, row, segments=4, stretch=1.4, tolerance=0.01):
    """Whether a cell's first step passes the test where it begins."""
    b, x = square(int(segments), k=10.0**(row - 6), stretch=stretch)
    E = Step(b, x, 0 * x, 10**(column / 2 - 9))
    return E.residual(E.direction(x)[0]) <= tolerance

def shown_cell(f):
    column, row = f.s.raw["cell"]
    return 10**(column / 2 - 9), 10.0**(row - 6)

def of_map(f):
    return f.s.b.segments, f.s.b.stretch, f.s.b.tolerance

def cells_known(f):
    return set(f.s.cells) | {(c, r) for r in range(f.step) for c in range(25)}

def steps_of_cell(f):
    h, k = shown_cell(f)
    beyond = h * h * k > 1e10  # digits of masses are lost beside those of springs
    return [3, MEASURED if beyond else cell_updates(h, k, *of_map(f))]

def guess(f):
    at = np.array(f.s.raw["guess"])
    scalar = f.s.scene in ("tangent", "overshoot")
    off = abs(at[0] - f.descent[1]) if scalar else np.hypot(*(at - f.s.x[0]))
    return [(off, 3, 1e-12)]

def lane_total(f):
    s = f.states[f.turn("lane") - 1, f.step]
    return [(s.parts["total"] / 1e3, 3, 1e-14 * s.size())]

def scale(f, metre):
    """The bar's length, by where the middle of its number is."""
    if f.s.scene == "circle" and f.turn("metre") == 1:
        return [1]  # the radius
    stages = [pane["stage"] for pane in f.raw["panes"]]
    return [Is(lambda x: ROUND.test(x) and any(
        near(x * metre, 2 * (f.at[0] - left - EM) / pixels, 2, 3 / pixels)
        for left, pixels in stages), "as long as the bar")]

# ---- rules: # a number, ~ any words; the function gets the frame and the words

SO = lambda f, *_: []
RULES = [
    *[("%s # %s" % (name, unit), lambda f, n, a=name, u=joule: energy(f, a, u))
      for name in ("total kinetic elastic gravity contact hand plastic fracture "
                   "friction work dissipated damping").split() + [
                       "forward Euler", "symplectic Euler", "backward Euler"]
      for unit, joule in UNITS.items()],
    ("step #", lambda f, n: [f.step]),
    ("step #   t = # s", lambda f, *_: [f.step, (f.s.time, 4)]),
    ("step #   t = # s   real time × #", lambda f, n, t, times: [
        f.step, (f.s.time, 4), Is(lambda x: speed(f, x), "60 h 2^s")]),
    ("step # of #   t = # s",
     lambda f, *_: [f.step, f.raw["newest"], (f.s.time, 4)]),
    *[(turn + " #", lambda f, n: [f.step])
      for turn in ("iteration", "row", "turn", "run")],
    *[(turn + " # of #", lambda f, n, m: [f.step, f.raw["newest"]])
      for turn in ("iteration", "row", "turn", "run")],
    ("page # of # · K: its code and test",
     lambda f, n, m: [PAGES.index(f.page) + 1, len(PAGES)]),
    ("steps # ... # are forgotten", lambda f, a, b: [  # it may be told later
        between(1, f.step + 1), between(value(a) + 1, math.inf)]),
    ("step # is forgotten", lambda f, a: [between(1, f.step + 1)]),
    ("node # is ~", lambda f, i, what: [
        Is(lambda i: f.s.b.pinned[int(i)] == (what == "pinned"), "so")]),
    # lines of Algorithm 3
    ("line 3: the blocks of # of # springs had a negative eigenvalue and were "
     "projected", lambda f, *_: [f.projected(), len(f.s.b.l2)]),
    ("# of # springs", lambda f, *_: [f.projected(), len(f.s.b.l2)]),
    ("line 3: # blocks of springs, contacts and cells had a negative eigenvalue and "
     "were projected", lambda f, n: [f.projected()]),
    ("# blocks", lambda f, n: [f.projected()]),
    ("# block", lambda f, n: [f.projected()]),
    ("line 2: the loop begins for the #~ time", lambda f, *_: [f.trace.i + 1]),
    ("line 5: {alpha} = # is ~", lambda f, a, how: alpha(f, how)),
    ("line 7: the residual is # m/s, above #", lambda f, *_: residual(f, ">")),
    ("line 7: the residual is # m/s, not above #", lambda f, *_: residual(f, "≤")),
    ("line 7: ‖{p}‖_{∞}/h is not above # m/s: its ~ is below, and {p} is not needed",
     lambda f, *_: [f.s.b.tolerance]),
    ("≤ # m/s: it ends", lambda f, e: [f.s.b.tolerance]),
    ("line 8: the step of # s is done", lambda f, h: [f.s.h]),
    ("‖{p}‖_{∞} = # m", lambda f, p: [
        (f.residual()[0] * f.s.h, 3, f.residual()[1] * f.s.h)]),
    *[("# %s #%s" % (sign, unit), lambda f, r, e, s=sign: residual(f, s))
      for sign in (">", "≤") for unit in ("", " m/s", " m/s: given up")],
    ("{alpha} = #", lambda f, a: alpha(f)),
    ("{alpha} = #: refused", lambda f, a: alpha(f, "refused")),
    ("{alpha} = # ~: #", lambda f, a, how, E: alpha(f, how) + [
        (f.change()[0], 3, f.change()[1])]),
    ("off: {alpha} = 1", SO),
    ("search direction p × #", lambda f, n: [POWER]),
    # what is told
    ("~: E # in # update~; ~: E # in # update~",
     lambda f, was, had, n, _, now, has, *__: outcomes(f, was, had, now, has)),
    ("update # of #: E has risen by # J s², and nodes are # m away; N goes on",
     lambda f, *_: explosion(f)),
    ("ε is loose: above # m/s bodies may hang or freeze", lambda f, e: [
        min(0.1 * f.s.h * math.hypot(*f.s.b.g), 0.1 * f.s.b.slip_speed)]),
    ("within the tolerance, not at rest: ε = # m/s lets # m pass in each step of # s; "
     "a smaller one goes on",
     lambda f, *_: [f.s.b.tolerance, f.s.b.tolerance * f.s.h, f.s.h]),
    ("step # ends beyond all numbers; shown is step #, the last below ten times the "
     "size", lambda f, *_: overflow(f)),
    ("# side by side · ~", lambda f, n, how: [f.raw["lanes"]]),
    ("nothing deforms any more: free as it is, it drifts on at # m/s~",
     lambda f, v, _: [(np.hypot(*f.s.v.mean(0)), 2)]),
    ("~ # kJ", lambda f, *_: lane_total(f)),
    # the square, and what the mouse is over
    ("# m", lambda f, n: scale(f, 1)),
    ("# mm", lambda f, n: scale(f, 1e-3)),
    ("# km", lambda f, n: scale(f, 1e3)),
    ("# cells folded over", lambda f, n: folded(f)),
    ("# cell folded over", lambda f, n: folded(f)),
    *[(sign + "# %", lambda f, n: [Is(
        lambda x: x == 100 or ROUND.test(abs(x)), "round")]) for sign in ("-", "+", "")],
    ("contact force # N", lambda f, n: contact_force(f)),
    ("# μ = # tan #°: ~", lambda f, g, m, a, how: block(f, how)),
    ("node #", lambda f, i: [f.raw["hover"][1]]),
    ("node #, pinned", lambda f, i: [
        f.raw["hover"][1], bool(f.s.b.pinned[f.raw["hover"][1]])]),
    ("m = # kg", lambda f, m: [f.s.b.m[f.raw["hover"][1]]]),
    *[("%s = (#, #) %s" % (name, unit), lambda f, x, y, n=name: vector(f, n))
      for name, unit in (("{x}", "m"), ("v", "m/s"), ("f", "N"), ("{xt}", "m"))],
    ("spring #–#", lambda f, i, j: list(f.s.b.e[f.raw["hover"][1]])),
    ("l² = # m²,  strain # %", lambda f, *_: strain(f)),
    # small scenes
    ("exact: |{x}| = # m", lambda f, n: [1]),
    ("stays on an ellipse~ while hω < #", lambda f, *_: [
        Is(lambda h: flies(h) and not flies(0.99 * h), "the limit")]),
    *[(name + " Euler: # m", lambda f, n, m=name + "-euler": [
        np.hypot(*next(r for r in f.s.runs if r.method == m).x[0])])
      for name in ("forward", "symplectic", "backward")],
    ("    = (#, #) + # (#, #) = (#, #)", lambda f, *_: mass_line(f)),
    ("energy # J → # J  (× #)", lambda f, *_: arrow_energies(f)),
    ("~: energy # J → # J  (× #)", lambda f, name, *_: arrow_energies(f, name)),
    ("# m off", lambda f, n: guess(f)),
    ("h = # s", lambda f, h: [  # the card's, or one of the marks
        (f.s.h, 4) if near(value(h), f.s.h, 4) else MARK]),
    ("from {xt}: # m", lambda f, d: [
        (np.hypot(*(f.minimiser - f.s.raw["target"])), 4, 1e-13)]),
    ("inertia # J s²", lambda f, E: [(f.part(f.minimiser, 1), 4, 1e-15)]),
    ("elasticity h² P # J s²", lambda f, E: [(f.part(f.minimiser, 2), 4, 1e-15)]),
    ("P = # J", lambda f, P: [(f.part(f.minimiser, 2) / f.s.h**2, 4, 1e-13)]),
    ("x^{#} = #", lambda f, *_: iterate(f)),
    ("x^{#} + {p} = #", lambda f, *_: [update(f)[0], (sum(update(f)[1:3]), 8)]),
    ("x^{#} = #,  {alpha} = #", lambda f, *_: iterate(f, True) + [update(f)[3]]),
    ("g = #     E″ = #", lambda f, *_: [(f_at(f)[1], 6, 1e-13), (f_at(f)[2], 6)]),
    ("{p} = -g / E″ = #", lambda f, p: [(update(f)[2], 8, 1e-15)]),
    ("E: # → #", lambda f, *_: [(f_at(f)[0], 8), (f_at(f, True)[0], 8)]),
    ("quadratic model at x^{#}", lambda f, n: [update(f)[0]]),
    ("~to x = #~", lambda f, *_: [sum(update(f)[1:3])]),
    ("x^{#}", lambda f, n: [between(0, f.step)]),
    *[(name + " (slope #)", lambda f, s, w=way: [(f.slope_of(w), 2, 1e-12)])
      for name, way in (("with projection", "clamp"), ("without", "none"),
                        ("inertia alone", "clamp"), ("elasticity alone", "clamp"))],
    ("d = (#, #) m   |d| = # m   l = # m", lambda f, *_: [
        *spring(f).d, (spring(f).r, 4), spring(f).l]),
    ("s = |d|²/l² - 1 = #", lambda f, s: [(spring(f).s, 4, 1e-15)]),
    ("P = l² k/2 s² = # · #/2 · #² = # J", lambda f, l2, k, s, P: [
        spring(f).l**2, spring(f).k, (spring(f).s, 4), (spring(f).P, 5),
        spring(f).s >= 0]),
    ("P = l² k/2 s² = # · #/2 · (#)² = # J", lambda f, *_: [
        spring(f).l**2, spring(f).k, (spring(f).s, 4), (spring(f).P, 5)]),
    ("f = -2 k s d = (#, #) N", lambda f, *_: [(F, 4, 1e-13) for F in spring(f).f]),
    ("curvature along #, across # J/m²", lambda f, *_: curvatures(f)),
    ("with the root: 2k (|d| - l)² = # J", lambda f, P: [
        (2 * spring(f).k * (spring(f).r - spring(f).l)**2, 5)]),
    ("shorter than l: it has an eigenvalue below 0", SO),
    # race and map
    ("# of # runs, # s of motion each", lambda f, *_: [f.step, 42, 0.064]),
    ("error at most # m:", lambda f, e: [
        Is(lambda x: x in (1e-2, 1e-4, 1e-6), "two powers of ten apart")]),
    ("    ~: # ms with h = # ms", lambda f, *_: [
        MEASURED, Is(lambda x: any(near(x, h) for h in H_RACE), "h of a run")]),
    ("AVF, #th order", lambda f, n: [4]),
    ("h = # s,  k = # J/m²", lambda f, *_: list(shown_cell(f))),
    ("# steps, # Newton updates", lambda f, *_: steps_of_cell(f)),
    ("# of # cells converge", lambda f, n, known: [
        between(0, value(known)), len(cells_known(f))]),
    ("in # nothing was done", lambda f, n: [
        sum(idle(*cell, *of_map(f)) for cell in cells_known(f))]),
    ("ε: h ε = # m", lambda f, n: [f.s.h * f.s.b.tolerance]),
    ("ε lets # m pass: h ε", lambda f, n: [shown_cell(f)[0] * f.s.b.tolerance]),
]

# Words with digits that are names and formulas.
NOTATION = re.compile(
    r"(?<!10)[\^_]\{[^}]*\}|Algorithm \d|lines? \d( and \d)?|4 × 4|2 × 2|F1\b|F11|BDF2"
    r"|SDIRK2|^1 2 3$|^4 5 6$|^7 8 9$|step 0;|\(1 \+ \(hω\)²\)|1/√2|1 - 1|4\^|\(4 -|4g"
    r"|1/\(|l/√3|\bm/2\b|k/2\b|/3\b|\(4\{x|\(4v|√2|- 1\)² needs|- 1 the force|2k|2 k"
    r"|2 d dᵀ|\(2 | - 4g|[36] (integrators|methods)|to 0\b|∇E\(x\) = 0|>1|line [146]:")

def compiled(pattern, whole=True):
    expression = re.escape(plain(pattern)).replace(r"\#", NUMBER).replace(
        r"\~", r"(.*?)")
    return re.compile("^" + expression + "$" if whole else expression)

# ---- numbers that stand alone

def groups(f, texts):
    """By the words before them: what the texts of these indices should be."""
    want = {}
    H = lambda x, s: next(blocks(f.s.b, x, f.s.n))[2][s][:2, :2]
    for k, (x, y, text) in enumerate(texts):
        slack, true = 0, []
        if text == "its block of ∇²P, J/m²":
            true = np.kron([[1, -1], [-1, 1]], H(f.x, f.raw["hover"][1])).reshape(-1)
        elif text == "eigenvalues, and after projection":
            low, high = 2 * np.linalg.eigvalsh(H(f.x, f.raw["hover"][1]))
            true = [0, 0, low, high]
        elif text in ("before", "after projection"):
            true = np.array([0, 0, *2 * np.linalg.eigvalsh(H(f.s.x, 0))])
            true = np.sort(true if text == "before" else np.maximum(true, 0))
            slack = 0.05
        elif re.search("(← start|← .*x.*n.*)$", text) and k and \
                texts[k - 1][2] == "1":  # the numbers of a listing's lines
            left = [j for j in range(k - 1, len(texts))
                    if abs(texts[j][0] - texts[k - 1][0]) < 1][:8]
            want.update({j: i + 1 for i, j in enumerate(left)})
        for i, number in enumerate(true):
            want[k + 1 + i] = (number, 3, slack + 1e-9 * np.abs(true).max())
    return want

def ticks(f, texts):
    """Numbers at axes stand where their value belongs."""
    want = {}
    part = lambda v, low, high, log: (v - low) / (high - low) if not log else (
        math.log(v / low) / math.log(high / low))
    for row in f.raw["plots"]:
        x0, y0, wide, high, xl, xh, xlog, yl, yh, ylog, first, last = row["p"]
        for k in range(int(first), int(last)):
            x, y, text = texts[k]
            if not re.fullmatch(NUMBER, text):
                continue
            v = value(text)
            if x < x0:
                off = y0 + (1 - part(v, yl, yh, ylog)) * high - 0.533 * EM - y
            else:
                off = x0 + part(v, xl, xh, xlog) * wide - x
            want[k] = Is(lambda v, off=off: abs(off) < 0.05, "%g px off" % off)
    return want

def contour(f, x, y):
    """E within two pixels of the place where a contour's number stands."""
    _, _, wide, high, xl, xh, _, yl, yh, _, _, _ = f.raw["plots"][0]["p"]
    E = [f.part((xl + (x + i) / wide * (xh - xl),
                 yh - (y + 0.53 * EM + j) / high * (yh - yl)))
         for i in (-2, 0, 2) for j in (-1, 0, 1)]
    return between(min(E) * (1 - 2e-3), max(E) * (1 + 2e-3))

def alone(f, texts, k):
    """Any other number that is a text of its own."""
    x, y, text = texts[k]
    if f.name.endswith("pages") and x > 900:
        return between(1, len(PAGES))
    if f.s.scene in ("landscape", "dial") and k < 60:
        return contour(f, x, y)
    if f.page in ("solid", "mesh", "square") and value(text) < len(f.x):
        i = int(value(text))
        way = (f.x[i] - f.x[0]) * f.scale
        zero = next(t for t in texts if t[2] == "0")
        off = math.hypot(x - zero[0] - way[0], y - zero[1] + way[1])
        return Is(lambda v: off < 0.1, "beside its node")
    if texts[k + 1:] and texts[k + 1][2] == "plastic strain":
        return 0
    return POWER if f.s.scene == "envelope" else None

def setting(f, texts, k):
    """A number of the row, with its unit."""
    if not k or texts[k - 1][2] not in SETTINGS or not re.match(
            NUMBER + "( J/m²| s| m/s)?$", texts[k][2]):
        return None
    name, digits = SETTINGS[texts[k - 1][2]]
    return getattr(f.s.b, name), digits

def look(f, rules):
    """Numbers and texts of a frame; what is wrong, and what no rule takes."""
    texts = [(x, y, plain(t)) for x, y, t in f.raw["texts"]]
    want = {**groups(f, texts), **ticks(f, texts)}
    wrong, left, numbers = [], [], 0

    def check(text, tokens, items):
        nonlocal numbers
        words = [bool(item) for item in items if isinstance(item, (bool, np.bool_))]
        items = [item for item in items if not isinstance(item, (bool, np.bool_))]
        if not all(words) or len(items) != len(tokens):
            wrong.append((f.name, text, "words", "false"))
        for token, item in zip(tokens, items):
            numbers += 1
            should = judge(token, item)
            if should:
                wrong.append((f.name, text, token, should))

    for k, (x, y, text) in enumerate(texts):
        f.at, rest = (x, y), text
        if not re.search(r"\d", text):
            continue
        item = setting(f, texts, k)
        if item is None and re.fullmatch(NUMBER, text):
            item = want[k] if k in want else alone(f, texts, k)
        if item is not None:
            check(text, [text.split(" ")[0]], [item])
            continue
        if text == TOLD_CLAIMS.get(f.page):
            check(text, [], [re.findall(NUMBER, text) == CLAIMS[f.page].split()])
            continue
        for expression, function, page in rules:
            if page not in (None, f.page):
                continue
            match = expression.search(rest)
            if not match:
                continue
            try:
                items = function(f, *match.groups())
            except Exception as error:  # the state has no such thing
                wrong.append((f.name, text, "rule", repr(error)))
                break
            if items is not None:
                check(text, [g for g in match.groups() if re.fullmatch(NUMBER, g)],
                      items)
                rest = rest.replace(match[0], " ")
                if page is None:
                    break
        if re.search(r"\d", NOTATION.sub("", rest)):
            left.append((f.name, text))
    return numbers, len(texts), wrong, left

def all_rules():
    yield from ((compiled(pattern), function, None) for pattern, function in RULES)
    for page, rows in WORDS.items():
        for pattern, items in rows:
            yield (compiled(pattern, False), lambda f, *_, i=items: [
                *(i() if callable(i) else i)], page)

# ---- what is played

PAGES, SCENES, TOLD_CLAIMS = [], [], {}  # the program tells them
# What is changed and dragged for the third state of each.
TOUCHED = {
    "forward": "handle 0 0.5 -0.8", "symplectic": "handle 1 1.2 0.4",
    "backward": "set timestep 1.5", "arrows": "handle 1 0.3 0.9",
    "tangent": "handle 1 1.4 0", "overshoot": "start 0.7 0",
    "newton": "start 0.3 -0.9", "landscape": "handle 0 -0.4 0.5",
    "parts": "handle 1 0.4 0.8", "inertia": "handle 0 0.5 0.5",
    "algorithm2": "start -3 0", "descent": "handle 1 0.05 0.3",
    "dial": "handle 0 -0.5 0.8", "psd": "handle 0 0.2 0.3",
    "energy": "handle 0 -0.4 0.1", "force": "handle 0 0.7 -0.2",
    "spring": "handle 0 0.25 0.1", "friction": "set friction 0.42",
    "slope": "set friction 0.3", "hang": "pin 30", "square": "set timestep 0.02",
    "potential": "set segments 3", "solid": "set segments 6",
    "mesh": "set segments 3", "race": "set stretch 1.05",
    "trust": "cell 300", "envelope": "cell 133",
    "stability": "set timestep 0.05", "circle": "set timestep 0.01",
}
LINES = "newton explodes minimise alpha algorithm3 step square unprojected drop".split()

def plan(long):
    for k, name in enumerate(PAGES + SCENES):
        page = k < len(PAGES)
        yield "begin " + ("square" if page else name)
        if page:
            yield from ("page " + name, "frame %s start" % name, "code",
                        "frame %s code" % name, "code")
        yield from ("run 2", "hover spring 5", "frame %s later" % name)
        if name in LINES or long and not page:
            yield from ("finer", "finer")
            for i in range(8 if long else 7):
                yield from ("next", "frame %s line %d" % (name, i))
        yield from ("hover node 1", TOUCHED.get(name, "set stiffness 5e4"),
                    "frame %s touched" % name, "run 3",
                    "frame %s touched, later" % name)
    for name, script in list(MORE.items())[:None if long else SHORT]:
        for command in ("begin " + script).split("; "):
            yield "frame " + name if command == "frame" else command

SHORT = 5  # of these also in the short test
MORE = {
    "square plastic": "square --yield 0.05 --hardening 0.1; run 4; hover node 3; frame; "
                      "hover spring 60; frame; "
                      "finer; finer; next; next; next; next; frame; next; frame",
    "square overflows": "square --integrator forward-euler; run 40; frame",
    "solid pages": "square; page-on; pages; frame",
    "square keys": "square; keys; frame",
    "square loose": "square --timestep 1000 --stiffness 10; run 1; frame; finer; finer; "
                    "next; next; next; next; frame",
    "dent late": "dent; run 90; hover node 128; frame; hover spring 390; frame; colours; frame",
    "tear late": "tear; run 90; hover node 24; frame; colours; frame",
    "drop late": "drop; run 70; hover node 0; frame; finer; finer; next; next; next; "
                 "next; frame; next; frame; next; frame; enlarge 4; frame",
    "squeeze late": "squeeze; run 40; frame; next; frame; enlarge 4; frame",
    "bend late": "bend; run 60; frame; hover node 7; frame; enlarge 4; frame",
    "slope late": "slope; run 30; frame; set friction 0.5; frame; run 30; frame",
    "hang late": "hang; run 30; frame; pin 3; frame; run 3; frame; enlarge 4; frame",
    "square hand": "square --segments 3; run 2; grab 0; drag -1 0.5; frame; run 3; "
                   "frame; drag -1 1; frame; run 2; release; frame; run 2; enlarge 4; "
                   "frame",
    "square toggles": "square --stretch 0.6 --filter none; next; next; projection; "
                      "frame; line-search; frame; next; frame; home; frame; goto 2; "
                      "frame; projection; frame",
    "square panes": "square --segments 2; run 3; method; add-pane; frame; add-pane; "
                    "run 3; frame; goto 2; frame",
    "square damped": "square --damping 0.01; run 5; frame; set damping 0.02; run 2; "
                     "enlarge 4; frame",
    "square damped lines": "square --damping 0.004; run 4; finer; finer; next; next; "
                           "next; next; frame; next; frame; next; next; frame",
    "square abs": "square --stretch 0.5 --filter abs; run 2; finer; finer; next; next; "
                  "next; next; frame; next; frame; next; next; frame",
    "square drifts": "square --segments 1 --stretch 1.1 --velocity 3,4; run 400; frame",
    "square methods": "square --integrator verlet; run 3; frame; set integrator bdf2; run 2; "
                      "frame; set integrator midpoint; run 2; frame; set integrator "
                      "sdirk2; run 2; frame",
    "explosion peak": "explosion; next; frame; next; frame; projection; frame",
    "drop loose": "drop --tolerance 0.1; run 2; frame",
    "arrows guess": "arrows --integrator forward-euler; predict 1 1; frame; next; frame",
    "tangent guess": "tangent; predict 1 0; frame; next; frame; next; frame; next; next; "
                     "next; next; frame; next; frame",
    "overshoot guess": "overshoot --start 1.08 --line-search none; predict 1 0; next; "
                       "frame; next; frame; line-search; frame; next; frame",
    "landscape parts": "landscape --start 0.4,0.9; flip 0; frame; next; frame; flip 0; "
                       "flip 1; frame; next; frame; handle 1 0.05 -0.05; frame; next; "
                       "next; next; next; next; next; frame",
    "dial turned": "dial; flip 0; frame; run 4; frame; run 20; frame; run 30; frame",
    "spring let go": "spring --start 0.3,0.2; flip 0; frame; run 12; frame; finer; "
                     "finer; next; next; next; next; frame; next; frame",
    "race ahead": "race; run 14; frame",
    "trust ahead": "envelope; cell 200; frame; cell 430; frame; cell 520; frame",
}

def read(program, lines):
    """Plays; yields frames with the states so far."""
    lines = "".join(line + "\n" for line in lines)
    answer = subprocess.run([program], input=lines, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if answer.returncode:
        sys.exit("not ok numbers: %s: %s" % (program, answer.stderr[-200:]))
    states, last = {}, {}
    for line in answer.stdout.splitlines():
        raw = json.loads(line)
        if "begin" in raw:
            TOLD.clear()
        if "pages" in raw:
            PAGES[:], SCENES[:] = raw["pages"], raw["scenes"]
            TOLD_CLAIMS.update(zip(PAGES, map(plain, raw["claims"])))
        elif "begin" in raw:
            states, last = {}, {}
        elif "state" in raw:
            lane = raw["lane"]
            if "m" not in raw:  # the mesh of the step before
                old = last[lane].raw
                raw.update({name: old[name] for name in ("m", "l2", "e", "cells",
                                                         "sides", "shape")
                            if name in old})
            state = State(raw)
            old, at = last.get(lane, last.get(0)), (lane, raw["state"])
            if old is None or state.scene != old.scene:
                states, last = {}, {}
                state.first()
            elif state.step == old.step + 1:
                state.after(old)
            elif state.step == old.step and state.step and at in states and (
                    state.x.shape != old.x.shape or (state.x != old.x).any()):
                mu = [o["b"][7] for o in raw["obstacles"]]
                start = states[lane, state.step - 1].with_numbers(raw["given"], mu)
                states[lane, state.step - 1] = start
                state.after(start)  # taken again
            elif state.step == old.step:
                state.changed(old)
            else:
                state.changed(states.get(at) or states[0, state.step])
            states[at] = last[lane] = state
        else:
            yield raw, states

def main():
    program, long = sys.argv[1], len(sys.argv) > 2
    list(read(program, []))
    rules, wrong, left, sums = list(all_rules()), [], [], np.zeros(3, int)
    for raw, states in read(program, plan(long)):
        numbers, texts, bad, unexplained = look(Frame(raw, states), rules)
        sums += (1, texts, numbers)
        wrong, left = wrong + bad, left + unexplained
    for row in left:
        print("unexplained: %s: %s" % row)
    for row in wrong:
        print("wrong: %s: %s: %s, should be %s" % row)
    print("%s numbers (%d states, %d texts, %d numbers: %d wrong, %d unexplained)"
          % ("not ok" if wrong or left else "ok", *sums, len(wrong), len(left)))
    return bool(wrong or left)

if __name__ == "__main__":
    sys.exit(main())
