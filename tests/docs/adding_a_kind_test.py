"""Tests the example of engine/docs/adding-a-kind.md: the page quotes its files, and its program works as described."""

import json
import re
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py

from poesy_program import PROGRAM, ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "engine/docs/adding-a-kind.md"
FILES = ROOT / "tests/docs/extremes"
STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 6
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "0.2 deg" }
[analysis]
kind = "extremes"
samples = 2300
[run]
seed = 5
"""


class Page(unittest.TestCase):
    def test_the_example_is_short(self):
        lines = sum(len(path.read_text().splitlines()) for path in FILES.iterdir())
        self.assertLessEqual(lines, 200)

    def test_it_quotes_the_files(self):
        source = (FILES / "extremes.cpp").read_text()
        quotes = re.findall(r"<!-- extremes: ([^\n]*) -->\n```cpp\n(.*?)```", PAGE.read_text(), re.DOTALL)
        self.assertGreaterEqual(len(quotes), 4)
        for begins, quote in quotes:
            self.assertIn(begins, quote)
            self.assertIn(quote, source, "the page quotes what extremes.cpp does not have")


class Extremes(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)

    def content_hash(self, name):
        with h5py.File(self.folder / name) as result:
            return result.attrs["content_sha256"]

    def whole(self):
        self.succeeds("run", "study.toml", "-o", "whole.h5", "--quiet")
        return self.content_hash("whole.h5")

    def test_a_study_is_checked_and_has_a_template(self):
        self.assertIn('kind = "extremes"', self.succeeds("template", "2upr-rpu", "extremes"))
        self.assertIn("solves", self.succeeds("check", "study.toml"))

    def test_a_stopped_run_goes_on_with_the_same_bits(self):
        expected = self.whole()
        self.write("study.toml", STUDY.replace("2300", "92300"))
        self.succeeds("run", "study.toml", "-o", "long.h5", "--quiet")
        stopped = 0
        while not (self.folder / "out.h5").exists():
            self.assertLess(stopped, 100)
            run = subprocess.Popen([PROGRAM, "run", "study.toml", "-o", "out.h5", "--quiet", "--resume", "--checkpoint-every",
                                    "0.01 s"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(0.3 + 0.1 * stopped)
            run.send_signal(signal.SIGINT)
            run.communicate()
            stopped += 1
        self.assertEqual(self.content_hash("out.h5"), self.content_hash("long.h5"))
        self.assertNotEqual(self.content_hash("out.h5"), expected)

    def test_more_samples_go_on_from_the_checkpoint(self):
        expected = self.whole()
        self.write("study.toml", STUDY.replace("2300", "1300"))
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--keep-checkpoint")
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
        self.assertEqual(self.content_hash("out.h5"), expected)

    def test_adaptive_samples_go_on_to_their_max(self):
        self.whole()
        self.write("study.toml", STUDY.replace("samples = 2300", "samples = { min = 1000, max = 2300, relative_error = 0.1 }"))
        self.succeeds("run", "study.toml", "-o", "adaptive.h5", "--quiet")
        with h5py.File(self.folder / "whole.h5") as whole, h5py.File(self.folder / "adaptive.h5") as adaptive:
            for name in ("value", "sample"):
                self.assertTrue((whole["extremes"][name][()] == adaptive["extremes"][name][()]).all())

    def test_shards_are_the_whole(self):
        expected = self.whole()
        names = []
        for k in (3, 1, 2):
            names.append(f"s{k}.h5")
            self.succeeds("run", "study.toml", "--shard", f"{k}/3", "-o", names[-1], "--quiet")
        self.succeeds("merge", *names, "-o", "all.h5")
        self.assertEqual(self.content_hash("all.h5"), expected)

    def test_the_result_is_told_and_its_addresses_replay(self):
        self.whole()
        self.assertIn("smallest", self.succeeds("show", "whole.h5"))
        self.succeeds("verify", "whole.h5")
        self.succeeds("export", "whole.h5", "-d", "tables")
        self.assertTrue((self.folder / "tables/extremes_linear_deformation.csv").read_text().startswith("pose,"))
        self.succeeds("report", "whole.h5", "-o", "report.html")
        self.assertIn("How far responses go", (self.folder / "report.html").read_text())
        tables = json.loads(self.succeeds("show", "whole.h5", "--json"))
        self.assertIn("extremes", json.dumps(tables))
        with h5py.File(self.folder / "whole.h5") as result:
            responses = [name.decode() for name in result["response"][()]]
            values, samples = result["extremes/value"][()], result["extremes/sample"][()]
        for r, response in enumerate(responses):
            for end in (0, 1):
                pose = 3
                said = self.succeeds("replay", "whole.h5", "all", pose, samples[r, end, pose])
                found = re.search(rf"^  {response} +(\S+)", said, re.MULTILINE)
                self.assertAlmostEqual(float(found[1]), values[r, end, pose], delta=1e-9 * abs(values[r, end, pose]))


if __name__ == "__main__":
    main()
