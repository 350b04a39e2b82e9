"""One study with both fidelities of a model, and what calibration can remove of its errors."""

import h5py
import numpy

from poesy_program import ProgramTest, main

#: Errors of each limb that have no first-order effect on the platform.
WITHOUT_EFFECT = ("theta_B_y", "theta_Bp_y", "theta_Bp_z")


def study(fidelity, linear, angular, factors="all"):
    return f"""\
format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs", fidelity = "{fidelity}" }}
poses = {{ count = 12 }}
[errors]
linear = {{ distribution = "normal", sigma = "{linear}" }}
angular = {{ distribution = "normal", sigma = "{angular}" }}
[analysis]
factors = {factors}
samples = 400
"""


class Fidelity(ProgramTest):
    def run_study(self, *arguments):
        self.write("study.toml", study(*arguments))
        output = self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        self.succeeds("verify", "out.h5")
        return h5py.File(self.folder / "out.h5"), output

    def test_small_errors_are_linear(self):
        result, output = self.run_study("both", "0.01 mm", "0.01 deg", '"all"')
        self.assertIn(f"{2 * 51 * 12 * 400} samples", output)
        with result:
            self.assertEqual(result["run/all_samples"][()], 2 * 51 * 12 * 400)
            self.assertEqual(list(result["fidelity"].attrs["fidelities"]), ["exact", "first-order"])
            self.assertEqual(result["fidelity/linear"].shape, (51,))
            self.assertTrue(result["fidelity/linear"][:].all())
            difference = result["fidelity/global"][:] - result["sensitivity/global"][:]
            numpy.testing.assert_array_equal(result["fidelity/discrepancy"][:], difference)
        shown = self.succeeds("show", "out.h5")
        self.assertIn("0 of 51 errors are not linear", shown)
        self.assertEqual(shown.count(" linear\n"), 51)

    def test_large_errors_are_not(self):
        result, _ = self.run_study("both", "5 mm", "5 deg", '"all"')
        with result:
            linear = result["fidelity/linear"][:]
            self.assertGreater(linear.sum(), 0)
            self.assertLess(linear.sum(), 51)
        self.assertIn("not linear", self.succeeds("show", "out.h5"))

    def test_what_has_no_effect_has_none_at_either(self):
        names = [f"{name}_{limb}" for name in WITHOUT_EFFECT for limb in (1, 2, 3)]
        result, _ = self.run_study("both", "1 mm", "1 deg", str(names).replace("'", '"'))
        with result:
            self.assertTrue(result["fidelity/linear"][:].all())
            self.assertTrue(numpy.isnan(result["fidelity/nonlinearity"][:]).all())
            self.assertTrue(numpy.isnan(result["separation/removable"][:]).all())
        self.assertEqual(self.succeeds("show", "out.h5").count(" no effect\n"), 9)

    def test_each_part_is_the_study_at_that_fidelity_alone(self):
        arguments = ("1 mm", "1 deg", '"platform-hinges"')
        with self.run_study("both", *arguments)[0] as both:
            first, second = both["sensitivity/local"][:], both["fidelity/global"][:]
            removable = both["separation/removable"][:]
        with self.run_study("exact", *arguments)[0] as exact:
            numpy.testing.assert_array_equal(exact["sensitivity/local"][:], first)
            numpy.testing.assert_array_equal(exact["separation/removable"][:], removable)
            self.assertNotIn("fidelity", exact)
        with self.run_study("first-order", *arguments)[0] as linear:
            numpy.testing.assert_array_equal(linear["sensitivity/global"][:], second)

    def test_check_counts_both(self):
        self.write("study.toml", study("both", "1 mm", "1 deg", '["q_1"]'))
        self.assertIn("1 errors x 12 poses x 400 samples x 2 fidelities = 9600 solves", self.succeeds("check", "study.toml"))

    def test_published_classes(self):
        with self.run_study("exact", "1 mm", "1 deg", '"all"')[0] as result:
            published = result["separation/published"].asstr()[:]
            names = result["factors/name"].asstr()[:]
            removable = result["separation/removable"][:]
            drive = result["separation/drive_share"][:]
            together = result["separation/removable_together"][()]
        is_c = numpy.char.startswith(names.astype(str), "c_")
        self.assertEqual(((published == "compensable") & ~is_c).sum(), 21)  # the paper has 24, with three scalars c
        self.assertEqual((published == "non-compensable").sum(), 21)
        pure = (published == "compensable") & ~is_c
        numpy.testing.assert_array_equal(removable[pure], 1.0)
        numpy.testing.assert_array_equal(drive[pure], 1.0)
        numpy.testing.assert_array_equal(drive[published == "non-compensable"], 0.0)
        self.assertTrue((removable[is_c] > 0).all() and (removable[is_c] < 1).all())
        self.assertTrue(0 < together < 1)
        self.assertIn("What calibration can remove", self.succeeds("show", "out.h5"))

    def test_evaluation_refuses_both(self):
        self.write("study.toml", study("both", "1 mm", "1 deg", '"all"'))
        self.write("poses.csv", "alpha,beta,z\n0,0,0.7\n")
        self.write("errors.csv", "q_1\n0.001\n")
        done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b'write "exact" or "first-order"', done.stderr)


if __name__ == "__main__":
    main()
