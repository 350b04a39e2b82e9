"""Responses that do not vary have no shares of a variance. In a planar five-bar with errors in its plane the gap, z,
theta_x and theta_y are rounding errors: every kind of study says so, has no ranking by them, and begins with what
varies."""

import csv
import json

import h5py
import numpy
from poesy_program import ProgramTest, main

FIVE_BAR = """\
format = "poesy-mechanism"
version = 1
name = "five-bar"

[platform]
origin = [0, "110 mm", 0]
coordinates = ["x", "y"]
points = [[0, 0, 0], ["20 mm", 0, 0], [0, "20 mm", 0]]
workspace = { x = ["-20 mm", "20 mm"], y = ["90 mm", "125 mm"] }

[[limb]]
joints = [
  { name = "A", type = "R", at = ["-20 mm", 0, 0], axis = "z", actuated = true },
  { name = "B", type = "R", at = ["-52 mm", "51 mm", 0], axis = "z" } ]

[[limb]]
joints = [
  { name = "A", type = "R", at = ["20 mm", 0, 0], axis = "z", actuated = true },
  { name = "B", type = "R", at = ["52 mm", "51 mm", 0], axis = "z" },
  { name = "C", type = "R", at = [0, "110 mm", 0], axis = "z" } ]

[errors]
frames = "all"
"""
STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "five-bar.toml"
poses.count = 6
errors.linear = { distribution = "normal", sigma = "0.05 mm" }
errors.angular = { distribution = "normal", sigma = "0.05 deg" }
[analysis]
factors = ["delta_1_0_x", "delta_1_0_y", "delta_1_1_x", "delta_1_2_x", "delta_2_1_x", "delta_2_2_x", "epsilon_1_1_z",
           "epsilon_2_1_z"]
"""
KINDS = {
    "sensitivity": 'kind = "sensitivity"\nsamples = 100\n',
    "sobol": 'kind = "sobol"\nsamples = 256\nsecond_order = true\n',
    "shapley": 'kind = "sobol"\nsamples = 256\nshapley = true\n',
    "monte-carlo": 'kind = "monte-carlo"\ndraws = "per pose"\nsamples = 500\n',
    "machines": 'kind = "monte-carlo"\nsamples = 500\ndraws = "per machine"\n'
                'limits = { gap = "0.001 mm", position = "0.1 mm" }\n',
}
IN_THE_PLANE = {"x", "y", "position", "theta_z", "rotation"}
OF_THE_VECTORS = {"displacement", "theta"}
DOES_NOT_VARY = "does not vary"


class Constant(ProgramTest):
    def run_study(self, analysis, name="out", study=STUDY):
        self.write("five-bar.toml", FIVE_BAR)
        self.write(f"{name}.toml", study + analysis)
        self.succeeds("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet")
        return self.folder / f"{name}.h5"

    @staticmethod
    def names(file):
        return list(file["responses/name"].asstr())

    def test_sobol(self):
        for kind in ("sobol", "shapley"):
            with h5py.File(self.run_study(KINDS[kind])) as file:
                names, vectors = self.names(file), list(file["vector"].asstr())
                varying = numpy.array([name in IN_THE_PLANE for name in names])
                self.assertEqual({name for name, one in zip(names, file["sobol/varies"][:]) if one}, IN_THE_PLANE)
                self.assertEqual({name for name, one in zip(vectors, file["sobol/vector/varies"][:]) if one}, OF_THE_VECTORS)
                shares = [f"{group}/{index}{end}" for group in ("sobol", "sobol/aggregated")
                          for index in ("S1", "ST") for end in ("", "_ci_low", "_ci_high")]
                shares += ["sobol/aggregated/Sh"] if kind == "shapley" else ["sobol/aggregated/S2"]
                for path in shares:
                    found = file[path][:]
                    self.assertTrue(numpy.isnan(found[~varying]).all(), path)
                    self.assertTrue(numpy.isfinite(found[varying]).any(axis=1).all() or found.ndim > 2, path)
                # The S1 of all errors on a component that varies add up to about 1.
                x = file["sobol/aggregated/S1"][names.index("x")]
                self.assertAlmostEqual(x.sum(), 1.0, delta=0.15)
                found = file["sobol/vector/ST"][:]
                varies = numpy.array([name in OF_THE_VECTORS for name in vectors])
                self.assertTrue(numpy.isnan(found[~varies]).all())
                self.assertTrue(numpy.isfinite(found[varies]).all())

    def tables(self, *options):
        return json.loads(self.succeeds("show", "out.h5", "--json", *options))["tables"]

    def test_sobol_is_shown_by_what_varies(self):
        self.run_study(KINDS["sobol"])
        tables = self.tables()
        names = [table["name"] for table in tables]
        self.assertEqual(names[:3], ["sobol_position", "sobol_rotation", "sobol_gap"])
        gap = tables[2]
        self.assertIn(f"gap {DOES_NOT_VARY}", gap["caption"])
        self.assertEqual([row["ST"] for row in gap["rows"]], [None] * 8)
        self.assertEqual(gap["notes"], [])
        self.assertNotIn("pairs_gap", names)
        (vectors,) = (table for table in tables if table["name"] == "vectors")
        self.assertIn("do not vary, so no error has a share of them", " ".join(vectors["notes"]))
        for response in ("z", "theta_x"):
            (table,) = (one for one in self.tables("--response", response) if one["name"] == f"sobol_{response}")
            self.assertIn(f"{response} {DOES_NOT_VARY}", table["caption"])
            self.assertNotIn("has no sign", json.dumps(table))
            self.assertNotIn("correlated", json.dumps(table))
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables/sobol_gap.csv", encoding="utf-8") as file:
            self.assertEqual({row["ST"] for row in csv.DictReader(file)}, {"NaN"})

    def test_every_kind_begins_with_what_varies(self):
        for kind, analysis in KINDS.items():
            with self.subTest(kind):
                self.run_study(analysis)
                shown = self.succeeds("show", "out.h5")
                self.succeeds("report", "out.h5", "-o", "report.html")
                page = (self.folder / "report.html").read_text(encoding="utf-8")
                for wrong in ("gap: shares of its variance", "because it does not vary or errors are correlated"):
                    self.assertFalse(wrong in shown + page, wrong)  # a failure does not print the page
                first, constant = page.find("position"), page.find(f"gap {DOES_NOT_VARY}")
                self.assertGreater(first, 0)
                self.assertTrue(constant < 0 or constant > first)
                answer = page[page.index("Answer"):][:400]
                self.assertFalse("gap" in answer, answer)
                if kind != "sensitivity":
                    self.assertIn(f"gap {DOES_NOT_VARY}", " ".join(shown.split()))

    def test_sensitivity_ranks_by_what_varies(self):
        self.run_study(KINDS["sensitivity"])
        (ranked,) = (table for table in self.tables() if table["name"] == "ranked")
        self.assertIn("on position", ranked["caption"])
        (ranked,) = (table for table in self.tables("--response", "gap") if table["name"] == "ranked")
        self.assertIn(f"gap {DOES_NOT_VARY}", ranked["caption"])
        self.assertEqual({row["rank"] for row in ranked["rows"]}, {None})
        self.assertTrue(all(row["effect"] < 1e-9 for row in ranked["rows"]))

    def test_monte_carlo_has_neither_indices_nor_curves(self):
        for kind in ("monte-carlo", "machines"):
            with h5py.File(self.run_study(KINDS[kind])) as file:
                names = self.names(file)
                varying = numpy.array([name in IN_THE_PLANE for name in names])
                self.assertTrue((file["monte_carlo/varies"][:] == varying).all())
                groups = ["monte_carlo"] + (["machines/largest"] if kind == "machines" else [])
                for group in groups:
                    for path in (f"{group}/S1", f"{group}/S1_ci_low", f"{group}/main_effect/mean"):
                        found = file[path][:]
                        self.assertTrue(numpy.isnan(found[~varying]).all(), path)
                        self.assertTrue(numpy.isfinite(found[varying]).all(), path)
            notes = " ".join(next(one for one in self.tables() if one["name"] == "first_order")["notes"])
            self.assertIn(f"gap {DOES_NOT_VARY}", notes)

    def test_what_varies_leaves_no_word_of_it(self):
        for kind, group in (("sobol", "sobol"), ("monte-carlo", "monte_carlo")):
            self.write("study.toml", STUDY[:STUDY.index("factors")].replace('file = "five-bar.toml"', 'model = "2upr-rpu"') +
                       KINDS[kind].replace("second_order = true\n", ""))
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
            with h5py.File(self.folder / "out.h5") as file:
                self.assertNotIn("varies", file[group])

    def test_adaptive_samples_end(self):
        analysis = 'kind = "sobol"\nsamples = { min = 250, max = 16000, relative_error = 0.3 }\n'
        with h5py.File(self.run_study(analysis)) as file:
            names = self.names(file)
            reached = file["convergence/reached"][:]
            self.assertTrue(reached[[names.index(name) for name in ("gap", "position", "rotation")]].all())
            self.assertLess(file["convergence/samples"][()], 16000)

    def test_too_few_samples_are_the_reason(self):
        for draws in ("per pose", "per machine"):
            for samples, formed in ((50, False), (63, False), (64, True), (100, True)):
                with h5py.File(self.run_study(f'kind = "monte-carlo"\nsamples = {samples}\ndraws = "{draws}"\n')) as file:
                    found = file["monte_carlo/S1"][self.names(file).index("position")]
                self.assertEqual(numpy.isfinite(found).all(), formed, samples)
                notes = " ".join(next(one for one in self.tables() if one["name"] == "first_order")["notes"])
                self.assertEqual("position: no S1 is formed below 64 samples" in notes, not formed, notes)
                self.assertNotIn("correlated", notes)


if __name__ == "__main__":
    main()
