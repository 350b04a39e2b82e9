"""Studies of calibrated machines, compared with yields that another program computed (tests/data/calibration.json)."""

import json
import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
FILES = DATA / "calibration"
YIELDS = json.loads((DATA / "calibration.json").read_text())["delta"]["yields"]
STUDY = (FILES / "delta-yield.toml").read_text()
FIT = 'fit      = ["zero_1", "zero_2", "zero_3", "radius"]'
NOISE = 'noise    = { z = "5 um" }'
COMBINATIONS = """
combinations.side_1 = { foot_y_1 = 1 }
combinations.side_2 = { foot_y_2 = 1 }
combinations.rods   = { rod_1 = 1, rod_2 = 1, rod_3 = 1 }
"""
MACHINES = 400
# Bound of a standard normal number: 28 comparisons of shares and root mean squares have alpha = 1e-5 together.
SIGMAS = 5.1


def with_calibration(fit, noise="5 um", more="", machines=MACHINES):
    """The study of the printer with another calibration."""
    names = ", ".join(f'"{name}"' for name in fit)
    text = STUDY.replace(FIT, f"fit = [{names}]").replace(NOISE, f'noise = {{ z = "{noise}" }}')
    return text.replace("samples = 20000", f"samples = {machines}") + COMBINATIONS + more


class CalibratedStudy(ProgramTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def ran(self, text, *options, output="r.h5", code=0):
        self.write("study.toml", text)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet", *options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def near_share(self, found, percent, machines, what):
        """A share of `machines` and one of 40 000, whose true value is the same."""
        share = percent / 100.0
        error = np.sqrt(max(share * (1.0 - share), 1.0 / machines) * (1.0 / machines + 1.0 / 40000))
        self.assertLess(abs(found - share), SIGMAS * error, what)

    def near_rms(self, found, expected, what):
        """A root mean square over the machines. Its relative standard error is at most 1/sqrt(2 n) for a normal number;
        beyond the first order, by which the other program found it, is less than 1 %."""
        self.assertLess(abs(found / expected - 1.0), SIGMAS / np.sqrt(2.0 * MACHINES) + 0.01, what)

    def test_yields(self):
        for one in YIELDS:
            if (len(one["fit"]), one["noise"]) not in ((3, 0.0), (4, 5e-6), (6, 5e-6), (7, 5e-6), (7, 2e-5)):
                continue  # not all, because each takes seconds
            what = f"{one['fit']} {one['noise']} {one['prior']}"
            with self.subTest(what):
                prior = f'prior = "{one["prior"]}"\n'
                self.ran(with_calibration(one["fit"], f"{1e6 * one['noise']} um", prior))
                with h5py.File(self.folder / "r.h5") as file:
                    names = [name.decode() for name in file["responses/name"][:]]
                    by_response = file["yield/by_response"][:]
                    rms = {name: file["monte_carlo/rms"][names.index(name)] for name in ("x", "y", "z")}
                    self.near_share(by_response[names.index("z")], one["yield_z"], MACHINES, what)
                    self.near_share(file["yield/value"][()], one["yield_both"], MACHINES, what)
                    self.assertEqual(file["yield/calibration/not_fitted"][()], 0)
                lateral = np.sqrt(np.mean(rms["x"] ** 2 + rms["y"] ** 2))
                self.near_rms(lateral, one["first_order_rms_lateral"], what)
                if one["first_order_rms_z"] > 1e-6:  # smaller values have noticeable second-order effects
                    self.near_rms(np.sqrt(np.mean(rms["z"] ** 2)), one["first_order_rms_z"], what)

    def test_three_yields_are_those_of_three_studies(self):
        """Without calibration and with the best correction: the same machines in studies of their own."""
        self.ran(with_calibration(["zero_*", "radius"], machines=200))
        with h5py.File(self.folder / "r.h5") as file:
            found = {name: file[f"yield/calibration/{name}"][()] for name in ("uncalibrated", "best", "fitted",
                                                                             "measured", "measured_poses")}
        plain = STUDY.split("[analysis.calibration]")[0].replace("20000", "200")
        for name, text in (("uncalibrated", plain),
                           ("best", plain.replace("[analysis]", "[analysis]\ncalibrated = true"))):
            self.ran(text, output="other.h5")
            with h5py.File(self.folder / "other.h5") as file:
                self.assertEqual(found[name], file["yield/value"][()], name)
        self.assertEqual((found["fitted"], found["measured"], found["measured_poses"]), (4, 7, 7))
        shown = " ".join(self.succeeds("show", "r.h5").split())
        self.assertIn("as they are made, without calibration", shown)
        self.assertIn("with this calibration: 4 fitted errors, 7 measured values at 7 poses", shown)
        self.assertIn("with the drives corrected at each pose, best for the platform's points 100", shown)
        self.assertIn("for another point, such as the tool, a calibration can be better", shown)
        self.assertRegex(" ".join(self.succeeds("show", "r.h5", "--method").split()),
                         r"Responses are what a calibration of each machine leaves \(fitted: \[zero_1, zero_2, zero_3, radius\]; "
                         r"measured: \[z\]; .*noise of z: 0.005 mm.*\)\.")
        self.succeeds("export", "r.h5", "-d", "out")
        self.assertIn("uncalibrated,uncalibrated_ci_low", (self.folder / "out/yield.csv").read_text())

    def test_points_away_from_the_limited_one_are_told(self):
        """calibrated = true is best for metric_points: a limit on the tool away from them is warned of."""
        plain = STUDY.split("[analysis.calibration]")[0].replace("20000", "20").replace("delta-puu.toml", "m.toml")
        mechanism = (self.folder / "delta-puu.toml").read_text()
        around = '[[0, 0, "-t"], ["4 mm", 0, "-t"], [0, "4 mm", "-t"]]'
        near = mechanism.replace('tool        = [0, 0, "-t"]', f'tool        = [0, 0, "-t"]\nmetric_points = {around}')
        self.assertNotEqual(near, mechanism)
        wide = near.replace("4 mm", "600 mm")
        asked = plain.split("limits")[0] + 'calibrated = true\nlimits = { RESPONSE = "1 mm" }\n'
        told = "put metric_points around the tool"
        for text, response, is_told in ((mechanism, "tip_position", True), (mechanism, "tip_z", True),
                                        (mechanism, "position", False), (near, "tip_position", False),
                                        (wide, "tip_position", True)):
            with self.subTest(response, is_told=is_told):
                self.write("m.toml", text)
                self.write("study.toml", asked.replace("RESPONSE", response))
                for command in (("check", "study.toml"), ("run", "study.toml", "-o", "r.h5", "--quiet")):
                    said = self.poesy(*command).stderr.decode()
                    self.assertEqual(told in said, is_told, said)
        self.write("m.toml", mechanism)
        self.write("study.toml", asked.replace("RESPONSE", "tip_position"))
        sweep = ("sweep", "study.toml", "--set", "geometry.t=70,80mm", "-o", "s.h5", "--quiet")
        swept = self.poesy(*sweep).stderr.decode()
        self.assertEqual(swept.count(told), 1, swept)
        self.write("m.toml", mechanism)
        self.write("study.toml", asked.replace("RESPONSE", "tip_position").replace("calibrated = true\n", ""))
        self.assertNotIn("metric_points", self.poesy("check", "study.toml").stderr.decode())

    def test_points_of_a_platform_with_six_freedoms_are_not_told(self):
        """The correction there leaves nothing at any point to first order."""
        mechanism = (self.folder / "hexapod.toml").read_text()
        away = mechanism.replace("[platform]\n", '[platform]\ntool = [0, 0, "h + 500 mm"]\n')
        self.assertNotEqual(away, mechanism)
        self.write("hexapod.toml", away)
        study = (FILES / "hexapod-measured.toml").read_text().split("[analysis.calibration]")[0]
        study += 'poses = { count = 2 }\n[analysis]\nkind = "monte-carlo"\ndraws = "per machine"\n'
        self.write("study.toml", study + 'samples = 20\ncalibrated = true\nlimits.tip_position = "1 mm"\n')
        done = self.poesy("check", "study.toml")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn(b"metric_points", done.stderr)

    def test_same_bits(self):
        """On threads and shards, after a stop, and as the continuation of a shorter study."""
        text = with_calibration(["zero_*", "radius"], machines=130)  # three units of 40 machines and a smaller one
        self.ran(text, "--threads", "1", output="one.h5")
        expected = self.content_hash("one.h5")
        self.ran(text, "--threads", "2", output="two.h5")
        self.assertEqual(self.content_hash("two.h5"), expected)
        for shard in ("1/2", "2/2"):
            self.ran(text, "--shard", shard, output=f"shard{shard[0]}.h5")
        self.succeeds("merge", "shard1.h5", "shard2.h5", "-o", "merged.h5")
        self.assertEqual(self.content_hash("merged.h5"), expected)
        self.ran(text, "--threads", "1", "--max-wall", "0.000001 s", output="stopped.h5", code=4)
        self.ran(text, "--resume", output="stopped.h5")
        self.assertEqual(self.content_hash("stopped.h5"), expected)
        self.ran(text.replace("samples = 130", "samples = 60"), "--keep-checkpoint", output="longer.h5")
        self.ran(text, "--resume", output="longer.h5")
        self.assertEqual(self.content_hash("longer.h5"), expected)
        self.ran(text.replace("5 um", "6 um"), output="other.h5")
        self.assertNotEqual(self.content_hash("other.h5"), expected)

    def test_errors_are_those_of_the_study_without_it(self):
        """Noise has streams of its own: with a fit of nothing that matters, machines are nearly as they are made."""
        text = with_calibration(["zero_1", "zero_2", "zero_3"], "5 um", 'prior = "tolerances"\n', machines=200)
        text = text.replace('noise = { z = "5 um" }', 'noise = { z = "1 m" }')  # useless measurements
        self.ran(text)
        self.ran(STUDY.split("[analysis.calibration]")[0].replace("20000", "200"), output="plain.h5")
        with h5py.File(self.folder / "r.h5") as file, h5py.File(self.folder / "plain.h5") as plain:
            difference = file["monte_carlo/std"][:] - plain["monte_carlo/std"][:]
            self.assertLess(np.nanmax(np.abs(difference)), 1e-6)
            self.assertGreater(np.nanmax(plain["monte_carlo/std"][:]), 1e-4)

    def test_full_poses_leave_their_noise(self):
        """Whoever fits all 42 errors of a hexapod to exact poses leaves nothing, and little by noise in an own frame."""
        study = (FILES / "hexapod-measured.toml").read_text().split("[analysis.calibration]")[0]
        study += ('poses = { count = 20 }\n[analysis]\nkind = "monte-carlo"\ndraws = "per machine"\nsamples = 12\n'
                  'limits.position = "1 um"\n[analysis.calibration]\nfit = "all"\nmeasured = ["pose"]\n')
        noise = "noise = {{ x = {0}, y = {0}, z = {0}, theta_x = {1}, theta_y = {1}, theta_z = {1} }}\n"
        tiny = noise.format('"0.1 um"', '"1e-4 mrad"')
        for more in ("", 'prior = "tolerances"\nframe = "rigid"\n'):
            with self.subTest(more):
                self.ran(study + tiny + more)
                with h5py.File(self.folder / "r.h5") as file:
                    self.assertEqual(file["yield/value"][()], 1.0)
                    self.assertLess(file["yield/calibration/uncalibrated"][()], 0.2)

    def test_case_of_four_factors(self):
        """What the users of a printer asked: 100 % where nothing is promised that no firmware does."""
        text = with_calibration(["zero_1", "zero_2", "zero_3", "radius"], "0 um")
        self.ran(text)
        with h5py.File(self.folder / "r.h5") as file:
            z = [name.decode() for name in file["responses/name"][:]].index("z")
            self.near_share(file["yield/by_response"][z], 47.8, MACHINES, "z")
            self.near_share(file["yield/value"][()], 5.2, MACHINES, "both")
            self.assertEqual(file["yield/calibration/best"][()], 1.0)

    def test_check_says_what_it_costs(self):
        self.write("study.toml", with_calibration(["zero_*", "radius"]))
        said = self.succeeds("check", "study.toml")
        self.assertIn("to fit 4 errors to 7 values at 7 poses", said)
        self.assertIn("calibrated: zero_1, zero_2, zero_3, radius of each machine are fitted to measured z", said)
        self.assertIn("[analysis.calibration]", said)

    def test_refusals(self):
        four = ["zero_1", "zero_2", "zero_3", "radius"]
        seven = [*four, "side_1", "side_2", "rods"]
        place = 'poses = { select = "file", file = "few.csv" }\n'
        refused = [
            (with_calibration(four).replace('"per machine"', '"per pose"'), ":13:1", 'set draws = "per machine"'),
            (with_calibration(four).replace('measured = ["z"]', ""), ":13:1", "does not say what is measured"),
            (with_calibration(four, more='pairs = [[0, 1]]\n'), ":", "has no \"distance\""),
            (with_calibration(four).replace('["z"]', '["z", "distance"]').replace('z = "5 um"', 'z = "5 um", distance = "5 um"'),
             ":", "pairs names no poses"),
            (with_calibration(four, more='pairs = [[0, 7]]\n').replace('["z"]', '["z", "distance"]').replace(
                'z = "5 um"', 'z = "5 um", distance = "5 um"'), ":", "names pose 7, but 7 poses are measured"),
            (with_calibration(seven, more=place), ":", "7 fitted errors and 3 measured values"),
            (with_calibration(four, more='frame = "plane"\n'), ":",
             "zero_1, zero_2, zero_3: the measurements do not tell them apart (zero_1 + zero_2 + zero_3); fit fewer"),
            (with_calibration(four, more='poses = { select = "file", file = "axis.csv" }\n'), ":",
             "zero_1, zero_2, zero_3, radius: the measurements do not tell them apart (3 directions); fit fewer"),
            (with_calibration(four, more='frame = "height"\n'), ":",
             "zero_1, zero_2, zero_3: the measurements do not tell them apart (zero_1 + zero_2 + zero_3); fit fewer"),
            (with_calibration(["zero_1", "slide"], more="combinations.slide = { foot_y_1 = 1 }\n" + place).replace(
                '"few.csv"', '"middle.csv"'), ":", "changes nothing that is measured"),
            (with_calibration(four).replace('["z"]', '["z", "theta_x"]').replace('z = "5 um"', 'z = 0, theta_x = 0'), ":",
             "noise is 0 and values have lengths and angles: say how they are weighed"),
            (with_calibration(four).replace('["z"]', '["z", "x"]').replace('z = "5 um"', 'z = 0, x = "1 um"'), ":",
             "some values have noise 0"),
            (with_calibration(four, "0 um", 'prior = "tolerances"\n'), ":", "noise is 0, so nothing can be weighed"),
            (with_calibration(four).replace("errors.linear", 'errors.override.rod_1 = { draws = "per pose" }\nerrors.linear'),
             ":", "'rod_1' is drawn anew at each pose"),
        ]
        self.write("few.csv", "x [mm],y [mm],z [mm]\n0,0,0\n50,0,0\n0,50,0\n")
        self.write("axis.csv", "x [mm],y [mm],z [mm]\n" + "".join(f"0,0,{z}\n" for z in range(4)))
        self.write("middle.csv", "x [mm],y [mm],z [mm]\n0,0,0\n0,0,10\n")
        for text, where, message in refused:
            for command in ("run", "check"):
                with self.subTest(f"{command}: {message}"):
                    self.write("study.toml", text)
                    done = self.poesy(command, "study.toml")
                    said = done.stderr.decode()
                    self.assertEqual(done.returncode, 2, said)
                    self.assertIn(message, said)
                    self.assertRegex(said, r"study\.toml" + where + r"[\d:]*: .*; ")
                    self.assertFalse((self.folder / "study.h5").exists())

    def evaluated(self, cases, calibration):
        """x, y, z of cases of errors at the places, [cases x places x 3]."""
        text = STUDY.split("[analysis]")[0].replace("errors.linear", "# errors.linear") + '[analysis]\nkind = "evaluate"\n'
        text += calibration
        for number, errors in enumerate(cases):
            listed = ", ".join(f'{name} = "{value!r} mm"' for name, value in errors.items())
            text += f'[[analysis.cases]]\nname = "case {number}"\nerrors = {{ {listed} }}\n'
        self.ran(text, output="cases.h5")
        with h5py.File(self.folder / "cases.h5") as file:
            return np.stack([file[f"evaluate/{name}"][:] for name in ("x", "y", "z")], axis=-1)

    def test_cases_are_calibrated_without_noise(self):
        """What is left is the displacement less that of the fitted numbers, which follow from heights by least squares: to
        first order, from cases of single errors. Errors of 0.1 mm leave a thousandth of them for the second order."""
        fit = {"zero_1": ["zero_1"], "zero_2": ["zero_2"], "zero_3": ["zero_3"], "radius": ["foot_x_1", "foot_x_2", "foot_x_3"]}
        drawn = np.random.default_rng(4).normal(0.0, 0.1, (3, 12))
        names = [f"{kind}_{limb}" for kind in ("foot_x", "foot_y", "zero", "rod") for limb in (1, 2, 3)]
        machines = [dict(zip(names, map(float, row))) for row in drawn]
        made = self.evaluated(machines, "")
        by_number = 1e3 * self.evaluated([{name: 0.001 for name in errors} for errors in fit.values()], "")  # m per mm
        table = '[analysis.calibration]\nfit = ["zero_*", "radius"]\nmeasured = ["z"]\nnoise = { z = "5 um" }\n'
        table += "combinations.radius = { foot_x_1 = 1, foot_x_2 = 1, foot_x_3 = 1 }\n"
        left = self.evaluated(machines, table)
        for machine in range(3):
            numbers = np.linalg.lstsq(by_number[:, :, 2].T, made[machine, :, 2], rcond=None)[0]
            expected = made[machine] - np.tensordot(numbers, by_number, 1)
            np.testing.assert_allclose(left[machine], expected, rtol=0, atol=0.5e-6)
        self.assertGreater(np.abs(made[:, :, 2]).max(), 5e-5)
        self.assertLess(np.abs(left[:, :, 2]).max(), 0.4 * np.abs(made[:, :, 2]).max())
        shown = " ".join(self.succeeds("show", "cases.h5").split())
        self.assertIn("calibrated: zero_1, zero_2, zero_3, radius of each machine are fitted", shown)
        done = self.poesy("replay", "cases.h5", "case 0", "0", "0")
        self.assertEqual(done.returncode, 2)
        self.assertIn("its machines are calibrated", done.stderr.decode())

    def test_cases_have_the_same_bits(self):
        """On threads and shards."""
        text = STUDY.split("[analysis]")[0] + '[analysis]\nkind = "evaluate"\n[analysis.calibration]\nfit = ["zero_*"]\n'
        text += 'measured = ["z"]\nnoise = { z = "5 um" }\n'
        text += "".join(f'[[analysis.cases]]\nerrors = {{ linear = "0.{n} mm" }}\n' for n in (1, 2))
        self.ran(text, "--threads", "1", output="one.h5")
        self.ran(text, "--threads", "2", output="two.h5")
        for shard in ("1/2", "2/2"):
            self.ran(text, "--shard", shard, output=f"shard{shard[0]}.h5")
        self.succeeds("merge", "shard1.h5", "shard2.h5", "-o", "merged.h5")
        self.assertEqual(len({self.content_hash(name) for name in ("one.h5", "two.h5", "merged.h5")}), 1)

    def test_templates_offer_it(self):
        """As a comment, which makes a study that is valid."""
        for kind in ("monte-carlo", "evaluate"):
            with self.subTest(kind):
                text = self.succeeds("template", "delta-puu.toml", kind, "--full")
                offered = text.replace("# calibration = {", "calibration = {").replace('draws = "per pose"', 'draws = "per machine"')
                self.assertNotEqual(text, offered)
                self.write("study.toml", offered)
                self.assertIn("calibrated: foot_x_1 of each machine is fitted", self.succeeds("check", "study.toml"))
        self.assertNotIn("# calibration = {", self.succeeds("template", "delta-puu.toml", "sobol", "--full"))

    def test_kinds_that_do_not_calibrate(self):
        """Each says which kinds do; none passes over the table."""
        table = '[analysis.calibration]\nfit = ["zero_*"]\nmeasured = ["z"]\nnoise = { z = "5 um" }\n'
        start = STUDY.split("[analysis]")[0]
        for kind in ("sobol", "coupling"):
            with self.subTest(kind):
                self.write("study.toml", start + f'[analysis]\nkind = "{kind}"\n' + table)
                for command in ("run", "check"):
                    done = self.poesy(command, "study.toml")
                    self.assertEqual(done.returncode, 2, done.stderr.decode())
                    self.assertIn(f'analysis.calibration does not belong to kind = "{kind}"; take kind = "sensitivity" or kind = '
                                  '"evaluate" or kind = "monte-carlo" or kind = "allocation", or remove it here; `poesy '
                                  'calibrate` takes it', done.stderr.decode())
        self.write("study.toml", start + '[analysis]\nkind = "evaluate"\n' + table.replace('measured = ["z"]\n', "")
                   + '[[analysis.cases]]\nerrors = { zero_1 = "0.1 mm" }\n')
        done = self.poesy("run", "study.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("analysis.calibration does not say what is measured; write analysis.calibration.measured", done.stderr.decode())

    def test_limits_on_other_bodies_are_refused(self):
        shutil.copyfile(DATA / "mechanisms" / "printer.toml", self.folder / "printer.toml")
        study = STUDY.replace("delta-puu", "printer").replace("samples = 20000", "samples = 10")
        study = study.replace(FIT, 'fit = ["endstop_*"]').replace('position = "0.2 mm"', 'carriage_1_x = "0.2 mm"')
        self.write("study.toml", study.split("combinations")[0])
        done = self.poesy("run", "study.toml")
        self.assertEqual(done.returncode, 2, done.stderr.decode())
        self.assertIn("the limit on 'carriage_1_x' is not on the platform", done.stderr.decode())
        self.assertIn("; remove the limit, or the calibration", done.stderr.decode())

    def test_replay_is_refused(self):
        self.ran(with_calibration(["zero_*", "radius"], machines=50))
        done = self.poesy("replay", "r.h5", "all", "0", "3")
        self.assertEqual(done.returncode, 2)
        self.assertIn("its machines are calibrated", done.stderr.decode())


if __name__ == "__main__":
    main()
