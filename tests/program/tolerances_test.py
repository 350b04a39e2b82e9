"""`poesy tolerances`: what it prints and writes, Monte Carlo studies that confirm it, and what it refuses."""

import csv
import math
import shutil

import h5py
from poesy_program import GALLERY, STUDY, ProgramTest, main

RESPONSE = "gap"
# epsilon_1_1_z changes only a length. With the published metric it has no effect on angles.
PUBLISHED = STUDY.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', '["delta_1_1_y", "epsilon_1_4_z", "epsilon_1_1_z"]')
PUBLISHED = PUBLISHED.replace("samples = 1500", 'samples = 1500\nreference = { factor = "epsilon_1_1_z", tolerance = "1 deg" }')
# With the platform metric, indices hold for errors of any size.
FACTORS = STUDY.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', '["delta_1_1_y", "epsilon_1_4_z", "epsilon_1_1_z"]')
FACTORS = FACTORS.replace('method = "gauss-newton"', 'metric = "platform"')
REFERENCE = FACTORS.replace("samples = 1500", 'samples = 1500\nreference = { factor = "epsilon_1_1_z", tolerance = "1 deg" }')
# epsilon_3_0_y deforms the mechanism only together with the background.
DEFORMED = FACTORS.replace('factors = "benign", linear', 'factors = ["epsilon_3_0_y"], linear')

# The angular errors of limbs 1 and 3 that rotate the platform.
ANGLES = [f"epsilon_{name}" for name in ("1_0_y", "1_0_z", "1_1_x", "1_2_x", "1_2_y", "1_3_y", "1_3_z", "1_4_x", "1_4_z", "3_0_y",
                                         "3_0_z", "3_1_x", "3_1_y", "3_2_y", "3_2_z", "3_3_x", "3_4_x", "3_4_z")]


class Tolerances(ProgramTest):
    def result(self, study=REFERENCE):
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        return "r.h5"

    def table(self, folder):
        with (self.folder / folder / "tolerances.csv").open(newline="") as file:
            return {row["factor"]: row for row in csv.DictReader(file)}

    def refuses(self, *arguments, words):
        done = self.poesy("tolerances", *arguments)
        message = "".join(line for line in done.stderr.decode().splitlines(keepends=True)
                          if "was changed since it was written" not in line)
        self.assertEqual(done.returncode, 2, message)
        self.assertEqual(message.count("\n"), 1, message)
        self.assertIn("; ", message)
        for word in words:
            self.assertIn(word, message)
        self.assertEqual(done.stdout, b"")

    def test_equal_effect_from_the_study_reference(self):
        printed = self.succeeds("tolerances", self.result(), "--response", RESPONSE, "-d", "out")
        self.assertIn("epsilon_1_1_z = 1 deg", printed)
        self.assertNotIn("test with", printed)
        self.assertNotIn("kind allocation", printed)
        table = self.table("out")
        self.assertEqual({name: (row["kind"], row["limb"], row["unit"]) for name, row in table.items()},
                         {"delta_1_1_y": ("linear", "1", "m"), "epsilon_1_4_z": ("angular", "1", "rad"),
                          "epsilon_1_1_z": ("angular", "1", "rad")})
        self.assertAlmostEqual(float(table["epsilon_1_1_z"]["equal_effect_display"]), 1.0, places=14)
        # Both errors act on one length: 1 deg of epsilon_1_1_z has the effect of pi / 180 mm of delta_1_1_y, up to
        # sampling errors.
        self.assertAlmostEqual(float(table["delta_1_1_y"]["equal_effect_display"]) / (math.pi / 180), 1.0, delta=0.15)
        products = [float(row["index"]) * float(row["equal_effect"]) for row in table.values()]
        self.assertAlmostEqual(max(products) / min(products), 1.0, places=12)
        self.assertAlmostEqual(sum(float(row["mean_square_share"]) for row in table.values()), 1.0, places=12)
        self.assertNotIn("variance", printed)
        with h5py.File(self.folder / "r.h5") as file:
            group = file["tolerances"]
            at = list(file["response"].asstr()).index(RESPONSE)
            self.assertEqual([float(row["equal_effect"]) for row in table.values()], list(group["equal_effect"][at]))
            self.assert_shares(file, table, at)

    def assert_shares(self, file, table, response):
        """That shares are of the mean square over samples and poses, from the samples' own moments."""
        found = file["sensitivity"]
        count = found["count"][response]
        square = found["mean"][response] ** 2 + found["std"][response] ** 2 * (count - 1) / count
        added = square.mean(axis=1) - (found["background"][response] ** 2).mean()
        for row, share in zip(table.values(), added / added.sum()):
            self.assertAlmostEqual(float(row["mean_square_share"]), share, places=9)

    def test_equal_tolerance_is_one_number_for_lengths_and_one_for_angles(self):
        # Some lengths and angles have another size and distribution than the others.
        study = FACTORS.replace('["delta_1_1_y"', '["delta_1_1_y", "delta_1_4_z", "delta_3_4_z"').replace(
            "[analysis]", '[errors.override]\ndelta_1_4_z = { distribution = "uniform", half_width = "0.02 mm" }\n'
            'epsilon_1_4_z = { distribution = "triangular", half_width = "0.01 deg" }\n[analysis]')
        printed = " ".join(self.succeeds("tolerances", self.result(study), "--response", RESPONSE, "--limit", "0.05 mm",
                                         "-d", "out").split())
        self.assertIn("2 of 5 errors are not normal in the study (uniform, triangular): the tolerance is still the standard "
                      "deviation of a normal error", printed)
        table = self.table("out")
        self.assertEqual([row["studied_as"] for row in table.values()],
                         ["normal", "uniform", "normal", "triangular", "normal"])
        equal = {kind: {row["limit_equal_tolerance"] for row in table.values() if row["kind"] == kind}
                 for kind in ("linear", "angular")}
        self.assertEqual({kind: len(values) for kind, values in equal.items()}, {"linear": 1, "angular": 1})

    def test_mean_of_norms_says_by_how_much_it_may_be_short(self):
        # The response is a mean of three norms, so mean squares do not add up even in a linear model. Only angular
        # errors, because linear errors rotate the platform by the square of their size.
        study = STUDY.replace("count = 6", "count = 20").replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', str(ANGLES))
        study = study.replace("samples = 1500", "samples = 1000").replace('"1 mm" }\nang', '"0.05 mm" }\nang').replace("0.2 deg", "0.05 deg")
        result = self.result(study.replace('method = "gauss-newton"', ""))
        angular = ("tolerances", result, "--response", "angular_deformation", "--limit")
        printed = " ".join(self.succeeds(*angular, "0.02 deg", "-d", "out").split())
        self.assertIn("may come out up to 1.22 times as large, 0.02449 deg", printed)
        ratios = self.rms_of_confirmations("angular_deformation")
        self.assertGreater(max(ratios), 1.05 * math.radians(0.02))
        self.assertLess(max(ratios), math.sqrt(1.5) * math.radians(0.02))
        self.assertIn('--limit "0.01633 deg"', printed)
        self.succeeds(*angular, "0.01633 deg", "-d", "out")
        self.assertLess(max(self.rms_of_confirmations("angular_deformation")), math.radians(0.02))

    def rms_of_confirmations(self, response):
        """What the two Monte Carlo studies of the folder `out` find, SI."""
        found = []
        for name in ("confirm_equal_effect", "confirm_equal_tolerance"):
            self.poesy("run", f"out/{name}.toml", "--quiet")
            with h5py.File(self.folder / f"{name}.h5") as file:
                at = list(file["response"].asstr()).index(response)
                found.append(math.hypot(*(file[f"monte_carlo/overall_{what}"][at] for what in ("mean", "std"))))
        return found

    def deforming(self, size):
        """A result of all errors that deform the mechanism, as published: ten of them act with the square of their size."""
        study = STUDY.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', '"deforming"').replace('method = "gauss-newton"', "")
        study = study.replace('"1 mm" }\nang', f'"{size} mm" }}\nang').replace("0.2 deg", f"{size} deg")
        return self.result(study.replace("samples = 1500", "samples = 500"))

    def test_errors_that_act_with_the_square_of_a_small_size_keep_it(self):
        printed = " ".join(self.succeeds("tolerances", self.deforming(0.01), "--response", "linear_deformation", "--limit",
                                         "0.05 mm", "-d", "out").split())
        self.assertIn("10 negligible errors have the size studied as tolerance", printed)
        for rms in self.rms_of_confirmations("linear_deformation"):
            self.assertAlmostEqual(rms / 0.05e-3, 1.0, delta=0.1)

    def test_study_that_refutes_its_limit_says_so(self):
        # Errors with a quadratic effect look harmless in a study of small errors.
        response = "linear_deformation"
        self.succeeds("tolerances", self.deforming(0.03), "--response", response, "--limit", "0.05 mm", "--extrapolate", "-d", "out")
        first, second = (self.folder / "out/confirm_equal_effect.toml").read_text().splitlines()[:2]
        self.assertEqual(first, "# held constant: 30 errors of set 'benign' at 1 mm and 1 deg")
        self.assertRegex(second, "^# 10 errors have an index on linear_deformation that changes with size")
        done = self.poesy("run", "out/confirm_equal_effect.toml", "--quiet")
        self.assertEqual(done.returncode, 6, done.stderr)
        with h5py.File(self.folder / "confirm_equal_effect.h5") as file:
            at = list(file["response"].asstr()).index(response)
            mean, std, count = (file[f"monte_carlo/overall_{what}"][at] for what in ("mean", "std", "count"))
            rms = 1e3 * math.hypot(mean, std * math.sqrt((count - 1) / count))
            self.assertEqual(file.attrs["title"], "Tests tolerances of equal effect against a limit of 0.05 mm on the root "
                                                  "mean square of linear_deformation")
        self.assertGreater(rms, 0.5)
        verdict = next(line for line in done.stdout.decode().splitlines() if "FAIL" in line and response in line)
        self.assertIn(f" {rms:.4g} ", verdict)
        self.assertIn("0.05", verdict)

    def test_files_of_the_user_are_not_replaced(self):
        result = self.result()
        own = ("tolerances", result, "--response", RESPONSE, "--limit", "0.05 mm", "-d", ".")
        for name in ("tolerances.csv", "confirm_equal_effect.toml", "confirm_equal_tolerance.toml"):
            with self.subTest(name):
                path = self.write(name, "mine\n")
                self.refuses(*own[1:], words=[name, "would be lost", "-d"])
                self.assertEqual(path.read_text(), "mine\n")
                path.unlink()
                self.assertEqual(list(self.folder.glob("confirm*")) + list(self.folder.glob("*.csv")), [])
        self.succeeds(*own)
        self.succeeds(*own)

    def test_a_mechanism_of_the_user_is_not_replaced(self):
        """Of a study of a mechanism's file, the studies that confirm have a copy of it, which belongs to the manifest."""
        shutil.copyfile(GALLERY / "tricept" / "tricept.toml", self.folder / "tricept.toml")
        self.write("study.toml", 'format = "poesy-study"\nversion = 1\nmechanism.file = "tricept.toml"\nposes.count = 3\n'
                   'errors.linear = { distribution = "normal", sigma = "0.1 mm" }\n'
                   'errors.angular = { distribution = "normal", sigma = "0.01 deg" }\nanalysis.samples = 200\n')
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        own = ("tolerances", "r.h5", "--response", "position", "--limit", "0.05 mm", "--extrapolate", "-d", ".")
        path = self.write("confirm_mechanism.toml", "mine\n")
        self.refuses(*own[1:], words=["confirm_mechanism.toml", "would be lost", "-d"])
        self.assertEqual(path.read_text(), "mine\n")
        path.unlink()
        self.succeeds(*own)
        self.assertIn("confirm_mechanism.toml", (self.folder / "poesy_manifest.txt").read_text())
        self.succeeds(*own)

    def test_responses_are_listed(self):
        self.refuses(self.result(PUBLISHED), words=["r.h5: has tolerances for angular_deformation (deg), linear_deformation (mm), "
                                           "deformation_max; choose one with --response"])

    def test_confirmation_stays_within_the_parts(self):
        # Tolerances for such a large angle would exceed the sizes of the parts.
        template = self.succeeds("template", "2upr-rpu", "--full").replace("count = 158", "count = 5").replace("samples = 1000", "samples = 300")
        self.write("whole.toml", template)
        self.succeeds("run", "whole.toml", "-o", "w.h5", "--quiet")
        printed = self.succeeds("tolerances", "w.h5", "--response", "angular_deformation", "--limit", "20 deg", "-d", "t")
        self.assertIn("the tolerance of delta_1_0_y is 15 mm, a quarter", printed)
        for name in ("equal_effect", "equal_tolerance"):
            self.succeeds("check", f"t/confirm_{name}.toml")

    def test_writes_beside_the_result_unless_told_otherwise(self):
        printed = self.succeeds("tolerances", self.result(), "--response", RESPONSE, "--limit", "0.05 mm")
        self.assertIn("poesy run r_tolerances/confirm_equal_effect.toml -o r_tolerances/confirm_equal_effect.h5", printed)
        self.assertRegex(printed, r"errors were not in this study, and count as perfect here")
        self.assertIn("root mean square of gap over all poses", " ".join(printed.split()))
        self.assertIn("without costs, bounds or a yield. A study of kind allocation finds the tolerances of a drawing, with a "
                      "certificate: poesy template MODEL allocation", " ".join(printed.split()))
        self.assertIn("root mean square", (self.folder / "r_tolerances/confirm_equal_effect.toml").read_text())
        self.assertEqual(set(self.table("r_tolerances")), {"delta_1_1_y", "epsilon_1_4_z", "epsilon_1_1_z"})

    def test_reference_from_the_command_line(self):
        result = self.result()
        self.succeeds("tolerances", result, "--response", RESPONSE, "--reference", "delta_1_1_y=10 um", "-d", "a")
        self.assertAlmostEqual(float(self.table("a")["delta_1_1_y"]["equal_effect"]), 1e-5, places=18)
        self.succeeds("tolerances", result, "--response", RESPONSE, "--reference", "delta_1_1_y", "-d", "b")
        self.assertAlmostEqual(float(self.table("b")["delta_1_1_y"]["equal_effect"]), 1e-3, places=16)

    def test_no_limit_for_an_error_without_effect(self):
        printed = self.succeeds("tolerances", self.result(PUBLISHED), "--response", "angular_deformation", "--reference",
                                "epsilon_1_4_z", "-d", "out")
        self.assertIn("no effect", printed)
        self.assertEqual(self.table("out")["epsilon_1_1_z"]["equal_effect"], "inf")

    def confirm(self, study, limit_mm):
        """The root mean square that each Monte Carlo study finds, over the limit."""
        printed = self.succeeds("tolerances", self.result(study), "--response", RESPONSE, "--limit", f"{limit_mm} mm", "-d",
                                "out")
        ratios = {}
        for name in ("confirm_equal_effect", "confirm_equal_tolerance"):
            self.assertIn(f"poesy run out/{name}.toml", printed)
            done = self.poesy("run", f"out/{name}.toml", "--quiet")
            with h5py.File(self.folder / f"{name}.h5") as file:
                at = list(file["response"].asstr()).index(RESPONSE)
                mean, std = (file[f"monte_carlo/overall_{what}"][at] for what in ("mean", "std"))
            self.assertLess(mean, limit_mm * 1e-3)
            ratios[name] = math.hypot(mean, std) / (limit_mm * 1e-3)
            self.assertEqual(done.returncode, 0 if ratios[name] <= 1.0 else 6, done.stderr)
        return ratios

    def test_monte_carlo_confirms_the_limit(self):
        # The prediction neglects nonlinear effects, which are some percent.
        for name, ratio in self.confirm(REFERENCE, 0.05).items():
            self.assertAlmostEqual(ratio, 1.0, delta=0.3, msg=name)

    def test_poses_from_a_file_are_taken_along(self):
        poses = self.folder / "elsewhere"
        poses.mkdir()
        (poses / "poses.csv").write_text("z,beta,gamma\n-0.2,0.1,0.1\n-0.25,0,0.2\n")
        self.confirm(REFERENCE.replace("count = 6", 'select = "file"\nfile = "elsewhere/poses.csv"'), 0.05)

    def test_limits_that_cannot_be(self):
        result = self.result()
        for limit, words in {"0 mm": ["not above zero"], "-1 mm": ["not above zero"], "1 deg": ["length", "mm"],
                             "0.05": ["no unit", "mm"], "0.05 foot": ["foot", "mm"], "much": ["much"], "": ["--limit"]}.items():
            with self.subTest(limit):
                self.refuses(result, "--response", RESPONSE, f"--limit={limit}", words=words)

    def test_limit_that_the_background_exceeds(self):
        result = self.result(DEFORMED)
        self.refuses(result, "--response", RESPONSE, "--limit", "0.05 mm", "-d", "out",
                     words=["--limit", "background alone", "0.05 mm", "no tolerance can meet"])
        self.assertFalse((self.folder / "out").exists())
        self.succeeds("tolerances", result, "--response", RESPONSE, "--limit", "50 mm", "--extrapolate")

    def test_reference_without_effect(self):
        result = self.result(PUBLISHED)
        words = ["'epsilon_1_1_z' has no effect on angular_deformation (index 0)", "name another with --reference"]
        self.refuses(result, "--response", "angular_deformation", words=["the study's [analysis] reference: ", *words])
        self.refuses(result, "--response", "angular_deformation", "--reference", "epsilon_1_1_z",
                     words=["--reference: ", *words])

    def test_names_and_files_that_do_not_fit(self):
        result = self.result()
        self.refuses(result, "--response", "linear_deformatio", words=["linear_deformatio'", "did you mean 'linear_deformation'"])
        self.refuses(result, "--response", RESPONSE, "--reference", "epsilon_1_4_y", words=["--reference", "epsilon_1_4_z"])
        self.refuses(result, "--response", RESPONSE, "--reference", "epsilon_1_4_z=1 mm", words=["--reference", "angle"])
        self.refuses(result, words=["--response"])
        self.write("mc.toml", STUDY.replace('"sensitivity"', '"monte-carlo"'))
        self.succeeds("run", "mc.toml", "--quiet")
        self.refuses("mc.h5", "--response", RESPONSE, words=["mc.h5", "monte-carlo", "sensitivity"])
        self.assertEqual(self.poesy("tolerances", "absent.h5", "--response", RESPONSE).returncode, 3)

    def test_background_that_was_not_solved(self):
        result = self.result()
        with h5py.File(self.folder / result, "r+") as file:
            file["sensitivity/background"][...] = math.nan
        self.refuses(result, "--response", RESPONSE, "--limit", "0.05 mm", words=["--limit", "background", "not solved"])
        self.assertIn("unknown", self.succeeds("tolerances", result, "--response", RESPONSE))

    def test_nothing_has_an_effect(self):
        result = self.result(STUDY.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', '["delta_1_1_y", "epsilon_1_1_z"]'))
        self.refuses(result, "--response", "angular_deformation", words=["no error", "angular_deformation"])


if __name__ == "__main__":
    main()
