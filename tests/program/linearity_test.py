"""Whether indices hold for other sizes of the errors: what a run finds, what is shown, and that `tolerances` does not
extrapolate without a message."""

import json

import h5py
import numpy
from poesy_program import ProgramTest, main

# A study of the errors that deform the mechanism, without a background of constant errors.
STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 6
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "1 deg" }
[analysis]
factors = "deforming"
samples = 500
[solver]
metric = "published"
"""


class Linearity(ProgramTest):
    def result(self, name="study", text=STUDY):
        self.write(f"{name}.toml", text)
        self.succeeds("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet")
        return f"{name}.h5"

    def by_platform(self):
        return self.result("platform", STUDY.replace("published", "platform"))

    def read(self, result, response, name="index_change"):
        """A number of each error, by its name."""
        with h5py.File(self.folder / result) as file:
            at = list(file["responses/name"].asstr()).index(response)
            return dict(zip(file["factors/name"].asstr()[:], file[f"sensitivity/{name}"][at]))

    def test_published_index_of_a_quadratic_error_is_said_to_change(self):
        result = self.result()
        change = self.read(result, "linear_deformation")["epsilon_3_4_z"]
        self.assertGreater(change, -1.0)
        self.assertLess(change, -0.85)
        shown = " ".join(self.succeeds("show", result, "--response", "linear_deformation").split())
        self.assertRegex(shown, rf"not for [^;]*epsilon_3_4_z \({100 * change:.1f} %\)")
        table = json.loads(self.succeeds("show", result, "--response", "linear_deformation", "--json"))["tables"][0]
        shown = {row["error"]: row["index_change"] for row in table["rows"]}
        self.assertAlmostEqual(shown["epsilon_3_4_z"], 100 * change, places=9)
        self.succeeds("report", result)
        self.assertIn("Some indices say something about the size of the errors in this study and no other",
                      (self.folder / "study.html").read_text())

    def test_solves_to_first_order_do_not_test_it(self):
        first = STUDY.replace("published", "platform").replace('model = "2upr-rpu"', 'model = "2upr-rpu"\nfidelity = "first-order"')
        result = self.result("first", first)
        shown = " ".join(self.succeeds("show", result).split())
        said = "solved to first order in the errors, so it is not tested whether indices hold at other sizes"
        self.assertIn(said, shown)
        self.assertRegex(shown, r"solved to first order in the errors \d[\d ]* solves in ")
        for words in ("at a tenth", "holds at"):
            self.assertNotIn(words, shown)
        self.succeeds("report", result)
        page = (self.folder / "first.html").read_text()
        self.assertIn(f"The samples were {said}.", page)
        self.assertNotIn("hold at a tenth", page)
        self.succeeds("export", result, "-d", "tables", "--latex")
        self.assertIn(said, " ".join((self.folder / "tables/ranked.tex").read_text().split()))

    def test_change_is_that_between_two_studies(self):
        found = self.read(self.result(), "linear_deformation")
        large = self.read("study.h5", "linear_deformation", "global")
        small = self.result("small", STUDY.replace("1 mm", "0.1 mm").replace("1 deg", "0.1 deg"))
        quadratic = 0
        for name, index in self.read(small, "linear_deformation", "global").items():
            if numpy.isnan(found[name]):
                continue
            change = index / large[name] - 1.0
            # Few draws suffice to find whether an index changes. The change itself is accurate if the effect is purely
            # quadratic.
            self.assertEqual(abs(found[name]) > 0.02, abs(change) > 0.02, name)
            if change < -0.8:
                quadratic += 1
                self.assertAlmostEqual(found[name], change, delta=0.05, msg=name)
        self.assertGreater(quadratic, 8)

    def test_by_the_platform_every_index_holds(self):
        result = self.by_platform()
        changes = self.read(result, "gap")
        self.assertEqual(len(changes), 25)
        indices = self.read(result, "gap", "global")
        without = {name for name, index in indices.items() if index < 1e-10}
        self.assertLess(len(without), 3)
        self.assertEqual({name for name, change in changes.items() if numpy.isnan(change)}, without)
        for name in changes.keys() - without:
            self.assertLess(abs(changes[name]), 0.02, name)
        count = 25 - len(without)
        self.assertIn(f"within 2 %: {count} of {count} errors with an effect\n", self.succeeds("show", result, "--width", "200"))
        self.succeeds("report", result)
        self.assertNotIn("Some indices say something about", (self.folder / "platform.html").read_text())

    def test_tolerances_of_another_size_are_refused(self):
        command = ("tolerances", self.result(), "--response", "linear_deformation", "--limit", "0.03 mm", "-d", "out")
        done = self.poesy(*command)
        message = done.stderr.decode()
        self.assertEqual((done.returncode, done.stdout), (2, b""), message)
        self.assertEqual(message.count("\n"), 1)
        self.assertRegex(message, r"epsilon_3_4_z \(-\d\d\.\d %; study it at 0\.\d+ deg\)")
        self.assertNotIn("delta_1_1_y", message)
        for words in ("changes with size", '[solver] metric = "platform"', "--extrapolate", "[errors.override]"):
            self.assertIn(words, message)
        self.assertFalse((self.folder / "out").exists())

    def test_extrapolation_is_said_where_it_was_asked_for(self):
        printed = " ".join(self.succeeds("tolerances", self.result(), "--response", "linear_deformation", "--limit", "0.03 mm",
                                         "--extrapolate", "-d", "out").split())
        self.assertIn("changes with size", printed)
        self.assertIn("epsilon_3_4_z (-", printed)
        for name in ("equal_effect", "equal_tolerance"):
            study = (self.folder / f"out/confirm_{name}.toml").read_text()
            self.assertRegex(study.splitlines()[0], "^# .* changes with size.*epsilon_3_4_z")
            self.succeeds("check", f"out/confirm_{name}.toml")
        changes = self.read("study.h5", "linear_deformation")
        table = numpy.genfromtxt(self.folder / "out/tolerances.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        for row in table:
            self.assertEqual(numpy.nan_to_num(row["index_change"]), numpy.nan_to_num(changes[row["factor"]]))

    def test_tolerances_by_the_platform_may_be_of_any_size(self):
        result = self.by_platform()
        for limit in ("0.3 um", "3 um", "0.03 mm"):
            printed = self.succeeds("tolerances", result, "--response", "gap", "--limit", limit, "-d", "out")
            self.assertNotIn("changes with size", printed)

    def test_tolerances_at_the_size_studied_are_not_refused(self):
        # With one error, the limit is a multiple of the error's effect, so the tolerance is this multiple of the size
        # studied.
        study = STUDY.replace('"deforming"', '["epsilon_3_4_z"]')
        result = self.result("one", study)
        self.assertLess(self.read(result, "linear_deformation")["epsilon_3_4_z"], -0.5)
        with h5py.File(self.folder / result) as file:
            at = list(file["responses/name"].asstr()).index("linear_deformation")
            rms = 1e3 * file["tolerances/rms_effect"][at][0] * file["factors/sigma"][0]
        for multiple, refused in ((1.0, False), (1.9, False), (0.55, False), (2.1, True), (0.45, True)):
            done = self.poesy("tolerances", result, "--response", "linear_deformation", "--limit", f"{multiple * rms} mm",
                              "-d", "out")
            self.assertEqual(done.returncode, 2 if refused else 0, multiple)

    def test_shards_and_threads_give_the_bits_of_one_run(self):
        self.result()
        for shard in ("1/2", "2/2"):
            self.succeeds("run", "study.toml", "--shard", shard, "--quiet")
        self.succeeds("merge", "study.1-of-2.h5", "study.2-of-2.h5", "-o", "merged.h5")
        self.succeeds("run", "study.toml", "-o", "one.h5", "--threads", "1", "--quiet")
        expected = self.read("study.h5", "angular_deformation")
        for result in ("merged.h5", "one.h5"):
            numpy.testing.assert_array_equal(list(self.read(result, "angular_deformation").values()), list(expected.values()))


if __name__ == "__main__":
    main()
