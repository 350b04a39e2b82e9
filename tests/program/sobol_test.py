"""Sobol' indices: same bits however a study is run, the shares of a linear mechanism, tables, and what is refused."""

import csv
import json

import h5py
import numpy

from poesy_program import main
from resumption import SOBOL, ResumptionTest

LINEAR = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
fidelity = "first-order"
[poses]
count = 5
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
angular = { distribution = "uniform", half_width = "0.1 deg" }
[analysis]
kind = "sobol"
factors = "all"
samples = 20000
conf_level = 0.9999
"""
DESIGNS = {"random": "", "lhs": 'design = "lhs"\n', "sobol": 'design = "sobol"\n'}


class Sobol(ResumptionTest):
    def run_study(self, study, *options, output="out.h5"):
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", output, "--quiet", *options)

    def small(self, design="random"):
        return SOBOL.replace("samples = 2100", "samples = 480\n" + DESIGNS[design])

    def test_threads(self):
        for design in DESIGNS:
            hashes = set()
            for threads in (1, 2, 3):
                self.run_study(self.small(design), "--threads", threads)
                self.succeeds("verify", "out.h5")
                hashes.add(self.content_hash())
            self.assertEqual(len(hashes), 1, design)

    def test_shards_of_every_design(self):
        for design in DESIGNS:
            self.run_study(self.small(design))
            expected = self.content_hash()
            for k in (1, 2, 3):
                self.run_study(self.small(design), "--shard", f"{k}/3", output=f"s{k}.h5")
            self.succeeds("merge", "s3.h5", "s1.h5", "s2.h5", "-o", "all.h5")
            self.assertEqual(self.content_hash("all.h5"), expected, design)

    def test_more_samples_go_on_from_fewer(self):
        for fewer, more in ((500, 1000), (480, 1130)):
            expected = self.undisturbed(self.small().replace("480", str(more)))
            self.run_study(self.small().replace("480", str(fewer)), "--keep-checkpoint")
            self.write("study.toml", self.small().replace("480", str(more)))
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
            self.assertEqual(self.content_hash(), expected)
            for path in self.folder.glob("out.h5*"):
                path.unlink()

    def test_a_design_of_more_samples_is_another_one(self):
        self.run_study(self.small("lhs"), "--keep-checkpoint")
        self.write("study.toml", self.small("lhs").replace("480", "960"))
        done = self.resume()
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn(b"design with other samples", done.stderr)

    def test_samples_are_the_machines_of_a_monte_carlo_study(self):
        self.run_study(self.small())
        with h5py.File(self.folder / "out.h5") as file:
            both = file["sobol/mean"][:]
        self.run_study(self.small().replace('"sobol"', '"monte-carlo"\ndraws = "per machine"'))
        with h5py.File(self.folder / "out.h5") as file:
            mean = file["monte_carlo/mean"][:]
            spread = file["monte_carlo/std"][:] / numpy.sqrt(file["monte_carlo/count"][:])
        # The mean of the Sobol' study is over samples A, which are these machines, and as many independent samples B.
        # So 2 (both - mean) is the difference of two independent means.
        self.assertTrue((numpy.abs(2 * (both - mean)) < 5 * numpy.sqrt(2) * spread).all())
        self.assertFalse((both == mean).any())

    def test_a_linear_mechanism_has_the_shares_of_its_mean_square(self):
        self.run_study(LINEAR)
        with h5py.File(self.folder / "out.h5") as file:
            names = list(file["factors/name"].asstr())
            sigma = file["factors/sigma"][:]
            axes = [name for name in ("alpha", "beta", "z") if name in file["poses"]]
            axes = axes if len(axes) == 3 else [key for key in file["poses"] if file["poses"][key].ndim == 1][:3]
            poses = numpy.array([file["poses"][axis][:] for axis in axes]).T
            vectors = list(file["vector"].asstr())
            found = {name: file[f"sobol/vector/{name}"][:] for name in
                     ("S1", "S1_ci_low", "S1_ci_high", "ST", "ST_ci_low", "ST_ci_high")}
        v = vectors.index("tip")
        self.write("poses.csv", "\n".join([",".join(axes)] + [",".join(map(repr, map(float, pose))) for pose in poses]))
        rows = [",".join(repr(float(sigma[p])) if p == q else "0" for q in range(len(names))) for p in range(len(names))]
        self.write("errors.csv", "\n".join([",".join(names)] + rows))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet")
        with h5py.File(self.folder / "rows.h5") as file:
            squares = sum((file[f"evaluate/tip_{axis}"][:] ** 2).sum(axis=0) for axis in "xyz")
        shares = squares / squares.sum()
        for index in ("S1", "ST"):
            self.assertTrue((found[f"{index}_ci_low"][v] <= shares + 1e-9).all())
            self.assertTrue((found[f"{index}_ci_high"][v] >= shares - 1e-9).all())
            self.assertAlmostEqual(found[index][v].sum(), 1.0, delta=0.05)

    def test_absorbed_errors_are_zero_in_every_bit(self):
        study = LINEAR.replace('"3-prs"', '"2upr-rpu"').replace("20000", "200") + '[solver]\nmetric = "platform"\n'
        self.run_study(study)
        self.run_study(study.replace('"all"', '"deforming-all"'), output="deforming.h5")
        with h5py.File(self.folder / "out.h5") as file, h5py.File(self.folder / "deforming.h5") as deforming:
            acting = set(deforming["factors/name"].asstr())
            self.assertEqual(len(acting), 41)
            for p, name in enumerate(file["factors/name"].asstr()):
                for group in ("sobol", "sobol/aggregated", "sobol/vector"):
                    for index in ("S1", "S1_ci_low", "S1_ci_high", "ST", "ST_ci_low", "ST_ci_high"):
                        values = file[f"{group}/{index}"][:, p]
                        self.assertTrue(name in acting or (values == 0.0).all(), f"{name}: {index} of {group}")
            self.assertGreater((file["sobol/aggregated/ST"][0] > 0.0).sum(), 35)

    def test_tables(self):
        self.run_study(self.small() + 'second_order = true\ngroups = "frame"\n')
        found = json.loads(self.succeeds("show", "out.h5", "--json", "--top", 3))
        names = [table["name"] for table in found["tables"]]
        self.assertIn("sobol_linear_deformation", names)
        self.assertIn("vectors", names)
        self.assertIn("pairs_linear_deformation", names)
        (table,) = [table for table in found["tables"] if table["name"] == "sobol_linear_deformation"]
        self.assertEqual(len(table["rows"]), 3)
        self.assertGreaterEqual(table["rows"][0]["ST"], table["rows"][1]["ST"])
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables/sobol_linear_deformation.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0])[:5], ["group", "S1", "S1_conf", "ST", "ST_conf"])
        for row in rows:
            self.assertAlmostEqual(float(row["ST_conf"]), (float(row["ST_ci_high"]) - float(row["ST_ci_low"])) / 2)
        self.assertTrue((self.folder / "tables/sobol_pairs_linear_deformation.csv").exists())
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("has no sign", page)
        self.assertIn("have no sign, so they are not additive", page)
        self.assertIn("Which errors interact", page)

    def test_named_groups(self):
        self.run_study(self.small() + 'groups = { hinge = ["delta_1_*", "epsilon_1_4_?"], single = "epsilon_3_0_y" }\n')
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(list(file["group"].asstr()), ["hinge", "single", "others"])
            self.assertIn("epsilon_1_4_z", file["sobol/members"].asstr()[0].split())
            self.assertEqual(file["sobol/S1"].shape[1], 3)
            self.assertEqual(file["sobol/S1"].dims[1].keys(), ["group"])

    def test_groups_with_errors_correlated_across_them_are_summarised_by_shapley_effects(self):
        correlated = '[[errors.correlated]]\nfactors = ["delta_1_1_y", "epsilon_3_0_y"]\ncorrelation = [[1, 0.5], [0.5, 1]]\n'
        study = self.small().replace("[analysis]\n", correlated + "[analysis]\n")
        self.run_study(study + 'shapley = true\ngroups = { hinge = ["delta_1_*"], single = "epsilon_3_0_y" }\n')
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(list(numpy.isnan(file["sobol/aggregated/ST"][0])), [True, True, False])
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertRegex(page, r"divided evenly \(Shapley\), the largest shares of the variance of linear_deformation are made "
                               r"by hinge \(\S+ %\), \w+ \(\S+ %\), \w+ \(\S+ %\)\.")
        self.assertIn("interval of the Shapley effect of hinge is", page)
        self.assertIn("Make the errors of hinge smaller first.", page)

    def test_a_solve_is_replayed(self):
        self.run_study(self.small())
        self.assertIn("solved as in the run", self.succeeds("replay", "out.h5", "all", 2, 17))
        self.run_study(self.small("lhs"))
        done = self.poesy("replay", "out.h5", "all", 2, 17)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"keeps no addresses", done.stderr)

    def test_refusals(self):
        def refused(study, *words):
            self.write("study.toml", study)
            done = self.poesy("run", "study.toml", "-o", "out.h5")
            self.assertEqual(done.returncode, 2, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr.decode())
        refused(self.small() + 'groups = "joint"\n', "analysis.groups is 'joint'")
        refused(self.small() + 'groups = { a = ["delta_9_*"] }\n', "analysis.groups.a has 'delta_9_*'", "none of the errors")
        refused(self.small() + 'groups = { a = ["delta_1_*"], b = ["delta_1_1_y"] }\n', "which group 'a' has as well")
        refused(self.small() + "groups = { a = [] }\n", "is empty")
        refused(self.small() + 'groups = { others = ["delta_1_*"] }\n', "is not a name for a group")
        refused(self.small() + 'groups = { "=1+1" = ["delta_1_*"] }\n', "is not a name for a group: it begins with '='")
        refused(self.small() + 'groups = { all = ["*"] }\n', "all errors are one group")
        refused(self.small() + 'second_order = "yes"\n', "analysis.second_order is the text 'yes'", "true or false")
        refused(self.small() + "replicates = 20\n", 'analysis.design is "random"')
        refused(self.small("sobol") + "replicates = 7\n", "at least 8")
        refused(self.small("lhs").replace("480", "490"), "16 replicates do not share evenly", "samples = 496")
        refused(self.small("lhs").replace("samples = 480", "samples = { max = 1000, relative_error = 0.1 }"),
                'analysis.design is not "random"')
        refused(self.small() + 'draws = "per machine"\n', "analysis.draws does not belong to kind")


if __name__ == "__main__":
    main()
