"""results/tutorial/README.md: its commands run in its order in an empty folder, and print what the page shows."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import h5py
from poesy_program import PROGRAM, ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
TUTORIAL = ROOT / "results/tutorial"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks(text):
    """The commands of a page: each block of code marked as sh, with the lines of output that are shown after it."""
    found = []
    for language, code in BLOCK.findall(text):
        if language == "sh":
            found.append((code, []))
        elif not language:
            found[-1][1].extend(code.splitlines())
    return found


def first_not_printed(shown, output):
    """The first line shown that the output does not have after those before it; "..." stands for lines left out."""
    printed = iter([line.rstrip() for line in output.splitlines()])
    for line in shown:
        if line.strip() not in ("", "...") and line.rstrip() not in printed:
            return line
    return None


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

    def test_commands_run_and_print_what_is_shown(self):
        commands = blocks((TUTORIAL / "README.md").read_text(encoding="utf-8"))
        self.assertGreater(len(commands), 12)
        for block, shown in commands:
            output = self.run_block(block)
            self.assertIsNone(first_not_printed(shown, output), f"{block}\n{output}")
        for name in ("linear-delta.toml", "study.toml", "allocation.toml", "drawn-delta.toml", "drawing.toml"):
            self.assertEqual((self.work / name).read_bytes(), (TUTORIAL / name).read_bytes(), name)
        with h5py.File(self.work / "precise.h5") as file:
            self.assertIn("convergence", file)
        with h5py.File(self.work / "boundary.h5") as file:
            self.assertEqual(file["factor"].shape, (33,))
        with h5py.File(self.work / "boundary_tolerances/confirm_equal_effect.h5") as file:
            at = list(file["response"].asstr()).index("tip_position")
            mean, std = (file[f"monte_carlo/overall_{what}"][at] for what in ("mean", "std"))
        self.assertLess(math.hypot(mean, std), 5e-5)
        self.assertGreater(math.hypot(mean, std), 0.98 * 5e-5)
        self.assert_drawing(self.work / "allocation.h5", self.work / "allocation_certificate.h5")
        self.assertGreater((self.work / "ranked.svg").stat().st_size, 5000)
        self.assertTrue((self.work / "tables/local_tip_position.csv").is_file())

    def assert_drawing(self, drawing, repeated):
        """That the tolerances are certified, and the certificate's study finds as many rejects with them."""
        with h5py.File(drawing) as file:
            self.assertEqual(len(file["allocation/part"]), 11)
            certificate = file["allocation/certificate"]
            self.assertEqual(certificate["decision"].asstr()[()], "kept")
            rejects = certificate["rejects"][()]
        with h5py.File(repeated) as file:
            self.assertEqual(file["yield/rejects"][()], rejects)

    def test_a_command_that_fails_is_found(self):
        (first, shown), (second, nothing) = blocks(
            "```sh\npoesy models\n```\n\n```\nfalse\n```\n```toml\na = 1\n```\n```sh\npoesy frobnicate\ntrue\n```\n")
        self.assertEqual((shown, nothing), (["false"], []))
        self.run_block(first)
        with self.assertRaises(AssertionError):
            self.run_block(second)

    def test_output_that_differs_is_found(self):
        self.assertIsNone(first_not_printed(["a", "...", "", "c"], "a  \nb\nc\n"))
        self.assertEqual(first_not_printed(["a", "b 2"], "a\nb 1\n"), "b 2")
        self.assertEqual(first_not_printed(["c", "a"], "a\nc\n"), "a")


if __name__ == "__main__":
    main()
