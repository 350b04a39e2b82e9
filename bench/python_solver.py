#!/usr/bin/env python3
"""What Python takes from the solver: poesy_solver beside solver_bench, on the same errors at the same poses.

usage: bench/python_solver.py [--build build/release] [--repetitions 15]

All 71 errors of the 2UPR-RPU at 0.1 mm and 0.1 deg by the platform's metric, blocks of 1000 samples at pose after
pose: the case platform/all_errors/0.1_mm_0.1_deg of solver_bench, on the fastest instruction set of this machine. In
each round both run on one thread and on two, in random order. Rates are solves in a second of CPU time, and in a second
on the clock, which says nothing where others use the machine; figures are medians over rounds, and ratios medians of
what each round gives. Needs python3-numpy, and a build with POESY_PYTHON_MODULE and POESY_BENCH.
"""

import argparse
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

COUNT = 1000
CASE = "platform/all_errors/0.1_mm_0.1_deg"


def run(*command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True).stdout


class Bench:
    """solver_bench: {"cpu": rate, "wall": rate}, of all threads together."""

    def __init__(self, program):
        self.program = program
        cases = run(program, "--benchmark_list_tests", f"--benchmark_filter=^{CASE}/").splitlines()
        isas = {case.split("/")[3] for case in cases}
        self.isa = next(isa for isa in ("avx512", "avx2", "neon", "plain") if isa in isas)

    def __call__(self, threads):
        report = json.loads(run(self.program, f"--benchmark_filter=^{CASE}/{self.isa}/.*threads:{threads}$",
                                "--benchmark_format=json"))
        (case,) = report["benchmarks"]
        # Google Benchmark gives the time of an iteration, of which each thread does one: milliseconds.
        return {"cpu": 1e3 * COUNT / case["cpu_time"], "wall": case["solves/s"]}


class Module:
    """poesy_solver on the same blocks, from as many threads of Python."""

    def __init__(self, poesy_solver, folder):
        self.evaluator = poesy_solver.Evaluator
        self.poses = np.fromfile(folder / "poses.f64").reshape(-1, 3)
        self.blocks = np.fromfile(folder / "all_errors.f64").reshape(8, -1, COUNT)

    def work(self, at_poses, barrier):
        out, status = np.empty((3, COUNT)), np.empty(COUNT, np.uint8)
        barrier.wait()
        for n, at_pose in enumerate(at_poses):
            at_pose(self.blocks[n % len(self.blocks)], out, status)

    def __call__(self, threads):
        evaluator = self.evaluator("2upr-rpu")  # new, as in solver_bench: one that is called again remembers its poses
        at_poses = [evaluator.at(self.poses[31 * n % len(self.poses)]) for n in range(len(self.poses))]
        barrier = threading.Barrier(threads + 1)
        workers = [threading.Thread(target=self.work, args=(at_poses, barrier)) for _ in range(threads)]
        for worker in workers:
            worker.start()
        wall, cpu = time.perf_counter(), time.process_time()
        barrier.wait()
        for worker in workers:
            worker.join()
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        solves = threads * len(at_poses) * COUNT
        return {"cpu": solves / cpu, "wall": solves / wall}


def measure(sides, repetitions):
    """Rounds of {(side, threads): rates}."""
    rounds = []
    for n in range(repetitions):
        runs = [(side, threads) for side in sides for threads in (1, 2)]
        rounds.append({each: sides[each[0]](each[1]) for each in random.sample(runs, len(runs))})
        print(f"round {n + 1} of {repetitions}; load {os.getloadavg()[0]:.1f}", file=sys.stderr)
    return rounds


def show(rounds, isa):
    print(f"| {isa}, all threads together | without Python | from NumPy | ratio | smallest and largest |\n|---|---|---|---|---|")
    for threads in (1, 2):
        for clock in ("cpu", "wall"):
            cpp, python = ([each[side, threads][clock] for each in rounds] for side in ("C++", "Python"))
            ratios = [b / a for a, b in zip(cpp, python)]
            second = "CPU time" if clock == "cpu" else "clock"
            print(f"| {threads} thread{'s' if threads > 1 else ''}, solves in a second of {second} "
                  f"| {statistics.median(cpp) / 1e6:.2f} M | {statistics.median(python) / 1e6:.2f} M "
                  f"| {statistics.median(ratios):.2f} | {min(ratios):.2f}, {max(ratios):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--repetitions", type=int, default=15)
    options = parser.parse_args()
    sys.path.insert(0, str(options.build / "python"))
    import poesy_solver  # pylint: disable=import-outside-toplevel,import-error

    bench = Bench(options.build / "bin" / "solver_bench")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(options.build / "bin" / "published_samples", folder)
        module = Module(poesy_solver, folder)
    show(measure({"C++": bench, "Python": module}, options.repetitions), bench.isa)


if __name__ == "__main__":
    main()
