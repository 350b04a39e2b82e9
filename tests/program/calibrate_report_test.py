"""Tests that `show` and the report of a calibration agree with the result: residuals, correlations, remaining
errors."""

import base64
import json
import os
import re
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

FILES = Path(os.environ["POESY_DATA"]) / "calibration"
MM = 1e-3


class CalibrationReport(ProgramTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def calibrate(self, study="delta-measured.toml", measured="delta-heights.csv"):
        self.succeeds("calibrate", study, "--measured", measured, "-o", "r.h5")

    def table(self, name):
        shown = json.loads(self.succeeds("show", "r.h5", "--json"))
        return next(table for table in shown["tables"] if table["name"] == name)

    def figures(self):
        """The figures of the report and a function that gives the numbers of an array."""
        self.succeeds("report", "r.h5", "-o", "r.html")
        page = (self.folder / "r.html").read_text()
        data = json.loads(re.search(r'id="report-data">(.*?)</script>', page, re.S)[1])
        return data["figures"], lambda name: np.frombuffer(base64.b64decode(data["arrays"][name]), "<f4")

    def test_the_example_among_the_results(self):
        """results/measured-printer/calibration.txt is what `show` prints, but for the speed."""
        self.calibrate()
        shown = self.succeeds("show", "r.h5", "--width", "100").splitlines()
        example = Path(__file__).resolve().parents[2] / "results/measured-printer/calibration.txt"
        self.assertEqual([line for line in shown if not line.endswith(" solves/s")], example.read_text().splitlines())

    def test_residuals_of_show(self):
        self.calibrate()
        table = self.table("residuals")
        with h5py.File(self.folder / "r.h5") as file:
            found = {name: values[()] for name, values in file["calibration"].items() if isinstance(values, h5py.Dataset)}
            names = [name.decode() for name in file["value"][:]]
            rows = [name.decode() for name in file["measurement"][:]]
        self.assertEqual(rows, [f"p{n}" for n in range(13)])
        largest = np.argsort(-np.abs(found["standardised"]))[:10]
        self.assertEqual([row["value"] for row in table["rows"]], [names[i] for i in largest])
        for row, i in zip(table["rows"], largest):
            at = found["measured_at"][found["value_row"][i]]
            np.testing.assert_allclose([row["at_x"], row["at_y"], row["at_z"]], at / MM, rtol=1e-12)
            np.testing.assert_allclose(row["measured"], found["measured"][i] / MM, rtol=1e-12)
            np.testing.assert_allclose(row["fitted"], (found["measured"] - found["residual"])[i] / MM, rtol=1e-12)
            np.testing.assert_allclose(row["residual"], found["residual"][i] / MM, rtol=1e-12)
            np.testing.assert_allclose(row["residual_over_sd"], found["standardised"][i], rtol=1e-12)
        distance = names.index("distance p1 p4")
        self.assertEqual((rows[found["value_row"][distance]], rows[found["value_to"][distance]]), ("p1", "p4"))
        self.assertIn("10 of 15 values shown", " ".join(table["notes"]))

    def test_every_column_is_explained(self):
        """Units stand in the heading or in a column; the notes explain what the headings do not."""
        self.calibrate()
        for name, words in (("fitted", ["estimate:", "low, high: its 95 % interval", "sd:", "tolerance/sd:"]),
                            ("next", ["gain:"]), ("residuals", ["residual:", "residual/sd:"])):
            notes = "\n".join(self.table(name)["notes"])
            for word in words:
                self.assertIn(word, notes)
        text = (self.folder / "delta-measured.toml").read_text()
        self.write("study.toml", text.replace("next       = 5", 'frame = "height"\nnext = 0').replace("errors.linear", "# "))
        self.calibrate("study.toml")
        self.assertIn("height, target_x, ...: places in m", self.table("frame")["notes"][0])
        self.assertIn("scale/sd: a usual size", "\n".join(self.table("fitted")["notes"]))

    def test_outliers_are_marked(self):
        text = (self.folder / "delta-heights.csv").read_text()
        self.write("wrong.csv", text.replace("-51.962,0,-72.8,", "-51.962,0,7.2,"))
        self.calibrate(measured="wrong.csv")
        marks = {row["value"]: row["mark"] for row in self.table("residuals")["rows"]}
        self.assertEqual([value for value, mark in marks.items() if mark == "outlier"],
                         ["deviation_z of p5", "deviation_z of p4"])

    def test_figures_of_the_report(self):
        self.calibrate()
        figures, numbers = self.figures()
        with h5py.File(self.folder / "r.h5") as file:
            found = {name: values[()] for name, values in file["calibration"].items() if isinstance(values, h5py.Dataset)}
            left = file["calibration/left/mean"][()], file["calibration/left/sd"][()]
            moved = [name.decode() for name in file["moved"][:]]
        heights, _, distances, _ = figures["residuals"]["fields"]
        self.assertEqual([heights["label"], distances["label"]], ["residual of deviation_z", "residual of distance"])
        np.testing.assert_allclose(numbers(figures["residuals"]["numbers"]), np.arange(1, 14))
        np.testing.assert_allclose(numbers(figures["residuals"]["coordinates"][0]["value"]),
                                   found["measured_at"][:, 0] / MM, rtol=1e-6)
        expected = np.full(13, np.nan)
        expected[found["value_row"][:12]] = found["residual"][:12] / MM
        np.testing.assert_allclose(numbers(heights["value"]), expected, rtol=1e-6)
        self.assertTrue(np.isnan(expected[9]))
        self.assertEqual(np.flatnonzero(~np.isnan(numbers(distances["value"]))).tolist(), [1, 2, 3])
        np.testing.assert_allclose(numbers(figures["correlations"]["layers"][0]["value"]),
                                   found["correlation"].ravel(), rtol=1e-6, atol=1e-7)
        fields = {field["label"]: numbers(field["value"]) for field in figures["left"]["fields"]}
        z = moved.index("z")
        np.testing.assert_allclose(fields["z, root mean square"], np.hypot(left[0][:, z], left[1][:, z]) / MM, rtol=1e-6)
        np.testing.assert_allclose(fields["z, expected"], left[0][:, z] / MM, rtol=1e-6)
        components = [moved.index(name) for name in ("x", "y", "z")]
        np.testing.assert_allclose(fields["position, root mean square"],
                                   np.sqrt((left[0][:, components]**2 + left[1][:, components]**2).sum(axis=1)) / MM, rtol=1e-6)
        # The platform of this printer does not rotate, so fields of the tool would equal those of the platform's
        # origin.
        self.assertEqual({label.split(",")[0] for label in fields}, {"x", "y", "z", "position"})

    def test_no_noise(self):
        """Without noise residuals have no standard deviation: they are ordered by their size."""
        heights = [",".join(row.split(",")[1:5]) for row in (self.folder / "delta-heights.csv").read_text().splitlines()]
        self.write("m.csv", "\n".join(heights) + "\n")
        text = (self.folder / "delta-measured.toml").read_text()
        self.write("study.toml", text.replace('z = "10 um", distance = "50 um"', "z = 0").replace("next       = 5", "next = 0"))
        self.calibrate("study.toml", "m.csv")
        table = self.table("residuals")
        sizes = [abs(row["residual"]) for row in table["rows"]]
        self.assertEqual(sizes, sorted(sizes, reverse=True))
        self.assertNotIn("residual_over_sd", table["rows"][0])
        self.assertNotIn("mark", table["rows"][0])
        figures, _ = self.figures()
        self.assertEqual([field["label"] for field in figures["residuals"]["fields"]], ["residual of deviation_z"])

    def test_values_that_nothing_checks(self):
        """As many values as fitted numbers: each is followed, and is marked so."""
        text = (self.folder / "delta-measured.toml").read_text()
        self.write("study.toml", text.replace('"radius", "side_1", "side_2", "rods"]', '"radius"]').split("[analysis.calibration.c")[0]
                   .replace("next       = 5", "next = 0"))
        rows = [",".join(row.split(",")[1:5]) for row in (self.folder / "delta-heights.csv").read_text().splitlines()][:5]
        self.write("m.csv", "\n".join(rows) + "\n")
        self.calibrate("study.toml", "m.csv")
        table = self.table("residuals")
        self.assertEqual([row["mark"] for row in table["rows"]], ["unchecked"] * 4)
        self.assertIn("unchecked: no other value checks this one", table["notes"])

    def test_a_row_that_is_not_there(self):
        self.calibrate()
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file["calibration/value_to"][3] = 13
        self.assertIn("a value of an unknown row", self.poesy("show", "r.h5").stderr.decode())


if __name__ == "__main__":
    main()
