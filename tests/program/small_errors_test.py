"""Errors so small that rounding matters: errors without effect are recognised by the rounding of the mechanism, and
a message says if errors are too small."""

import csv
import json
import math

import h5py
import numpy
from poesy_program import ProgramTest, main

SIZES = [("1 mm", "1 deg"), ("10 um", "0.01 deg"), ("1 um", "1 arcsec"), ("0.1 um", "0.1 arcsec")]


def study(model, linear, angular, poses=20, samples=100, fidelity=""):
    return f"""\
format = "poesy-study"
version = 1
[mechanism]
model = "{model}"
{fidelity}
[poses]
count = {poses}
[errors]
linear = {{ distribution = "normal", sigma = "{linear}" }}
angular = {{ distribution = "normal", sigma = "{angular}" }}
[analysis]
factors = "all"
samples = {samples}
"""


class SmallErrors(ProgramTest):
    def run_study(self, name, *arguments, **options):
        self.write(f"{name}.toml", study(*arguments, **options))
        self.succeeds("run", f"{name}.toml", "--quiet")
        return f"{name}.h5"

    def refusal(self, *arguments):
        done = self.poesy(*arguments)
        self.assertEqual((done.returncode, done.stdout), (2, b""))
        return done.stderr.decode()

    def test_the_same_errors_are_without_effect_at_any_size(self):
        self.write("benign.toml", study("2upr-rpu", "1 mm", "1 deg", 2, 10).replace('"all"', '"benign"'))
        self.succeeds("run", "benign.toml", "--quiet")
        with h5py.File(self.folder / "benign.h5") as file:
            benign = set(file["factors/name"].asstr()[:])
        without = {}
        for number, size in enumerate(SIZES):
            with h5py.File(self.folder / self.run_study(f"s{number}", "2upr-rpu", *size)) as file:
                names = file["factors/name"].asstr()[:]
                at = list(file["responses/name"].asstr()).index("linear_deformation")
                tolerance = file["tolerances/equal_effect"][at]
                without[size] = {name for name, value in zip(names, tolerance) if math.isinf(value)}
                effect = file["sensitivity/global"][at] * file["factors/sigma"][:]
                # An independent criterion: the largest effect by rounding is far below the smallest true effect.
                gap = numpy.sort(effect)[len(without[size]) - 1:][:2]
                self.assertLess(gap[0], 1e-16)
                self.assertGreater(gap[1], 1e3 * gap[0])
                self.assertEqual(file["tolerances/reference_factor"].asstr()[at], names[numpy.argsort(effect)[len(without[size])]])
        self.assertEqual((len(benign), len(without[SIZES[0]])), (30, 33))
        for size in SIZES[1:]:
            self.assertEqual(without[size], without[SIZES[0]], size)
        self.assertLessEqual(benign, without[SIZES[0]])

    def test_tolerances_of_small_errors_stay_small(self):
        result = self.run_study("small", "2upr-rpu", *SIZES[-1])
        self.succeeds("tolerances", result, "--response", "linear_deformation", "--limit", "0.05 um", "--extrapolate", "-d",
                      "out")
        with (self.folder / "out/tolerances.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sum(row["equal_effect"] == "inf" for row in rows), 33)
        for row in rows:
            for way in ("limit_equal_effect", "limit_equal_tolerance"):
                self.assertLess(float(row[way]), 0.02, (row["factor"], way))  # m or rad; the mechanism is 60 mm large

    def test_adaptive_samples_are_not_spent_on_rounding(self):
        text = study("2upr-rpu", *SIZES[-1], poses=2, samples="{ min = 1000, max = 3000, relative_error = 1e-4 }")
        self.write("adaptive.toml", text.replace('"all"', '["delta_3_3_x", "delta_1_1_y"]'))  # without and with an effect
        self.succeeds("run", "adaptive.toml", "--quiet")
        with h5py.File(self.folder / "adaptive.h5") as file:
            samples = dict(zip(file["factors/name"].asstr()[:], file["convergence/samples"][:]))
        self.assertEqual(samples, {"delta_3_3_x": 1000, "delta_1_1_y": 3000})

    def test_errors_too_small_to_tell_are_said_to_be(self):
        result = self.run_study("tiny", "3-prs", "1e-13 mm", "1e-13 mrad", poses=3)
        ranked = json.loads(self.succeeds("show", result, "--json"))["tables"][0]
        self.assertTrue(any("cannot be told from the rounding" in note for note in ranked["notes"]), ranked["notes"])
        self.assertEqual({(row["effect"], row["index"], row["index_low"], row["index_high"]) for row in ranked["rows"]},
                         {(None,) * 4})
        self.assertIn(" rounding ", self.succeeds("show", result))
        self.succeeds("export", result, "-d", "tables")
        with (self.folder / "tables/global.csv").open(newline="") as file:
            for row in csv.DictReader(file):
                self.assertEqual({value for name, value in row.items() if "_corrected" in name}, {"NaN"})
        self.succeeds("report", result)
        self.assertIn("so small in this study", (self.folder / "tiny.html").read_text())
        for limit in ([], ["--limit", "1 um"]):
            message = self.refusal("tolerances", result, "--response", "tip_position", *limit)
            self.assertIn("cannot be told from the rounding of the solves; study larger errors", message)

    def test_what_is_told_of_tiny_errors_is_right(self):
        first_order = 'fidelity = "first-order"'
        told = {}
        for size in ("1e-10", "1e-11", "1e-12", "1e-13"):
            sizes = (f"{size} mm", f"{size} mrad")
            with h5py.File(self.folder / self.run_study("exact", "3-prs", *sizes, 3)) as exact, \
                    h5py.File(self.folder / self.run_study("linear", "3-prs", *sizes, 3, fidelity=first_order)) as linear:
                found = exact["sensitivity/global_corrected"][:]
                low, high = (exact["sensitivity/global_corrected" + end][:] for end in ("_ci_low", "_ci_high"))
                expected = linear["sensitivity/global_corrected"][:]
                effect = found * exact["factors/sigma"][:] > exact["sensitivity/rounding"][:][:, None]
            told[size] = effect.sum()
            # Both studies have the same draws, so they differ only by rounding.
            numpy.testing.assert_allclose(found[effect], expected[effect], rtol=0.02)
            self.assertTrue(((low <= found) & (found <= high))[effect].all())
            self.assertTrue(numpy.isnan(found[~effect]).all())
        self.assertGreater(told["1e-10"], 100)
        self.assertEqual(told["1e-13"], 0)

    def test_first_order_has_no_rounding_of_its_own(self):
        first_order = 'fidelity = "first-order"'
        with h5py.File(self.folder / self.run_study("tiny", "3-prs", "1e-12 mm", "1e-12 mrad", 3, fidelity=first_order)) as tiny, \
                h5py.File(self.folder / self.run_study("usual", "3-prs", "1 mm", "1 mrad", 3, fidelity=first_order)) as usual:
            for name in ("global_corrected", "global_corrected_ci_low", "global_corrected_ci_high"):
                numpy.testing.assert_allclose(tiny["sensitivity"][name], usual["sensitivity"][name], rtol=1e-9, atol=1e-14)

    def test_errors_whose_squares_vanish_are_refused(self):
        for size in ("1e-80 mm", "1e-160 mm", "9e-31 m"):
            path = self.write("vanishing.toml", study("3-prs", size, "1 mrad", fidelity='fidelity = "first-order"'))
            message = self.refusal("run", path)
            self.assertIn("vanishing.toml:9:", message)
            self.assertIn(f"errors.linear.sigma is '{size}'", message)
            self.assertIn("at least 1e-30 m", message)
        self.write("least.toml", study("3-prs", "1e-30 m", "1e-30 rad", 3, fidelity='fidelity = "first-order"'))
        self.succeeds("run", "least.toml", "--quiet")
        with h5py.File(self.folder / "least.h5") as file:
            self.assertTrue((file["sensitivity/global_ci_low"][:] <= file["sensitivity/global"][:]).all())
            self.assertTrue((file["sensitivity/global"][:] <= file["sensitivity/global_ci_high"][:]).all())


if __name__ == "__main__":
    main()
