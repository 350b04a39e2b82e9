#!/usr/bin/python3
"""All 71 errors of the 2UPR-RPU at once, by the platform's metric, compiled by numba: what a fair peer takes an afternoon for.

usage: solver_numba.py BIN [--rounds N] [--samples N] [--scale S]

BIN: the folder of poesy and solver_bench. Errors are normal with standard deviations of S mm and S deg, 20 poses.
Gauss-Newton as in solver_numpy.py, sample by sample in scalars, until no joint moves by 1e-7, then once more to carry
the residuals; one thread, compiled before the clock starts (njit, fastmath). Each round runs it and `solver_bench` for
each instruction set, in random order. Exit code 1 when a response differs from `poesy evaluate` by more than 1e-5 of
the largest: the peer solves in pairs of limbs, as in the paper, and poesy each limb against the platform, which is the
same to first order (engine/docs/theory.md). Needs numba, NumPy and h5py.
"""

import argparse
import json
import pathlib
import random
import statistics
import subprocess
import tempfile
import time

import h5py
import numba
import numpy as np

import solver_numpy

POSES = 20
DONE = 1e-7  # rad, m
MOST_ROUNDS = 50
LIMIT = 1e-5
RESPONSES = ("gap", "angular_deformation", "linear_deformation")
STUDY = """\
format = "poesy-study"
version = 1
mechanism = { model = "2upr-rpu" }
poses = { select = "interior", count = 20 }
errors.linear = { distribution = "normal", sigma = "1 mm" }
errors.angular = { distribution = "normal", sigma = "1 deg" }
analysis = { kind = "monte-carlo", draws = "per pose", factors = "all", samples = 2 }
solver = { metric = "platform" }
"""
FRAMES = np.array(solver_numpy.FRAMES)  # [limb, frame, 4, 4]
PAIRS = np.array(solver_numpy.PAIRS)

compiled = numba.njit(fastmath=True, cache=False)


@compiled
def multiply_into(out, a, b):
    """out = a b, motions [3, 4]."""
    for i in range(3):
        for j in range(4):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]
        out[i, 3] += a[i, 3]


@compiled
def invert_into(out, g):
    for i in range(3):
        for j in range(3):
            out[i, j] = g[j, i]
        out[i, 3] = -(g[0, i] * g[0, 3] + g[1, i] * g[1, 3] + g[2, i] * g[2, 3])


@compiled
def error_into(out, e):
    """Eq. 26."""
    x, y, z = e[0], e[1], e[2]
    square = x * x + y * y + z * z
    if square > 0.0:
        theta = np.sqrt(square)
        a = np.sin(theta) / theta
        half = np.sin(0.5 * theta) / theta
        b = 2.0 * half * half
    else:
        a, b = 1.0, 0.5
    out[0, 0], out[0, 1], out[0, 2] = 1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    out[1, 0], out[1, 1], out[1, 2] = b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x
    out[2, 0], out[2, 1], out[2, 2] = b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)
    out[0, 3], out[1, 3], out[2, 3] = e[3], e[4], e[5]


@compiled
def log_into(out, g):
    """Eq. 30 for small motions."""
    x, y, z = 0.5 * (g[2, 1] - g[1, 2]), 0.5 * (g[0, 2] - g[2, 0]), 0.5 * (g[1, 0] - g[0, 1])
    sine = np.sqrt(x * x + y * y + z * z)
    theta = np.arctan2(sine, 0.5 * (g[0, 0] + g[1, 1] + g[2, 2] - 1.0))
    square = theta * theta
    factor = theta / sine if theta > 1e-4 else 1.0 + square / 6.0
    if theta > 0.05:
        bend = (1.0 - 0.5 * theta / np.tan(0.5 * theta)) / square
    else:
        bend = 1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square / 1209600.0))
    x, y, z = factor * x, factor * y, factor * z
    px, py, pz = g[0, 3], g[1, 3], g[2, 3]
    ox, oy, oz = y * pz - z * py, z * px - x * pz, x * py - y * px
    out[0], out[1], out[2] = x, y, z
    out[3] = px - 0.5 * ox + bend * (y * oz - z * oy)
    out[4] = py - 0.5 * oy + bend * (z * ox - x * oz)
    out[5] = pz - 0.5 * oz + bend * (x * oy - y * ox)


@compiled
def segments_into(limbs, frames, drives, actuated, errors, a, b, motion):
    """Eq. 28 between passive joints: limbs [limb, 4, 3, 4] of errors [limb, frame, 6]."""
    for i in range(3):
        count = 0
        begun = False
        for j in range(5):
            error_into(a, errors[i, j])
            if j == 4:
                invert_into(b, a)
                multiply_into(a, frames[i, j], b)
            else:
                multiply_into(b, a, frames[i, j])
                a[:, :] = b
            if begun:
                multiply_into(b, motion, a)
                motion[:, :] = b
            else:
                motion[:, :] = a
                begun = True
            if j == actuated[i]:  # a prismatic joint along z
                for k in range(3):
                    motion[k, 3] += motion[k, 2] * drives[i]
            else:
                limbs[i, count] = motion
                count += 1
                begun = False


@compiled
def evaluate_into(mu, columns, limbs, q, poses, pairs, a, b):
    """Residuals [3, 6] and the columns [9, 6] of the passive joints' spatial Jacobians at q [9]."""
    for i in range(3):
        g = poses[i]
        g[:, :] = limbs[i, 0]
        for k in range(3):
            n = 3 * i + k
            zx, zy, zz = g[0, 2], g[1, 2], g[2, 2]
            px, py, pz = g[0, 3], g[1, 3], g[2, 3]
            columns[n, 0], columns[n, 1], columns[n, 2] = zx, zy, zz
            columns[n, 3], columns[n, 4], columns[n, 5] = py * zz - pz * zy, pz * zx - px * zz, px * zy - py * zx
            s, c = np.sin(q[n]), np.cos(q[n])
            for r in range(3):
                x, y = g[r, 0], g[r, 1]
                g[r, 0], g[r, 1] = c * x + s * y, c * y - s * x
            multiply_into(a, g, limbs[i, k + 1])
            g[:, :] = a
    for p in range(3):
        invert_into(a, poses[pairs[p, 1]])
        multiply_into(b, poses[pairs[p, 0]], a)
        log_into(mu[p], b)


@compiled
def step_into(f, N, weighted, columns, mu, root, pull):
    """Solves J^T W J s = -J^T W mu (Eq. 44) by Cholesky; the step is in f."""
    for n in range(9):
        for r in range(6):
            total = 0.0
            for c in range(6):
                total += root[r, c] * columns[n, c]
            weighted[n, r] = total
    for r in range(6):
        m0 = m1 = m2 = 0.0
        for c in range(6):
            m0 += root[r, c] * mu[0, c]
            m1 += root[r, c] * mu[1, c]
            m2 += root[r, c] * mu[2, c]
        pull[0, r], pull[1, r], pull[2, r] = m0 - m2, m1 - m0, m2 - m1
    for n in range(9):
        total = 0.0
        for r in range(6):
            total += weighted[n, r] * pull[n // 3, r]
        f[n] = total
        for m in range(n + 1):
            product = 0.0
            for r in range(6):
                product += weighted[n, r] * weighted[m, r]
            N[n, m] = 2.0 * product if n // 3 == m // 3 else -product
    for n in range(9):
        for m in range(n + 1):
            rest = N[n, m]
            for k in range(m):
                rest -= N[n, k] * N[m, k]
            N[n, m] = np.sqrt(rest) if n == m else rest / N[m, m]
    for n in range(9):
        rest = f[n]
        for k in range(n):
            rest -= N[n, k] * f[k]
        f[n] = rest / N[n, n]
    for n in range(8, -1, -1):
        rest = f[n]
        for k in range(n + 1, 9):
            rest -= N[k, n] * f[k]
        f[n] = rest / N[n, n]


@compiled
def solve_into(answers, errors, frames, pairs, actuated, passive, drives, roots, origins):
    """Gap, angular and linear deformation [pose, sample, 3] of errors [sample, limb, frame, 6]."""
    limbs, poses = np.empty((3, 4, 3, 4)), np.empty((3, 3, 4))
    a, b, motion = np.empty((3, 4)), np.empty((3, 4)), np.empty((3, 4))
    mu, columns, weighted = np.empty((3, 6)), np.empty((9, 6)), np.empty((9, 6))
    f, N, pull, q = np.empty(9), np.empty((9, 9)), np.empty((3, 6)), np.empty(9)
    iterations = 0
    for m in range(len(passive)):
        for s in range(len(errors)):
            segments_into(limbs, frames, drives[m], actuated, errors[s], a, b, motion)
            q[:] = passive[m]
            evaluate_into(mu, columns, limbs, q, poses, pairs, a, b)
            for _ in range(MOST_ROUNDS):
                step_into(f, N, weighted, columns, mu, roots[m], pull)
                largest = 0.0
                for n in range(9):
                    q[n] += f[n]
                    largest = max(largest, abs(f[n]))
                evaluate_into(mu, columns, limbs, q, poses, pairs, a, b)
                iterations += 1
                if largest < DONE:
                    break
            gap = angular = linear = 0.0
            for p in range(3):
                for r in range(6):
                    total = 0.0
                    for c in range(6):
                        total += roots[m, r, c] * mu[p, c]
                    gap += total * total
                w = mu[p]
                o = origins[m]
                angular += w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
                linear += ((w[3] + w[1] * o[2] - w[2] * o[1])**2 + (w[4] + w[2] * o[0] - w[0] * o[2])**2 +
                           (w[5] + w[0] * o[1] - w[1] * o[0])**2)
            answers[m, s, 0] = np.sqrt(gap / 3.0)
            answers[m, s, 1] = np.sqrt(angular / 3.0)
            answers[m, s, 2] = np.sqrt(linear / 3.0)
    return iterations


def at_poses(poses):
    """What solve_into() takes of the poses: passive and driven displacements, roots of W, origins."""
    passive, drives, roots, origins = [], [], [], []
    for pose in poses:
        joints = solver_numpy.joint_variables(*pose) - solver_numpy.HOME
        passive.append([joints[i, j] for i in range(3) for j in range(4) if j != solver_numpy.ACTUATED[i]])
        drives.append([joints[i, j] for i, j in enumerate(solver_numpy.ACTUATED)])
        metric = solver_numpy.PlatformMetric(pose)
        roots.append(metric.root)
        origins.append(metric.origin)
    return tuple(np.ascontiguousarray(each) for each in (passive, drives, roots, origins))


def numba_rate(errors, poses):
    passive, drives, roots, origins = at_poses(poses)
    answers = np.empty((len(poses), len(errors), 3))
    frames = np.ascontiguousarray(FRAMES[:, :, :3, :])
    actuated = np.array(solver_numpy.ACTUATED)
    start = time.process_time()
    iterations = solve_into(answers, errors, frames, PAIRS, actuated, passive, drives, roots, origins)
    rate = answers[..., 0].size / (time.process_time() - start)
    return rate, iterations / answers[..., 0].size, answers


def bench_rates(solver_bench, scale):
    """CPU rates of one thread of each instruction set."""
    name = f"platform/all_errors/{'1_mm_1_deg' if scale == 1.0 else '0.1_mm_0.1_deg'}"
    done = subprocess.run([solver_bench, f"--benchmark_filter={name}/.*threads:1$", "--benchmark_format=json"],
                          capture_output=True, text=True, check=True)
    rates = {}
    for case in json.loads(done.stdout)["benchmarks"]:
        isa = case["name"].split("/")[3]
        rates[isa] = case["solves/s"] * case["real_time"] / case["cpu_time"]
    return rates


def run(command, folder):
    subprocess.run([str(part) for part in command], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def poses_and_errors(poesy, folder):
    """Poses [pose, 3] that poesy selects, and the names of its 71 errors."""
    (folder / "study.toml").write_text(STUDY)
    run([poesy, "run", "study.toml", "-o", "poses.h5", "--quiet", "--yes"], folder)
    with h5py.File(folder / "poses.h5") as file:
        poses = np.stack([file["poses"][name][()] for name in file["poses"].attrs["coordinates"]], axis=1)
        return poses, [name.decode() for name in file["factor"][()]]


def draw(names, samples, scale):
    """Errors [sample, limb, frame, 6], and the same as a table [sample, name]."""
    slots = [solver_numpy.slot(name) for name in names]
    sigma = np.array([np.deg2rad(scale) if component < 3 else 1e-3 * scale for _, component in slots])
    table = sigma * np.random.default_rng(1).standard_normal((samples, len(names)))
    errors = np.zeros((samples, 3, 5, 6))
    for f, ((i, j), component) in enumerate(slots):
        errors[:, i, j, component] = table[:, f]
    return errors, table


def poesy_answers(poesy, folder, names, poses, table):
    """Responses [pose, sample, 3] by `poesy evaluate`, with NaN where it found no solution."""
    np.savetxt(folder / "p.csv", poses, delimiter=",", header="z,beta,gamma", comments="", fmt="%.17g")
    np.savetxt(folder / "e.csv", table, delimiter=",", header=",".join(names), comments="", fmt="%.17g")
    run([poesy, "evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "r.h5", "--quiet"], folder)
    with h5py.File(folder / "r.h5") as file:
        answers = np.stack([file["evaluate"][name][()] for name in RESPONSES], axis=-1)
        return np.where((file["evaluate/status"][()] < 2)[..., None], answers, np.nan)


def check(answers, expected):
    """Fails where a response differs too much; returns the largest difference."""
    difference = np.nanmax(np.abs(answers - expected), axis=(0, 1)) / np.nanmax(expected, axis=(0, 1))
    if not difference.max() < LIMIT:
        raise SystemExit(f"differs from poesy by {difference.max():.3g} of the largest response, more than {LIMIT:g}")
    return difference.max()


def measure(rounds, by_numba, by_poesy):
    """Rates of each, for each round, in random order."""
    rates = {}
    for _ in range(rounds):
        for job in random.sample([by_numba, by_poesy], 2):
            for name, rate in job().items():
                rates.setdefault(name, []).append(rate)
    return rates


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--samples", type=int, default=1000)
    parser.add_argument("--scale", type=float, choices=(0.1, 1.0), default=0.1)
    options = parser.parse_args()
    binaries = options.bin.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        poses, names = poses_and_errors(binaries / "poesy", folder)
        errors, table = draw(names, options.samples, options.scale)
        _, rounds, answers = numba_rate(errors, poses)  # also compiles
        largest = check(answers, poesy_answers(binaries / "poesy", folder, names, poses, table))
    rates = measure(options.rounds, lambda: {"numba": numba_rate(errors, poses)[0]},
                    lambda: bench_rates(binaries / "solver_bench", options.scale))
    print(f"numba {numba.__version__}, NumPy {np.__version__}; {len(poses)} poses x {options.samples} samples; {rounds:.2f} "
          f"rounds of Gauss-Newton; largest difference {largest:.2g} of the largest response; {options.rounds} rounds")
    print("| who | solves/s, one thread | smallest | largest | x numba |\n|---|---|---|---|---|")
    for who, each in sorted(rates.items(), key=lambda item: statistics.median(item[1])):
        ratio = statistics.median(own / peer for own, peer in zip(each, rates["numba"]))
        print(f"| {who} | {statistics.median(each):.3g} | {min(each):.3g} | {max(each):.3g} | {ratio:.3g} |")


if __name__ == "__main__":
    main()
