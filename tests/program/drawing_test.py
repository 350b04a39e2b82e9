"""Features and zones of a drawing, compared with numbers of another program; same draws however a run is divided."""

import csv
import json
import math
import os
import re
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np

from poesy_program import PROGRAM, ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
MECHANISM = DATA / "mechanisms" / "linear-delta-drawing.toml"
REFERENCES = json.loads((DATA / "drawing.json").read_text())
EXPECTED = REFERENCES["linear_delta"]
STUDY = """\
format = "poesy-study"
version = 1
mechanism = {{ file = "delta.toml", fidelity = "{fidelity}" }}
poses = {{ select = "file", file = "poses.csv" }}
{zones}
[analysis]
{analysis}
"""
# From OTAF (Kramer84/otaf), notebook Ex1_2D_4dof: a part with two faces in a pocket. The second limb does not constrain
# the part.
POCKET = """\
format = "poesy-mechanism"
version = 1
name = "pocket"
title = "Part of 99.8 mm in a pocket of 100 mm"
[platform]
origin = ["99.8 mm", 0, 0]
points = { top = [0, "5 mm", 0], bottom = [0, "-5 mm", 0] }
metric_points = [[0, "5 mm", 0], [0, "-5 mm", 0], [0, 0, "5 mm"]]
coordinates = ["x"]
workspace = { x = ["99 mm", "101 mm"] }
[[limb]]
joints = [ { name = "part", type = "P", at = [0, 0, 0], axis = "x", actuated = true } ]
features = [
  { name = "left", joint = "part", kind = "axis", z = "y", x = "x", length = "10 mm", shape = "planes", along = "x", position = { zone = "0.31 mm", datums = "A" } },
  { name = "right", joint = "part", part = "after", at = ["99.8 mm", 0, 0], kind = "axis", z = "y", x = "x", length = "10 mm", shape = "planes", along = "x", position = { zone = "0.31 mm", datums = "A" } } ]
[[limb]]
joints = [ { name = "A", type = "S", at = [0, "50 mm", 0] }, { name = "B", type = "P", from = "A", to = "C" }, { name = "C", type = "S", at = ["99.8 mm", "50 mm", 0] } ]
"""
POSES = "x [m],y [m],z [m]\n" + "".join(",".join(map(repr, one["pose"])) + "\n" for one in EXPECTED["poses"])


class Drawing(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(MECHANISM, self.folder / "delta.toml")
        self.write("poses.csv", POSES)

    def result(self, name, analysis, fidelity="first-order", arguments=(), shape='"normal", sigmas = 3'):
        has_features = "features = [" in (self.folder / "delta.toml").read_text()
        zones = f"errors.zones = {{ distribution = {shape} }}" if has_features else ""
        self.write(f"{name}.toml", STUDY.format(analysis=analysis, fidelity=fidelity, zones=zones))
        self.succeeds("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet", *arguments)
        return h5py.File(self.folder / f"{name}.h5")

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def test_scatter(self):
        """The root mean square of the tool's displacement is that of all zones, to first order."""
        samples = 40000
        with self.result("mc", f'kind = "monte-carlo"\ndraws = "per pose"\nsamples = {samples}') as file:
            names = [name.decode() for name in file["response"][:]]
            rms = file["monte_carlo/rms"][names.index("tip_position")]
            sigma = dict(zip((name.decode() for name in file["factors/name"][:]), file["factors/sigma"][:]))
        np.testing.assert_allclose(sigma["rail_x_1"], 7.6376261583e-6, rtol=1e-10)
        np.testing.assert_allclose(sigma["rail_lean_y_3"], 6.6666666667e-6, rtol=1e-10)
        np.testing.assert_allclose(sigma["rod_2"], 0.02e-3 / 3, rtol=1e-12)
        expected = np.array([pose["rms_tip"] for pose in EXPECTED["poses"]])
        # The mean square of a normal number has a relative standard error of sqrt(2 / samples), and that of a norm at
        # most this; its root has half of it. alpha = 1e-6.
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
        self.assertIn("20 of 78 rows shown; --top N shows more, --json all", shown)
        self.assertIn("What the features of the drawing do to tip_position in their zones, to first order", shown)
        self.assertIn("rod_bore_3  -                  parallelism 0.03 A", shown)
        self.assertIn("worst case, with all features in their zones, to first order: 0.7656 mm", " ".join(shown.split()))
        self.succeeds("export", "mc.h5", "-d", "tables")
        lines = (self.folder / "tables" / "features.csv").read_text().splitlines()
        self.assertEqual([line.split(",")[0] for line in lines[1:]], [name for name in names for _ in features])
        self.assertNotIn("'", "".join(lines))

    def test_advice_names_features(self):
        """The report advises to halve a feature in all limbs, not one of its errors: the one with the largest share."""
        self.result("mc", 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 2000\nlimits = { tip_position = "0.12 mm" }').close()
        tables = json.loads(self.succeeds("show", "mc.h5", "--json"))["tables"]
        rows = next(table for table in tables if table["name"] == "features")["rows"]
        # Features whose shares are too close to the largest to be told apart.
        first = [re.sub(r"_\d$", "", row["feature"]) for row in rows if row["share"] > 0.9 * rows[0]["share"]]
        self.succeeds("report", "mc.h5", "-o", "mc.html")
        advice = re.search(r"for one change alone, now [\d.]+ %: halving (\w+) ", (self.folder / "mc.html").read_text())
        self.assertIn(advice.group(1), first)

    def test_template_states_only_the_sizes_that_it_uses(self):
        """All errors of this mechanism are in zones, so sizes of all lengths and of all angles would say nothing."""
        template = self.succeeds("template", "delta.toml")
        full = self.succeeds("template", "delta.toml", "--full")
        for key in ("linear", "angular"):
            self.assertNotIn(f"{key} =", template)
            self.assertIn(f'\n# {key} = {{ distribution = "normal"', full)

    def test_no_template_for_indices_of_errors_drawn_per_pose(self):
        shutil.copy(DATA / "mechanisms" / "designed-delta.toml", self.folder / "loose.toml")
        done = self.poesy("template", "loose.toml", "sobol")
        self.assertEqual(done.returncode, 2)
        self.assertIn("has clearances, whose errors, such as play_x_1, are drawn per pose", done.stderr.decode())

    def test_template_of_an_allocation_joins_limbs_that_are_alike(self):
        self.assertIn("zones = \"all\", each = true, identical_limbs = [1, 2, 3]", self.succeeds("template", "delta.toml", "allocation"))

    def test_limbs_of_a_part_are_numbers(self):
        self.write("named.toml", STUDY.format(fidelity="exact", zones="errors.zones = { distribution = \"normal\", sigmas = 3 }", analysis='kind = "allocation"\n'
                   'limits = { tip_position = "0.12 mm" }\nparts = [ { zones = "all", each = true, identical_limbs = ["leg"] } ]'))
        done = self.poesy("check", "named.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is 'leg', but this key takes the numbers of limbs; write some of 1, 2, 3", " ".join(done.stderr.decode().split()))

    def test_errors_in_no_part_need_a_size(self):
        """They would have the default size of 1 mm, which no drawing means."""
        text = (self.folder / "delta.toml").read_text()
        self.write("delta.toml", re.sub(r'(name = "zero".*?), tolerance = "[^"]*"', r"\1", text))
        self.assertNotEqual((self.folder / "delta.toml").read_text(), text)
        analysis = ('kind = "allocation"\nlimits = { tip_position = "0.12 mm" }\n'
                    'parts = [ { zones = "all", each = true, cost = { law = "reciprocal", b = 1, unit = "mm" } } ]')
        zones = 'errors.zones = { distribution = "normal", sigmas = 3 }'
        self.write("some.toml", STUDY.format(fidelity="first-order", zones=zones, analysis=analysis))
        done = self.poesy("check", "some.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("'zero_1' of the feature 'zero_1' varies, but no zone of the feature limits it",
                      " ".join(done.stderr.decode().split()))

    def test_division(self):
        """Threads, shards and a stop change no bit."""
        analysis = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 3000\nlimits = { tip_position = "0.12 mm" }'
        self.result("one", analysis, "exact", ["--threads", "1"]).close()
        self.result("two", analysis, "exact", ["--threads", "2"]).close()
        for shard in ("1/2", "2/2"):
            self.succeeds("run", "one.toml", "--shard", shard, "-o", f"part{shard[0]}.h5", "--quiet")
        self.succeeds("merge", "part1.h5", "part2.h5", "-o", "merged.h5")
        self.assertEqual(len({self.content_hash(f"{name}.h5") for name in ("one", "two", "merged")}), 1)

    # For each feature, its standard deviation with a uniform distribution divided by that with a normal distribution of
    # three sigmas: 1.5 for a location or a lean alone, sqrt(3) for a distance or a lift alone. Features with both zones
    # are not listed.
    UNIFORM = {"face": 3**0.5, "zero": 3**0.5, "cross_b": 1.5, "rod": 3**0.5, "rod_bore": 1.5, "cross_c": 1.5, "hinge_c": 1.5}
    SHAPED = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = {samples}\nfactors = [{factors}]\nlimits = {{ tip_position = "0.12 mm" }}'

    def test_uniform(self):
        """Mean squares of uniform features are those of normals times closed ratios, and draws have them."""
        samples = 40000
        factors = ", ".join(f'"{feature}_*"' for feature in self.UNIFORM if feature not in ("rod", "zero"))
        analysis = self.SHAPED.format(samples=samples, factors=factors + ', "rod_?", "zero_?"')
        with self.result("uniform", analysis, shape='"uniform"') as file:
            tip = [name.decode() for name in file["response"][:]].index("tip_position")
            found, drawn = file["drawing/rms"][tip], file["monte_carlo/rms"][tip]
            worst = file["drawing/rms_worst_division"][tip]
            self.assertEqual(set(file["drawing/sigmas"][:]), {0.0})
            self.assertTrue(np.isnan(file["monte_carlo/S1"][tip, 0]))
        expected = [np.sqrt(sum((ratio * pose["zones"][f"{feature}_{limb}"]["rms_tip"]) ** 2
                                for feature, ratio in self.UNIFORM.items() for limb in (1, 2, 3))) for pose in EXPECTED["poses"]]
        np.testing.assert_allclose(found, expected, rtol=1e-9)
        np.testing.assert_array_equal(worst, found)
        # Squares of uniform errors scatter less than those of normal errors, so this bound of normal errors is safe;
        # alpha = 1e-6.
        self.assertLess(np.abs(drawn / expected - 1.0).max(), 5.0 * np.sqrt(2.0 / samples) / 2.0)
        self.assertIn("groups that hold whole features", " ".join(self.succeeds("show", "uniform.h5").split()))

    def test_inspected_parts_are_in_their_zones(self):
        """So no machine exceeds the worst case of the zones, which is first-order as the solves are, and many normal ones do."""
        samples = 4000
        analysis = self.SHAPED.format(samples=samples, factors='"rail_*"')
        beyond = {}
        for name, shape in (("normal", '"normal", sigmas = 1.5'), ("inspected", '"inspected", sigmas = 1.5'), ("uniform", '"uniform"')):
            with self.result(name, analysis, shape=shape) as file:
                tip = [one.decode() for one in file["response"][:]].index("tip_z")
                worst = file["drawing/worst_case"][tip]
                low, high = file["monte_carlo/min"][tip], file["monte_carlo/max"][tip]
                beyond[name] = (np.maximum(-low, high) > worst * (1.0 + 1e-9)).any()
        self.assertEqual(beyond, {"normal": True, "inspected": False, "uniform": False})

    def test_division_of_shapes(self):
        """Threads, shards and a stop change no bit, and a sample is replayed alone."""
        analysis = self.SHAPED.format(samples=2000, factors='"*"')
        for shape in ('"uniform"', '"inspected", sigmas = 1.5'):
            self.result("one", analysis, arguments=["--threads", "1"], shape=shape).close()
            self.result("two", analysis, arguments=["--threads", "2"], shape=shape).close()
            for shard in ("1/2", "2/2"):
                self.succeeds("run", "one.toml", "--shard", shard, "-o", f"part{shard[0]}.h5", "--quiet")
            self.succeeds("merge", "part1.h5", "part2.h5", "-o", "merged.h5")
            self.assertEqual(len({self.content_hash(f"{name}.h5") for name in ("one", "two", "merged")}), 1)
            for part in (self.folder / "part1.h5", self.folder / "part2.h5", self.folder / "merged.h5"):
                part.unlink()

    def test_groups_of_whole_features(self):
        """Indices of Sobol' are of features as a whole: of independent ones they add up to one, to first order."""
        groups = 'groups = { rail = ["rail_*"], hinges = ["hinge_*"], rods = ["rod_*"] }'
        analysis = f'kind = "sobol"\nsamples = 4096\n{groups}'
        with self.result("sobol", analysis, shape='"inspected", sigmas = 2') as file:
            tip = [name.decode() for name in file["response"][:]].index("tip_z")
            low, high = (file[f"sobol/aggregated/S1_ci_{end}"][tip] for end in ("low", "high"))
            self.assertLess(low.sum(), 1.0)
            self.assertGreater(high.sum(), 1.0)

    def test_published_pocket(self):
        """How many parts are too wide for the pocket, wherever it holds them: at the top or at the bottom of their faces."""
        samples = 400000
        published = REFERENCES["published"][0]

        def beyond(sigma):
            """Of a normal, 0.2 mm."""
            return 0.5 * math.erfc(2e-4 / (sigma * math.sqrt(2.0)))

        edge = 0.31e-3 / 6.0  # standard deviation of the middle or an edge of a face (m)
        largest = f"""
[errors.override]
"*_x_?" = {{ distribution = "normal", sigma = "{edge} m" }}
"*_lean_x_?" = {{ distribution = "normal", sigma = "{2.0 * edge} m" }}
"""
        cases = (("exact_percent", 1.0 - (1.0 - beyond(2.0 * edge)) ** 2, largest, '"all"'),
                 ("same_with_equal_shares_percent", 1.0 - (1.0 - beyond(math.sqrt(2.0) * edge)) ** 2, "", '"all"'),
                 ("translation_alone_percent", beyond(math.sqrt(2.0) * edge), largest, '["left_x_1", "right_x_1"]'),
                 ("rotation_alone_percent", 2.0 * beyond(math.sqrt(2.0) * edge), largest, '["*_lean_x_1"]'))
        (self.folder / "delta.toml").write_text(POCKET)
        self.write("poses.csv", "x [m]\n0.0998\n")
        for name, closed, override, factors in cases:
            self.assertAlmostEqual(closed, published[name] / 100.0, delta=1e-12)
            limits = 'limits = { top_x = { to = "0.2 mm" }, bottom_x = { to = "0.2 mm" } }'
            analysis = f'kind = "monte-carlo"\ndraws = "per machine"\nfactors = {factors}\nsamples = {samples}\n{limits}'
            with self.result("pocket", analysis + override) as file:
                found = file["yield/rejects"][()] / samples
            # alpha = 1e-4
            self.assertLess(abs(found - closed), 3.9 * math.sqrt(closed / samples), name)

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

    def test_pins_in_bores(self):
        """Where zones are not normal, each end of a pin touches its bore at each pose."""
        text = (self.folder / "delta.toml").read_text()
        loose = 'clearances = [ { name = "play", joint = "B", length = "40 mm", fit = "8 H7/g6" } ]\n'
        (self.folder / "delta.toml").write_text(text[:text.index("features = [")] + loose)
        self.write("pins.toml", STUDY.format(zones='errors.zones = { distribution = "uniform" }', fidelity="first-order",
                                             analysis='kind = "monte-carlo"\ndraws = "per machine"\nsamples = 50'))
        self.succeeds("run", "pins.toml", "--quiet")
        found = set()
        for pose, machine in ((0, 3), (1, 3), (0, 17)):
            said = self.succeeds("replay", "pins.h5", "all", pose, machine)
            part = said[said.index("errors that vary\n"):said.index("solved as in the run")]
            error = {line.split()[0]: float(line.split()[1]) for line in part.splitlines()[1:] if line.startswith("  ")}
            for end in (-0.5, 0.5):
                away = math.hypot(*(error[f"play_{axis}_2"] + end * error[f"play_lean_{axis}_2"] for axis in "xy"))
                self.assertAlmostEqual(away, 0.5 * 17.2481883107e-6, delta=1e-14)
            found.add(error["play_x_2"])
        self.assertEqual(len(found), 3, "a machine draws its pins anew at each pose")

    ALLOCATION = """\
kind = "allocation"
samples = 4000
limits = { tip_position = "0.1 mm" }
yield = 0.95
[[analysis.parts]]
zones = "all"
each = true
identical_limbs = [1, 2, 3]
cost = { law = "reciprocal", b = 1, unit = "mm" }
bounds = ["0.002 mm", "0.2 mm"]
"""

    def rows(self, result):
        self.succeeds("export", result, "-d", "tables")
        with open(self.folder / "tables" / "drawing.csv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_allocation(self):
        """The drawing comes back as a table for the workshop, the same however it is run."""
        self.result("one", self.ALLOCATION, "exact", ["--threads", "1"]).close()
        with self.result("two", self.ALLOCATION, "exact", ["--threads", "2"]) as file:
            found = file["allocation"]
            zones = {name.decode(): k for k, name in enumerate(file["part"][:])}
            tolerance, needed = found["tolerance"][:], found["zone_is_needed"][:]
            rejects = found["certificate/rejects"][()]
            self.assertEqual(found.attrs["certified"], 1)
            np.testing.assert_allclose(found["mean_square_share"][:].sum(), 1.0, rtol=1e-12)
            np.testing.assert_allclose(np.nansum(found["error_mean_square_share"][:]), 1.0, rtol=1e-12)
        self.assertEqual(self.content_hash("one.h5"), self.content_hash("two.h5"))
        left_out = [name for name, k in zones.items() if needed[k] == 0]
        self.assertEqual(left_out, ["rail.perpendicularity", "hinge_b.parallelism"])
        rows = self.rows("two.h5")
        self.assertEqual(list(rows[0]), "limbs feature symbol sign zone_mm shape datums length_mm cost share_of_cost "
                                        "share_of_mean_square sigmas inside grade remark angle_deg".split())
        self.assertEqual([f"{row['feature']}.{row['symbol']}" for row in rows], [z for z in zones if z not in left_out])
        for row in rows:
            exact = 1e3 * tolerance[zones[f"{row['feature']}.{row['symbol']}"]]
            self.assertLessEqual(float(row["zone_mm"]), exact)
            self.assertGreater(float(row["zone_mm"]), 0.999 * exact)
        self.assertIn("cost: of each tolerance once, however many limbs share it", " ".join(self.succeeds("show", "two.h5").split()))
        self.succeeds("report", "two.h5", "-o", "two.html")
        self.assertIn(f"{len(rows)} parts cost ", (self.folder / "two.html").read_text(encoding="utf-8"))
        rail = rows[1]
        self.assertEqual([rail[key] for key in ("limbs", "sign", "shape", "datums", "length_mm", "remark")],
                         ["1-3", "\u2316", "cylinder", "A|B", "500", "perpendicularity: not needed"])
        inside = {row["feature"]: float(row["inside"]) for row in rows}
        for feature, expected in (("rail", 0.9779054167276021), ("rod", 0.9973002039367398), ("rod_bore", 0.9888910034617577),
                                  ("face", 0.9973002039367398**2)):
            np.testing.assert_allclose(inside[feature], expected, rtol=1e-9)
        # The certificate's study has the same rejects.
        self.succeeds("run", "two_certificate.toml", "-o", "again.h5", "--quiet")
        with h5py.File(self.folder / "again.h5") as file:
            self.assertEqual(file["yield/rejects"][()], rejects)

    def test_certificate_with_other_seeds(self):
        """Tolerances that are certified with one set of machines are so with 18 of 20 others at least."""
        self.result("drawing", self.ALLOCATION, "exact").close()
        passed = 0
        for seed in range(101, 121):
            done = self.poesy("run", "drawing_certificate.toml", "-o", "again.h5", "--quiet", "--seed", seed)
            passed += b"PASS" in done.stdout and done.returncode == 0
        self.assertGreaterEqual(passed, 18)

    def test_given_orientation(self):
        """An orientation that is in no block stays as drawn."""
        parts = self.ALLOCATION.replace('"all"', '["*.position", "*.tolerance"]')
        self.result("given", parts, "exact").close()
        rows = {f"{row['feature']}.{row['symbol']}": row for row in self.rows("given.h5")}
        self.assertEqual(rows["hinge_b.parallelism"]["zone_mm"], "0.01")
        self.assertEqual(rows["hinge_b.parallelism"]["remark"], "given")

    def test_signs(self):
        """A terminal shows signs where its locale has them, and words elsewhere."""
        self.result("signs", self.ALLOCATION, "exact").close()
        for locale, line in (("C.UTF-8", "1-3 rail      \u2316  \u23000."), ("C", "1-3 rail      position     dia 0.")):
            shown = subprocess.run([PROGRAM, "show", "signs.h5"], cwd=self.folder, env=os.environ | {"LC_ALL": locale},
                                   capture_output=True, text=True, encoding="utf-8", check=True).stdout
            self.assertIn(line, shown)
            self.assertIn("perpendicularity: not needed", shown)
        self.assertIn("\u2316", self.succeeds("show", "signs.h5", "--json"))

    def test_report(self):
        """A report draws the frames of tolerances, and features in the picture of the mechanism."""
        self.result("report", self.ALLOCATION, "exact").close()
        self.succeeds("report", "report.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        rail = re.search(r"<span>\u2316</span><span>\u2300([\d.]+)</span><span>A</span><span>B</span></span>", page)
        self.assertIn(rail[1], [row["zone_mm"] for row in self.rows("report.h5") if row["symbol"] == "position"])
        self.assertIn("<title>rail of limb 3: position 0.05 mm to A|B, perpendicularity 0.02 mm to A</title>", page)
        self.result("mc", 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 500').close()
        self.succeeds("report", "mc.h5", "-o", "mc.html")
        page = (self.folder / "mc.html").read_text(encoding="utf-8")
        self.assertIn("<span>\u2316</span><span>\u23000.05</span><span>A</span><span>B</span></span>", page)
        self.assertIn("<span>\u2225</span><span>0.01</span><span>A</span></span>", page)  # zone of a face

    def test_measured_parts(self):
        """A feature whose errors are measured has the effect of its parts, not of its zone; the worst case is of the zones."""
        analysis = 'kind = "sensitivity"\nsamples = 200'
        with self.result("zones", analysis) as file:
            before = {name: file[f"drawing/{name}"][:] for name in ("effect", "worst_case")}
            features = [name.decode() for name in file["feature"][:]]
            sigma = dict(zip((name.decode() for name in file["factors/name"][:]), file["factors/sigma"][:]))
            response = [name.decode() for name in file["response"][:]].index("tip_position")
        times = 2.5  # scatter of the parts, relative to that of their zone
        offsets = np.linspace(-1, 1, 21)
        parts = times * sigma["rod_2"] * offsets / np.std(offsets, ddof=1) + 3e-6
        self.write("parts.csv", "rod [m]\n" + "".join(f"{value!r}\n" for value in map(float, parts)))
        study = (self.folder / "zones.toml").read_text()
        override = '[errors.override]\nrod_2 = { distribution = "measured", file = "parts.csv", column = "rod" }\n'
        self.write("study.toml", study.replace("[analysis]", override + "[analysis]"))
        self.succeeds("run", "study.toml", "-o", "study.h5", "--quiet")
        with h5py.File(self.folder / "study.h5") as file:
            after = {name: file[f"drawing/{name}"][:] for name in before}
        ratio = after["effect"][response] / before["effect"][response]
        expected = np.where(np.array(features) == "rod_2", times, 1.0)
        np.testing.assert_allclose(ratio, expected, rtol=1e-6)
        np.testing.assert_array_equal(after["worst_case"], before["worst_case"])
        table = next(one for one in json.loads(self.succeeds("show", "study.h5", "--json"))["tables"] if one["name"] == "features")
        shown = {row["feature"]: row["location"] for row in table["rows"]}
        self.assertEqual(shown["rod_2"], "measured, instead of +-0.02")
        self.assertEqual([name for name, text in shown.items() if "measured" in text], ["rod_2"])
        self.assertIn("the effect is that of the standard deviation of the measured parts", " ".join(table["notes"]))

    def test_overridden_sizes(self):
        """The table does not show the zone of a feature as if it were the size of errors that the study sets otherwise."""
        self.result("zones", 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 100').close()
        override = '[errors.override]\nrod_2 = { distribution = "uniform", half_width = "0.2 mm" }\n'
        study = (self.folder / "zones.toml").read_text()
        self.write("study.toml", study.replace("[analysis]", override + "[analysis]"))
        self.succeeds("run", "study.toml", "-o", "study.h5", "--quiet")
        table = next(one for one in json.loads(self.succeeds("show", "study.h5", "--json"))["tables"] if one["name"] == "features")
        shown = {row["feature"]: row["location"] for row in table["rows"]}
        self.assertEqual(shown["rod_2"], "overridden, instead of +-0.02")
        self.assertEqual([name for name, text in shown.items() if "overridden" in text], ["rod_2"])
        self.assertIn("overridden: the study sets the sizes of some errors of the feature", " ".join(table["notes"]))

    def test_rounded(self):
        """Tolerances in steps that a workshop has: the certificate is of these."""
        for name, round_to in (("r10", '"R10"'), ("steps", '"0.0005 mm"')):
            analysis = self.ALLOCATION + f"round = {round_to}\n"
            with self.result(name, analysis, "exact") as file:
                found = file["allocation"]
                needed, tolerance = found["zone_is_needed"][:], 1e3 * found["tolerance"][:]
                stage, machines = [s.decode() for s in file["stage"][:]], found["stages/rejects"][:]
                self.assertEqual(found.attrs["certified"], 1)
                self.assertEqual(stage[-1], "rounded down")
                before, after = found["stage_tolerance"][-2:]
                self.assertLessEqual(machines[-1], machines[-2])
            wanted = tolerance[needed == 1]
            if name == "steps":
                np.testing.assert_allclose(wanted / 0.0005, np.round(wanted / 0.0005), rtol=1e-12)
            else:
                r10 = [1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8]
                first = 10 ** (np.log10(wanted) % 1)
                self.assertLess(np.abs(first[:, None] / r10 - 1).min(axis=1).max(), 1e-12)
            self.assertTrue((after <= before * (1 + 1e-12)).all())
            rows = self.rows(f"{name}.h5")
            self.assertEqual({row["grade"] for row in rows}, {"R10" if name == "r10" else "steps of 0.0005 mm"})
            np.testing.assert_allclose([float(row["zone_mm"]) for row in rows], wanted, rtol=1e-12)
            self.succeeds("run", f"{name}_certificate.toml", "-o", "again.h5", "--quiet")

    def test_steps_that_are_too_coarse(self):
        parts = self.ALLOCATION.replace("0.2 mm", "1 mm") + 'round = "0.2 mm"\n'
        self.write("coarse.toml", STUDY.format(analysis=parts, fidelity="first-order",
                                               zones='errors.zones = { distribution = "normal", sigmas = 3 }'))
        done = self.poesy("run", "coarse.toml", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn("widen the limit, or lower the bounds of parts, or round to finer steps", done.stderr.decode())

    def test_values(self):
        """Zones of a list of values."""
        values = 'values = ["0.004 mm", "0.0063 mm", "0.01 mm", "0.016 mm", "0.025 mm"]'
        analysis = self.ALLOCATION.replace('bounds = ["0.002 mm", "0.2 mm"]', values)
        self.result("values", analysis).close()
        self.assertLessEqual({row["zone_mm"] for row in self.rows("values.h5")}, {"0.004", "0.0063", "0.01", "0.016", "0.025"})

    def test_forgotten(self):
        """`models` and `check` say which directions of a part have no tolerance, and a picture shows features."""
        hint = "hint: limbs 1 to 3, between q and B (frame 2): displacement along y has no tolerance; is that meant?"
        self.assertIn(hint, self.succeeds("models", "delta.toml", "-o", "delta.svg"))
        self.assertIn('class="bar"', (self.folder / "delta.svg").read_text())
        self.write("study.toml", STUDY.format(analysis='kind = "sensitivity"', fidelity="exact",
                                              zones='errors.zones = { distribution = "normal", sigmas = 3 }'))
        self.assertIn("# " + hint, self.succeeds("check", "study.toml"))

    def test_zones_that_are_not_used(self):
        """A study of a drawing without `errors.zones` is asked about, also where its result is shown."""
        asked = "errors.zones is missing, so zones of the drawing, such as that of face_1, are not used, and"
        analysis = 'kind = "monte-carlo"\nsamples = 20\nlimits = { tip_position = "1 mm" }'
        sizes = 'errors.linear = { distribution = "normal", sigma = "0.005 mm" }'
        override = '\nerrors.override."*" = { distribution = "normal", sigma = "0.006 mm" }'
        drawn = '\nerrors.override."rail_*" = { draws = "per pose" }'
        for zones, is_asked in ((sizes, True), (sizes + drawn, True), (sizes + override, False),
                                ('errors.zones = { distribution = "normal", sigmas = 3 }', False)):
            self.write("study.toml", STUDY.format(analysis=analysis, fidelity="first-order", zones=zones))
            done = self.poesy("run", "study.toml", "-o", "r.h5", "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr.decode())
            self.assertEqual(asked in done.stderr.decode(), is_asked, (zones, done.stderr.decode()))
            if override in zones:
                continue  # the study in the result states the sizes of all errors at once
            self.succeeds("report", "r.h5", "-o", "r.html")
            for text in (" ".join(self.succeeds("show", "r.h5").split()), (self.folder / "r.html").read_text()):
                self.assertEqual(asked in text, is_asked, (zones, text[:2000]))

    def test_named(self):
        """`models` says in words what the errors of a feature are, and where its axes point."""
        text = self.succeeds("models", "delta.toml")
        self.assertRegex(text, r"face of limb 1 lifts towards x: [^\n]* down by as much\n")  # x of the base
        self.assertRegex(text, r"face of limb 2 lifts towards x: [^\n]*, where x is \(-0.5, 0.866025, 0\) at home\n")
        self.assertRegex(text, r"face of limb 3 lifts towards x: [^\n]*, where x is \(-0.5, -0.866025, 0\) at home\n")
        self.assertIn("leans to x: its far end against its near end, 500 mm apart", text)


if __name__ == "__main__":
    main()
