"""results/tutorial/README.md: its commands run, in its order, in an empty folder, and come to what it says."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import h5py
from poesy_program import PROGRAM, ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks(text):
    """The commands of a page, a text for each block of code that is marked as sh."""
    return BLOCK.findall(text)


class Tutorial(ProgramTest):
    def setUp(self):
        super().setUp()
        programs = self.folder / "programs"
        programs.mkdir()
        (programs / "poesy").symlink_to(Path(PROGRAM).resolve())
        (programs / "python3").symlink_to(sys.executable)
        self.work = self.folder / "work"
        self.work.mkdir()
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        self.environment = {**os.environ, "PATH": path, "POESY": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}

    def run_block(self, block):
        done = subprocess.run(["bash", "-eu", "-o", "pipefail", "-c", block], cwd=self.work, env=self.environment, text=True,
                              capture_output=True, timeout=600, check=False)
        self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
        return done.stdout

    def test_commands_run_and_tolerances_are_confirmed(self):
        commands = blocks((ROOT / "results/tutorial/README.md").read_text())
        self.assertGreater(len(commands), 8)
        for block in commands:
            self.run_block(block)
        with h5py.File(self.work / "study.h5") as file:
            study = file["study/text"].asstr()[()]
            self.assertIn('l_A = "0.08 m"', study)
            self.assertIn("count = 40", study)
        with h5py.File(self.work / "all.h5") as file:
            self.assertEqual(file["factor"].shape, (41,))
        with h5py.File(self.work / "precise.h5") as file:
            self.assertIn("convergence", file)
        with h5py.File(self.work / "all_tolerances/confirm_equal_effect.h5") as file:
            at = list(file["response"].asstr()).index("gap")
            mean, std = (file[f"monte_carlo/overall_{what}"][at] for what in ("mean", "std"))
        self.assertLess(math.hypot(mean, std), 5e-5)
        self.assertGreater(math.hypot(mean, std), 0.98 * 5e-5)
        self.assertGreater((self.work / "ranked.svg").stat().st_size, 5000)
        self.assertTrue((self.work / "tables/local_gap.csv").is_file())

    def test_a_command_that_fails_is_found(self):
        first, second = blocks("```sh\npoesy models\n```\n\n```\nfalse\n```\n```sh\npoesy frobnicate\ntrue\n```\n")
        self.run_block(first)
        with self.assertRaises(AssertionError):
            self.run_block(second)


if __name__ == "__main__":
    main()
