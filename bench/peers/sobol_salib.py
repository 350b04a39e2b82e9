#!/usr/bin/python3
"""The panel of Sobol' indices of one pose by NumPy and SALib, on poesy's own samples, beside poesy's kind of study.

usage: sobol_salib.py POESY [--samples N] [--rounds N] [--processes N]

41 errors of the 2UPR-RPU, 0.1 mm and 0.1 deg, by the platform's metric. Of the machines A and B that `poesy run` draws,
and of the mixtures of both, the batched solver of solver_numpy.py finds the three responses, and SALib's analysis (100
bootstrap resamples, no second order) takes each of them. `poesy run` does the whole study, solves and intervals. Each
round has a seed of its own; all three are timed in each. Exit code 1 when responses differ from those of
`poesy evaluate` by more than 1e-5 of them, or the numerators of total indices from poesy's by more than 1e-5 of the
variance: NumPy solves in pairs of limbs, poesy each limb against the platform, which is the same to first order.
Needs SALib (github.com/SALib/SALib), NumPy, SciPy and h5py.
"""

import argparse
import collections
import json
import multiprocessing
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

import h5py
import numpy as np
from SALib.analyze import sobol
from scipy.special import ndtri

import solver_numpy

POSE = (-0.25, 0.1, 0.2)
BATCH = 1000
ERROR_SAMPLES, SECOND_ERROR_SAMPLES = 1, 5  # what draws of A and B are for: Purpose of engine/random/stream.h
LIMIT = 1e-5
STUDY = """\
format = "poesy-study"
version = 1
mechanism = { model = "2upr-rpu" }
poses = { select = "file", file = "pose.csv" }
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
errors.angular = { distribution = "normal", sigma = "0.1 deg" }
analysis = { kind = "sobol", factors = "deforming-all", samples = SAMPLES }
solver = { metric = "platform" }
run = { seed = SEED }
"""


def uniforms(seed, purpose, factor, samples):
    """poesy's draws of one error: Philox4x64-10, counter (factor, pose 0, sample / 4, 0)."""
    stream = np.random.Philox(key=seed + (purpose << 64), counter=(factor - 1) % 2**256)  # it adds 1 before it draws
    words = []
    for _ in range(0, samples, 4):
        words.append(stream.random_raw(4))
        stream.advance(2**128 - 1)
    return ((np.concatenate(words)[:samples] >> 11) + 0.5) * 2.0**-53


def panel(seed, factors, sigma, samples):
    """A, each A with one error of B, B, machine by machine, as SALib wants them: [samples * (P + 2), P]."""
    a, b = (np.stack([s * ndtri(uniforms(seed, purpose, f, samples)) for f, s in zip(factors, sigma)], axis=1)
            for purpose in (ERROR_SAMPLES, SECOND_ERROR_SAMPLES))
    rows = np.repeat(a[:, None, :], len(sigma) + 2, axis=1)
    for p in range(len(sigma)):
        rows[:, p + 1, p] = b[:, p]
    rows[:, -1] = b
    return rows.reshape(-1, len(sigma))


def solve_batch(job):
    """Responses [R, B] and iterations [B] of errors [B, P]."""
    names, rows = job
    frames = {(i, j): np.zeros(6) for i in range(3) for j in range(5)}
    for name, values in zip(names, rows.T):
        frame, component = solver_numpy.slot(name)
        if frames[frame].ndim == 1:
            frames[frame] = np.zeros((len(rows), 6))
        frames[frame][:, component] = values
    metric = solver_numpy.PlatformMetric(POSE)
    mu, solved, iterations = solver_numpy.solve(POSE, frames, metric)
    if not solved.all():
        raise SystemExit("NumPy does not solve every sample")
    return metric.responses(mu), iterations


def solve(pool, names, rows):
    """Responses by name, each [samples], and iterations."""
    batches = [(names, rows[first:first + BATCH]) for first in range(0, len(rows), BATCH)]
    responses, iterations = zip(*pool.map(solve_batch, batches, chunksize=1))
    joined = {name: np.concatenate([part[name] for part in responses]) for name in responses[0]}
    return joined, np.concatenate(iterations)


def write_table(path, names, rows):
    np.savetxt(path, rows, fmt="%.17g", delimiter=",", header=",".join(names), comments="")


class Program:
    """poesy, with one study in one folder."""

    def __init__(self, poesy, folder, samples, threads):
        self.poesy, self.folder, self.samples, self.threads = pathlib.Path(poesy).resolve(), folder, samples, threads
        write_table(folder / "pose.csv", ("z", "beta", "gamma"), [POSE])

    def call(self, *arguments):
        return subprocess.run([self.poesy, *arguments], cwd=self.folder, check=True, capture_output=True, text=True)

    def factors(self):
        """All errors of the mechanism, by whose places draws are addressed."""
        text = self.call("models", "2upr-rpu").stdout
        return re.findall(r"^  ((?:delta|epsilon)_\d_\d_[xyz]) ", text, flags=re.MULTILINE)

    def set_seed(self, seed):
        study = STUDY.replace("SAMPLES", str(self.samples)).replace("SEED", str(seed))
        (self.folder / "study.toml").write_text(study)

    def run(self):
        self.call("run", "study.toml", "-o", "own.h5", "--threads", str(self.threads), "--quiet")

    def indices(self):
        with h5py.File(self.folder / "own.h5") as file:
            names, sigma = list(file["factors/name"].asstr()), file["factors/sigma"][:]
            responses = list(file["responses/name"].asstr())
            ST = file["sobol/ST"][:, :, 0]
            half = 0.5 * (file["sobol/ST_ci_high"][:, :, 0] - file["sobol/ST_ci_low"][:, :, 0])
        return names, sigma, {r: (ST[n], half[n]) for n, r in enumerate(responses)}

    def evaluate(self, names, rows):
        """Responses to some rows of errors, each with its pose."""
        write_table(self.folder / "poses.csv", ("z", "beta", "gamma"), [POSE] * len(rows))
        write_table(self.folder / "errors.csv", names, rows)
        self.call("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "--quiet",
                  "-o", "rows.h5")
        with h5py.File(self.folder / "rows.h5") as file:
            return {name: file[f"evaluate/{name}"][:].ravel() for name in file["responses/name"].asstr()}


def difference_of_responses(poesy, names, rows, responses):
    """The largest, as a share of a response, over some thousand samples from all parts of the panel."""
    some = np.arange(0, len(rows), max(1, len(rows) // 1000) | 1)  # an odd step meets all mixtures
    expected = poesy.evaluate(names, rows[some])
    return max(float(np.max(np.abs(responses[name][some] / values - 1.0))) for name, values in expected.items())


def differences_of_indices(own, found):
    """Of SALib's ST from poesy's, the largest: in half-widths of poesy's interval, and from poesy's times one number of
    each response. Both take Jansen's numerator, but SALib divides by the variance about a mean."""
    in_halves, of_numerators = 0.0, 0.0
    for name, (ST, half) in own.items():
        does = ST > 0.0
        in_halves = max(in_halves, float(np.max(np.abs(found[name]["ST"] - ST)[does] / half[does])))
        largest = np.argmax(ST)
        scaled = ST * (found[name]["ST"][largest] / ST[largest])
        of_numerators = max(of_numerators, float(np.max(np.abs(found[name]["ST"] - scaled))))
    return in_halves, of_numerators


def check(what, difference):
    if not difference < LIMIT:  # also when it is not a number
        raise SystemExit(f"{what} differ by {difference:.3g}, more than {LIMIT:g}")


class Clock:
    """Seconds of what is done in each round."""

    def __init__(self):
        self.seconds = collections.defaultdict(list)

    def __call__(self, job, call):
        start = time.perf_counter()
        result = call()
        self.seconds[job].append(time.perf_counter() - start)
        return result

    def table(self, solves):
        own = statistics.median(self.seconds["poesy run"])
        lines = ["| job | seconds, median | smallest | largest | samples/s | x poesy run |", "|---" * 6 + "|"]
        for job, seconds in self.seconds.items():
            median = statistics.median(seconds)
            lines.append(f"| {job} | {median:.3g} | {min(seconds):.3g} | {max(seconds):.3g} | {solves / median:.3g} | "
                         f"{median / own:.3g} |")
        return "\n".join(lines)


def play_round(poesy, pool, clock, seed):
    """Times all three; returns how many samples there were, iterations of NumPy and what checks found."""
    poesy.set_seed(seed)
    clock("poesy run", poesy.run)
    names, sigma, own = poesy.indices()
    every = poesy.factors()
    rows = panel(seed, [every.index(name) for name in names], sigma, poesy.samples)
    responses, iterations = clock("NumPy's solves", lambda: solve(pool, names, rows))
    problem = {"num_vars": len(names), "names": names, "bounds": [[0, 1]] * len(names)}
    found = clock("SALib's analysis",
                  lambda: {name: sobol.analyze(problem, values, calc_second_order=False, seed=seed)
                           for name, values in responses.items()})
    of_responses = difference_of_responses(poesy, names, rows, responses)
    in_halves, of_numerators = differences_of_indices(own, found)
    check("responses of NumPy and poesy evaluate", of_responses)
    check("numerators of ST", of_numerators)
    return len(rows), float(np.mean(iterations)), (of_responses, of_numerators, in_halves)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("poesy", help="the program")
    parser.add_argument("--samples", type=int, default=4096, help="machines A, and as many B")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)),
                        help="of NumPy, and threads of poesy")
    asked = parser.parse_args()
    clock = Clock()
    with tempfile.TemporaryDirectory() as folder, multiprocessing.Pool(asked.processes) as pool:
        poesy = Program(asked.poesy, pathlib.Path(folder), asked.samples, asked.processes)
        every = poesy.factors()
        solve(pool, every, np.zeros((asked.processes * BATCH, len(every))))  # processes are up and warm
        rounds = [play_round(poesy, pool, clock, seed) for seed in range(1, asked.rounds + 1)]
    solves, iterations, _ = rounds[0]
    print(clock.table(solves))
    of_responses, of_numerators, in_halves = (max(values) for values in zip(*(found for _, _, found in rounds)))
    print(json.dumps({"rounds": asked.rounds, "processes": asked.processes, "samples": solves,
                      "numpy_iterations_per_solve": round(iterations, 2),
                      "largest_difference_of_responses": of_responses,
                      "largest_difference_of_ST_numerators": of_numerators,
                      "largest_difference_of_ST_in_half_widths": in_halves,
                      "numpy": np.__version__}, indent=1))


if __name__ == "__main__":
    main()
