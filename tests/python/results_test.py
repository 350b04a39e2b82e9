"""Result files of every kind as the package reads them, compared with the files; and files that are not results.

usage: results_test.py EXAMPLES; EXAMPLES is the folder to which write_examples wrote
"""

import shutil
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np
from package import ROOT, STUDIES, FolderTest, poesy, result

from poesy import _verdict

try:
    from scipy.stats import beta, binom
except ImportError:
    beta = binom = None

EXAMPLES = Path(sys.argv[1])


class Files(unittest.TestCase):
    def check(self, path):
        found = poesy.read(path)
        groups = found.to_xarray()
        with h5py.File(path) as file:
            names = []
            file.visititems(lambda name, thing: names.append(name) if isinstance(thing, h5py.Group) else None)
            self.assertEqual(set(groups), set(names))
            self.assertEqual(groups.keys(), set(found.groups))
            for name in names:
                for each in (one for one in file[name] if isinstance(file[name][one], h5py.Dataset)):
                    with self.subTest(f"{path.name}:/{name}/{each}"):
                        self.check_variable(file[name][each], groups[name].variables[each])
            self.assertEqual(found.attrs["content_sha256"], file.attrs["content_sha256"])
        return found

    def check_variable(self, stored, read):
        text = h5py.check_string_dtype(stored.dtype) is not None
        expected = stored.asstr()[()] if text else stored[()]
        np.testing.assert_array_equal(read.values, expected)
        self.assertEqual(read.attrs["unit"], stored.attrs["unit"])
        self.assertEqual(read.attrs["description"], stored.attrs["description"])
        if h5py.h5ds.is_scale(stored.id):
            return
        for axis, name in enumerate(read.dims):
            scale = stored.dims[axis][0]
            self.assertEqual(scale.name.split("/")[-1], name)

    def test_examples_of_every_kind(self):
        kinds = set()
        for path in sorted(EXAMPLES.glob("*.h5")):
            if path.stem not in ("newer", "older", "stranger", "nameless"):
                kinds.add(self.check(path).kind)
        self.assertEqual(kinds, {"sensitivity", "monte-carlo", "sobol", "allocation", "identification", "coupling", "evaluate"})

    def test_results_of_the_program(self):
        for name in STUDIES:
            found = self.check(result(name).path)
            self.assertEqual(found.study["analysis"]["kind"], found.kind)

    def test_axes_have_names_and_units(self):
        found = result("sensitivity").to_xarray("sensitivity")
        self.assertEqual(found["local"].dims, ("response", "factor", "pose"))
        one = found.sel(response="gap", factor="epsilon_1_1_x")
        self.assertEqual(one["local"].shape, (4,))
        self.assertEqual((str(one["response_unit"].values), str(one["factor_unit"].values)), ("m", "rad"))
        self.assertEqual(found.attrs["conf_level"], 0.95)
        parts = result("allocation").to_xarray("allocation")
        self.assertEqual(str(parts["part_unit"].sel(part="delta_1_0_y").values), "m")

    def test_a_group_is_the_readers_own(self):
        found = result("sensitivity")
        changed = found.to_xarray("poses")
        changed["z"].values[:] = 7.0
        changed.attrs.clear()
        self.assertTrue(found.to_xarray("poses").attrs)
        self.assertTrue((found.to_xarray("poses")["z"] < 0.0).all())

    def test_resolved_study(self):
        study = result("machines").study
        self.assertEqual(study["analysis"]["limits"]["gap"], "2e-04 m")
        self.assertEqual(study["solver"]["not_converged"], "exclude")

    def test_what_is_missing_is_said(self):
        found = result("sensitivity")
        with self.assertRaisesRegex(poesy.NotInResult, "no group 'sobol'; it has .*sensitivity/history"):
            found.to_xarray("sobol")
        with self.assertRaisesRegex(poesy.NotInResult, "no response 'gapp'; it has gap, angular_deformation"):
            found.ranking("gapp")
        with self.assertRaisesRegex(poesy.NotInResult, "kind sensitivity has no Sobol' indices"):
            found.to_salib()
        with self.assertRaisesRegex(poesy.NotInResult, "kind coupling ranks nothing; kinds that do: allocation, "):
            result("coupling").ranking()
        with self.assertRaisesRegex(poesy.NotInResult, "belongs to no response"):
            result("allocation").ranking("gap")


class Strangers(FolderTest):
    def test_no_results(self):
        cases = {
            "newer": "version 2.0, this reads 1.x; take a newer package", "stranger": "filetype: something-else",
            "older": "version 0.9, this reads 1.x; run the study again", "nameless": "filetype: none",
        }  # fmt: skip
        for name, words in cases.items():
            with self.subTest(name), self.assertRaisesRegex(poesy.DamagedFile, words):
                poesy.read(EXAMPLES / f"{name}.h5")
        (self.folder / "text.h5").write_text("no result")
        with self.assertRaisesRegex(poesy.DamagedFile, "text.h5: is not an intact HDF5 file"):
            poesy.read("text.h5")
        with self.assertRaises(OSError) as absent:
            poesy.read("absent.h5")
        self.assertIsInstance(absent.exception, poesy.FileError)
        self.assertNotIsInstance(absent.exception, poesy.DamagedFile)

    def test_cut_off_files_are_refused(self):
        whole = result("sensitivity").path.read_bytes()
        for size in (0, 100, len(whole) // 2, len(whole) - 1):
            Path("cut.h5").write_bytes(whole[:size])
            with self.subTest(size), self.assertRaises(poesy.DamagedFile):
                for group in poesy.read("cut.h5").to_xarray().values():
                    group.load()

    def test_changed_numbers_are_found(self):
        shutil.copy(result("sensitivity").path, "changed.h5")
        poesy.read("changed.h5").verify()
        with h5py.File("changed.h5", "r+") as file:
            file["sensitivity/global"][0, 0] *= 2
        with self.assertRaisesRegex(poesy.DamagedFile, "changed.h5"):
            poesy.read("changed.h5").verify()


class Verdicts(unittest.TestCase):
    @unittest.skipIf(binom is None, "scipy is not installed")
    def test_tail_of_the_binomial_distribution(self):
        for trials in (1, 20, 1000, 149_000):
            for share in (1e-4, 0.0027, 0.3, 0.5, 0.99):
                mean = trials * share
                for most in {0, int(mean / 2), int(mean), int(mean + 3 * mean**0.5) + 1, trials}:
                    most = min(most, trials)
                    expected = binom.cdf(most, trials, share)
                    if expected > 1e-290:
                        found = _verdict.lower_tail(most, trials, share)
                        self.assertAlmostEqual(found / expected, 1.0, places=7, msg=(most, trials, share))

    @unittest.skipIf(beta is None, "scipy is not installed")
    def test_decision_is_that_of_clopper_and_pearson(self):
        """Bounds by the beta distribution, for every number of rejects around the asked yield."""
        machines, asked, level = 2000, 0.99, 0.95
        found = {"machines": _Scalar(machines)}
        for rejects in range(0, 60):
            good = machines - rejects
            low = beta.ppf(1 - level, good, rejects + 1)
            high = beta.ppf(level, good + 1, rejects) if rejects else 1.0
            expected = "kept" if low >= asked else "not kept" if high < asked else "undecided"
            group = _Group(found | {"rejects": _Scalar(rejects)}, {"conf_level": level})
            self.assertEqual(_verdict._of_yield(group, asked), expected, rejects)

    def test_what_studies_found(self):
        self.assertIsNone(result("sensitivity").verdict)
        self.assertEqual(result("allocation").verdict, "certified")
        self.assertEqual(result("evaluate").verdict, "not kept")


class _Scalar:
    def __init__(self, value):
        self.value = value

    def __getitem__(self, _):
        return self.value


class _Group(dict):
    def __init__(self, values, attrs):
        super().__init__(values)
        self.attrs = attrs


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
