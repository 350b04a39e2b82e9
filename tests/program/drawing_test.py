"""A drawing's features and zones: the numbers of another program, and the same draws however a run is divided."""

import json
import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
MECHANISM = DATA / "mechanisms" / "linear-delta-drawing.toml"
EXPECTED = json.loads((DATA / "drawing.json").read_text())["linear_delta"]
STUDY = """\
format = "poesy-study"
version = 1
mechanism = {{ file = "delta.toml", fidelity = "{fidelity}" }}
poses = {{ select = "file", file = "poses.csv" }}
errors.zones = {{ distribution = "normal", sigmas = 3 }}
[analysis]
{analysis}
"""
POSES = "x [m],y [m],z [m]\n" + "".join(",".join(map(repr, one["pose"])) + "\n" for one in EXPECTED["poses"])


class Drawing(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(MECHANISM, self.folder / "delta.toml")
        self.write("poses.csv", POSES)

    def result(self, name, analysis, fidelity="first-order", arguments=()):
        self.write(f"{name}.toml", STUDY.format(analysis=analysis, fidelity=fidelity))
        self.succeeds("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet", *arguments)
        return h5py.File(self.folder / f"{name}.h5")

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def test_scatter(self):
        """The root mean square of the tool's displacement is that of all zones, to first order."""
        samples = 40000
        with self.result("mc", f'kind = "monte-carlo"\nsamples = {samples}') as file:
            names = [name.decode() for name in file["response"][:]]
            rms = file["monte_carlo/rms"][names.index("tip_position")]
            sigma = dict(zip((name.decode() for name in file["factors/name"][:]), file["factors/sigma"][:]))
        np.testing.assert_allclose(sigma["rail_x_1"], 7.6376261583e-6, rtol=1e-10)
        np.testing.assert_allclose(sigma["rail_lean_y_3"], 6.6666666667e-6, rtol=1e-10)
        np.testing.assert_allclose(sigma["rod_2"], 0.02e-3 / 3, rtol=1e-12)
        expected = np.array([pose["rms_tip"] for pose in EXPECTED["poses"]])
        # A mean square of a normal has a relative standard error of at most sqrt(2 / samples); alpha = 1e-6.
        self.assertLess(np.abs(rms / expected - 1.0).max(), 5.0 * np.sqrt(2.0 / samples) / 2.0)

    def test_division(self):
        """Threads, shards and a stop change no bit."""
        analysis = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 3000\nlimits = { tip_position = "0.12 mm" }'
        self.result("one", analysis, "exact", ["--threads", "1"]).close()
        self.result("two", analysis, "exact", ["--threads", "2"]).close()
        for shard in ("1/2", "2/2"):
            self.succeeds("run", "one.toml", "--shard", shard, "-o", f"part{shard[0]}.h5", "--quiet")
        self.succeeds("merge", "part1.h5", "part2.h5", "-o", "merged.h5")
        self.assertEqual(len({self.content_hash(f"{name}.h5") for name in ("one", "two", "merged")}), 1)

    def test_named(self):
        """`models` says in words what the errors of a feature are."""
        text = self.succeeds("models", "delta.toml")
        self.assertIn("leans to x: its far end against its near end, 500 mm apart", text)


if __name__ == "__main__":
    main()
