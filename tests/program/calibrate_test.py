"""Compares `poesy calibrate` with numbers that another program computed (tests/data/calibration.json)."""

import json
import os
import re
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
LENGTHS = slice(3, 6)  # the translations in a displacement


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
        place = [names.index(name) for name in expected["names"]]  # the file has another order of errors
        found = dict(found)
        for key in ("estimate", "sd", "low", "high"):
            found[key] = found[key][place]
        for key in ("correlation", "null_projector"):
            found[key] = found[key][np.ix_(place, place)]
        np.testing.assert_allclose(found["estimate"], numbers(expected["theta"]), rtol=0, atol=of_estimate)
        frame = numbers(expected["frame"])
        if frame.size == 6:
            frame = np.roll(frame, 3)  # the expected numbers begin with the rotation
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

    def test_report_answers_with_the_fitted_values(self):
        self.succeeds("calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "machine.h5")
        self.succeeds("report", "machine.h5", "-o", "machine.html")
        page = " ".join((self.folder / "machine.html").read_text().split())
        self.assertRegex(page, r"Fitted: zero_1 \u22120\.4571 \u00b1 [0-9.]+ mm, zero_2 0\.09166 \u00b1 [0-9.]+ mm,")
        self.assertRegex(page, r"and 1 more \(95 % intervals\); left at the 7 poses, predicted: x 0\.2078 mm")
        self.assertRegex(page, r"position 0\.346\d* mm \(root mean square\)")
        self.assertIn("File delta-heights.csv: ", page)
        for said in ("1 of 7 directions is below the noise", "5 more errors have a tolerance and are not fitted",
                     "measure at the first of the poses to measure next"):
            self.assertIn(said, page.split("What is measured")[1])
        self.assertIn("calibration of delta-puu: 7 fitted errors, 7 poses", page)

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
        self.assertIn("First find out why the outlier is so far off: the fitted values rest on it. Then give the "
                      "controller the fitted values", self.page_of("delta-measured.toml", "wrong.csv"))

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

    def test_seven_numbers_of_a_printer_of_six_rods(self):
        """13 heights, each known to 2 um, are fitted as well as they are known; and it is said that the length of the rods
        is hardly told from the end stops."""
        moved = {}  # each error per unit of each fitted number, in base axes
        for k, (end_stop, turn) in enumerate(zip("abc", ("turn_a", "turn_b", None))):
            c, s = np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3)
            for rod in (k + 1, k + 4):
                moved[f"endstop_{rod}"] = {f"stop_{end_stop}": 1.0}
                moved[f"rod_{rod}"] = {"rods": 1.0}
                moved[f"tower_x_{rod}"] = {"radius": c, turn: -s}
                moved[f"tower_y_{rod}"] = {"radius": s, turn: c}
        true = dict(stop_a=3e-4, stop_b=-2e-4, stop_c=1e-4, radius=4e-4, turn_a=0.65e-3, turn_b=-0.44e-3, rods=5e-4)
        errors = {error: sum(factor * true.get(name, 0.0) for name, factor in by.items()) for error, by in moved.items()}
        factors = [f'combinations.{name} = {{ '
                   + ", ".join(f"{error} = {float(by[name])!r}" for error, by in moved.items() if abs(by.get(name, 0.0)) > 1e-12)
                   + " }" for name in true]
        head = 'format = "poesy-study"\nversion = 1\nmechanism.file = "delta-six-rods.toml"\n'
        self.write("evaluate.toml", head)
        self.write("study.toml", head + "[analysis.calibration]\nfit = [" + ", ".join(f'"{name}"' for name in true)
                   + ']\nnoise = { z = "2 um" }\n' + "\n".join(factors) + "\n")
        around = np.radians(np.arange(6) * 60.0)
        places = np.array([(0.0, 0.0), *((0.06 * np.cos(a), 0.06 * np.sin(a)) for a in around),
                           *((0.03 * np.cos(a), 0.03 * np.sin(a)) for a in around + np.pi / 6)]).tolist()
        self.write("p.csv", "x,y,z,rx,ry,rz\n" + "".join(f"{x!r},{y!r},0,0,0,0\n" for x, y in places))
        self.write("e.csv", ",".join(errors) + "\n" + ",".join(map(repr, map(float, errors.values()))) + "\n")
        self.succeeds("evaluate", "evaluate.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as file:
            z = file["evaluate/z"][:].ravel() + np.random.default_rng(1).normal(0.0, 2e-6, len(places))
        self.write("m.csv", "x,y,z,rx,ry,rz,deviation_z\n" + "".join(
            f"{x!r},{y!r},0,0,0,0,{height!r}\n" for (x, y), height in zip(places, z.tolist())))
        done = self.poesy("calibrate", "study.toml", "--measured", "m.csv", "-o", "r.h5")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        with h5py.File(self.folder / "r.h5") as file:
            names = [name.decode() for name in file["fitted"][:]]
            found = file["calibration"]
            # Bounds of 7 standard normal numbers, and of chi-square with 6 degrees of freedom: alpha = 1e-6 each.
            off = (found["estimate"][:] - [true[name] for name in names]) / found["sd"][:]
            self.assertLess(np.abs(off).max(), 4.9)
            self.assertEqual(found["dof"][()], 6)
            self.assertLess(found["chi_square"][()], 38.3)
            self.assertGreater(found["condition"][()], 500)
            self.assertGreater(found["sd"][names.index("rods")], 1e-4)
        shown = " ".join(done.stdout.decode().split())
        self.assertIn("stop_a, stop_b, stop_c, radius, rods move together", shown)

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
        shown = self.succeeds("show", "a.h5")
        solves = int(re.search(r"\n([\d ]+) solves in", shown)[1].replace(" ", ""))
        self.assertGreater(solves, 7 * 1000)  # the limits alone need 1000 machines at 7 poses
        self.assertNotIn("converge", shown)
        shown = json.loads(self.poesy("show", "a.h5", "--json").stdout)
        self.assertIn("fitted", json.dumps(shown))
        self.succeeds("report", "a.h5", "-o", "a.html")
        self.succeeds("export", "a.h5", "-d", "tables")
        for table, lines in (("estimates", 8), ("residuals", 16), ("correlation", 8), ("left", 8), ("next", 6),
                             ("controller", 5)):
            self.assertEqual(len((self.folder / "tables" / f"{table}.csv").read_text().splitlines()), lines, table)

    def page_of(self, study, measured):
        """The report on these measurements, in one line."""
        self.succeeds("calibrate", study, "--measured", measured, "-o", "page.h5")
        self.succeeds("report", "page.h5", "-o", "page.html")
        return " ".join((self.folder / "page.html").read_text().split())

    def said_of(self, changes=(), measured="delta-heights.csv", code=0):
        """What is said on stderr of the printer, and its code."""
        text = (self.folder / "delta-measured.toml").read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("study.toml", text)
        done = self.poesy("calibrate", "study.toml", "--measured", measured)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done.stderr.decode()

    def test_contradictions_are_said(self):
        """Residuals that the noise does not explain, of which none is an outlier; then errors larger than they should be."""
        noise = 'noise = { z = "10 um", distance = "50 um" }'
        said = self.said_of([(noise, 'noise = { z = "6.25 um", distance = "31.25 um" }')])
        self.assertRegex(said, r"residual 1\.33 of the noise, p = 0\.0009: the fitted errors do not explain the "
                               r"measurements; intervals are too narrow")
        said = self.said_of([("next       = 5", 'prior = "tolerances"\nnext = 0'), ('sigma = "0.3 mm"', 'sigma = "0.12 mm"')])
        self.assertRegex(said, r"estimates are far outside their tolerances \(S = 52\.8 of 15\): are these the sigmas\?")
        said = self.said_of([(noise, 'noise = { z = "10 mm", distance = "50 mm" }')])
        self.assertIn("the stated noise is larger than the scatter of the measurements, so intervals are too wide", said)
        self.assertEqual(self.said_of(), "")

    def test_a_fit_that_ends_nowhere(self):
        """Heights that change their sign from place to place, up to 26 mm: the result is kept, and is not to be used."""
        header, *rows = (self.folder / "delta-heights.csv").read_text().splitlines()
        changed = [row.split(",") for row in rows]
        for at, row in enumerate(changed):
            row[4] = row[4] and repr(50.0 * float(row[4]) * (-1) ** at)
        self.write("far.csv", "\n".join([header, *(",".join(row) for row in changed)]) + "\n")
        done = self.poesy("calibrate", "delta-measured.toml", "--measured", "far.csv", "-o", "far.h5")
        self.assertEqual(done.returncode, 5, done.stderr.decode())
        self.assertIn("far.csv: the fit did not converge, so no number of it is to be used or typed in; look at the units",
                      done.stderr.decode())
        self.assertNotIn("measure it again", done.stderr.decode())
        self.succeeds("verify", "far.h5")
        for words in ((done.stdout.decode(),), ("show", "far.h5"), ("show", "far.h5", "--method")):
            shown = words[0] if len(words) == 1 else self.succeeds(*words)
            self.assertIn("the fit did not converge", shown.lower().replace("\n", " "))
            for said in ("to type in", "left at the", "measure it again"):
                self.assertNotIn(said, shown)
        self.succeeds("report", "far.h5", "-o", "far.html")
        page = (self.folder / "far.html").read_text()
        self.assertIn("The fit did not converge, so no number of it is to be used or typed in.", page)
        self.assertNotIn("ive the controller the fitted values", page)

    def test_deviations_larger_than_the_mechanism(self):
        """Micrometres that are read as metres: the column is doubted, and its first number is refused before any fit."""
        text = (self.folder / "delta-heights.csv").read_text()
        self.write("bare.csv", text.replace("deviation_z [um]", "deviation_z"))
        said = self.said_of(measured="bare.csv", code=2)
        self.assertIn("bare.csv: deviation_z has no unit, so its numbers are in m: one is -240", said)
        self.assertIn("name their unit in the first line, e.g. 'deviation_z [mm]'", said)
        self.assertIn("bare.csv:2:1: deviation_z of p0 is -2.4e+05 mm, which is more than a tenth of", said)

    def test_numbers_without_a_unit_are_doubted(self):
        header, *rows = (self.folder / "delta-heights.csv").read_text().splitlines()
        for old, new, doubt in (("distance [mm]", "distance", "distance has no unit, so its numbers are in m: one is 119"),
                                ("deviation_z [um]", "actual_z", "actual_z has no unit"),
                                ("to,", "sd_z,", "sd_z has no unit")):
            with self.subTest(old):
                changed = rows
                if old == "to,":
                    changed = [",".join([*row.split(",")[:5], "10"]) for row in rows]
                    header_now = "name,x [mm],y [mm],z [mm],deviation_z [um],sd_z"
                else:
                    header_now = header.replace(old, new)
                self.write("bare.csv", "\n".join([header_now, *changed]) + "\n")
                self.write("study.toml", (self.folder / "delta-measured.toml").read_text())
                done = self.poesy("calibrate", "study.toml", "--measured", "bare.csv")
                self.assertIn("bare.csv: " + doubt, done.stderr.decode())

    def test_over_constrained_limbs_are_named(self):
        shutil.copyfile(DATA / "mechanisms" / "upr2-rpu.toml", self.folder / "upr2-rpu.toml")
        self.write("study.toml", 'format = "poesy-study"\nversion = 1\nmechanism.file = "upr2-rpu.toml"\n'
                                 'solver.metric = "platform"\n[analysis.calibration]\nfit = ["delta_1_0_z", "delta_2_0_z"]\n'
                                 'noise = { x = "5 um", y = "5 um", z = "5 um" }\n')
        self.write("m.csv", "z [mm],beta [deg],gamma [deg],deviation_x [um],deviation_y [um],deviation_z [um]\n"
                            "-220,0,0,3,-2,10\n-220,10,0,1,2,12\n-250,0,-10,0,1,8\n")
        done = self.poesy("calibrate", "study.toml", "--measured", "m.csv")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        self.assertIn("limbs over-constrain each other", done.stderr.decode())

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
        # A controller that has the machine's errors reaches every commanded pose exactly.
        np.testing.assert_allclose(found["residual"], 0.0, atol=1e-11)
        np.testing.assert_allclose(found["estimate"], [estimate[name] for name in names], rtol=0, atol=2e-8)

    def test_any_number_of_threads(self):
        """Poses and candidates are solved by several threads, in the order of the poses: the same bits."""
        hashes = set()
        for threads in (1, 2, 5):
            self.succeeds("calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "t.h5", "--threads",
                          threads)
            with h5py.File(self.folder / "t.h5") as file:
                hashes.add(file.attrs["content_sha256"])
                self.assertEqual(file["run/threads"][()], threads)
        self.assertEqual(len(hashes), 1)

    def test_numbers_that_the_controller_had(self):
        """What is typed in goes from the value with the present corrections to the new one."""
        _, without, done = self.calibrated("delta-measured.toml", "delta-heights.csv")
        np.testing.assert_array_equal(without["controller/present"], without["controller/nominal"])
        self.assertIn("delta_radius 95.0000 -> 95.1139", " ".join(done.stdout.decode().split()))
        present = 'present = { radius = "0.25 mm", rods = "-0.1 mm" }\nnext = 5'
        names, found, done = self.calibrated("delta-measured.toml", "delta-heights.csv", [("next       = 5", present)])
        shown = " ".join(done.stdout.decode().split())
        np.testing.assert_array_equal(found["controller/nominal"], without["controller/nominal"])
        np.testing.assert_allclose(found["controller/present"][:2], without["controller/nominal"][:2] + [-0.1e-3, 0.25e-3],
                                   rtol=0, atol=1e-15)
        radius = 95e-3 + found["estimate"][names.index("radius")]
        self.assertIn(f"delta_radius 95.2500 -> {1e3 * radius:.4f}", shown)
        self.assertIn("diagonal_rod 216.9000 -> ", shown)

    def test_combinations_by_patterns(self):
        """A pattern gives all errors that it matches one weight, of which a later key may change some: the same bits."""
        _, named, _ = self.calibrated("delta-measured.toml", "delta-heights.csv")
        patterns = [("{ foot_x_1 = 1, foot_x_2 = 1, foot_x_3 = 1 }", '{ "foot_x_*" = 1 }'),
                    ("{ rod_1 = 1, rod_2 = 1, rod_3 = 1 }", '{ "rod_?" = 1 }')]
        _, by_pattern, _ = self.calibrated("delta-measured.toml", "delta-heights.csv", patterns)
        np.testing.assert_array_equal(by_pattern["estimate"], named["estimate"])
        weights = ("{ rod_1 = 1, rod_2 = 1, rod_3 = 1 }", '{ rod_1 = 2, rod_2 = 1, rod_3 = 1 }')
        _, named, _ = self.calibrated("delta-measured.toml", "delta-heights.csv", [weights])
        later = (weights[0], '{ "rod_*" = 1, rod_1 = 2 }')
        _, by_pattern, _ = self.calibrated("delta-measured.toml", "delta-heights.csv", [later])
        np.testing.assert_array_equal(by_pattern["estimate"], named["estimate"])

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
        page = self.page_of("study.toml", "m.csv")
        self.assertIn("5 more errors have a tolerance and are not fitted.", page)
        self.assertIn("measure more, so that the other errors can be fitted too.", page)
        for words in ("a good chi-square does not mean", "next = 5"):
            self.assertNotIn(words, page)


if __name__ == "__main__":
    main()
