#!/usr/bin/env python3
"""Costs of the random optimisation problems of random_programme.h by scipy's SLSQP, an independent solver.

Its variables are tolerances divided by each part's scale, so limits on mean squares are quadratic. Whether SLSQP's
result is feasible is checked independently: it is moved towards the lower bounds until all limits hold. The best result
of several starts counts.

Usage: reference_costs.py write FILE       solves all 1000; writes lines NUMBER,COST
       reference_costs.py check FILE       solves every 40th again; exits with 1 if a cost is lower than in FILE by 1e-7
                                           or higher by 1e-4 (relative), with 77 without scipy
"""

import math
import sys
import warnings

try:
    import numpy as np
    from scipy.optimize import minimize
except ImportError:
    sys.exit(77)

PROGRAMMES = 1000
MASK = (1 << 64) - 1


class SplitMix:
    def __init__(self, state):
        self.state = state & MASK

    def next(self):
        self.state = z = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def below(self, n):
        return self.next() % n

    def uniform(self):
        return (self.next() >> 11) * 2.0**-53


def random_law(draw, t0):
    kind = draw.below(3)
    fixed = draw.uniform()
    height = 0.2 + 2.0 * draw.uniform()
    bend = draw.uniform()
    if kind == 0:
        return 0, fixed, height * t0, 1.0
    if kind == 1:
        return 0, fixed, height * t0 ** (0.5 + 2.0 * bend), 0.5 + 2.0 * bend
    return 1, fixed, 2.0 * height, t0 * (0.3 + 2.0 * bend)


class Programme:
    """Programme `number`, as random_programme() of random_programme.h makes it."""

    def __init__(self, number):
        draw = SplitMix(number * 1000003)
        parts = 2 + draw.below(11)
        count = 1 + draw.below(10)
        self.power = 1 if draw.below(2) == 1 else 2
        t0, laws, lo, hi = [], [], [], []
        for _ in range(parts):
            t = 0.01 + 0.09 * draw.uniform()
            t0.append(t)
            laws.append(random_law(draw, t))
            low = t * (0.02 + 0.3 * draw.uniform())
            high = t * (1.0 + 3.0 * draw.uniform())
            special = draw.below(8)
            if special == 0:
                low = high = t
            if special in (1, 2):
                high = math.inf
            lo.append(low)
            hi.append(high)
        self.effects, self.room = [], []
        for limit in range(count):
            again = draw.below(6) == 0 and limit > 0
            room = 0.0
            width = 0.05 + draw.uniform()
            row = []
            for i in range(parts):
                none = draw.below(5) == 0
                effect = (0.1 + draw.uniform()) * draw.uniform() / t0[i] ** self.power
                effect = 0.0 if none else effect
                row.append(self.effects[-1][i] if again else effect)
                room += row[i] * (lo[i] ** self.power + width * t0[i] ** self.power)
            self.effects.append(row)
            self.room.append(max(room, 1e-3))
        for i in range(parts):
            if all(row[i] == 0.0 for row in self.effects):
                hi[i] = min(hi[i], 3.0 * t0[i])
        self.effects, self.room = np.array(self.effects), np.array(self.room)
        self.t0, self.lo, self.hi = np.array(t0), np.array(lo), np.array(hi)
        self.form, self.fixed, self.b, self.shape = (np.array(column) for column in zip(*laws))

    def cost(self, tolerance):
        power = self.b * tolerance**-self.shape
        exponential = self.b * np.exp(-tolerance / self.shape)
        return np.sum(self.fixed + np.where(self.form == 1, exponential, power))

    def slope(self, tolerance):
        power = -self.shape * self.b * tolerance ** (-self.shape - 1.0)
        exponential = -self.b / self.shape * np.exp(-tolerance / self.shape)
        return np.where(self.form == 1, exponential, power)

    def left(self, tolerance):
        return 1.0 - self.effects @ tolerance**self.power / self.room

    def left_slope(self, tolerance):
        return -self.effects * self.power * tolerance ** (self.power - 1) / self.room[:, None]

    def drawn_within(self, tolerance):
        """Between the lower bounds, which keep the limits, and this: the last that keeps them."""
        tolerance = np.clip(tolerance, self.lo, self.hi)
        if np.all(self.left(tolerance) >= 0.0):
            return tolerance
        keep, lose = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (keep + lose)
            if np.all(self.left(self.lo + middle * (tolerance - self.lo)) >= 0.0):
                keep = middle
            else:
                lose = middle
        return self.lo + keep * (tolerance - self.lo)

    def best(self):
        """The least cost that SLSQP finds from several starts."""
        upper = np.where(np.isfinite(self.hi), self.hi, 50.0 * self.t0)
        bounds = list(zip(self.lo / self.t0, upper / self.t0))
        constraint = {
            "type": "ineq",
            "fun": lambda x: self.left(x * self.t0),
            "jac": lambda x: self.left_slope(x * self.t0) * self.t0,
        }
        best = math.inf
        for share in (0.0, 0.5, 1.0):
            x = self.drawn_within(self.lo + share * (np.minimum(upper, 2.0 * self.t0) - self.lo)) / self.t0
            for _ in range(3):  # restarts at the last solution
                found = minimize(
                    lambda x: self.cost(x * self.t0),
                    x,
                    jac=lambda x: self.slope(x * self.t0) * self.t0,
                    bounds=bounds,
                    constraints=[constraint],
                    method="SLSQP",
                    options={"ftol": 1e-14, "maxiter": 500},
                )
                tolerance = self.drawn_within(found.x * self.t0) if np.all(np.isfinite(found.x)) else self.lo
                best = min(best, self.cost(tolerance))
                x = tolerance / self.t0
        return best


def check(lines):
    wrong = 0
    for line in lines[::40]:
        number, cost = int(line.split(",")[0]), float(line.split(",")[1])
        now = Programme(number).best()
        if not cost * (1.0 - 1e-7) <= now <= cost * (1.0 + 1e-4):
            print(f"programme {number}: {now!r} instead of {cost!r}")
            wrong += 1
    return 1 if wrong else 0


def main():
    np.seterr(all="ignore")
    warnings.simplefilter("ignore")
    task, path = sys.argv[1:]
    if task == "check":
        with open(path, encoding="utf-8") as file:
            return check(file.read().splitlines()[1:])
    with open(path, "w", encoding="utf-8") as file:
        file.write("programme,cost\n")
        for number in range(PROGRAMMES):
            file.write(f"{number},{Programme(number).best():.12g}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
