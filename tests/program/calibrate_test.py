"""`poesy calibrate` against numbers that another program computed (tests/data/calibration.json)."""

import json
import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
FILES = DATA / "calibration"
EXPECTED = json.loads((DATA / "calibration.json").read_text())
DELTA = EXPECTED["delta"]
HEXAPOD = EXPECTED["hexapod"]
LENGTHS = slice(3, 6)  # of the components of a displacement


def numbers(values):
    """A list of the file, in which null means: not determined."""
    return np.array(values, dtype=float)


class Calibrate(ProgramTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def calibrated(self, study, measured, change=()):
        """The result for a study of which these texts are replaced."""
        text = (self.folder / study).read_text()
        for old, new in change:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("study.toml", text)
        done = self.poesy("calibrate", "study.toml", "--measured", measured, "-o", "r.h5")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        with h5py.File(self.folder / "r.h5") as file:
            names = [name.decode() for name in file["fitted"][:]]
            found = {path: value[()] for path, value in self.datasets(file["calibration"])}
        (self.folder / "r.h5").unlink()
        return names, found, done

    @staticmethod
    def datasets(group):
        list_of = []
        group.visititems(lambda path, value: list_of.append((path, value)) if isinstance(value, h5py.Dataset) else None)
        return list_of

    def compare(self, names, found, expected, *, of_estimate, of_sd=1e-6):
        """All numbers of one case. of_estimate: m or rad. of_sd: relative."""
        self.assertEqual(sorted(names), sorted(expected["names"]))
        place = [names.index(name) for name in expected["names"]]  # the file lists errors in an order of its own
        found = dict(found)
        for key in ("estimate", "sd", "low", "high"):
            found[key] = found[key][place]
        for key in ("correlation", "null_projector"):
            found[key] = found[key][np.ix_(place, place)]
        np.testing.assert_allclose(found["estimate"], numbers(expected["theta"]), rtol=0, atol=of_estimate)
        frame = numbers(expected["frame"])
        if frame.size == 6:
            frame = np.roll(frame, 3)  # there the rotation comes first
        np.testing.assert_allclose(found["frame"], frame, rtol=0, atol=3 * of_estimate)
        np.testing.assert_allclose(found["sd"], numbers(expected["sd"]), rtol=of_sd)
        for key in ("low", "high"):
            np.testing.assert_allclose(found[key], numbers(expected[key]), rtol=of_sd, atol=2 * of_estimate)
        for key in ("rank", "frame_rank", "dof", "below_noise"):
            self.assertEqual(found[key], expected[key], key)
        seen = int(expected["rank"])
        np.testing.assert_allclose(found["singular_values"][:seen], expected["singular_values"][:seen], rtol=of_sd)
        np.testing.assert_allclose(found["residual"], expected["residual"], rtol=0, atol=3 * of_estimate)
        np.testing.assert_allclose(found["leverage"], expected["leverage"], rtol=0, atol=of_sd)
        for key, name in (("chi2", "chi_square"), ("rms", "rms"), ("p", "p")):
            np.testing.assert_allclose(found[name], expected[key], rtol=1e-5, atol=1e-9, err_msg=key)
        for key, value in expected["indices"].items():
            np.testing.assert_allclose(found[key], value, rtol=of_sd, err_msg=key)
        if "correlation" in expected:
            known = ~np.isnan(numbers(expected["sd"]))
            np.testing.assert_allclose(found["correlation"][np.ix_(known, known)],
                                       numbers(expected["correlation"])[np.ix_(known, known)], rtol=0, atol=of_sd)

    def compare_prediction(self, found, expected):
        """What is left, the controller and the next poses of a case of the printer."""
        np.testing.assert_allclose(found["left/drive_shift"], expected["drive_shift"], rtol=0, atol=1e-11)
        np.testing.assert_allclose(found["left/mean"][:, LENGTHS], expected["left"]["mean"], rtol=0, atol=1e-12)
        np.testing.assert_allclose(found["left/sd"][:, LENGTHS], expected["left"]["sd"], rtol=1e-6)
        np.testing.assert_allclose(found["controller/value"], expected["controller"]["value"], rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(found["controller/sd"], expected["controller"]["sd"], rtol=1e-5)
        np.testing.assert_array_equal(found["next/candidate"], expected["next"]["candidate"])
        np.testing.assert_allclose(found["next/gain"], expected["next"]["gain_bits"], rtol=1e-5)

    def test_printer_by_least_squares(self):
        expected = DELTA["measured"]["cases"]["least squares"]
        names, found, done = self.calibrated("delta-measured.toml", "delta-heights.csv")
        self.compare(names, found, expected, of_estimate=1e-12)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)
        np.testing.assert_allclose(found["outlier_limit"], expected["outlier_limit"], rtol=1e-10)
        self.compare_prediction(found, expected)
        self.assertEqual(done.stderr, b"")

    def test_printer_with_estimated_noise(self):
        expected = DELTA["measured"]["cases"]["least squares, sd estimated"]
        names, found, _ = self.calibrated("delta-measured.toml", "delta-heights.csv", [("next  ", 'sd = "estimated"\nnext  ')])
        self.compare(names, found, expected, of_estimate=1e-12)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)

    def test_printer_with_prior(self):
        expected = DELTA["measured"]["cases"]["tolerances as prior"]
        names, found, _ = self.calibrated("delta-measured.toml", "delta-heights.csv",
                                          [("next  ", 'prior = "tolerances"\nnext  ')])
        self.compare(names, found, expected, of_estimate=1e-12)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)
        self.compare_prediction(found, expected)

    def test_outlier(self):
        expected = DELTA["measured"]["cases"]["least squares, the sixth height 80 um too high"]
        text = (self.folder / "delta-heights.csv").read_text()
        self.write("wrong.csv", text.replace("-51.962,0,-72.8,", "-51.962,0,7.2,"))
        names, found, done = self.calibrated("delta-measured.toml", "wrong.csv")
        self.compare(names, found, expected, of_estimate=1e-12)
        self.compare_prediction(found, expected)
        self.assertEqual(list(np.flatnonzero(found["outlier"])), [4, 5])
        self.assertIn("residual 1.46 of the noise, p = 0.0001: deviation_z of p5 is 4.6 standard deviations off",
                      done.stderr.decode())

    def heights(self, true_errors, extra=""):
        """The heights that a machine with these errors has at the 13 places, as `poesy evaluate` solves it."""
        study = (self.folder / "delta-measured.toml").read_text().split("[analysis]")[0]
        self.write("evaluate.toml", study)
        rows = (self.folder / "delta-heights.csv").read_text().splitlines()
        poses = [row.split(",")[1:4] for row in rows]
        self.write("p.csv", "\n".join(",".join(pose) for pose in poses) + "\n")
        self.write("e.csv", ",".join(DELTA["errors"]) + "\n" + ",".join(map(repr, true_errors)) + "\n")
        self.succeeds("evaluate", "evaluate.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as file:
            moved = {key: file[f"evaluate/{key}"][:].ravel() for key in ("x", "y", "z")}
        nominal = np.array([[float(number) for number in pose] for pose in poses[1:]]) * 1e-3
        return nominal, moved

    def test_heights_alone(self):
        """Without noise, but weighed as if it were there: four numbers of 13 that no fit of seven explains."""
        expected = DELTA["measured"]["cases"]["heights alone, 13, without noise"]
        nominal, moved = self.heights(DELTA["measured"]["true_errors"])
        rows = [f"{x!r},{y!r},{z!r},{dz!r}" for (x, y, z), dz in zip(nominal.tolist(), moved["z"].tolist())]
        self.write("m.csv", "\n".join(["x,y,z,deviation_z", *rows]) + "\n")
        names, found, _ = self.calibrated("delta-measured.toml", "m.csv", [("next       = 5", "next = 0")])
        self.compare(names, found, expected, of_estimate=1e-12)

    def test_heights_over_an_unknown_plane(self):
        case = "heights over an unknown plane (0.2 mm, 1 mrad, -0.5 mrad), without noise"
        expected = DELTA["measured"]["cases"][case]
        nominal, moved = self.heights(DELTA["measured"]["true_errors"])
        actual = nominal + np.stack([moved[key] for key in ("x", "y", "z")], axis=1)
        seen = moved["z"] - (0.2e-3 + 1e-3 * actual[:, 0] - 0.5e-3 * actual[:, 1])
        rows = [f"{x!r},{y!r},{z!r},{dz!r}" for (x, y, z), dz in zip(nominal.tolist(), seen.tolist())]
        self.write("m.csv", "\n".join(["x,y,z,deviation_z", *rows]) + "\n")
        names, found, done = self.calibrated("delta-measured.toml", "m.csv",
                                             [("next       = 5", 'frame = "plane"\nnext = 0')])
        self.compare(names, found, expected, of_estimate=5e-12)
        np.testing.assert_allclose(found["null_projector"], expected["null_projector_scaled"], rtol=0, atol=1e-7)
        self.assertIn("zero_1, zero_2, zero_3: no measurement tells them apart", " ".join(done.stdout.decode().split()))

    def hexapod(self, case, file, change=(), **tolerances):
        expected = HEXAPOD["cases"][case]
        rows = [",".join(map(repr, pose)) for pose in HEXAPOD["remaining_at"]]
        self.write("places.csv", "x,y,z,rx,ry,rz\n" + "\n".join(rows) + "\n")
        poses = ('[analysis.calibration]', 'poses = { select = "file", file = "places.csv" }\n[analysis.calibration]')
        names, found, done = self.calibrated("hexapod-measured.toml", file, [poses, *change])
        self.compare(names, found, expected, **tolerances)
        return expected, found, done

    def test_hexapod(self):
        least_squares = [('prior = "tolerances"', 'prior = "none"')]
        for case, change, of_estimate in (("known frame, tolerances as prior", [], 7e-12),
                                          ("known frame, least squares", least_squares, 7e-10)):
            with self.subTest(case):
                expected, found, _ = self.hexapod(case, "hexapod-poses.csv", change, of_estimate=of_estimate)
                np.testing.assert_allclose(found["left/drive_shift"], expected["drive_shift"], rtol=0, atol=of_estimate)
                np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=0, atol=1e-4)

    def test_hexapod_in_a_frame_of_the_device(self):
        frame = ('frame = "known"', 'frame = "rigid"')
        for case, change, of_estimate in (
                ("own frame, tolerances as prior", [frame], 1e-11),
                ("own frame, least squares", [frame, ('prior = "tolerances"', 'prior = "none"')], 1e-8)):
            with self.subTest(case):
                self.hexapod(case, "hexapod-poses-own-frame.csv", change, of_estimate=of_estimate)

    def test_files_of_a_result(self):
        """The result is intact, shown and exported, and the same measurements give the same content."""
        hashes = []
        for name in ("a.h5", "b.h5"):
            self.succeeds("calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", name)
            with h5py.File(self.folder / name) as file:
                hashes.append(file.attrs["content_sha256"])
                self.assertEqual(file["calibration/file_text"][()].decode(), (FILES / "delta-heights.csv").read_text())
        self.assertEqual(*hashes)
        self.succeeds("verify", "a.h5")
        self.succeeds("show", "a.h5")
        shown = json.loads(self.poesy("show", "a.h5", "--json").stdout)
        self.assertIn("fitted", json.dumps(shown))
        self.succeeds("report", "a.h5", "-o", "a.html")
        self.succeeds("export", "a.h5", "-d", "tables")
        for table, lines in (("estimates", 8), ("residuals", 16), ("correlation", 8), ("left", 8), ("next", 6),
                             ("controller", 5)):
            self.assertEqual(len((self.folder / "tables" / f"{table}.csv").read_text().splitlines()), lines, table)

    def test_present_corrections(self):
        """A controller that already corrects the estimates measures nothing but noise, and the totals stay what they are."""
        first = self.calibrated("hexapod-measured.toml", "hexapod-poses.csv")
        estimate = dict(zip(first[0], first[1]["estimate"].tolist()))
        header, *rows = (self.folder / "hexapod-poses.csv").read_text().splitlines()
        fitted = first[1]["measured"] - first[1]["residual"]
        self.assertGreater(np.abs(fitted).max(), 1e-4)
        zero = [",".join([*row.split(",")[:6], *("0" for _ in range(6))]) for row in rows]
        self.write("zero.csv", "\n".join([header, *zero]) + "\n")
        present = "present = { " + ", ".join(f'{name} = "{value!r} m"' for name, value in estimate.items()) + " }"
        names, found, _ = self.calibrated("hexapod-measured.toml", "zero.csv",
                                          [("frame ", present + "\nframe "), ('"tolerances" ', '"none" ')])
        # Heights and angles of six freedoms are right where the controller has the errors that the machine has.
        np.testing.assert_allclose(found["residual"], 0.0, atol=1e-11)
        np.testing.assert_allclose(found["estimate"], [estimate[name] for name in names], rtol=0, atol=2e-8)

    def test_no_noise(self):
        """All noise 0: equal weights, the same estimates as with equal noise, and no intervals."""
        text = (self.folder / "delta-heights.csv").read_text()
        heights = [",".join(row.split(",")[1:5]) for row in text.splitlines()]
        self.write("m.csv", "\n".join(heights) + "\n")
        changes = [("next       = 5", "next = 0")]
        _, equal, _ = self.calibrated("delta-measured.toml", "m.csv", changes)
        _, none, done = self.calibrated("delta-measured.toml", "m.csv",
                                        [*changes, ('z = "10 um", distance = "50 um"', "z = 0")])
        np.testing.assert_allclose(none["estimate"], equal["estimate"], rtol=0, atol=1e-9)
        self.assertTrue(np.isnan(none["sd"]).all())
        self.assertIn("the noise is 0", done.stdout.decode())


if __name__ == "__main__":
    main()
