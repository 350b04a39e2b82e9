"""Errors as a designer states them: means, limits, fits, and errors that a machine draws anew at each pose. Compared
with plain loops in NumPy over the linear kinematics of a hexapod."""

import h5py
import numpy

from poesy_program import main
from resumption import ResumptionTest

# The struts of a telescope's hexapod (lsst-ts/ts_mthexapod): their points on the platform and on the base (m).
MOVING = numpy.array([(0, 1701.8, 114.3), (-1542.35, -719.21, 114.3), (1542.35, -719.21, 114.3),
                      (0.79, 1460.49, 228.6), (-1503.37, 7.66, 228.6), (1503.37, 7.66, 228.6)]) / 1e3
FIXED = numpy.array([(0, 1701.8, 607.3), (-1542.35, -719.21, 607.3), (1542.35, -719.21, 607.3),
                     (493.79, 1460.49, 228.6), (-1256.87, -419.29, 228.6), (1256.87, -419.29, 228.6)]) / 1e3
ORIGIN = numpy.array([0, 0, -0.703])
ARCSEC = numpy.pi / 180 / 3600
MACHINES = 20000

MECHANISM = """\
format = "poesy-mechanism"
version = 1
name = "hexapod"
title = "hexapod of a telescope's mirror"
[platform]
origin = [0, 0, "-703 mm"]
rotation = "xyz"
coordinates = ["x", "y", "z", "rx", "ry", "rz"]
workspace = { x = ["-6 mm", "6 mm"], y = ["-6 mm", "6 mm"], z = ["-709 mm", "-697 mm"], rx = ["-0.1 deg", "0.1 deg"], ry = ["-0.1 deg", "0.1 deg"], rz = ["-0.05 deg", "0.05 deg"] }
""" + "".join(f"""\
[[limb]]
joints = [
  {{ name = "F", type = "S", at = [{", ".join(f'"{1e3 * x:.6g} mm"' for x in fixed)}] }},
  {{ name = "q", type = "P", from = "F", to = "M", actuated = true }},
  {{ name = "M", type = "S", at = [{", ".join(f'"{1e3 * x:.6g} mm"' for x in moving)}] }} ]
""" for fixed, moving in zip(FIXED, MOVING)) + """\
[[error]]
name = "strut"
limb = "each"
frame = 4
component = "delta_z"
"""

STUDY = f"""\
format = "poesy-study"
version = 1
mechanism.file = "hexapod.toml"
poses.count = 20
[errors]
linear = {{ distribution = "uniform", half_width = "5 um" }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = {MACHINES}
limits = {{ theta_x = "0.6 arcsec", theta_y = "0.6 arcsec" }}
"""
UNIFORM = 'linear = { distribution = "uniform", half_width = "5 um" }'


def tilt_of_struts():
    """[2 x 6] theta_x and theta_y for longer struts, in arcsec per metre, at home."""
    arms = MOVING - ORIGIN
    along = MOVING - FIXED
    along /= numpy.linalg.norm(along, axis=1)[:, None]
    return numpy.linalg.inv(numpy.hstack([numpy.cross(arms, along), along]))[:2] / ARCSEC


def standard_errors(difference, share, count=MACHINES):
    """How many, of the difference of two counted shares."""
    return abs(difference) / numpy.sqrt(2 * share * (1 - share) / count)


class StatedErrors(ResumptionTest):
    def run_study(self, study, code=0, output="out.h5"):
        self.write("hexapod.toml", MECHANISM)
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def yield_of(self, study):
        self.run_study(study)
        with h5py.File(self.folder / "out.h5") as file:
            return {name: file[f"yield/{name}"][()] for name in ("value", "ci_low", "ci_high", "gradient", "rejects")}

    def share_of_good(self, draw):
        """The share of machines whose tilt is within 0.6 arcsec at all poses. draw(generator) gives struts [n x M x 6]."""
        generator = numpy.random.default_rng(7)
        tilt = numpy.abs(draw(generator) @ tilt_of_struts().T)
        return (tilt <= 0.6).all(axis=(1, 2)).mean()

    def test_each_move_anew(self):
        """Steps of drives, rounded at each move: 40 % of the machines are good at all moves, 95 % if drawn once."""
        expected = self.share_of_good(lambda g: g.uniform(-5e-6, 5e-6, (MACHINES, 20, 6)))
        once = self.share_of_good(lambda g: g.uniform(-5e-6, 5e-6, (MACHINES, 1, 6)))
        self.assertAlmostEqual(expected, 0.400, delta=0.012)
        self.assertAlmostEqual(once, 0.954, delta=0.005)
        anew = self.yield_of(STUDY.replace("5 um\" }", "5 um\", draws = \"per pose\" }"))
        self.assertLess(standard_errors(anew["value"] - expected, expected), 3.9)
        fixed = self.yield_of(STUDY)
        self.assertLess(standard_errors(fixed["value"] - once, once), 3.9)

    def test_fixed_errors_beside_those_of_each_move(self):
        study = STUDY.replace("[analysis]", """\
[errors.override]
"strut_*" = { distribution = "normal", sigma = "2 um" }
strut_2 = { draws = "per pose" }
strut_5 = { distribution = "uniform", limits = ["-5 um", "1 um"], draws = "per pose" }
[analysis]""")

        def draw(generator):
            struts = numpy.repeat(generator.normal(0, 2e-6, (MACHINES, 1, 6)), 20, axis=1)
            struts[:, :, 1] = generator.uniform(-5e-6, 5e-6, (MACHINES, 20))
            struts[:, :, 4] = generator.uniform(-5e-6, 1e-6, (MACHINES, 20))
            return struts
        expected = self.share_of_good(draw)
        self.assertGreater(expected, 0.3)
        self.assertLess(expected, 0.97)
        found = self.yield_of(study)
        self.assertLess(standard_errors(found["value"] - expected, expected), 3.9)
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(list(file["factors/draws"].asstr()), ["per machine", "per pose", "per machine", "per machine",
                                                                   "per pose", "per machine"])
            numpy.testing.assert_allclose(file["factors/mean"][:], [0, 0, 0, 0, -2e-6, 0], atol=1e-20)
        # Replay draws the errors of a machine. Those drawn per machine are equal at all poses, those drawn per pose
        # differ.
        rows = [self.errors_of(sample=11, pose=pose) for pose in (0, 13)]
        for name in rows[0]:
            self.assertEqual(rows[0][name] == rows[1][name], name not in ("strut_2", "strut_5"), name)

    def test_gradient_by_errors_of_each_move(self):
        """Against runs whose one error is larger, on the same uniforms."""
        study = STUDY.replace(UNIFORM, 'linear = { distribution = "normal", sigma = "2.5 um" }\n[errors.override]\n'
                              'strut_1 = { distribution = "normal", sigma = "2.5 um", draws = "per pose" }')
        found = self.yield_of(study)
        with h5py.File(self.folder / "out.h5") as file:
            low, high = file["yield/gradient_ci_low"][:], file["yield/gradient_ci_high"][:]
        step = 0.1e-6
        more = self.yield_of(study.replace('2.5 um", draws', '2.6 um", draws'))["value"]
        less = self.yield_of(study.replace('2.5 um", draws', '2.4 um", draws'))["value"]
        slope = (more - less) / (2 * step)
        noise = numpy.hypot((high[0] - low[0]) / 3.92, numpy.sqrt(2 * abs(more - less) / MACHINES) / (2 * step))
        self.assertLess(high[0], 0)
        self.assertLess(abs(found["gradient"][0] - slope), 3.9 * noise)

    def test_means_and_limits(self):
        """Struts that are short by up to 5 um: limits are one-sided, and a mean moves the tilt."""
        study = STUDY.replace(UNIFORM, UNIFORM + """
[errors.override]
strut_1 = { distribution = "uniform", limits = ["-9 um", "1 um"] }
strut_2 = { distribution = "normal", limits = [0, "9 um"], sigmas = 3 }
strut_3 = { distribution = "triangular", half_width = "5 um", mean = "-2 um" }
""")

        def draw(generator):
            struts = generator.uniform(-5e-6, 5e-6, (MACHINES, 1, 6))
            struts[:, 0, 0] -= 4e-6
            struts[:, 0, 1] = generator.normal(4.5e-6, 1.5e-6, MACHINES)
            struts[:, 0, 2] = generator.triangular(-7e-6, -2e-6, 3e-6, MACHINES)
            return struts
        expected = self.share_of_good(draw)
        found = self.yield_of(study)
        self.assertLess(standard_errors(found["value"] - expected, expected), 3.9)
        text = self.succeeds("show", "out.h5", "--width", 160)
        self.assertIn("mean", text)

    def test_zone_of_a_fit(self):
        self.run_study(STUDY.replace(UNIFORM, 'linear = { distribution = "uniform", limits = "450 h5" }')
                       .replace(f"samples = {MACHINES}", "samples = 100"))
        with h5py.File(self.folder / "out.h5") as file:
            numpy.testing.assert_allclose(file["factors/mean"][:], -13.5e-6, rtol=1e-12)
            numpy.testing.assert_allclose(file["factors/sigma"][:], 13.5e-6 / numpy.sqrt(3), rtol=1e-12)

    def test_given_machines(self):
        """Rows of a file, whose other struts are drawn: good ones counted by hand from what replay draws."""
        rows = numpy.random.default_rng(3).uniform(-7e-6, 7e-6, (2400, 2))
        table = "part,strut_2 [um],strut_1\n" + "".join(f"p{n},{1e6 * a!r},{b!r}\n" for n, (a, b) in enumerate(rows.tolist()))
        self.write("parts.csv", table)
        study = STUDY.replace(UNIFORM, UNIFORM + '\nmachines = "parts.csv"').replace(f"samples = {MACHINES}\n", "")
        found = self.yield_of(study)
        for n in range(0, 2400, 240):
            drawn = self.errors_of(sample=n, pose=n // 240)
            self.assertAlmostEqual(float(drawn["strut_2"]), rows[n, 0], delta=1e-20)
            self.assertEqual(float(drawn["strut_1"]), rows[n, 1])
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(file["yield/machines"][()], 2400)
            self.assertEqual(list(file["factors/distribution"].asstr())[:3], ["given", "given", "uniform"])
            self.assertTrue(numpy.isnan(file["yield/gradient"][:2]).all())
        self.assertIn("2 of 6 errors given by errors.machines, 4 drawn; poesy evaluate STUDY.toml --errors FILE.csv judges each",
                      " ".join(self.succeeds("show", "out.h5").split()))
        generator = numpy.random.default_rng(5)
        good = []
        for _ in range(50):
            struts = generator.uniform(-5e-6, 5e-6, (2400, 6))
            struts[:, 1], struts[:, 0] = rows.T
            good.append((numpy.abs(struts @ tilt_of_struts().T) <= 0.6).all(axis=1).mean())
        self.assertLess(abs(found["value"] - numpy.mean(good)), 3.9 * numpy.std(good) + 1 / 2400)
        # The result is the same with any shards and threads. Another table of machines is another study.
        expected = self.content_hash()
        for shard in range(1, 4):
            self.succeeds("run", "study.toml", "-o", f"part-{shard}.h5", "--quiet", "--shard", f"{shard}/3", "--threads", shard)
        self.succeeds("merge", *(f"part-{shard}.h5" for shard in range(1, 4)), "-o", "merged.h5")
        self.assertEqual(self.content_hash("merged.h5"), expected)
        self.succeeds("run", "study.toml", "-o", "again.h5", "--quiet", "--keep-checkpoint")
        self.write("parts.csv", table.replace(table.split("\n")[1], "p0,0.5,0"))
        done = self.poesy("run", "study.toml", "-o", "again.h5", "--quiet", "--resume")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"another study", done.stderr)
        self.write("parts.csv", table.replace("p7,", "p7,x"))
        done = self.poesy("run", "study.toml", "-o", "wrong.h5", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"parts.csv:9:4", done.stderr)

    def test_another_draw_is_another_study(self):
        self.write("hexapod.toml", MECHANISM)
        first = STUDY.replace(f"samples = {MACHINES}", "samples = 1500")
        hashes = set()
        for study in (first, first.replace("5 um\" }", "5 um\", draws = \"per pose\" }"),
                      first.replace("5 um\" }", "5 um\", mean = \"1 um\" }")):
            self.write("study.toml", study)
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--keep-checkpoint")
            hashes.add(self.content_hash())
            self.write("study.toml", study.replace("half_width", "mean = \"0.5 um\", half_width")
                       if "mean" not in study else study.replace("1 um", "2 um"))
            done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(b"another study", done.stderr)
            for path in self.folder.glob("out.h5*"):
                path.unlink()
        self.assertEqual(len(hashes), 3)

    def test_refusals(self):
        self.write("hexapod.toml", MECHANISM)
        anew = STUDY.replace("5 um\" }", "5 um\", draws = \"per pose\" }").replace(f"samples = {MACHINES}", "samples = 100")

        def refused(study, *words):
            self.write("study.toml", study)
            done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
            self.assertEqual(done.returncode, 2, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr.decode())
        refused(anew.replace("limits =", "calibrated = true\nlimits ="), "study.toml:11:14", "analysis.calibrated is true, but",
                "'strut_1' is drawn per pose", "which no calibration removes")
        refused(anew.replace('"monte-carlo"\ndraws = "per machine"', '"sobol"').replace("limits =", "# limits ="),
                "the error 'strut_1' is drawn per pose, but indices of Sobol' are of errors that a machine keeps")
        parts = anew.replace('"monte-carlo"\ndraws = "per machine"', '"allocation"').replace("samples = 100", "samples = 3000") + """\
yield = 0.99
sigmas = 3
parts = [{ factors = ["strut_*"], each = true, cost = { law = "reciprocal", b = 1, unit = "mm" } }]
"""
        refused(parts, "has 'strut_1', which a machine draws anew at each pose, so no part has it")
        refused(parts.replace('draws = "per pose" }', 'mean = "1 um" }'),
                "has 'strut_1', whose mean is not zero", "middle of the limits")


if __name__ == "__main__":
    main()
