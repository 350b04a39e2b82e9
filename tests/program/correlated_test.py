"""Measured and correlated errors: forty parts become ten thousand machines, with the same bits in every run."""

import json
import math
import random

import h5py
import numpy

from poesy_program import main
from resumption import ResumptionTest

NAMES = ("delta_1_1_x", "delta_1_1_y", "delta_1_1_z")
STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
fidelity = "first-order"
[poses]
count = 4
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
angular = { distribution = "normal", sigma = "0.1 deg" }
correlated = "as measured"
[errors.override]
delta_1_1_x = { distribution = "measured", file = "parts.csv", column = "hole" }
delta_1_1_y = { distribution = "measured", file = "parts.csv", column = "height [um]" }
delta_1_1_z = { distribution = "uniform", half_width = "0.2 mm" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "all"
samples = 10000
limits = { linear_deformation = "0.5 mm" }
[run]
seed = 3
"""


def parts(offset=0.0):
    """Forty parts: two sizes that go up and down together, of a skewed distribution."""
    rows = random.Random(40)
    lines = ["part,hole [mm],comment,height [um]"]
    for number in range(40):
        common = rows.gauss(0, 1)
        hole = 0.05 * math.exp(0.5 * common) - 0.03 + offset
        height = 100 * (0.8 * common + 0.6 * rows.gauss(0, 1))
        lines.append(f"p{number},{hole:.5f},as delivered,{height:.2f}")
    return "\n".join(lines) + "\n"


class Correlated(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.write("parts.csv", parts())
        self.write("study.toml", STUDY)

    def run_study(self, *options, output="out.h5"):
        done = self.poesy("run", "study.toml", "-o", output, "--quiet", *options)
        self.assertIn(done.returncode, (0, 6), done.stderr)
        return self.content_hash(output) if "--shard" not in options else None

    def errors_of(self, sample, pose=0):
        """The errors of a machine by name, SI, as replay has them."""
        text = self.succeeds("replay", "out.h5", "all", pose, sample)
        part = text[text.index("errors that vary\n"):text.index("solved as in the run")]
        return {line.split()[0]: float(line.split()[1]) for line in part.splitlines()[1:] if line.startswith("  ")}

    def test_the_same_bits(self):
        whole = self.run_study("--threads", 1)
        self.succeeds("verify", "out.h5")
        self.assertEqual(self.run_study("--threads", 3), whole)
        for k in (1, 2, 3):
            self.run_study("--shard", f"{k}/3", output=f"s{k}.h5")
        done = self.poesy("merge", "s2.h5", "s1.h5", "s3.h5", "-o", "all.h5")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        self.assertEqual(self.content_hash("all.h5"), whole)

    def test_a_stopped_run_goes_on_unless_the_parts_are_others(self):
        whole = self.run_study(output="whole.h5")
        self.stop_early()
        self.write("parts.csv", parts(offset=0.001))
        done = self.resume()
        self.assertIn(done.returncode, (2, 3), done.stderr)
        self.write("parts.csv", parts())
        done = self.resume()
        self.assertIn(done.returncode, (0, 6), done.stderr)
        self.assertEqual(self.content_hash(), whole)

    def test_machines_scatter_as_the_parts(self):
        self.run_study()
        (self.folder / "parts.csv").unlink()
        table = [line.split(",") for line in parts().splitlines()[1:]]
        hole = numpy.array([float(row[1]) for row in table]) * 1e-3
        height = numpy.array([float(row[3]) for row in table]) * 1e-6
        machines = [self.errors_of(s, pose=s % 4) for s in range(60)]
        for name, values in (("delta_1_1_x", hole), ("delta_1_1_y", height)):
            drawn = numpy.array([machine[name] for machine in machines])
            self.assertGreaterEqual(drawn.min(), values.min() - values.std())
            self.assertLessEqual(drawn.max(), values.max() + values.std())
            # Bound of Kolmogorov's statistic for alpha = 0.001, plus one step of the distribution function of 60
            # machines.
            steps = numpy.abs(numpy.searchsorted(numpy.sort(drawn), numpy.quantile(values, numpy.arange(1, 40) / 40)) / 60
                              - numpy.arange(1, 40) / 40)
            self.assertLess(steps.max(), 1.95 / math.sqrt(60) + 1 / 60)
        drawn = numpy.array([[machine[name] for name in NAMES] for machine in machines])
        ranks = drawn.argsort(axis=0).argsort(axis=0)
        found = numpy.corrcoef(ranks.T)
        wanted = numpy.corrcoef(numpy.array([hole.argsort().argsort(), height.argsort().argsort()]))[0, 1]
        # Fisher's transformation of rank correlations: the standard error is 1.03 / sqrt(n - 3), alpha = 0.001.
        self.assertLess(abs(math.atanh(found[0, 1]) - math.atanh(wanted)), 3.29 * 1.03 / math.sqrt(57))
        self.assertLess(abs(found[0, 2]), 0.45)

    def test_results_say_what_was_drawn(self):
        self.run_study()
        with h5py.File(self.folder / "out.h5") as file:
            text = file["study/text"].asstr()[()]
            names = list(file["factors/name"].asstr())
            shapes = list(file["factors/distribution"].asstr())
            s1 = file["monte_carlo/S1"][:]
            gradient = file["yield/gradient"][:]
        self.assertNotIn("parts.csv", text)
        self.assertIn("[[errors.correlated]]", text)
        self.assertEqual([shapes[names.index(name)] for name in NAMES], ["measured", "measured", "uniform"])
        known = ~numpy.isnan(s1).all(axis=0)
        self.assertEqual([bool(known[names.index(name)]) for name in NAMES], [False, False, True])
        # The gradient is unknown for the two measured, correlated errors, and known for uniform and normal ones.
        self.assertEqual([bool(g) for g in numpy.isnan(gradient[[names.index(name) for name in NAMES]])], [True, True, False])
        self.assertEqual(numpy.isnan(gradient).sum(), 2)
        self.assertIn("correlated with others", self.succeeds("show", "out.h5"))
        self.succeeds("report", "out.h5", "-o", "report.html")
        self.succeeds("export", "out.h5", "-d", "tables")

    def test_results_say_how_parts_and_draws_scatter(self):
        said = self.poesy("run", "study.toml", "-o", "out.h5").stdout.decode()
        self.assertIn("40 good parts show a yield of", " ".join(said.split()))
        table = [line.split(",") for line in parts().splitlines()[1:]]
        measured = [numpy.array([float(row[1]) for row in table]) * 1e-3, numpy.array([float(row[3]) for row in table]) * 1e-6]
        with h5py.File(self.folder / "out.h5") as file:
            names = list(file["factors/name"].asstr())
            self.assertEqual(list(file["measured_error"].asstr()), list(NAMES[:2]))
            found = file["measured_errors"]
            self.assertEqual(list(found["parts"]), [40, 40])
            self.assertEqual(list(found["most_correlated"].asstr()), [NAMES[1], NAMES[0]])
            for at, values in enumerate(measured):
                sigma = values.std(ddof=1)
                self.assertAlmostEqual(file["factors/sigma"][names.index(NAMES[at])] / sigma, 1, places=12)
                self.assertAlmostEqual(found["sigma"][at] / sigma, 1, places=12)
                self.assertAlmostEqual(found["sigma_of_parts"][at] / sigma, 1, places=12)
                self.assertAlmostEqual((found["mean"][at] - values.mean()) / sigma, 0, places=12)
                self.assertEqual(found["least_part"][at], values.min())
                self.assertLess(found["least"][at], values.min())
                self.assertGreater(found["greatest"][at], values.max())
            low, high = (file["yield"][name][()] for name in ("ci_low", "ci_high"))
            of_parts = [file["yield/parts"][name][()] for name in ("ci_low", "ci_high")]
        self.assertLess(of_parts[0], low)
        self.assertGreater(of_parts[1], high)
        shown = " ".join(self.succeeds("show", "out.h5").split())
        self.assertIn("Interval of machines and measured parts", shown)
        self.assertIn("40 good parts show a yield of 92.78 % at 95 %, and cannot show 99.73 %, which takes 1 109", shown)
        tables = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]
        (one,) = [each for each in tables if each["name"] == "measured_errors"]
        self.assertEqual([row["parts"] for row in one["rows"]], [40, 40])
        self.succeeds("export", "out.h5", "-d", "tables")
        header = (self.folder / "tables/measured_errors.csv").read_text(encoding="utf-8").splitlines()[0]
        self.assertIn("sigma_of_parts,sigma,", header)
        self.succeeds("report", "out.h5", "-o", "report.html")
        self.assertIn("cannot show 99.73", (self.folder / "report.html").read_text(encoding="utf-8"))

    def test_one_part_that_stands_apart(self):
        """Ten parts, nine of them nearly right: the response has the mean and the deviation of the parts."""
        sizes = [0.0] * 5 + [0.001] * 4 + [0.5]
        values = ", ".join(f'"{size} mm"' for size in sizes)
        self.write("study.toml", f"""format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs", fidelity = "first-order" }}
poses = {{ count = 1 }}
errors.override.q_1 = {{ distribution = "measured", values = [{values}] }}
analysis = {{ kind = "monte-carlo", factors = ["q_1"], samples = 40000, draws = "per machine", limits = {{ position = "0.1 mm" }}, yield = 0.85 }}
""")
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("PASS for these measured parts, which do not show it of others:", " ".join(done.stdout.decode().split()))
        self.assertIn("the parts on which errors were measured do not show it", done.stderr.decode())
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("The machines keep a yield of 85 %, but the parts on which errors were measured do not show it", page)
        self.assertNotIn("Nothing has to be done", page)
        with h5py.File(self.folder / "out.h5") as file:
            at = list(file["responses/name"].asstr()).index("position")
            mean, deviation = (file["monte_carlo"][name][at, 0] for name in ("mean", "std"))
            value = file["yield/value"][()]
            self.assertAlmostEqual(file["factors/sigma"][0], 1e-3 * numpy.std(sizes, ddof=1), places=15)
        # Five standard errors of 40 000 machines (the kurtosis is 8), plus the rounding of the expected numbers.
        self.assertAlmostEqual(mean, 0.0168e-3, delta=5 * 0.0527e-3 / 200 + 0.00005e-3)
        self.assertAlmostEqual(deviation, 0.0527e-3, delta=5 * 0.0066 * 0.0527e-3 + 0.00005e-3)
        # Draws around nine of ten parts keep the limit. Of the draws around the tenth part, in 0.5 mm +- sqrt(3) sigma,
        # those below 0.3 mm keep it.
        reach = math.sqrt(3) * numpy.std(sizes, ddof=1)
        self.assertAlmostEqual(value, 0.9 + 0.1 * (0.3 - (0.5 - reach)) / (2 * reach), delta=5 * 0.3 / 200)

    def test_shapley(self):
        self.write("study.toml", STUDY.replace('"monte-carlo"\ndraws = "per machine"', '"sobol"\nshapley = true')
                   .replace('"all"', '["delta_1_1_x", "delta_1_1_y", "delta_1_1_z", "epsilon_1_4_z"]')
                   .replace("limits = { linear_deformation = \"0.5 mm\" }\n", "").replace("10000", "1000"))
        whole = self.run_study("--threads", 1)
        self.assertEqual(self.run_study("--threads", 2), whole)
        with h5py.File(self.folder / "out.h5") as file:
            effects = file["sobol/aggregated/Sh"][:]
            total = file["sobol/aggregated/ST"][:]
        self.assertTrue(numpy.isnan(total[:, :2]).all())
        self.assertFalse(numpy.isnan(total[:, 2:]).any())
        numpy.testing.assert_allclose(effects.sum(axis=1), 1.0, atol=1e-12)
        table = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]
        (one,) = [each for each in table if each["name"] == "sobol_linear_deformation"]
        self.assertIn("Sh", one["rows"][0])
        self.succeeds("export", "out.h5", "-d", "tables")
        header = (self.folder / "tables/sobol_linear_deformation.csv").read_text(encoding="utf-8").splitlines()[0]
        self.assertIn("Sh,Sh_conf,Sh_ci_low,Sh_ci_high", header)
        self.succeeds("report", "out.h5", "-o", "report.html")

    def test_refusals(self):
        def refused(study, *words):
            self.write("study.toml", study)
            done = self.poesy("check", "study.toml")
            self.assertEqual(done.returncode, 2, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr.decode())
        plain = STUDY.replace('\ndraws = "per machine"', "").replace("limits = { linear_deformation = \"0.5 mm\" }\n", "")
        refused(plain.replace("monte-carlo", "sensitivity"), "study.toml:11:", "delta_1_1_x, delta_1_1_y",
                "varies one error at a time", 'kind = "monte-carlo"')
        refused(plain.replace("monte-carlo", "sobol"), "delta_1_1_x, delta_1_1_y", "different groups", "shapley = true")
        refused(plain.replace('"monte-carlo"', '"sobol"\nshapley = true'), "analysis.shapley", "at most 8 groups")
        refused(plain.replace('"all"', '["delta_1_1_x", "delta_1_1_z"]'), "'delta_1_1_y'", "does not vary")
        refused(plain.replace('"hole"', '"whole"'), "parts.csv:1:1", "no column is 'whole'", "hole")
        self.write("parts.csv", parts().replace("as delivered,", "as delivered,about ", 1))
        refused(plain, "parts.csv:2:", "'about ", "height [um]")


if __name__ == "__main__":
    main()
