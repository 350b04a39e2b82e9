"""The deformation by the platform metric: reference cases, indices that hold at any size, mean squares that add up,
no solves at the iteration cap, and that only studies that select the metric have it."""

import json
import math
import os

import h5py
import numpy as np

from poesy_program import GALLERY, STUDY, ProgramTest, main

COORDINATES = ["z", "beta", "gamma"]
RESPONSES = ["gap", "angular_deformation", "linear_deformation"]


def study(analysis, size, poses=20, background="", solver="", seed=3):
    """A study of the 2UPR-RPU by the metric; size in mm and deg."""
    return f"""\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = {poses}
[errors]
linear = {{ distribution = "normal", sigma = "{size} mm" }}
angular = {{ distribution = "normal", sigma = "{size} deg" }}
[analysis]
{analysis}
{background}
[solver]
metric = "platform"
{solver}
[run]
seed = {seed}
"""


SENSITIVITY = 'kind = "sensitivity"\nfactors = "deforming"\nsamples = {}'
MONTE_CARLO = 'kind = "monte-carlo"\ndraws = "per pose"\nfactors = "{}"\nsamples = {}'
BACKGROUND = 'background = { factors = "benign", linear = "1 mm", angular = "1 deg" }'


def with_other_errors(text):
    """The study with errors that are not normal, and not about zero."""
    values = ", ".join(f'"{value} mm"' for value in (-0.31, -0.12, -0.08, 0.02, 0.05, 0.11, 0.18, 0.55))
    before, after = text.split("[errors]\n")[0], text[text.index("[analysis]"):]
    return f"""{before}[errors]
linear = {{ distribution = "truncated-normal", sigma = "0.1 mm", half_width = "0.15 mm", shift = "0.3 mm" }}
angular = {{ distribution = "uniform", half_width = "0.2 deg", mean = "-0.1 deg" }}
override.delta_1_0_y = {{ distribution = "measured", values = [{values}] }}
override.delta_3_0_y = {{ distribution = "triangular", limits = ["-0.1 mm", "0.4 mm"] }}
{after}"""


class Metric(ProgramTest):
    def result(self, name, text):
        self.write(f"{name}.toml", text)
        self.succeeds("run", f"{name}.toml", "--quiet")
        return h5py.File(self.folder / f"{name}.h5")

    def test_reference_cases(self):
        with open(os.environ["POESY_METRIC_ORACLE"], encoding="utf-8") as file:
            cases = json.load(file)["cases"]
        factors = sorted({name for case in cases for name in case["errors"]})
        rows = [",".join(repr(case["pose"][name]) for name in COORDINATES) for case in cases]
        self.write("poses.csv", "\n".join([",".join(COORDINATES), *rows]) + "\n")
        rows = [",".join(repr(case["errors"].get(name, 0.0)) for name in factors) for case in cases]
        self.write("errors.csv", "\n".join([",".join(factors), *rows]) + "\n")
        for method in ("newton", "gauss-newton"):
            text = STUDY.replace('method = "gauss-newton"', f'method = "{method}"\nmetric = "platform"')
            self.write(f"{method}.toml", text)
            self.succeeds("evaluate", f"{method}.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "-o",
                          f"{method}.h5")
            with h5py.File(self.folder / f"{method}.h5") as result:
                group = result["evaluate"]
                for m, case in enumerate(cases):
                    self.assertLess(group["status"][m, 0], 2)
                    # The cases compare limbs in pairs, which is the same only to first order.
                    for name in RESPONSES:
                        self.assertAlmostEqual(group[name][m, 0], case[name], delta=1e-5 * case[name])
                    largest = np.max(np.abs(case["delta_mu"]))
                    for pair, name in enumerate(("delta_mu_21", "delta_mu_32", "delta_mu_13")):
                        np.testing.assert_allclose(group[name][m, 0], case["delta_mu"][pair], rtol=0, atol=1e-5 * largest)

    def test_indices_hold_at_any_size(self):
        # The background has the same size in all studies.
        index, low, high = [], [], []
        for size in (1, 0.1, 0.01):
            with self.result(f"s{size}", study(SENSITIVITY.format(1000), size, 40, BACKGROUND)) as file:
                self.assertEqual(file["responses/name"].asstr()[0], "gap")
                index.append(file["sensitivity/global_corrected"][0])
                low.append(file["sensitivity/global_corrected_ci_low"][0])
                high.append(file["sensitivity/global_corrected_ci_high"][0])
        for other in (1, 2):
            self.assertTrue(np.all(low[other] <= 1.02 * high[0]) and np.all(high[other] >= 0.98 * low[0]))
            np.testing.assert_allclose(index[other], index[0], rtol=0.02)  # all studies have the same draws

    def test_series_are_solves_but_for_rounding(self):
        normal = [study(SENSITIVITY.format(400), size, 10, BACKGROUND) for size in (0.01, 0.1, 1)]
        for text in (with_other_errors(normal[0]), *normal):
            each = text.replace("[run]", "series = false\n[run]")
            with self.result("series", text) as series, self.result("solved", each) as solved:
                for name in ("mean", "std", "local", "global"):
                    found, truth = series[f"sensitivity/{name}"], solved[f"sensitivity/{name}"]
                    np.testing.assert_allclose(found, truth, rtol=1e-9, atol=1e-13)
                self.assertNotIn(b"by_series", solved["status"][:])
                self.assertEqual(solved["run/solves"][()], 25 * 10 * 400)
                ends = dict(zip(series["status"].asstr()[:], series["solver/solves_by_status"][:]))
                self.assertGreater(np.mean(ends["by_series"] > 0), 0.95)
                self.assertEqual(series["run/all_samples"][()], 25 * 10 * 400)
                self.assertEqual(series["run/solves"][()], 25 * 10 * 400 - np.sum(ends["by_series"]))
        pairs = r"by certified series: [\d.]+ % of the samples, in 2\d\d of 250 pairs"
        self.assertRegex(self.succeeds("show", "series.h5"), pairs)

    def test_more_samples_keep_the_series_of_the_first(self):
        few, more = (study(SENSITIVITY.format(samples), 1, 5) for samples in (300, 500))
        with self.result("few", few) as few, self.result("more", more) as more:
            for name in ("global", "global_ci_low", "global_ci_high"):
                path = f"sensitivity/history/{name}"
                np.testing.assert_array_equal(few[path][..., :2], more[path][..., :2])

    def test_mean_squares_add(self):
        with self.result("each", study(SENSITIVITY.format(2000), 0.3, 30, BACKGROUND)) as file:
            mean, std = file["sensitivity/mean"][0], file["sensitivity/std"][0]
            predicted = math.sqrt(np.mean(np.sum(mean**2 + std**2, axis=0)))
        with self.result("all", study(MONTE_CARLO.format("deforming", 4000), 0.3, 30, BACKGROUND)) as file:
            self.assertLess(abs(file["monte_carlo/overall_rms"][0] / predicted - 1), 0.03)

    def test_everything_is_solved(self):
        with self.result("published_design", study(SENSITIVITY.format(1000), 1, 158, BACKGROUND)) as file:
            missed = np.sum(file["solver/not_converged"][:])
            self.assertLessEqual(missed, 158 * 25 * 1000 / 100_000)
        with self.result("all", study(MONTE_CARLO.format("all", 1000), 1, 60)) as file:
            self.assertLessEqual(np.sum(file["solver/not_converged"][:]), 60 * 1000 / 10_000)

    def test_large_errors_near_singular_poses(self):
        # Whether a machine can be assembled does not depend on the metric. With the platform metric, the method has no
        # effect.
        wide = 'workspace = { z = ["-300 mm", "-60 mm"], beta = ["-1.2 rad", "1.2 rad"], gamma = ["-1.4 rad", "1.4 rad"] }'
        text = study(SENSITIVITY.format(40), 3, 20, BACKGROUND.replace('"1 ', '"3 ')).replace("count = 20", f"count = 20\n{wide}")
        ends = {}
        for name, solver in (("platform", ""), ("gauss_newton", 'method = "gauss-newton"\n'), ("published", "")):
            changed = text.replace("[run]", solver + "[run]").replace('"platform"', '"published"' if name == "published" else '"platform"')
            with self.result(name, changed) as file:
                names = [status.decode() for status in file["status"][:]]
                ends[name] = dict(zip(names, file["solver/solves_by_status"][:].astype(int).sum(axis=(1, 2))))
        self.assertEqual(ends["platform"], ends["gauss_newton"])
        self.assertLess(ends["platform"]["iteration_cap"], 10)  # of 20 000 solves
        # Close to the border of what can be assembled, a solve may end on the other side.
        impossible = ends["published"]["not_assembled"]
        self.assertGreater(impossible, 100)
        self.assertLess(abs(ends["platform"]["not_assembled"] - impossible), 0.1 * impossible)

    def test_first_order_is_the_limit_of_small_errors(self):
        for size, most in ((0.001, 1e-4), (1, 0.2)):
            exact = study(MONTE_CARLO.format("all", 500), size, 10)
            linear = exact.replace('model = "2upr-rpu"', 'model = "2upr-rpu"\nfidelity = "first-order"')
            with self.result(f"e{size}", exact) as one, self.result(f"l{size}", linear) as other:
                np.testing.assert_allclose(other["monte_carlo/rms"], one["monte_carlo/rms"], rtol=most)

    def test_who_does_not_ask_has_the_published_one(self):
        plain = study(SENSITIVITY.format(200), 1, 5, BACKGROUND).replace('metric = "platform"\n', "")
        asked = plain.replace("[solver]\n", '[solver]\nmetric = "published"\n')
        with self.result("plain", plain) as one, self.result("asked", asked) as other:
            self.assertEqual(one.attrs["content_sha256"], other.attrs["content_sha256"])
            self.assertIn("deformation_max", one["responses/name"].asstr()[:])

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def test_shards_have_the_bits_of_one_run(self):
        text = study(SENSITIVITY.format(700), 1, 9, BACKGROUND, 'points = [["10 mm", "0 m", "0 m"], ["0 m", "10 mm", "0 m"], ["0 m", "0 m", "0 m"]]')
        self.result("whole", text).close()
        shards = [f"s{n}.h5" for n in (1, 2, 3)]
        for n, shard in enumerate(shards, 1):
            self.succeeds("run", "whole.toml", "--shard", f"{n}/3", "--threads", n, "-o", shard, "--quiet")
        self.succeeds("merge", *shards, "-o", "all.h5")
        self.assertEqual(self.content_hash("all.h5"), self.content_hash("whole.h5"))
        for what, old, new in (("metric", 'metric = "platform"', 'metric = "published"'), ("points", '"10 mm", "0 m"', '"20 mm", "0 m"')):
            other = text.replace(old, new, 1)
            if what == "metric":
                other = "".join(line for line in other.splitlines(True) if not line.startswith("points"))
            self.write("other.toml", other)
            self.succeeds("run", "other.toml", "--shard", "2/3", "-o", f"{what}.h5", "--quiet")
            done = self.poesy("merge", "s1.h5", f"{what}.h5", "s3.h5", "-o", "mixed.h5")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{what}.h5: is of another study", done.stderr.decode())

    def test_a_sample_is_replayed_by_its_metric(self):
        text = study(SENSITIVITY.format(2), 1, 3, BACKGROUND).replace("[run]", 'max_iterations = 3\n[run]')
        with self.result("few", text) as file:
            self.assertGreater(np.sum(file["solver/not_converged"][:]), 0)
        shown = self.succeeds("show", "few.h5")
        command = next(line for line in shown.splitlines() if line.startswith("replay it: ")).split(maxsplit=4)[4]
        printed = self.succeeds("replay", *command.split())
        self.assertIn("Newton on the equilibrium of the bodies", printed)
        self.assertIn("status: the same", printed)
        self.assertIn("gap", printed)

    def test_a_mechanism_with_stiffness_keeps_the_metric_that_its_study_names(self):
        """It is not over-constrained, so without stiffness it has no metric. A study without the key has its stiffness."""
        text = (GALLERY / "tricept" / "yield.toml").read_text().replace("samples = 5000", "samples = 20")
        text = text.replace('file = "tricept.toml"', f'file = "{GALLERY / "tricept" / "tricept.toml"}"')
        self.result("named", text).close()
        replayed = self.succeeds("replay", "named.h5", "all", "0", "0")
        self.assertIn("tip_position", replayed)
        self.assertNotIn("strain_energy", replayed)
        self.result("unnamed", text.replace('metric = "platform"', "")).close()
        self.assertIn("strain_energy", self.succeeds("replay", "unnamed.h5", "all", "0", "0"))

    def test_both_fidelities_say_which_errors_are_linear(self):
        for metric, fewest, most in (("platform", 0, 0), ("published", 10, 25)):
            text = study(SENSITIVITY.format(400), 0.1, 6).replace('"platform"', f'"{metric}"')
            text = text.replace('model = "2upr-rpu"', 'model = "2upr-rpu"\nfidelity = "both"')
            with self.result(metric, text) as file:
                not_linear = 25 - np.sum(file["fidelity/linear"][:])
            self.assertTrue(fewest <= not_linear <= most, not_linear)

    def test_points_are_checked(self):
        def refused(points, *parts):
            text = study(SENSITIVITY.format(10), 1, 2, BACKGROUND, f"points = {points}")
            self.write("points.toml", text)
            done = self.poesy("check", "points.toml")
            self.assertEqual(done.returncode, 2)
            for part in ("points.toml:", *parts):
                self.assertIn(part, done.stderr.decode())

        refused('[["60 mm", 0, 0], ["-60 mm", 0, 0], [0, "60 m", 0]]', "a point is 60000 mm from", "three times", "reach of")
        refused('[["60 um", 0, 0], ["-60 um", 0, 0], [0, "60 um", 0]]', "mm from their middle", "a thousandth")
        refused('[["1e200 m", 0, 0], ["-60 mm", 0, 0], [0, "60 mm", 0]]', "three times")
        self.write("zero.toml", study(SENSITIVITY.format(10), 1, 2, BACKGROUND, 'points = [["60 mm", 0, 0], ["-60 mm", 0, 0], [0, "60 mm", 0]]'))
        self.succeeds("check", "zero.toml")  # 0 needs no unit

        refused('[["1 mm", "0 mm", "0 mm"], ["2 mm", "0 mm", "0 mm"], ["9 mm", "0 mm", "0 mm"]]', "on one line", "joints")
        refused('[["1 mm", "0 mm", "0 mm"], ["2 mm", "0 mm", "0 mm"]]', "has 2 points", "three or more")
        refused('[["1 mm", "0 mm"], ["2 mm", "0 mm", "0 mm"], ["0 mm", "0 mm", "3 mm"]]', "has 2 values", "a point has three")
        text = study(SENSITIVITY.format(10), 1, 2, BACKGROUND, 'points = [["1 mm", "0 mm", "0 mm"]]')
        self.write("published.toml", text.replace('"platform"', '"published"'))
        done = self.poesy("check", "published.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn('metric = "platform"', done.stderr.decode())

    def test_the_points_that_are_usual_may_be_named(self):
        points = 'points = [["60 mm", "0 mm", "0 mm"], ["-60 mm", "0 mm", "0 mm"], ["0 mm", "60 mm", "0 mm"]]'
        with self.result("usual", study(SENSITIVITY.format(100), 1, 3, BACKGROUND)) as one:
            with self.result("named", study(SENSITIVITY.format(100), 1, 3, BACKGROUND, points)) as other:
                np.testing.assert_array_equal(one["sensitivity/global"], other["sensitivity/global"])
        text = study(SENSITIVITY.format(100), 1, 3, BACKGROUND, points.replace("60 mm", "120 mm"))
        with self.result("twice", text) as other:
            self.assertTrue(np.all(other["sensitivity/global"][0] > 1.05 * h5py.File(self.folder / "usual.h5")["sensitivity/global"][0]))


if __name__ == "__main__":
    main()
