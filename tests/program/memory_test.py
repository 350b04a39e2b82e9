"""The peak memory that `poesy check` predicts for a run is within -10 % and +40 % of the measured one. For studies
with large results, memory is limited to a multiple of the size of the result file, in addition to that of the
program."""

import os
import re
import resource
import subprocess
import sys

from poesy_program import PROGRAM, ProgramTest, main

HEAD = """\
format = "poesy-study"
version = 1
[mechanism]
model = "{model}"
{fidelity}
[poses]
count = {poses}
[analysis]
kind = "{kind}"
"""
CASES = "".join(f'[[analysis.cases]]\nerrors = {{ linear = "{k + 1} um" }}\n' for k in range(60))
BLOCKS = 'limbs = "independent"\ncomponents = "independent"\n'
SIZES = "linear = [" + ", ".join(f'"{k + 1} um"' for k in range(20)) + "]\n"

STUDIES = {
    "sensitivity": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=5000, kind="sensitivity")
    + 'factors = "all"\nsamples = 2\n',
    "a smaller last unit": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=1000, kind="sensitivity")
    + 'factors = "all"\nsamples = 1001\n',
    "two fidelities": HEAD.format(model="3-prs", fidelity='fidelity = "both"', poses=5000, kind="sensitivity")
    + 'factors = "all"\nsamples = 2\n',
    "cases": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=12000, kind="evaluate") + CASES,
    "coupling": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=900, kind="coupling") + BLOCKS + SIZES
    + 'worst_case = "sum"\n',
    "worst cases": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=400, kind="coupling") + SIZES,
    "monte-carlo": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=18000, kind="monte-carlo")
    + 'draws = "per pose"\nfactors = "all"\nsamples = 2\n',
    "machines": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=1000, kind="monte-carlo")
    + 'draws = "per machine"\nfactors = "all"\nsamples = 8000\nlimits.position = "0.1 mm"\n',
}
SMALL_ALLOCATION = HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=5, kind="allocation") + """\
factors = {factors}
samples = 2000
limits = {{ position = "1 mm" }}
yield = 0.95
sigmas = 3
[[analysis.parts]]
factors = "linear"
each = true
cost = {{ law = "reciprocal", b = 1, unit = "mm" }}
"""
SMALL = {
    "allocation of two parts": SMALL_ALLOCATION.format(factors='["a_x_1", "q_1"]'),
    "allocation of more parts": SMALL_ALLOCATION.format(factors='"rod-length"'),
    "monte-carlo": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=100, kind="monte-carlo")
    + 'draws = "per pose"\nfactors = ["a_x_1"]\nsamples = 100\n',
    "sensitivity": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=5, kind="sensitivity")
    + 'factors = ["a_x_1"]\nsamples = 100\n',
}
# Largest memory of a run without that of the program, in multiples of the size of its result file. A smaller last unit
# has its own state besides that of whole units, while the file has the sum of both.
MOST_TIMES_THE_FILE = {"sensitivity": 1.5, "a smaller last unit": 3.0, "two fidelities": 2.2, "cases": 1.5, "coupling": 1.5,
                        "worst cases": 1.5}
# The same for merging. The states of all shards stay in memory until the last one is merged.
MOST_TIMES_THE_FILE_MERGED = {"sensitivity": 1.5, "a smaller last unit": 3.0}


# The same for exporting: what is read, and the line that is being written.
MOST_TIMES_THE_FILE_EXPORTED = 1.5


def peak_of(*arguments, cwd):
    """Bytes that the program had in memory at the most; of a child of this one, whose own peak is not of its parent's."""
    process = subprocess.Popen([PROGRAM, *arguments], cwd=cwd, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0
    return 1024 * usage.ru_maxrss


class Memory(ProgramTest):
    def peak_of_program(self):
        """Bytes that it has in memory without a study to speak of."""
        self.assertLess(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, 60e6, "a child begins with its parent's peak")
        self.write("study.toml", HEAD.format(model="3-prs", fidelity="", poses=1, kind="coupling") + SIZES)
        return peak_of("run", "study.toml", "-o", "r.h5", "--quiet", cwd=self.folder)

    def test_peak(self):
        program = self.peak_of_program()
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                self.write("study.toml", study)
                line = re.search(r"# memory: about ([\d.e+]+) MB at the peak, when the result file of about ([\d.e+]+) MB is written",
                                 self.succeeds("check", "study.toml"))
                said, file_size = (1e6 * float(number) for number in line.groups())
                peak = peak_of("run", "study.toml", "-o", "r.h5", "--quiet", cwd=self.folder)
                written = (self.folder / "r.h5").stat().st_size
                times = (peak - program) / written
                print(f"{kind}: said {said / 1e6:.0f} MB, was {peak / 1e6:.0f} MB, {times:.2f} files", file=sys.stderr)
                self.assertGreater(peak, 80e6, "so large that the result counts, not the program")
                self.assertGreater(said, 0.9 * peak)
                self.assertLess(said, 1.4 * peak)
                self.assertAlmostEqual(file_size / written, 1.0, delta=0.1)
                if kind in MOST_TIMES_THE_FILE:
                    self.assertLess(times, MOST_TIMES_THE_FILE[kind])

    def test_peak_of_merging(self):
        program = self.peak_of_program()
        for kind, most in MOST_TIMES_THE_FILE_MERGED.items():
            with self.subTest(kind):
                self.write("study.toml", STUDIES[kind])
                for k in (1, 2):
                    self.succeeds("run", "study.toml", "--shard", f"{k}/2", "-o", f"{k}.h5", "--quiet")
                peak = peak_of("merge", "1.h5", "2.h5", "-o", "m.h5", cwd=self.folder)
                times = (peak - program) / (self.folder / "m.h5").stat().st_size
                print(f"{kind}, merged: was {peak / 1e6:.0f} MB, {times:.2f} files", file=sys.stderr)
                self.assertLess(times, most)

    def test_size_of_small_files(self):
        """What a file has whatever its size counts, too."""
        for kind, study in SMALL.items():
            with self.subTest(kind):
                self.write("study.toml", study)
                said = 1e6 * float(re.search(r"the result file of about ([\d.e+-]+) MB", self.succeeds("check", "study.toml"))[1])
                self.poesy("run", "study.toml", "-o", "r.h5", "--quiet")
                written = (self.folder / "r.h5").stat().st_size
                print(f"{kind}: said {said / 1e3:.0f} kB, was {written / 1e3:.0f} kB", file=sys.stderr)
                self.assertAlmostEqual(said / written, 1.0, delta=0.3)

    def test_peak_of_exporting(self):
        """A column of a table takes no memory of its own, however many poses there are."""
        program = self.peak_of_program()
        self.write("study.toml", HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=20000, kind="sensitivity")
                   + 'factors = ["a_x_1", "theta_A_x_1"]\nsamples = 2\n')
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        peak = peak_of("export", "r.h5", "-d", "tables", cwd=self.folder)
        times = (peak - program) / (self.folder / "r.h5").stat().st_size
        print(f"exported: was {peak / 1e6:.0f} MB, {times:.2f} files", file=sys.stderr)
        self.assertLess(times, MOST_TIMES_THE_FILE_EXPORTED)

    def test_peak_of_reading(self):
        """A file is hashed in slices: verifying it takes no more memory than verifying a small one."""
        peaks = []
        for poses in (10, 6000):
            self.write("study.toml", HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=poses,
                                                 kind="evaluate") + CASES)
            self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
            peaks.append(peak_of("verify", "r.h5", cwd=self.folder))
        self.assertLess(peaks[1] - peaks[0], 15e6)


main()
