"""poesy.sweep: designs that differ in a key, their figure, and what is refused."""

import warnings
from pathlib import Path

import numpy as np
from matplotlib import pyplot
from package import STUDIES, FolderTest, main, poesy, result

MACHINES = STUDIES["machines"]
LENGTHS = ["60 mm", "70 mm", "80 mm"]
SIZES = ["0.01 deg", "0.02 deg"]


class Sweeps(FolderTest):
    def tearDown(self):
        pyplot.close("all")

    def test_designs_are_runs(self):
        found = poesy.sweep(MACHINES, {"geometry.l_A": "60:80:10 mm"})
        self.assertEqual(found.kind, "sweep")
        group = found.to_xarray("sweep")
        self.assertEqual(group["number"].values[:, 0].tolist(), [60.0, 70.0, 80.0])
        listed = poesy.sweep(MACHINES, {"geometry.l_A": LENGTHS})
        self.assertEqual(listed.attrs["content_sha256"], found.attrs["content_sha256"])
        for d, length in enumerate(LENGTHS):
            single = poesy.run({**MACHINES, "mechanism": {"model": "2upr-rpu", "geometry": {"l_A": length}}})
            self.assertEqual(str(group["content_sha256"].values[d]), single.attrs["content_sha256"])
            merit = float(group["merit"].sel(quantity="yield")[d])
            self.assertAlmostEqual(merit, 100.0 * float(single.to_xarray("yield")["value"]), places=10)

    def test_output_and_seed(self):
        found = poesy.sweep(MACHINES, {"errors.angular.sigma": SIZES}, output="sizes.h5", seed=7, threads=1, response="gap")
        self.assertEqual(found.path, Path("sizes.h5"))
        self.assertEqual(found.study["run"]["seed"], 7)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["sizes.h5"])
        found.verify()
        with self.assertRaisesRegex(poesy.NotInResult, "sweep"):
            found.ranking()

    def test_plot(self):
        found = poesy.sweep(MACHINES, {"geometry.l_A": LENGTHS, "errors.angular.sigma": SIZES})
        axes = found.plot.sweep()
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("l_A [mm]", "yield [%]"))
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], [f"sigma = {size}" for size in SIZES])
        merit = found.to_xarray("sweep")["merit"].sel(quantity="yield").values
        for c, line in enumerate(axes.lines):
            np.testing.assert_array_equal(line.get_xdata(), [60.0, 70.0, 80.0])
            np.testing.assert_array_equal(line.get_ydata(), merit[c::2])
        self.assertEqual(len(axes.collections), 2)  # bands of the intervals
        self.assertEqual(found.plot.sweep("root mean square of gap").get_ylabel(), "root mean square of gap [mm]")
        for wrong in (lambda: found.plot.sweep("cost"), lambda: result("sensitivity").plot.sweep()):
            with self.assertRaises(poesy.NotInResult):
                wrong()

    def test_words_are_drawn_in_their_order(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", poesy.PoesyWarning)
            found = poesy.sweep(MACHINES, {"solver.method": ["newton", "gauss-newton"]})
        axes = found.plot.sweep()
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], ["newton", "gauss-newton"])

    def test_refusals(self):
        for values, said in [
            ({"geometry.l_A": "60 mm"}, "has one value only"),
            ({"geometry.l_A": [60, 70]}, "has no unit"),
            ({}, "needs --set"),
            ({"geometry.lA": LENGTHS}, "with mechanism.geometry.lA = 60 mm"),
        ]:
            with self.subTest(values), self.assertRaisesRegex(poesy.StudyError, said):
                poesy.sweep(MACHINES, values)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()
