#!/usr/bin/python3
"""The panel of Sobol' indices of one pose by SALib, on samples that poesy solves, beside poesy's own kind of study.

usage: sobol_salib.py POESY [SAMPLES] [ROUNDS]

41 errors of the 2UPR-RPU, 0.1 mm and 0.1 deg, by the platform's metric. NumPy draws A, B and the mixtures in the order
that SALib wants, `poesy evaluate` solves them, SALib's analysis (100 bootstrap resamples, no second order) takes each of
the three responses; then `poesy run` does the whole study. Prints medians of the rounds, interleaved, and how far the
indices are apart in units of the joint half-width. Needs SALib (github.com/SALib/SALib), NumPy and h5py.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np
from SALib.analyze import sobol

STUDY = """\
format = "poesy-study"
version = 1
mechanism = { model = "2upr-rpu" }
poses = { select = "file", file = "poses.csv" }
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
errors.angular = { distribution = "normal", sigma = "0.1 deg" }
analysis = { kind = "sobol", factors = "deforming-all", samples = SAMPLES }
solver = { metric = "platform" }
"""


def saltelli(generator, samples, sigma):
    """A, each A with one error of B, B, block by block."""
    a, b = (generator.normal(size=(samples, sigma.size)) * sigma for _ in range(2))
    rows = np.repeat(a[:, None, :], sigma.size + 2, axis=1)
    for p in range(sigma.size):
        rows[:, p + 1, p] = b[:, p]
    rows[:, -1] = b
    return rows.reshape(-1, sigma.size)


def main(poesy, samples="4096", rounds="3"):
    samples, rounds = int(samples), int(rounds)
    seconds = {"SALib's analysis": [], "poesy evaluate": [], "poesy run": []}

    def timed(name, call):
        start = time.perf_counter()
        result = call()
        seconds[name].append(time.perf_counter() - start)
        return result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "poses.csv").write_text("z,beta,gamma\n-0.25,0.1,0.2\n")
        (folder / "study.toml").write_text(STUDY.replace("SAMPLES", str(samples)))

        def run(*arguments):
            subprocess.run([poesy, *arguments, "--quiet"], cwd=folder, check=True, capture_output=True)

        run("run", "study.toml", "-o", "own.h5")
        with h5py.File(folder / "own.h5") as file:
            names, sigma = list(file["factors/name"].asstr()), file["factors/sigma"][:]
            responses = list(file["responses/name"].asstr())
            own = {index: file[f"sobol/{index}"][:, :, 0] for index in ("S1", "ST", "ST_ci_low", "ST_ci_high")}
        problem = {"num_vars": len(names), "names": names, "bounds": [[0, 1]] * len(names)}
        apart = []
        for n in range(rounds):
            rows = saltelli(np.random.default_rng(n), samples, sigma)
            np.savetxt(folder / "errors.csv", rows, delimiter=",", header=",".join(names), comments="")
            timed("poesy evaluate", lambda: run("evaluate", "study.toml", "--poses", "poses.csv", "--errors",
                                                "errors.csv", "-o", "rows.h5"))
            with h5py.File(folder / "rows.h5") as file:
                values = [file[f"evaluate/{response}"][0] for response in responses]
            found = timed("SALib's analysis",
                          lambda: [sobol.analyze(problem, y, calc_second_order=False, seed=n) for y in values])
            timed("poesy run", lambda: run("run", "study.toml", "-o", "own.h5"))
            for r, indices in enumerate(found):
                half = 0.5 * (own["ST_ci_high"][r] - own["ST_ci_low"][r])
                apart.append(np.abs(indices["ST"] - own["ST"][r]) / np.hypot(half, indices["ST_conf"]))
    print(json.dumps({"samples": samples, "errors": len(names), "responses": len(responses),
                      "median_seconds": {key: round(statistics.median(list_), 3) for key, list_ in seconds.items()},
                      "share_of_ST_within_joint_half_width": round(float(np.mean(np.concatenate(apart) <= 1.0)), 3)},
                     indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:])
