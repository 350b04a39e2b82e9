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
{zones}
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
        has_features = "features = [" in (self.folder / "delta.toml").read_text()
        zones = 'errors.zones = { distribution = "normal", sigmas = 3 }' if has_features else ""
        self.write(f"{name}.toml", STUDY.format(analysis=analysis, fidelity=fidelity, zones=zones))
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

    def test_worst_case(self):
        """To first order the worst case and the root mean squares are those of the other program."""
        limits = 'limits = { tip_position = "0.12 mm" }'
        with self.result("mc", f'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 500\n{limits}') as file:
            names = [name.decode() for name in file["response"][:]]
            features = [name.decode() for name in file["feature"][:]]
            found = {name: file["drawing"][name][:] for name in ("rms", "rms_worst_division", "worst_case", "effect")}
        for name in ("tip_x", "tip_y", "tip_z", "tip_position"):
            expected = [pose[f"worst_{name}"] for pose in EXPECTED["poses"]]
            np.testing.assert_allclose(found["worst_case"][names.index(name)], expected, rtol=1e-9)
        tip = names.index("tip_position")
        for of, key in (("rms", "rms_tip"), ("rms_worst_division", "rms_tip_worst_split")):
            np.testing.assert_allclose(found[of][tip], [pose[key] for pose in EXPECTED["poses"]], rtol=1e-9)
        for feature, effect in zip(features, found["effect"][tip]):
            squares = [pose["zones"][feature]["rms_tip"] ** 2 for pose in EXPECTED["poses"]]
            np.testing.assert_allclose(effect, np.sqrt(np.mean(squares)), rtol=1e-9, err_msg=feature)
        shown = self.succeeds("show", "mc.h5", "--response", "tip_position")
        self.assertIn("What the features of the drawing do to tip_position in their zones, to first order", shown)
        self.assertIn("rod_bore_3  -                  parallelism 0.03 A", shown)
        self.assertIn("worst case, with all features in their zones, to first order: 0.7656 mm", " ".join(shown.split()))
        self.succeeds("export", "mc.h5", "-d", "tables")
        lines = (self.folder / "tables" / "features.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + len(names) * len(features))

    def test_division(self):
        """Threads, shards and a stop change no bit."""
        analysis = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 3000\nlimits = { tip_position = "0.12 mm" }'
        self.result("one", analysis, "exact", ["--threads", "1"]).close()
        self.result("two", analysis, "exact", ["--threads", "2"]).close()
        for shard in ("1/2", "2/2"):
            self.succeeds("run", "one.toml", "--shard", shard, "-o", f"part{shard[0]}.h5", "--quiet")
        self.succeeds("merge", "part1.h5", "part2.h5", "-o", "merged.h5")
        self.assertEqual(len({self.content_hash(f"{name}.h5") for name in ("one", "two", "merged")}), 1)

    def test_clearance(self):
        """A pin is loose in another way at each pose: the yield over the poses is the product of those of each."""
        text = (self.folder / "delta.toml").read_text()
        loose = 'clearances = [ { name = "play", joint = "B", length = "40 mm", fit = "8 H7/g6" } ]\n'
        (self.folder / "delta.toml").write_text(text[:text.index("features = [")] + loose)
        samples = 20000
        analysis = f'kind = "monte-carlo"\ndraws = "per machine"\nsamples = {samples}\nlimits = {{ tip_position = "0.025 mm" }}'
        with self.result("loose", analysis) as file:
            together = file["yield/value"][()]
            sigma = dict(zip((name.decode() for name in file["factors/name"][:]), file["factors/sigma"][:]))
        end = np.hypot(sigma["play_x_1"], 0.5 * sigma["play_lean_x_1"])
        np.testing.assert_allclose(end, 6.098155458825233e-6, rtol=1e-9)
        alone = []
        for pose in EXPECTED["poses"]:
            self.write("poses.csv", "x [m],y [m],z [m]\n" + ",".join(map(repr, pose["pose"])) + "\n")
            with self.result("alone", analysis) as file:
                alone.append(file["yield/value"][()])
        product = np.prod(alone)
        variance = product * (1 - product) + sum((product / one) ** 2 * one * (1 - one) for one in alone)
        self.assertLess(abs(together - product), 5.0 * np.sqrt(variance / samples))
        self.assertLess(together, min(alone))

    def test_named(self):
        """`models` says in words what the errors of a feature are."""
        text = self.succeeds("models", "delta.toml")
        self.assertIn("leans to x: its far end against its near end, 500 mm apart", text)


if __name__ == "__main__":
    main()
