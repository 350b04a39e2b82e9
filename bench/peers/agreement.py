#!/usr/bin/env python3
"""Checks that a solver's answers are those of this project, where both solved the sample.

usage: agreement.py FOLDER/ANSWERS_OF_THE_PEER.csv

Compares with FOLDER/answers.csv (see published_samples.cpp). A peer may answer every n-th sample only: its file then
has a column `row`, counted from 0. Exit code 1 when a response differs by more than 1e-9 (rad, m), or when one of the
two solves a hundredth of the samples that the other one does not.
"""

import csv
import pathlib
import sys

LIMIT = 1e-9
RESPONSES = ("angular_deformation", "linear_deformation")


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def compare(path):
    """Returns (samples, samples that both solved, largest difference)."""
    ours = read(path.parent / "answers.csv")
    both, only_one, largest = 0, 0, 0.0
    theirs = read(path)
    for n, answer in enumerate(theirs):
        expected = ours[int(answer.get("row", n))]
        if answer["solved"] != expected["solved"]:
            only_one += 1
        elif answer["solved"] == "1":
            both += 1
            largest = max([largest] + [abs(float(answer[r]) - float(expected[r])) for r in RESPONSES])
    if not largest < LIMIT:  # also when it is not a number
        raise SystemExit(f"{path}: differs from answers.csv by {largest:.3g}, more than {LIMIT:g}")
    if only_one > 0.01 * len(theirs) + 1:
        raise SystemExit(f"{path}: {only_one} of {len(theirs)} samples are solved here or in answers.csv, not in both")
    if both == 0:
        raise SystemExit(f"{path}: no sample is solved both here and in answers.csv")
    return len(theirs), both, largest


if __name__ == "__main__":
    print("%d samples, %d solved by both, largest difference %.2g" % compare(pathlib.Path(sys.argv[1])))
