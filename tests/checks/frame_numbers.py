#!/usr/bin/env python3
"""frame_numbers.py PROGRAM [long]: every number that the frames say, calculated again
from the states they show, by the formulas of the slides (slide_formulas.py).

PROGRAM (unit/texts.c) plays what PLAN says and writes states and drawn texts.
Each number in a text must be taken by a rule below: a pattern, with # where a
number stands, and what that should be.  A number that no rule takes fails, and
so does one that is not the true value, rounded to the digits shown."""
import functools
import json
import math
import re
import subprocess
import sys

import numpy as np

from slide_formulas import (GIVEN, LONG, Record, Step, blocks, explicit, force,
                           friction, line_energy, log_two_cosh, potential,
                           scalar_newton, square, strains, touching)

NUMBER = (r"(1/\d+|[-+]?(?:10\^\{-?\d+\}|\d+(?:\.\d+)?"
          r"(?:·10\^\{-?\d+\}|e[-+]?\d+)?|∞))")
UP = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def plain(text):
    """Minus signs and powers of ten in one way of writing."""
    text = text.replace("−", "-").replace("\u00a0", " ")
    return re.sub("10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)",
                  lambda m: "10^{%s}" % m[1].translate(UP), text)


def value(token):
    if token.startswith("1/"):
        return 1 / int(token[2:])
    token = token.replace("∞", "inf").replace("·10^{", "e")
    return float(re.sub(r"10\^\{", "1e", token).replace("}", ""))


class Near:
    """A number shown with so many digits; slack: what the state cannot tell."""

    def __init__(self, true, digits=3, slack=0.0, decimals=None):
        self.true, self.digits = true, digits
        self.slack, self.decimals = slack, decimals

    def holds(self, token):
        shown, true = value(token), float(self.true)
        if math.isinf(shown) or math.isinf(true):
            return shown == true
        unit = 10.0**-self.decimals if self.decimals is not None else 0
        size = max(abs(true), abs(shown))
        if self.decimals is None and size > 0:
            unit = 10.0**(math.floor(math.log10(size)) - self.digits + 1)
        rounding = 1e-9 * unit + 4e-15 * size
        return abs(shown - true) <= unit / 2 + rounding + self.slack

    def __str__(self):
        return "%.12g" % self.true


class That:
    """A number of which something must hold."""

    def __init__(self, holds, words):
        self.test, self.words = holds, words

    def holds(self, token):
        return self.test(value(token))

    def __str__(self):
        return self.words


MEASURED = That(lambda x: x >= 0, "measured")
NAME = That(lambda x: True, "a name")  # "4 x 4", "x^{0}"


def between(low, high):
    return That(lambda x: low <= x <= high, "%g ... %g" % (low, high))


# ---- states ----------------------------------------------------------------

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
        whole.k = old.b.k  # springs break at the end of a step
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

    def minimisation(self):
        """E of the step that led here, with the numbers of then."""
        made, old = self.made, self.before
        b = body_of(made.raw)
        b.k = old.b.k
        E = Step(b, old.x, old.v, made.h, old.n.ep, old.n.kappa, old.b)
        method, h, x, v = self.runs[0].method, made.h, old.x, old.v
        if method == "midpoint":
            E.w, E.tilde = h * h / 4, x + h / 2 * v
        if method == "bdf2" and old.before.runs[0].method == "bdf2":
            E.w = 4 / 9 * h * h
            E.tilde = (4 * x - old.before.x) / 3 + 2 * h / 9 * (
                4 * v - old.before.v)
        if method == "sdirk2":
            g = 1 - math.sqrt(0.5)
            E.w, E.tilde = (g * h)**2, x + g * h * v
            u = (E.minimise(1e-9)[1] - x) / (g * h)
            E.tilde = x + (1 - g) * h * u + g * h * (
                v + (1 - g) / g * (u - v))
        return E


class Frame:
    def __init__(self, raw, states, name):
        self.raw, self.name, self.page = raw, name, name.split()[0]
        self.states, self.lane, self.step = states, raw["active"], raw["step"]
        self.s = states[self.lane, self.step]
        pane = raw["panes"][self.lane]
        self.trace = Record(**pane["trace"]) if "trace" in pane else None
        self.x = np.array(pane["x"], float).reshape(-1, 2)
        self.scale = pane["stage"][1]
        self.cache = {}

    def once(self, key, make):
        if key not in self.cache:
            self.cache[key] = make()
        return self.cache[key]

    @property
    def clamp(self):
        return self.s.raw["filter"]

    @property
    def minimisation(self):
        return self.once("E", self.s.minimisation)

    def round(self, x):
        """p, slope, projected at an iterate of the step."""
        return self.once(x.tobytes(),
                         lambda: self.minimisation.direction(x, self.clamp))

    @property
    def iterate(self):
        x = np.array(self.trace.x, float).reshape(-1, 2)
        held = self.s.b.pinned
        if self.trace.i == 0 and held.any():  # they are moved before it begins
            x[held] = self.s.x[held]
        return x

    @property
    def tested(self):
        """The iterate whose p is tested: after the whole step, its end."""
        over = self.trace.line in (0, 8) and not self.trace.given_up
        return self.s.x if over else self.iterate

    def residual(self):
        E = self.minimisation
        p = self.round(self.tested)[0]
        # the state's digits: forces that cancel, times what H makes of them
        slack = 1e-13 * np.abs(self.tested).max() / E.h
        return E.residual(p), slack

    def alpha(self):
        return self.trace.first[0] * 2.0**(1 - max(self.trace.trials, 1))

    def change(self):
        p = self.round(self.iterate)[0]
        E = self.minimisation
        change = E.change(self.iterate, p, self.alpha())
        exact = not (E.b.obstacles or E.b.yield_strain)
        return change, (1e-9 * abs(float(change)) if exact else
                        1e-15 * abs(float(E.value(self.iterate))))

    # ---- descents: landscape, overshoot, tangent

    @functools.cached_property
    def plain(self):
        """Whether the loop is Algorithm 1, which tests the gradient."""
        return self.s.scene != "landscape" or (
            self.clamp == self.s.raw["search"] == "none")

    @functools.cached_property
    def descent(self):
        """The last update, x now, p there, what is tested there."""
        x, raw = self.s.x, self.s.raw
        search = self.s.made.raw["search"] != "none"
        old = self.states[self.lane, self.step - 1] if self.step else None
        if self.s.scene != "landscape":
            x, records = float(x[0, 0]), []
            if old:
                records = scalar_newton(self.function, float(old.x[0, 0]), 0, search,
                                        1)[0]
            p = scalar_newton(self.function, x, 0, search, 0)[2]
            return records, x, p, abs(self.function(x)[1])
        made = self.s.made.raw
        records = self.landscape(old.x, made).minimise(
            0, made["filter"], search, 1)[0] if old else []
        E = self.landscape(x, raw)
        p = E.direction(x, self.clamp)[0]
        return records, x, p, (np.hypot(*E.g[:2]) if self.plain else E.residual(p))

    @functools.cached_property
    def function(self):
        if self.s.scene == "overshoot":
            return log_two_cosh
        return line_energy(self.s.raw["line_target"][0], self.s.h)

    def landscape(self, x, raw):
        """The parts of E on the map."""
        parts = raw["parts"][0]
        b = Record(**{**vars(self.s.b), "m": (parts & 1) * self.s.b.m})
        E = Step(b, x, 0 * x, self.s.h)
        E.w *= parts >> 1
        E.tilde[0] = raw["target"]
        return E

    def part(self, x, parts=None):
        """E at a place of the map, J s^2: 1 inertia, 2 elasticity, 3 both."""
        parts = self.s.raw["parts"][0] if parts is None else parts
        b, h, at = self.s.b, self.s.h, self.s.x.copy()
        at[0] = x
        d = np.array(x) - self.s.raw["target"]
        P = potential(b, at)["elastic"]
        return (parts & 1) * b.m[0] * (d @ d) / 2 + (parts >> 1) * h * h * P

    def slope_of(self, clamp):
        """grad E . p at the iterate for the parts on the map."""
        return self.landscape(self.s.x, self.s.raw).direction(self.s.x, clamp)[1]


# ---- rules -----------------------------------------------------------------

RULES = []


def rule(pattern, whole=True):
    """What # should be: a function of the frame and the match's words."""
    expression = re.escape(plain(pattern)).replace(r"\#", NUMBER).replace(
        r"\~", r"(.*?)")
    if whole:
        expression = "^" + expression + "$"

    def keep(function):
        RULES.append((re.compile(expression), function, whole))
        return function
    return keep


UNITS = {"TJ": 1e12, "GJ": 1e9, "MJ": 1e6, "kJ": 1e3, "J": 1, "mJ": 1e-3,
         "µJ": 1e-6}
EXACT = 12  # digits of what is given


def given(name, digits=6):
    return lambda f, *_: [Near(getattr(f.s.b, name), digits)]


def count(n):
    return That(lambda x: x == n, "%g" % n)


def energy(f, name, number, unit):
    if "Euler" in name and f.raw["lanes"] > 1:
        return None
    if f.s.scene in ("arrows", "circle") and "Euler" in name:
        run = [r for r in f.s.runs
               if r.method == name.lower().replace(" ", "-")][0]
        true = ((run.x**2).sum() + (run.v**2).sum()) / 2
        return [Near(true / UNITS[unit], 3, 1e-13 * abs(true) / UNITS[unit])]
    slack = 2e-14 * f.s.size() / UNITS[unit]
    return [Near(f.s.energy(name) / UNITS[unit], 3, slack)]


for series in ("total kinetic elastic gravity contact hand plastic fracture "
               "friction work dissipated damping").split() + [
                   "forward Euler", "symplectic Euler", "backward Euler"]:
    for unit_ in UNITS:
        rule("%s # %s" % (series, unit_))(
            lambda f, n, name=series, unit=unit_: energy(f, name, n, unit))

rule("step #")(lambda f, n: [count(f.step)])


@rule("step #   t = # s")
def _(f, step, time):
    return [count(f.step), Near(f.s.time, 4)]


@rule("step #   t = # s   real time × #")
def _(f, step, time, speed):
    def a_power(x):  # 2^s steps a frame, 60 frames a second
        s = round(math.log2(x / (60 * f.s.h)))
        return Near(60 * f.s.h * 2.0**s, 2).holds("%.9g" % x)
    return [count(f.step), Near(f.s.time, 4), That(a_power, "60 h 2^s")]


@rule("step # of #   t = # s")
def _(f, step, newest, time):
    return [count(f.step), count(f.raw["newest"]), Near(f.s.time, 4)]


for turn_ in "iteration", "row", "turn", "run":
    rule(turn_ + " #")(lambda f, n: [count(f.step)])
    rule(turn_ + " # of #")(
        lambda f, n, m: [count(f.step), count(f.raw["newest"])])
rule("page # of 32 · K: its code and test")(
    lambda f, n: [count(PAGES.index(f.page) + 1)])
rule("steps # ... # are forgotten")(lambda f, a, b: [  # it may be told later
    between(1, f.step + 1), That(lambda x: x > value(a), "later")])
rule("step # is forgotten")(lambda f, a: [between(1, f.step + 1)])
rule("node # is ~")(lambda f, i, what: [
    That(lambda i: f.s.b.pinned[int(i)] == (what == "pinned"), "so")])

# the row: what stands before it is its name
SETTINGS = {"h": ("h", 4), "k": ("stiffness", 6), "stretch": ("stretch", 6),
            "segments": ("segments", 9), "ε": ("tolerance", 6), "μ": ("mu", 6),
            "η": ("damping", 6)}

# ---- lines of Algorithm 3


@rule("line 3: the blocks of # of # springs had a negative eigenvalue and were "
      "projected")
def _(f, n, springs):
    least, most = f.round(f.iterate)[2]
    return [between(least, most), count(len(f.s.b.l2))]


@rule("# of # springs")
def _(f, n, springs):
    least, most = (f.round(f.iterate)[2] if f.trace is not None else
                   f.descent[0][-1].projected)
    return [between(least, most), count(len(f.s.b.l2))]


@rule("line 3: # blocks of springs, contacts and cells had a negative "
      "eigenvalue and were projected")
def _(f, n):
    return [between(*f.round(f.iterate)[2])]


rule("# blocks")(lambda f, n: [between(*f.round(f.iterate)[2])])
rule("# block")(lambda f, n: [between(*f.round(f.iterate)[2])])
for line in (1, 4, 6):
    rule("line %d: the ~" % line)(lambda f, *_: [])
rule("line 2: the loop begins for the #~ time")(
    lambda f, n, th: [count(f.trace.i + 1)])
rule("line 5: {alpha} = # is ~")(lambda f, a, how: [Near(f.alpha()), search(f, how)])


def search(f, how):
    """Whether alpha may be taken, as the words say."""
    rises = f.change()[0] > f.change()[1]
    return rises == ("refused" in how) or f.s.raw["search"] == "none"


@rule("line 7: the residual is # m/s, ~above #")
def _(f, residual, no, tolerance):
    return [Near(*[f.residual()[0], 3, f.residual()[1]]), f.residual()[0] >
            f.s.b.tolerance or no == "not ", Near(f.s.b.tolerance)]


rule("line 7: ‖{p}‖_{∞}/h is not above # m/s: its ~ is below, and {p} is "
     "not needed")(given("tolerance", 3))
rule("≤ # m/s: it ends")(given("tolerance", 3))
rule("line 8: the step of # s is done")(given("h", 3))


@rule("‖{p}‖_{∞} = # m")
def _(f, p):
    r, slack = f.residual() if f.trace is not None else (f.descent[3], 0)
    return [Near(r * f.s.h, 3, slack * f.s.h)]


for sign_ in ">", "≤":
    for unit_ in "", " m/s", " m/s: given up":
        @rule("# %s #%s" % (sign_, unit_))
        def _(f, r, tolerance, sign=sign_):
            true, slack = (f.residual() if f.trace is not None else
                           (f.descent[3], 1e-15))
            return [Near(true, 3, slack), (true > f.s.b.tolerance) == (sign == ">"),
                    Near(f.s.b.tolerance)]


@rule("{alpha} = #~")
def _(f, a, rest):
    if f.trace is None:
        return [Near(f.descent[0][-1].alpha)]
    return [Near(f.alpha())] + ([search(f, rest)] if rest else [])


@rule("{alpha} = # ~: #")
def _(f, a, how, change):
    if f.trace is None:
        r = f.descent[0][-1]
        return [Near(r.alpha), Near(r.change, 3, 1e-15)]
    true, slack = f.change()
    return [Near(f.alpha()), search(f, how), Near(true, 3, slack)]


rule("off: {alpha} = 1")(lambda f: [])
rule("search direction p × #")(
    lambda f, n: [That(lambda x: math.log10(x) % 1 == 0, "a power of ten")])


# ---- what is told below the picture


@rule("~: E # in # update~; ~: E # in # update~")
def _(f, was, had, n, _, now, has, m, __):
    """The step with both settings, calculated twice."""
    rows = []
    if f.trace is None:
        for words in was, now:
            r = scalar_newton(f.function, f.descent[0][-1].x, 0, words != "full step",
                              1)[0][0]
            rows += [Near(r.change), count(1)]
        return rows
    for words in was, now:
        clamp, search = f.clamp, f.s.raw["search"] != "none"
        if "projection" in words:
            clamp = "none" if words == "no projection" else words.split()[-1]
        else:
            search = words != "full step"
        E = f.minimisation
        with np.errstate(all="ignore"):
            records, x = E.minimise(f.s.b.tolerance, clamp, search)
        change = E.value(x) - E.value(E.x_n)
        rows += [Near(change, 3, 1e-15 * abs(E.value(E.x_n))), count(len(records))]
    return rows


@rule("update # of #: E has risen by # J s², and nodes are # m away; N goes on")
def _(f, i, n, rise, far):
    E = f.minimisation
    with np.errstate(all="ignore"):
        records, x = E.minimise(f.s.b.tolerance, f.clamp, f.s.raw["search"] != "none")
    rises = [float(E.value(r.x + r.alpha * r.p) - E.value(E.x_n)) for r in records]
    return [count(int(np.argmax(rises)) + 1), count(len(records)),
            Near(max(rises), 3, 1e-9 * max(rises)),
            Near(max(np.abs(r.x).max() for r in records), 4)]


rule("ε is loose: above # m/s bodies may hang or freeze")(lambda f, e: [
    Near(min(0.1 * f.s.h * math.hypot(*f.s.b.g), 0.1 * f.s.b.slip_speed))])
rule("# side by side · ~")(lambda f, n, how: [count(f.raw["lanes"])])
rule("nothing deforms any more: free as it is, it drifts on at # m/s~")(
    lambda f, v, rest: [Near(np.hypot(*f.s.v.mean(0)), 2)])


@rule("~ # kJ")
def _(f, label, total):
    """One curve a pane."""
    lane = f.once("lanes", lambda: iter(range(f.raw["lanes"])))
    s = f.states[next(lane), f.step]
    return [Near(s.parts["total"] / 1e3, 3, 1e-14 * s.size())]


# ---- the square and what the mouse is over

@rule("# m", True)
def _(f, length):
    return [That(lambda x: ("%e" % x)[:8] in ("1.000000", "2.000000", "5.000000"),
                 "1, 2 or 5 times a power of ten")]


for unit_ in "mm", "km":
    rule("# " + unit_)(RULES[-1][1])


@rule("# cells folded over")
def _(f, n):
    return [That(lambda n: n in [folded(f, np.array(pane["x"], LONG).reshape(
        -1, 2)) for pane in f.raw["panes"]], "%d" % folded(f, f.x.astype(LONG)))]


rule("# cell folded over")(RULES[-1][1])


def folded(f, x):
    """Cells with a triangle that has turned over."""
    n = int(f.s.b.segments)
    at, cells = lambda i, j: i * (n + 1) + j, 0
    rows = (len(x) // (n + 1)) - 1
    cross = lambda d, e: d[0] * e[1] - d[1] * e[0]
    area = lambda p, q, r: cross(x[q] - x[p], x[r] - x[p])
    for i in range(n):
        for j in range(n):
            a, b = at(i, j), at(i + 1, j)
            c, d = at(i + 1, j + 1), at(i, j + 1)
            cells += area(a, b, c) < 0 or area(a, c, d) < 0
    return cells


@rule("-# %")
def _(f, strain):
    return [That(lambda x: 0 < x <= 100, "a strain")]


rule("+# %")(RULES[-1][1])
rule("# %")(RULES[-1][1])


@rule("contact force # N")
def _(f, force):
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
    return [Near(power * next(m for m in (1, 2, 5, 10)
                              if most <= m * power * (1 + 1e-9)))]


@rule("# μ = # tan #°: ~")
def _(f, grip, part, angle, how):
    """In the order of the runs."""
    run = f.once("slopes", lambda: iter(range(3)))
    r = next(run)
    b = body_of(f.s.raw, r)
    o = b.obstacles[0]
    slope = -o.n[0] / o.n[1]
    slips = [abs(np.array([-n[1], n[0]]) @ f.s.runs[r].v[i])
             for w, i, d, n, _ in touching(b, f.s.runs[r].x) if w.mu > 0]
    slides = bool(slips) and min(slips) >= b.slip_speed
    return [count((0.5, 0.9, 1.1)[r]), Near(o.mu / slope), Near(math.degrees(math.atan(slope))),
            (how == "slides") == slides]


def hovered(f, i, j=None):
    return f.raw["hover"][1]


@rule("node #~")
def _(f, n, pinned):
    i = f.raw["hover"][1]
    return [count(i), (pinned == ", pinned") == bool(f.s.b.pinned[i])]


rule("m = # kg")(lambda f, m: [Near(f.s.b.m[f.raw["hover"][1]])])


def vector(f, name):
    if f.s.scene == "dial":
        return [Near(x, decimals=4) for x in f.minimiser]
    i, b = f.raw["hover"][1], f.s.b
    tilde = f.x[i] + f.s.h * f.s.v[i]
    if f.trace is not None and f.trace.i >= 0 and f.s.step and (
            f.s.runs[0].method == "backward-euler"):
        tilde = f.minimisation.tilde[i]
    true = {"{x}": f.x, "v": f.s.v, "{xt}": [tilde] * (i + 1)}.get(name)
    true = force(b, f.x, f.s.n)[i] if true is None else true[i]
    scale = np.abs(f.x).max() * (b.k.max() if name == "f" else 1)
    return [Near(true[0], 3, 1e-14 * scale), Near(true[1], 3, 1e-14 * scale)]


for name_, unit_ in ("{x}", "m"), ("v", "m/s"), ("f", "N"), ("{xt}", "m"):
    rule("%s = (#, #) %s" % (name_, unit_))(
        lambda f, x, y, name=name_: vector(f, name))


@rule("spring #–#")
def _(f, i, j):
    a, b = f.s.b.e[f.raw["hover"][1]]
    return [count(a), count(b)]


@rule("l² = # m²,  strain # %")
def _(f, l2, strain):
    s = f.raw["hover"][1]
    q = strains(f.s.b, f.x.astype(LONG))[1][s]
    return [Near(f.s.b.l2[s]),
            Near(100 * (np.sqrt(q / f.s.b.l2[s]) - 1), 3, 1e-12)]


def spring_hessian(f, x, s):
    return next(blocks(f.s.b, x, f.s.n))[2][s][:2, :2]


def runs_of_numbers(f, texts):
    """Numbers that stand for themselves: by the words before them."""
    want = {}
    for k, (x, y, text) in enumerate(texts):
        if text == "its block of ∇²P, J/m²":
            H = spring_hessian(f, f.x, f.raw["hover"][1])
            true = np.kron([[1, -1], [-1, 1]], H).reshape(-1)
        elif text == "eigenvalues, and after projection":
            H = spring_hessian(f, f.x, f.raw["hover"][1])
            true = np.concatenate([[0, 0], 2 * np.linalg.eigvalsh(H)])
        elif text == "before" or text == "after projection":
            H = spring_hessian(f, f.s.x, 0)
            true = np.sort(np.concatenate([[0, 0], 2 * np.linalg.eigvalsh(H)]))
            if text != "before":
                true = np.sort(np.maximum(true, 0))
            for i in range(4):
                want[k + 1 + i] = Near(true[i], 3, 0.05 + 1e-9)
            continue
        elif re.search("(← start|← .*x.*n.*)$", text) and k and \
                texts[k - 1][2] == "1":
            for i in range(8):  # the numbers of a listing's lines
                rest = [j for j in range(k - 1, min(k + 30, len(texts)))
                        if texts[j][2] == str(i + 1) and
                        abs(texts[j][0] - texts[k - 1][0]) < 1]
                want.update({j: count(i + 1) for j in rest[:1]})
            continue
        else:
            continue
        for i, number in enumerate(true):
            want[k + 1 + i] = Near(number, 3, 1e-9 * np.abs(true).max())
    return want


def ticks(f, texts):
    """Numbers at axes stand where their value belongs."""
    want = {}
    for row in f.raw["plots"]:
        x0, y0, wide, high, xl, xh, xlog, yl, yh, ylog, first, last = row["p"]
        part = lambda v, low, high, log: (
            math.log(v / low) / math.log(high / low) if log
            else (v - low) / (high - low)) if not log or v > 0 else math.nan
        for k in range(int(first), int(last)):
            x, y, text = texts[k]
            if not re.fullmatch(NUMBER, text):
                continue
            v = value(text)
            if x < x0:
                em = (x0 - x) / 0.35
                off = y0 + (1 - part(v, yl, yh, ylog)) * high - 0.533 * em - y
            else:
                off = x0 + part(v, xl, xh, xlog) * wide - x
            want[k] = That(lambda v, off=off: abs(off) < 0.05, "%g px off" % off)
    return want


def contour(f, x, y):
    """E within two pixels of the place where a contour's number stands."""
    x0, y0, wide, high, xl, xh, _, yl, yh, _, _, _ = f.raw["plots"][0]["p"]
    middle = y + 0.53 * 21  # pixels an em
    near = [f.part((xl + (x + i) / wide * (xh - xl),
                    yh - (middle + j) / high * (yh - yl)))
            for i in (-2, 0, 2) for j in (-1, 0, 1)]
    return between(min(near) * (1 - 2e-3), max(near) * (1 + 2e-3))


def frame_is(f, kind):
    return f.name.endswith(kind)


def alone(f, texts, k):
    """A number that is a text of its own."""
    x, y, text = texts[k]
    before = texts[k - 1][2] if k else ""
    if frame_is(f, "pages") and k + 1 < len(texts) and x > 900:
        return between(1, len(PAGES))
    if before == "solver" or f.s.scene in ("landscape", "dial") and k < 60:
        return contour(f, x, y)
    if f.page in ("solid", "mesh", "square"):
        i = int(value(text))
        if i < len(f.x):
            way = (f.x[i] - f.x[0]) * f.scale
            zero = next(t for t in texts if t[2] == "0")
            off = math.hypot(x - zero[0] - way[0], y - zero[1] + way[1])
            return That(lambda v: off < 0.1, "beside its node")
    if text == "0" and k + 1 < len(texts) and texts[k + 1][2] == "plastic strain":
        return count(0)
    if f.s.scene == "envelope":
        return That(lambda v: True, "")  # placed below
    return None


# ---- small scenes

rule("exact: |{x}| = # m")(lambda f, n: [count(1)])
for name_ in "Forward Euler", "Symplectic Euler", "Backward Euler":
    label = name_.lower().replace("euler", "Euler")
    rule(label + ": # m")(lambda f, n, m=name_.lower().replace(" ", "-"): [
        Near(np.hypot(*[r.x for r in f.s.runs if r.method == m][0][0]))])
rule("3 integrators · ~")(lambda f, how: [len(f.s.runs) == 3])
rule("6 methods · ~")(lambda f, how: [])
rule("shorter than l: it has an eigenvalue below 0")(lambda f: [])


def mass_step(f, r=0):
    run = f.s.runs[r]
    x, v, h, w = run.x[0], run.v[0], f.s.h, f.s.b.omega2
    if run.method == "backward-euler":
        new_v = (v - h * w * x) / (1 + h * h * w)
        return x, v, -w * (x + h * new_v), x + h * new_v, new_v, new_v
    new_v = v - h * w * x
    used = v if run.method == "forward-euler" else new_v
    return x, v, -w * x, x + h * used, new_v, used


@rule("    = (#, #) + # (#, #) = (#, #)")
def _(f, *_):
    x, v, a, new_x, new_v, used = mass_step(f)
    first = f.once("second", lambda: [])
    row = (v, a, new_v) if not first else (x, used, new_x)
    first.append(1)
    near = lambda p: [Near(p[0], 3, 1e-15), Near(p[1], 3, 1e-15)]
    return near(row[0]) + [Near(f.s.h)] + near(row[1]) + near(row[2])


def mass_energy(f, method):
    r = [r.method for r in f.s.runs].index(method) if method else 0
    x, v, _, new_x, new_v, _ = mass_step(f, r)
    E, new = (x @ x + v @ v) / 2, (new_x @ new_x + new_v @ new_v) / 2
    return [Near(E, 4), Near(new, 4), Near(new / E, 4)]


rule("energy # J → # J  (× #)")(lambda f, *_: mass_energy(f, None))
rule("~: energy # J → # J  (× #)")(
    lambda f, name, *_: mass_energy(f, name.lower().replace(" ", "-")))


@rule("# m off")
def _(f, off):
    guess, b = np.array(f.s.raw["guess"]), f.s
    if f.s.scene in ("tangent", "overshoot"):
        return [Near(abs(guess[0] - f.descent[1]), 3, 1e-12)]
    return [Near(np.hypot(*(guess - f.s.x[0])), 3, 1e-12)]


rule("h = # s")(lambda f, h: [
    That(lambda x: x in (0.01, 0.1, 1, 10), "a mark") if len(h) < 5 and
    f.once("marks " + h, lambda: h) and f.once("n" + h, lambda: 1) and
    not Near(f.s.h, 4).holds(h) else Near(f.s.h, 4)])
rule("from {xt}: # m")(lambda f, d: [
    Near(np.hypot(*(f.minimiser - f.s.raw["target"])), 4, 1e-13)])
rule("inertia # J s²")(lambda f, E: [Near(f.part(f.minimiser, 1), 4, 1e-15)])
rule("elasticity h² P # J s²")(
    lambda f, E: [Near(f.part(f.minimiser, 2), 4, 1e-15)])
rule("P = # J")(lambda f, P: [
    Near(f.part(f.minimiser, 2) / f.s.h**2, 4, 1e-13)])


def minimiser(f):
    """For this h, from x_tilde: a hundred longer and longer steps."""
    x = f.s.x.copy()
    x[0] = f.s.raw["target"]
    for h in np.geomspace(1e-3, f.s.h, 25):
        E = f.landscape(x, {**f.s.raw, "parts": [3]})
        E.h, E.w = h, h * h
        E.x_n = x
        x = E.minimise(1e-13 / h)[1]
    return x[0]


Frame.minimiser = property(lambda f: f.once("dial", lambda: minimiser(f)))


def update(f):
    """The last update of a descent, or the one to come: number, x, p."""
    records, x, p, _ = f.descent
    last = f.step - 1
    return (last, records[-1].x, records[-1].p) if records else (0, x, p)


@rule("x^{#} = #")
def _(f, i, x):
    n, x0, p = update(f)
    second = f.once("x", lambda: [])
    second.append(1)
    return ([count(n), Near(x0, 8)] if len(second) == 1 else
            [count(n + 1), Near(x0 + length(f) * p, 8)])


def length(f):
    return f.descent[0][-1].alpha if f.descent[0] else 1


rule("x^{#} + {p} = #")(lambda f, n, x: [count(update(f)[0]), Near(
    sum(update(f)[1:]), 8)])
rule("x^{#} = #,  {alpha} = #")(lambda f, n, x, a: [
    count(update(f)[0] + 1), Near(update(f)[1] + length(f) * update(f)[2], 8),
    count(length(f))])


rule("g = #     E″ = #")(lambda f, g, H: [
    Near(f.function(update(f)[1])[1], 6, 1e-13),
    Near(f.function(update(f)[1])[2], 6)])
rule("{p} = -g / E″ = #")(lambda f, p: [Near(update(f)[2], 8, 1e-15)])
rule("E: # → #")(lambda f, a, b: [
    Near(f.function(update(f)[1])[0], 8),
    Near(f.function(update(f)[1] + length(f) * update(f)[2])[0], 8)])
rule("quadratic model at x^{#}")(lambda f, n: [count(update(f)[0])])
rule("~to x = #~")(lambda f, left, x, right: [Near(update(f)[1] + update(f)[2])])
rule("x^{#}")(lambda f, n: [between(0, f.step)])
for name_, clamp_ in (("with projection", "clamp"), ("without", "none"),
                      ("inertia alone", "clamp"), ("elasticity alone", "clamp")):
    rule(name_ + " (slope #)")(
        lambda f, s, c=clamp_: [Near(f.slope_of(c), 2, 1e-12)])


def facts(f):
    b, d = f.s.b, f.s.x[0] - f.s.x[1]
    r, l2, k = np.hypot(*d), b.l2[0], b.k[0]
    s = (r * r - l2) / l2
    return Record(d=d, r=r, l=math.sqrt(l2), k=k, s=s, P=l2 * k / 2 * s * s,
                  f=-2 * k * s * d, along=2 * k / l2 * (3 * r * r - l2),
                  across=2 * k / l2 * (r * r - l2))


@rule("d = (#, #) m   |d| = # m   l = # m")
def _(f, *_):
    a = facts(f)
    return [Near(a.d[0]), Near(a.d[1]), Near(a.r, 4), Near(a.l)]


rule("s = |d|²/l² - 1 = #")(lambda f, s: [Near(facts(f).s, 4, 1e-15)])


@rule("P = l² k/2 s² = # · #/2 · #² = # J")
def _(f, *_):
    a = facts(f)
    return [Near(a.l**2), Near(a.k), That(lambda s: s >= 0 and Near(
        a.s, 4).holds("%.9g" % s), "s, in parentheses if below 0"), Near(a.P, 5)]


@rule("P = l² k/2 s² = # · #/2 · (#)² = # J")
def _(f, *_):
    a = facts(f)
    return [Near(a.l**2), Near(a.k), Near(a.s, 4), Near(a.P, 5)]


rule("f = -2 k s d = (#, #) N")(lambda f, x, y: [
    Near(facts(f).f[0], 4, 1e-13), Near(facts(f).f[1], 4, 1e-13)])


@rule("curvature along #, across # J/m²")
def _(f, along, across):
    a = facts(f)
    if f.once("root", lambda: []):
        return [Near(4 * a.k, 4), Near(4 * a.k * (1 - a.l / a.r), 4)]
    f.cache["root"].append(1)
    return [Near(a.along, 4), Near(a.across, 4)]


rule("with the root: 2k (|d| - l)² = # J")(lambda f, P: [
    Near(2 * facts(f).k * (facts(f).r - facts(f).l)**2, 5)])

# ---- race and map

H_RACE = [0.064 / (8 << i) for i in range(7)]
rule("# of # runs, # s of motion each")(lambda f, n, all_, t: [
    count(f.step), count(42), Near(0.064)])
rule("error at most # m:")(lambda f, e: [
    That(lambda x: x in (1e-2, 1e-4, 1e-6), "two powers of ten apart")])
rule("    ~: # ms with h = # ms")(lambda f, name, t, h: [
    MEASURED, That(lambda x: any(Near(1e3 * a).holds(h) for a in H_RACE),
                   "h of a run")])


@functools.lru_cache(None)
def cell(h, k, segments, stretch, tolerance):
    """Three steps of a cell of the map: updates of each."""
    b, x = square(int(segments), k=k, stretch=stretch)
    v, updates = 0 * x, []
    for _ in range(3):
        E = Step(b, x, v, h)
        records, new = E.minimise(tolerance)
        v, x = (new - x) / h, new
        updates.append(len(records))
    return sum(updates)


def shown_cell(f):
    column, row = f.s.raw["cell"]
    return 10**(column / 2 - 9), 10.0**(row - 6)


rule("h = # s,  k = # J/m²")(lambda f, *_: [Near(c) for c in shown_cell(f)])
@rule("# steps, # Newton updates")
def _(f, steps, updates):
    h, k = shown_cell(f)
    if h * h * k > 1e10:  # beyond: digits of masses are lost beside springs
        return [count(3), MEASURED]
    return [count(3), count(cell(h, k, f.s.b.segments, f.s.b.stretch,
                                 f.s.b.tolerance))]


@rule("# of # cells converge")
def _(f, converged, known):
    cells = 25 * f.step + sum(row >= f.step for column, row in f.s.cells)
    return [That(lambda x: x <= value(known), "at most all"), count(cells)]


@functools.lru_cache(None)
def idle(column, row, segments=4, stretch=1.4, tolerance=0.01):
    """Whether a cell's first step passes the test where it begins."""
    b, x = square(int(segments), k=10.0**(row - 6), stretch=stretch)
    E = Step(b, x, 0 * x, 10**(column / 2 - 9))
    return E.residual(E.direction(x)[0]) <= tolerance


@rule("in # nothing was done")
def _(f, n):
    known = set(f.s.cells) | {(c, r) for r in range(f.step) for c in range(25)}
    return [count(sum(idle(*cell, f.s.b.segments, f.s.b.stretch, f.s.b.tolerance)
                      for cell in known))]


rule("ε: h ε = # m")(lambda f, n: [Near(f.s.h * f.s.b.tolerance)])
rule("ε lets # m pass: h ε")(lambda f, n: [
    Near(shown_cell(f)[0] * f.s.b.tolerance)])

# ---- the words of the pages

def says(page, pattern, *true):
    """What a page says: numbers, or a function without arguments of them."""
    def check(f, *_):
        now = true[0]() if true and callable(true[0]) else true
        return [t if isinstance(t, (Near, That, bool)) else
                count(t) if isinstance(t, (int, np.integer)) else Near(t)
                for t in now]
    rule(pattern, whole=False)(lambda f, *w: None if f.page != page else check(f))


def kinds(n):
    b, x = square(n)
    d = np.abs(x[b.e[:, 0]] - x[b.e[:, 1]]) / (1.4, 1) > 1e-9
    return ((d[:, 0] & ~d[:, 1]).sum(), (d[:, 1] & ~d[:, 0]).sum(),
            (d[:, 0] & d[:, 1]).sum())


def at_node(n, i, j):
    x = square(n, stretch=1)[1] * n + n / 2
    return [int(k) for k in range(len(x)) if np.allclose(x[k], (i, j))][0]


S4, X4 = square(4)


def polynomials():
    """a, b, c of (n + a)^2 nodes and b n^2 + c n springs, from two squares."""
    e = [len(square(n)[0].e) for n in (1, 2)]
    return [math.isqrt(len(S4.m)) - 4, (e[1] - 2 * e[0]) // 2, e[0] - (
        e[1] - 2 * e[0]) // 2]


says("solid", "With # segments # masses and # springs, with n (n + #)² and #n² + #n:",
     lambda: [4, len(S4.m), len(S4.e)] + polynomials())
says("solid", "the same # kg", float(S4.m.sum()))
says("solid", "# segments give # masses and # springs", 4, len(S4.m), len(S4.e))
says("solid", "have # kg", lambda: (square(7)[0].m.sum(),))
says("mesh", "node i (n + #) + j", 1)
says("mesh", "With n = #: # lower left, # upper right", 2, at_node(2, 0, 0), at_node(2, 2, 2))
says("mesh", "# springs are horizontal, # vertical, # diagonal", *kinds(2))
says("mesh", "# segments node # is above node # and node # to its right", 2,
     at_node(2, 0, 1), at_node(2, 0, 0), at_node(2, 1, 0))
says("mesh", "joins # and #,", *map(int, square(2)[0].e[0]))
says("mesh", "is # or #.", *sorted(set(np.round(square(2)[0].l2, 9))))
says("equation", "the # masses is # kg", len(S4.m), float(S4.m[0]))
says("equation", "after # steps the middle of the square has not moved",
     lambda: [That(lambda n: np.abs(relaxed(int(n))[-1][0].mean(0)).max() < 1e-12,
                   "the middle has not moved")])


@functools.lru_cache(None)
def relaxed(steps, tolerance=0.01):
    """The default square: x, updates of each step, energy after it."""
    x, v, rows = X4, 0 * X4, []
    for _ in range(steps):
        records, new = Step(S4, x, v, 0.004).minimise(tolerance)
        v, x = (new - x) / 0.004, new
        rows.append((x, records, sum(potential(S4, x).values())
                     + (S4.m[:, None] * v * v).sum() / 2))
    return rows


def euler(method, h=0.5, w=1.0, steps=1):
    b = Record(m=np.ones(1), omega2=w * w)
    s = Record(runs=[Record(method=method, x=np.array([[1.0, 0]]),
                            v=np.array([[0, w]]))], h=h, b=b)
    rows = []
    for _ in range(steps):
        _, _, _, x, v, _ = mass_step(Record(s=s))
        s.runs[0].x, s.runs[0].v = x[None], v[None]
        rows.append((x, v))
    return rows


def one_step(method):
    x, v = euler(method)[0]
    return (1, 0, 0, 1, 0.5, float(x[0]), float(x[1]))


for page_, method_ in ("forward", "forward-euler"), ("backward", "backward-euler"):
    says(page_, "One step from (#, #) with v = (#, #) and h = # leads to (#, #)",
         lambda m=method_: one_step(m))
    E1 = lambda x, v: x @ x / 2 + v @ v / 2
    says(page_, "the energy by # + h²", lambda m=method_: [That(
        lambda one: np.isclose(max(E1(*euler(m)[0]), 1 / E1(*euler(m)[0])),
                               one + 0.25), "1")])


def flies(h):
    return np.hypot(*euler("symplectic-euler", h, 1, 400)[-1][0]) > 100


says("symplectic", "From h = # s on the mass flies away", lambda: [That(
    lambda h: flies(h) and not flies(0.99 * h), "the limit of h")])
says("symplectic", "through # steps with h = #.", lambda: [That(
    lambda n: np.ptp([x @ x + v @ v - 0.5 * x @ v for x, v in euler(
        "symplectic-euler", 0.5, 1, int(n))]) < 1e-11, "it stays"), 0.5])
TURN = 2 * math.pi
says("stability", "√(# + h²ω²)", 1)
says("stability", "h = # s each step of forward Euler multiplies the radius by #",
     0.02, Near(math.hypot(1, 0.02 * TURN), 6))
says("stability", "Above #/ω = # s the", 2, 2 / TURN)
says("stability", "with # s within # m, with # s not for # steps", lambda: [
    0.31, That(lambda m: 0.75 * m < largest(0.31, 1000) < m, "largest way"), 0.33,
    That(lambda n: largest(0.33, int(n)) > 7, "flies away")])


def largest(h, steps):
    return max(np.hypot(*x) for x, _ in euler("symplectic-euler", h, TURN, steps))


says("stability", "within # percent", lambda: [That(lambda p: 0.75 * p < 100 * max(
    abs(np.hypot(*x) - 1) for x, v in euler("symplectic-euler", 0.02, TURN, 500)
) < p, "the largest way off")])


@functools.lru_cache(None)
def overflows(h, steps, method="symplectic-euler"):
    x, v = X4, 0 * X4
    for n in range(steps):
        x, v = explicit(S4, x, v, h, method)
        if not np.isfinite(x).all():
            return n + 1
    return math.inf


def ends(h):
    return cell(h, 1e5, 4, 1.4, 0.01) < 3 * 300


says("explicit", "h down to # s", lambda: [That(
    lambda h: overflows(h, 300) == math.inf, "it swings on")])
says("explicit", "h = # s symplectic Euler overflows within # steps, with # s it "
     "swings on for #; backward Euler ends every step with # s and with # s",
     lambda: [0.008, That(lambda n: overflows(0.008, int(n)) <= n, "overflows"),
              0.003, That(lambda n: overflows(0.003, int(n)) == math.inf, "holds"),
              That(ends, "ends"), That(ends, "ends")])


@functools.lru_cache(None)
def tangent():
    return scalar_newton(line_energy(2, 0.3), 2.5, 1e-10)


def third(x):  # of the energy: g″
    return 2 * 0.09 * 10 * 6 * x


says("tangent", "From # six updates reach the root # and near it each error is "
     "g″/(# g′) = # times", lambda: [
         2.5, Near(tangent()[1], 6), 2,
         Near(third(tangent()[1]) / 2 / line_energy(2, 0.3)(tangent()[1])[2], 2)])
says("tangent", "From # six updates reach the root #, and near it each error is "
     "g″/(# g′) = # times", lambda: [
         That(lambda x: x == 2.5 and len(tangent()[0]) == 6, "six updates from 2.5"),
         Near(tangent()[1], 6), 2,
         Near(third(tangent()[1]) / 2 / line_energy(2, 0.3)(tangent()[1])[2], 2)])


@functools.lru_cache(None)
def map_step(x, y, target=(0.2, 0.3), h=0.2):
    """The landscape: two springs of 1.5 m from pins 2 m apart to one mass."""
    b = Record(**{**vars(S4), "m": np.ones(3), "e": np.array([[0, 1], [0, 2]]),
                  "l2": np.full(2, 2.25), "k": np.full(2, 100.0),
                  "pinned": np.array([False, True, True])})
    at = np.array([[x, y], [-1, 0], [1, 0.0]])
    E = Step(b, at, 0 * at, h)
    E.tilde[0] = target
    return E, at


def direction(x, y, clamp):
    E, at = map_step(x, y)
    return E.direction(at, clamp)[1]


says("newton", "(#, #) Algorithm 1 needs # updates", lambda: [0.6, 0.9, len(
    map_step(0.6, 0.9)[0].minimise(1e-6, "none", False)[0])])


def solved_digits():
    E, at = map_step(0.6, 0.9)
    worst = 0
    for r in E.minimise(1e-6, "none", False)[0]:
        p = E.direction(r.x, "none")[0].reshape(-1)
        worst = max(worst, np.abs(E.H @ p + E.g)[:2].max() / np.abs(E.g[:2]).max())
    return worst


says("newton", "from (#, #) it ends on a saddle", lambda: [
    0.05, -0.05, saddle(0.05, -0.05)])


def saddle(x, y):
    E, at = map_step(x, y)
    end = E.minimise(0, "none", False, 8)[1]
    p = E.direction(end, "none")[0]
    low = np.linalg.eigvalsh(E.H[:2, :2])
    return bool(low[0] < 0 < low[1] and np.abs(p[0]).max() < 1e-9)


says("newton", "to # digits", lambda: [That(
    lambda n: solved_digits() < 10**-n, "digits")])


@functools.lru_cache(None)
def swings(start, search=False):
    return scalar_newton(log_two_cosh, start, 1e-10, search)


def converges(start):
    return abs(swings(start)[2]) <= 1e-10 and abs(swings(start)[1]) < 1e-9


def after(start, n):
    r = swings(start)[0][n - 1]
    return r.x + r.p


BEYOND = That(lambda x: x < abs(after(2, 2)) < 1.2 * x, "beyond")
SWINGS = That(lambda x: x == 1.09 and not converges(x) and sum(
    abs(r.x + r.p) > abs(r.x) for r in swings(x)[0]) >= 7, "seven, each wider")
says("overshoot", "from # the first step leads to # and the next one beyond #",
     lambda: [2, Near(after(2, 1)), BEYOND])
says("overshoot", "nearer to # than # it converges", lambda: [0, That(
    lambda x: converges(x) and not converges(x + 1e-4), "the border")])
says("overshoot", "From # the first update leads to # and the next beyond #; from "
     "# it converges, from # it makes", lambda: [
         2, Near(after(2, 1), 5), BEYOND, That(converges, "converges"), SWINGS])
says("algorithm2", "Begin with α = #", 1)
LENGTHS = [r.alpha for r in swings(2, True)[0]]
says("algorithm2", "From # the first step takes α = #, the second #, all others #",
     lambda: [2, LENGTHS[0], LENGTHS[1], That(
         lambda x: set(LENGTHS[2:]) == {x}, "all others")])
says("algorithm2", "From # the step lengths are #, #, #, #, #, #,",
     lambda: [2] + LENGTHS)


@functools.lru_cache(None)
def first_step(n, h, stretch, clamp, search, tolerance=0.01):
    b, x = square(n, stretch=stretch)
    E = Step(b, x, 0 * x, h)
    with np.errstate(all="ignore"):
        records, end = E.minimise(tolerance, clamp, search)
    E0, rise = E.value(x), 0
    for r in records:
        rise = max(rise, float(E.value(r.x + r.alpha * r.p) - E0))
    far = max(np.abs(r.x).max() for r in records)
    return Record(E=E, records=records, end=end, rise=rise, far=far)


def explosion(clamp="none", search=False):
    return first_step(3, 0.02, 0.485, clamp, search)


RISE = That(lambda x: x < explosion().rise * (1 + 0.3) and
            explosion().rise < 3 * x, "the height of E")
says("explodes", "E rises to #, nodes fly over a kilometre", lambda: [RISE])
says("explodes", "E rises above # and", lambda: [RISE])
says("explodes", "tames it: # updates", lambda: [len(
    explosion("clamp").records)])
says("explodes", "it converges in # updates", lambda: [len(
    explosion("clamp").records)])
says("dial", "h = # ms the minimiser is within # mm of x̃, at # s within # mm of "
     "rest", lambda: [1, That(lambda mm: way_off(1e-3)[0] < 1e-3 * mm, "of x̃"),
                      10, That(lambda mm: way_off(10)[1] < 1e-3 * mm, "of rest")])


@functools.lru_cache(None)
def way_off(h):
    x = np.array([0.2, 0.3])
    for g in np.geomspace(1e-4, h, 30):
        E, at = map_step(*x, h=g)
        x = E.minimise(1e-13 / g)[1][0]
    return (np.hypot(*(x - (0.2, 0.3))),
            max(abs(np.hypot(x[0] + s, x[1]) - 1.5) for s in (-1, 1)))


says("inertia", "At (#, #) it is # J s²", lambda: [
    0.6, 0.9, 0.5 * ((0.6 - 0.2)**2 + (0.9 - 0.3)**2)])


def lengths(f=None):
    return [r.alpha for n in range(1) for r in alpha_step().records]


@functools.lru_cache(None)
def alpha_step():
    return first_step(4, 0.1, 0.2, "clamp", True)


says("alpha", "but at α = # it may be", lambda: [That(
    lambda a: min(lengths()) < a, "a length that is refused")])
says("alpha", "In the first step α = # would raise E, and one of its updates is "
     "made with α = #", lambda: [That(lambda a: min(lengths()) < a, "refused"), That(
         lambda a: a in lengths(), "one of its lengths")])
says("descent", "negative eigenvalues set to #", 0)
says("descent", "At (#, #) ∇E·p is above # without and below # with projection; "
     "from each of # starts", lambda: [
         0.1, -0.35, That(lambda s: direction(0.1, -0.35, "none") > s, "uphill"),
         That(lambda s: direction(0.1, -0.35, "clamp") < s, "downhill"),
         That(lambda n: all(direction(x, y, "clamp") < 0 for x in np.linspace(
             -1.6, 1.6, 17) for y in np.linspace(-1.6, 1.6, 17)) and n == 17**2,
             "all downhill")])
says("psd", "replaced by #", 0)
says("psd", "set to #", 0)
says("psd", "above # m nothing is changed, below # m nothing", 1, 1 / math.sqrt(3))
says("psd", "has the eigenvalues #, #, and twice", lambda: np.sort(np.abs(
    np.linalg.eigvalsh(np.kron([[1, -1], [-1, 1]], [[3, 1], [1, 2.0]]))))[:2]
     .round(9))
says("psd", "leaves only #", 0)
for words_ in "smooth even at length #", "kink at length #", "At length # one":
    says("energy", words_, 0)


def root_curvature(k=1.0, r=1e-3):
    P = lambda x, y: 2 * k * (math.hypot(x, y) - 1)**2
    e = 1e-6
    return (P(r, e) - 2 * P(r, 0) + P(r, -e)) / e**2


says("energy", "the curvature #k along", 4)
says("energy", "At # mm the curvature across is -2k for P and # k with",
     lambda: [1, Near(root_curvature(), 4)])


def one_spring(x, y, k=100.0):
    s = x * x + y * y - 1
    return k / 2 * s * s, -2 * k * s * x, -2 * k * s * y


says("force", "At d = (#, #) the energy is # J and the force (#, #) N", lambda: [
    1.2, 0.5] + [Near(v, 5) for v in one_spring(1.2, 0.5)])


def stored():
    pairs = {(a, b) for a, b in S4.e.tolist()}
    return 4 * (2 * len(pairs) + len(S4.m))


says("potential", "a # × # block", 2, 2)
says("potential", "# + # × # triplets fall on # of the # places", lambda: [
    2 * len(S4.m), len(S4.e), 16, stored(), (2 * len(S4.m))**2])


@functools.lru_cache(None)
def squeezed():
    return first_step(4, 0.02, 0.5, "clamp", True)


says("algorithm3", "projects # of # springs, takes # updates with α = #", lambda: [
    between(*squeezed().records[0].projected), len(S4.e), len(squeezed().records),
    That(lambda a: {r.alpha for r in squeezed().records} == {a}, "each α")])
says("step", "as in numpy for an n × # array", 2)


def fine():
    return Step(S4, X4, 0 * X4, 0.004).minimise(1e-6)[0]


def falls(i):
    r = [u.residual for u in fine()]
    return r[i] / r[i + 1]


def coarse():
    return Step(S4, X4, 0 * X4, 0.004).minimise(1e-2)[0]


says("step", "by a factor of #, then of #", lambda: [
    Near(falls(0), 2), Near(falls(1), 2)])
says("step", "up to # m/s, as on", 0.01)
says("step", "tolerance of # m/s costs # updates more than # m/s", lambda: [
    1e-6, len(fine()) - len(coarse()), 1e-2])
says("simulator", "In # steps every one converges", lambda: [That(
    lambda n: all(b[2] < a[2] for a, b in zip(relaxed(50), relaxed(50)[1:]))
    and n == 50, "the energy never rises")])


# ---- what whole runs promise: played once, in long tests

LONG_RUNS = {"drop": "drop", "slope": "slope", "0.41": "slope --friction 0.41",
             "0.32": "slope --friction 0.32", "dent": "dent", "tear": "tear"}
PLAYED = {}


def played(name, test):
    """Of the states of a run; without them the number is taken as it is."""
    return lambda: [That(lambda x: name not in PLAYED or test(PLAYED[name], x),
                         "of %s" % name)]


def gaps(states):
    least = math.inf
    for s in states:
        for o in s.b.obstacles:
            least = min(least, ((s.x - o.o) @ o.n).min() if o.kind == 0 else
                        np.hypot(*(s.x - o.o).T).min() - o.radius)
    return least


def slid(states, run):
    a, b = states[0].runs[run].x.mean(0), states[300].runs[run].x.mean(0)
    return math.hypot(*(b - a))


def broken(states, step):
    return (states[step].b.k == 0).sum() - (states[0].b.k == 0).sum()


def adds_up(states):
    """What backward Euler has taken is never below 0, beside the rest."""
    lost = [float(s.energy("dissipated")) for s in states]
    return min(np.diff(lost)) > -1e-6 * states[0].size()


def both(*checks):
    return lambda: [n for check in checks for n in check()]


says("contact", "In # steps every one converges, and no node comes nearer to floor "
     "or walls than # mm", both(played("drop", lambda s, n: n == 300), played(
         "drop", lambda s, mm: gaps(s[:301]) > 1e-3 * mm)))
says("friction", "a slope of #°", 20)
says("friction", "tan #° = #", 20, Near(math.tan(math.radians(20))))
says("friction", "the blocks have #, #, # times it. Above # the second", 0.5, 0.9,
     1.1, Near(math.tan(math.radians(20)) / 0.9))
says("friction", "In # s the first block slides more than # m along, the last one "
     "less than # cm. With μ = # the second one comes to rest within # cm, with # it "
     "does not; with μ = # the third one slides more than # cm", both(
         lambda: [3], played("slope", lambda s, m: slid(s, 0) > m),
         played("slope", lambda s, cm: slid(s, 2) < cm / 100), lambda: [0.41],
         played("0.41", lambda s, cm: slid(s, 1) < cm / 100), lambda: [0.4],
         lambda: [0.32], played("0.32", lambda s, cm: slid(s, 2) > cm / 100)))
says("inelastic", "After # steps a spring has a plastic strain above #, all", both(
    played("dent", lambda s, n: n == 300 and adds_up(s) and gaps(s) > 0),
    played("dent", lambda s, e: np.abs(s[300].n.ep).max() > e)))
says("fracture", "In the first # steps no spring breaks, after # steps more than # "
     "have", both(played("tear", lambda s, n: broken(s, int(n)) == 0),
                  played("tear", lambda s, n: n == 100),
                  played("tear", lambda s, n: broken(s, 100) > n)))


@functools.lru_cache(None)
def order(method):
    """Errors of a run of 0.064 s with 64 and 128 steps, by a finer one."""
    b, x0 = square(4, stretch=1.1)
    g = 1 / (4 - 4**(1 / 3))
    share = (g, g, 1 - 4 * g, g, g) if method == "avf4" else (1,)

    def end(steps, method=method, share=share):
        x, v = x0, 0 * x0
        for _ in range(steps):
            for part in share:
                h = part * 0.064 / steps
                if method in ("forward-euler", "symplectic-euler", "verlet"):
                    x, v = explicit(b, x, v, h, method)
                    continue
                w = dict(midpoint=0.25, avf4=0.5).get(method, 1) * h * h
                E = Step(b, x, v * (0.5 if method == "midpoint" else 1), h)
                E.w = w
                y = E.averaged() if method == "avf4" else E.minimise(1e-9)[1]
                u = y - x
                scale = dict(midpoint=2).get(method, 1)
                x = x + scale * u
                v = u / h if scale * w == h * h else (
                    4 * u / h - v if method == "midpoint" else 2 * u / h - v)
        return x
    exact = end(4096, "verlet", (1,))
    errors = [np.abs(end(n) - exact).max() for n in (64, 128)]
    return errors[0] / errors[1]


def divides(*methods):
    return That(lambda n: not PLAYED or all(
        abs(math.log2(order(m)) - math.log2(n)) < 0.2 for m in methods), "orders")


says("race", "divides the error by # for the Euler methods, by # for Verlet and "
     "midpoint, by # for AVF of #th order", lambda: [
         divides("forward-euler", "symplectic-euler", "backward-euler"),
         divides("verlet", "midpoint"), divides("avf4"), 4])
rule("AVF, #th order")(lambda f, n: [count(4)])
says("race", "With # ms Verlet explodes after the race, with # ms it does not",
     lambda: [That(lambda ms: verlet_flies(ms / 1e3), "explodes"),
              That(lambda ms: not verlet_flies(ms / 1e3), "does not")])


@functools.lru_cache(None)
def verlet_flies(h):
    b, x = square(4, stretch=1.1)
    v = 0 * x
    for _ in range(1000):
        x, v = explicit(b, x, v, h, "verlet")
        if not np.abs(x).max() < 10:
            return True
    return False


says("trust", "over # powers of ten", 21)
says("trust", "In # of the # cells every", lambda: [That(
    # where h^2 k is beyond all digits of the masses the program goes on
    lambda n: n <= sum(idle(c, r) for c in range(25) for r in range(22)) < 1.06 * n,
    "cells that pass"), 550])
says("trust", "at least # of # cells", 97, 100)
says("trust", "at least # of # converge", That(lambda x: x <= 100, "stress"), 100)

# ---- words with digits that are names and formulas
NOTATION = re.compile(
    r"(?<!10)[\^_]\{[^}]*\}|Algorithm \d|lines? \d( and \d)?|4 × 4|2 × 2|F1\b|F11|BDF2|SDIRK2"
    r"|^1 2 3$|^4 5 6$|^7 8 9$|step 0;|\(1 \+ \(hω\)²\)|1/√2|1 - 1|4\^|\(4 -|4g"
    r"|1/\(|l/√3|\bm/2\b|k/2\b|/3\b|\(4\{x|\(4v|√2|- 1\)² needs|- 1 the force|2k|2 k"
    r"|2 d dᵀ|∇E\(x\) = 0|>1|\(2 | - 4g|3 integrators|to 0\b")


def setting(f, texts, k):
    """A number of the row, with its unit."""
    if not k or texts[k - 1][2] not in SETTINGS or not re.match(
            NUMBER + "( J/m²| s| m/s)?$", texts[k][2]):
        return None
    name, digits = SETTINGS[texts[k - 1][2]]
    return Near(getattr(f.s.b, name), digits)


def look(frame):
    """Counts numbers of a frame; returns what is wrong and what no rule takes."""
    texts = [(x, y, plain(t)) for x, y, t in frame.raw["texts"]]
    want = {**runs_of_numbers(frame, texts), **ticks(frame, texts)}
    wrong, unexplained, numbers = [], [], 0
    for k, (_, _, text) in enumerate(texts):
        if not re.search(r"\d", text):
            continue
        rest = text
        bare = re.fullmatch(NUMBER, text) or setting(frame, texts, k)
        if bare:
            true = (want.get(k) or setting(frame, texts, k)
                    or alone(frame, texts, k))
            if true is not None:
                numbers += 1
                rest = ""
                try:
                    ok = true.holds(text.split(" ")[0])
                except Exception as error:
                    ok, true = False, repr(error)
                if not ok:
                    wrong.append((frame.name, text, text, str(true)))
        for expression, function, whole in [] if bare else RULES:
            for match in expression.finditer(rest):
                try:
                    true = function(frame, *match.groups())
                except Exception as error:  # the state has no such thing
                    true = [That(lambda x: False, repr(error))]
                if true is None:
                    continue
                shown = re.findall(NUMBER, match[0])
                shown = [g for g in match.groups() if re.fullmatch(NUMBER, g)]
                for item in true:
                    if isinstance(item, (bool, np.bool_)):
                        if not item:
                            wrong.append((frame.name, text, "words", "false"))
                        continue
                    numbers += 1
                    token = shown.pop(0) if shown else "nan"
                    try:
                        ok = item.holds(token)
                    except Exception as error:
                        ok, item = False, repr(error)
                    if not ok:
                        wrong.append((frame.name, text, token, str(item)))
                rest = rest.replace(match[0], " ")
            if whole and rest != text:
                break
        left = NOTATION.sub("", rest)
        if re.search(r"\d", left):
            unexplained.append((frame.name, text))
    return numbers, len(texts), wrong, unexplained


PAGES = """solid mesh equation forward symplectic backward stability explicit tangent
newton overshoot explodes minimise parts dial inertia alpha algorithm2 descent psd
energy force potential algorithm3 step simulator contact friction inelastic fracture
race trust""".split()
SCENES = """square circle overshoot landscape unprojected explosion hang drop slope
squeeze dent tear bend arrows tangent dial spring race envelope""".split()
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
    "mesh": "set segments 3", "race": "set stretch 1.05", "trust": "cell 300", "envelope": "cell 133",
    "stability": "set timestep 0.05", "circle": "set timestep 0.01",
}
LINES = "newton explodes minimise alpha algorithm3 step square unprojected drop".split()


def plan(long):
    for name in PAGES + SCENES:
        page = name in PAGES and name not in SCENES
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


SHORT = 4  # of these also in the short test
MORE = {
    "square plastic": "square --yield 0.05 --hardening 0.1; run 4; hover node 3; frame; "
                      "hover spring 60; frame; "
                      "finer; finer; next; next; next; next; frame; next; frame",
    "square overflows": "square --integrator forward-euler; run 40; frame",
    "solid pages": "square; page-on; pages; frame",
    "square keys": "square; keys; frame",
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
    answer = subprocess.run([program], input="\n".join(lines) + "\n", text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if answer.returncode:
        sys.exit("not ok numbers: %s: %s" % (program, answer.stderr[-200:]))
    states, last = {}, {}
    for line in answer.stdout.splitlines():
        raw = json.loads(line)
        if "begin" in raw:
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
                state.after(states[lane, state.step - 1])  # taken again
            elif state.step == old.step:
                state.changed(old)
            else:
                state.changed(states.get(at) or states[0, state.step])
            states[at] = last[lane] = state
        else:
            yield raw, states


def main():
    program, long = sys.argv[1], len(sys.argv) > 2
    for name, line in LONG_RUNS.items() if long else ():
        for _, states in read(program, ["begin " + line, "run 301", "frame x"]):
            PLAYED[name] = [states[0, n] for n in range(302)]
    wrong, unexplained, sums = [], [], [0, 0, 0]
    for raw, states in read(program, plan(long)):
        numbers, texts, bad, left = look(Frame(raw, states, raw["frame"]))
        sums = [sums[0] + 1, sums[1] + texts, sums[2] + numbers]
        wrong += bad
        unexplained += left
    for frame, text in sorted(set(unexplained)):
        print("unexplained: %s: %s" % (frame, text))
    for row in wrong:
        print("wrong: %s: %s: %s, should be %s" % row)
    print("%s numbers (%d states, %d texts, %d numbers: %d wrong, %d unexplained)"
          % (("not ok" if wrong or unexplained else "ok",) + tuple(sums)
             + (len(wrong), len(unexplained))))
    return bool(wrong or unexplained)


if __name__ == "__main__":
    sys.exit(main())
