"""`poesy check` names the peak of memory that a run has: within -10 % and +40 % of what the system measured."""

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
SIZES = "linear = [" + ", ".join(f'"{k + 1} um"' for k in range(20)) + "]\n"

STUDIES = {
    "sensitivity": HEAD.format(model="2upr-rpu", fidelity="", poses=1200, kind="sensitivity") + 'factors = "all"\nsamples = 2\n',
    "cases": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=6000, kind="evaluate") + CASES,
    "coupling": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=600, kind="coupling") + SIZES,
    "monte-carlo": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=20000, kind="monte-carlo")
    + 'factors = "all"\nsamples = 2\n',
    "machines": HEAD.format(model="3-prs", fidelity='fidelity = "first-order"', poses=1000, kind="monte-carlo")
    + 'draws = "per machine"\nfactors = "all"\nsamples = 8000\nlimits.position = "0.1 mm"\n',
}


def peak_of(*arguments, cwd):
    """Bytes that the program had in memory at the most; of a child of this one, whose own peak is not of its parent's."""
    process = subprocess.Popen([PROGRAM, *arguments], cwd=cwd, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0
    return 1024 * usage.ru_maxrss


class Memory(ProgramTest):
    def test_peak(self):
        self.assertLess(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, 60e6, "a child begins with its parent's peak")
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                self.write("study.toml", study)
                line = re.search(r"# memory: about ([\d.e+]+) MB at the peak, when the result file of about ([\d.e+]+) MB is written",
                                 self.succeeds("check", "study.toml"))
                said, file_size = (1e6 * float(number) for number in line.groups())
                peak = peak_of("run", "study.toml", "-o", "r.h5", "--quiet", cwd=self.folder)
                print(f"{kind}: said {said / 1e6:.0f} MB, was {peak / 1e6:.0f} MB", file=sys.stderr)
                self.assertGreater(peak, 80e6, "so large that the result counts, not the program")
                self.assertGreater(said, 0.9 * peak)
                self.assertLess(said, 1.4 * peak)
                self.assertAlmostEqual(file_size / (self.folder / "r.h5").stat().st_size, 1.0, delta=0.1)


main()
