#!/usr/bin/python3
"""Scheme I of Du et al. 2022 (Eqs. 40-44) in batched NumPy: the same job as the solver of this project.

usage: solver_numpy.py FOLDER [PROCESSES]

Reads FOLDER/samples.csv and background.csv (see published_samples.cpp), solves every sample, writes
FOLDER/solver_numpy.csv (solved, iterations, angular_deformation, linear_deformation) and prints what that took.

A batch is what one error takes at one pose: everything constant there is one matrix, multiplied once for all samples
or folded into its neighbours beforehand. Samples that are done leave the batch. Cells are shared among processes.
"""

import csv
import functools
import itertools
import json
import multiprocessing
import os
import pathlib
import sys
import time

import numpy as np

L_A, L_B, C, D, Z_0 = 0.06, 0.15, 0.025, 0.115, -0.2
TOLERANCE, MAX_ITERATIONS = 1e-15, 50
ROUNDING = 64 * np.finfo(float).eps  # a smaller change of the residual may be rounding; limbs are shorter than 1 m
FLAT_ITERATIONS = 3
PAIRS = ((1, 0), (2, 1), (0, 2))  # delta_mu_21, _32, _13
# Entry (a, b) of J^T J is SIGNS[a, b] times the product of columns a and b of the limbs' Jacobians.
SIGNS = np.kron(3.0 * np.eye(3) - 1.0, np.ones((3, 3)))


def rot(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    g = np.eye(4)
    g[i, i] = g[j, j] = c
    g[i, j], g[j, i] = -s, s
    return g


def trans(axis, distance):
    g = np.eye(4)
    g["xyz".index(axis), 3] = distance
    return g


def angle_between(a, b, normal):
    turn = np.arctan2(normal @ np.cross(a, b), a @ b)
    return turn + 2 * np.pi if turn < -np.pi / 2 else turn


def platform(z, beta, gamma):
    """R and p of the platform's frame."""
    return (rot("x", beta) @ rot("y", gamma))[:3, :3], np.array([0.0, -z * np.tan(beta), z])


def joint_variables(z, beta, gamma):
    """Eqs. 1-12, as angles and lengths; [limb][joint]."""
    R, p = platform(z, beta, gamma)
    x, y, u, v = np.eye(3)[0], np.eye(3)[1], R[:, 0], R[:, 1]
    leg1, leg2, leg3 = p + L_A * u - L_B * x, p - L_A * u + L_B * x, p + L_A * v - L_B * y
    norm = np.linalg.norm
    return np.array([
        [beta, angle_between(x, leg1, v), norm(leg1), -angle_between(u, leg1, v)],
        [beta, angle_between(x, leg2, v), norm(leg2), angle_between(-u, leg2, -v)],
        [angle_between(-y, leg3, x), norm(leg3), angle_between(v, leg3, -x), gamma],
    ])


HOME = joint_variables(Z_0, 0.0, 0.0)


def upr_limb(side, angle, length):
    """Eqs. 15 and 16."""
    quarter = np.pi / 2
    return [trans("x", side * (L_B + D)) @ rot("y", quarter),
            trans("z", -side * D) @ rot("x", -quarter) @ rot("z", angle - quarter),
            rot("y", quarter),
            trans("z", length) @ rot("y", -quarter) @ rot("z", quarter - angle),
            trans("y", side * L_A) @ rot("y", -quarter) @ rot("z", -quarter)]


def rpu_limb(angle, length):
    """Eq. 17."""
    quarter = np.pi / 2
    return [trans("y", L_B) @ rot("y", quarter) @ rot("z", angle - quarter),
            rot("y", quarter),
            trans("z", length) @ rot("y", -quarter) @ rot("z", quarter - angle),
            trans("y", -C) @ rot("x", -quarter),
            trans("z", C - L_A) @ rot("y", -quarter) @ rot("z", -quarter)]


FRAMES = [upr_limb(1.0, HOME[0, 1], HOME[0, 2]), upr_limb(-1.0, HOME[1, 1], HOME[1, 2]),
          rpu_limb(HOME[2, 0], HOME[2, 1])]
ACTUATED = [2, 2, 1]


def cross(a, b):
    return np.stack((a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1], a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]), axis=-1)


def hat(w):
    m = np.zeros(w.shape[:-1] + (3, 3))
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -w[..., 2], w[..., 1], -w[..., 0]
    m[..., 1, 0], m[..., 2, 0], m[..., 2, 1] = w[..., 2], -w[..., 1], w[..., 0]
    return m


def error_motion(error):
    """Eq. 26 for errors [..., (omega, v)]."""
    w = hat(error[..., :3])
    theta = np.linalg.norm(error[..., :3], axis=-1)[..., None, None]
    safe = np.where(theta > 0.0, theta, 1.0)
    a = np.where(theta > 0.0, np.sin(safe) / safe, 1.0)
    b = np.where(theta > 0.0, 2.0 * (np.sin(0.5 * safe) / safe) ** 2, 0.5)
    g = np.zeros(error.shape[:-1] + (4, 4))
    g[..., :3, :3] = np.eye(3) + a * w + b * (w @ w)
    g[..., :3, 3] = error[..., 3:]
    g[..., 3, 3] = 1.0
    return g


def inverse(g):
    h = np.zeros_like(g)
    Rt = np.swapaxes(g[..., :3, :3], -1, -2)
    h[..., :3, :3] = Rt
    h[..., :3, 3] = -(Rt @ g[..., :3, 3:])[..., 0]
    h[..., 3, 3] = 1.0
    return h


def log(g):
    """Eq. 30, exact at small angles, which Eq. A6 is not; for rotations of less than a half turn."""
    R, p = g[..., :3, :3], g[..., :3, 3]
    antisymmetric = 0.5 * np.stack((R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0],
                                    R[..., 1, 0] - R[..., 0, 1]), axis=-1)
    sine = np.sqrt((antisymmetric * antisymmetric).sum(-1))
    cosine = 0.5 * (R[..., 0, 0] + R[..., 1, 1] + R[..., 2, 2] - 1.0)
    theta = np.arctan2(sine, cosine)
    safe = np.where(theta > 1e-4, theta, 1.0)
    factor = np.where(theta > 1e-4, theta / np.where(theta > 1e-4, sine, 1.0), 1.0 + theta * theta / 6.0)
    bend = np.where(theta > 0.05, (1.0 - 0.5 * safe / np.tan(0.5 * safe)) / (safe * safe),
                    1.0 / 12.0 + theta**2 * (1.0 / 720.0 + theta**2 * (1.0 / 30240.0 + theta**2 / 1209600.0)))
    w = factor[..., None] * antisymmetric
    once = cross(w, p)
    v = p - 0.5 * once + bend[..., None] * cross(w, once)
    return np.concatenate((w, v), axis=-1)


def segments(q, errors):
    """Eq. 28 between passive joints: per limb four motions, each [4, 4], or [B, 4, 4] where the error varies.

    errors: per (limb, frame) [6], or [B, 6]."""
    limbs = []
    for i, frames in enumerate(FRAMES):
        limb, motion = [], np.eye(4)
        for j, frame in enumerate(frames):
            delta = error_motion(errors[i, j])
            motion = motion @ frame @ inverse(delta) if j == 4 else motion @ delta @ frame
            if j == ACTUATED[i]:
                motion = motion @ trans("z", q[i, j])
            else:
                limb.append(motion)
                motion = np.eye(4)
        limbs.append(limb)
    return limbs


def multiply(g, motion):
    """[B, 4, 4] times [B, 4, 4], or times one matrix in a single product."""
    return g @ motion if motion.ndim == 3 else (g.reshape(-1, 4) @ motion).reshape(-1, 4, 4)


def evaluate(limbs, q):
    """Residuals [B, 3, 6] and the passive joints' spatial Jacobian columns [B, 6, 9] at displacements q [B, 9]."""
    columns = np.empty((len(q), 6, 9))
    poses = []
    sines, cosines = np.sin(q), np.cos(q)
    for i, limb in enumerate(limbs):
        g = np.array(np.broadcast_to(limb[0], (len(q), 4, 4)))
        for k in range(3):
            n = 3 * i + k
            columns[:, :3, n] = g[:, :3, 2]
            columns[:, 3:, n] = cross(g[:, :3, 3], g[:, :3, 2])
            s, c = sines[:, n, None], cosines[:, n, None]
            x, y = g[:, :, 0], g[:, :, 1]
            g[:, :, 0], g[:, :, 1] = c * x + s * y, c * y - s * x
            g = multiply(g, limb[k + 1])
        poses.append(g)
    inverses = [inverse(g) for g in poses]
    return log(np.stack([poses[k] @ inverses[i] for k, i in PAIRS], axis=1)), columns


class PublishedMetric:
    """Residuals count as they are, 1 rad as 1 m; their largest component says when a solve ends."""

    tolerance, flat_iterations = TOLERANCE, FLAT_ITERATIONS

    def weighted(self, columns, mu):
        return columns, mu

    def change(self, mu, previous):
        return np.abs(mu - previous).max(axis=(1, 2))

    def responses(self, mu):
        """Eqs. 49 and 50."""
        return {"angular_deformation": np.linalg.norm(mu[..., :3], axis=-1).mean(axis=-1),
                "linear_deformation": np.linalg.norm(mu[..., 3:], axis=-1).mean(axis=-1)}


class PlatformMetric:
    """Residuals count as the displacement of the points where the limbs hold the platform (engine/docs/theory.md)."""

    tolerance, flat_iterations = 1e-14, 0  # of the reach

    def __init__(self, pose):
        R, self.origin = platform(*pose)
        joints = L_A * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        displaced = [np.hstack((-hat(self.origin + R @ joint), np.eye(3))) for joint in joints]
        W = sum(P.T @ P for P in displaced) / len(displaced)
        self.root = np.linalg.cholesky(W).T  # |xi|_W = |root xi|
        self.reach = max(sum(np.linalg.norm(frame[:3, 3]) for frame in frames) for frames in FRAMES)

    def weighted(self, columns, mu):
        return self.root @ columns, mu @ self.root.T

    def gap(self, mu):
        return self.root_mean_square(mu @ self.root.T)

    def change(self, mu, previous):
        return self.gap(mu - previous) / self.reach

    def responses(self, mu):
        omega = mu[..., :3]
        return {"gap": self.gap(mu), "angular_deformation": self.root_mean_square(omega),
                "linear_deformation": self.root_mean_square(mu[..., 3:] + cross(omega, self.origin))}

    @staticmethod
    def root_mean_square(vectors):
        return np.sqrt((vectors * vectors).sum(-1).mean(-1))


PUBLISHED = PublishedMetric()


def step(columns, mu):
    """Eq. 44."""
    transposed = np.swapaxes(columns, 1, 2)
    pull = np.stack((mu[:, 0] - mu[:, 2], mu[:, 1] - mu[:, 0], mu[:, 2] - mu[:, 1]), axis=1)
    f = np.empty(columns.shape[:1] + (9, 1))
    for i in range(3):
        f[:, 3 * i:3 * i + 3] = transposed[:, 3 * i:3 * i + 3] @ pull[:, i, :, None]
    return np.linalg.solve(SIGNS * (transposed @ columns), f)[..., 0]


def solve(pose, errors, metric=PUBLISHED):
    """Residuals [B, 3, 6], whether they are solved, and iterations."""
    joints = joint_variables(*pose) - HOME
    limbs = segments(joints, errors)
    count = max(len(error) for error in errors.values() if error.ndim == 2)
    passive = np.array([joints[i, j] for i in range(3) for j in range(4) if j != ACTUATED[i]])
    solved, iterations = np.zeros(count, bool), np.full(count, MAX_ITERATIONS)
    answer = np.empty((count, 3, 6))
    index = np.arange(count)
    q = np.tile(passive, (count, 1))
    smallest, flat = np.full(count, np.inf), np.zeros(count, int)
    mu, columns = evaluate(limbs, q)
    for iteration in range(1, MAX_ITERATIONS + 1):
        q += step(*metric.weighted(columns, mu))
        previous = mu
        mu, columns = evaluate(limbs, q)
        change = metric.change(mu, previous)
        flat = np.where(change < smallest, 0, flat + 1)
        smallest = np.minimum(smallest, change)
        done = (change < metric.tolerance) | ((change <= ROUNDING) & (flat >= metric.flat_iterations))
        if not done.any():
            continue
        solved[index[done]], iterations[index[done]], answer[index[done]] = True, iteration, mu[done]
        go = ~done
        index, q, mu, columns, smallest, flat = (a[go] for a in (index, q, mu, columns, smallest, flat))
        limbs = [[motion[go] if motion.ndim == 3 else motion for motion in limb] for limb in limbs]
        if not len(index):
            break
    answer[index] = mu
    return answer, solved, iterations


def slot(factor):
    """(limb, frame) and component of [omega; v] of the error "delta_1_0_x"."""
    kind, limb, frame, axis = factor.split("_")
    return (int(limb) - 1, int(frame)), "xyz".index(axis) + (3 if kind == "delta" else 0)


def solve_cell(solver, job):
    start = time.process_time()
    pose, factor, values, background = job
    errors = {(i, j): np.zeros(6) for i in range(3) for j in range(5)}
    for name, value in background:
        frame, component = slot(name)
        errors[frame][component] = value
    frame, component = slot(factor)
    errors[frame] = np.tile(errors[frame], (len(values), 1))
    errors[frame][:, component] = values
    mu, solved, iterations = solver(pose, errors)
    return time.process_time() - start, solved, iterations, *PUBLISHED.responses(mu).values()


def read(path):
    with open(path, newline="") as file:
        return list(csv.reader(file))[1:]


def cells(folder):
    background = [(name, float(value)) for name, value in read(folder / "background.csv")]
    rows = read(folder / "samples.csv")
    for (z, beta, gamma, factor), cell in itertools.groupby(rows, key=lambda row: tuple(row[:4])):
        yield (float(z), float(beta), float(gamma)), factor, np.array([float(row[4]) for row in cell]), background


def main(solver, answers):
    folder = pathlib.Path(sys.argv[1])
    processes = int(sys.argv[2]) if len(sys.argv) > 2 else len(os.sched_getaffinity(0))
    jobs = list(cells(folder))
    with multiprocessing.Pool(processes) as pool:
        work = functools.partial(solve_cell, solver)
        pool.map(work, jobs[:processes], chunksize=1)  # processes are up and warm
        start = time.perf_counter()
        results = pool.map(work, jobs, chunksize=1)
        seconds = time.perf_counter() - start
    cpu_seconds = sum(result[0] for result in results)
    solved, iterations, angular, linear = (np.concatenate(parts) for parts in list(zip(*results))[1:])
    with open(folder / answers, "w") as file:
        file.write("solved,iterations,angular_deformation,linear_deformation\n")
        for row in zip(solved, iterations, angular, linear):
            file.write("%d,%d,%.17g,%.17g\n" % row)
    print(json.dumps({"processes": processes, "solves": len(solved), "seconds": seconds, "cpu_seconds": cpu_seconds,
                      "iterations_per_solve": iterations.mean(), "version": np.__version__}))


if __name__ == "__main__":
    main(solve, "solver_numpy.csv")
