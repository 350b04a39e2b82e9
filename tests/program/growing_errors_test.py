"""Errors in proportion to the travel of a joint, compared with closed-form kinematics of three machines."""

import os
from pathlib import Path

import h5py
import numpy as np

from linear_delta import TURNS, Linear, meeting
from poesy_program import GALLERY, ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
SCALES = np.array([2e-3, -1e-3, 5e-4])

STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
errors = {{ relative = {{ distribution = "normal", sigma = "0.05 %" }} }}
[analysis]
{analysis}
"""


class Rotary:
    """Three arms that turn about horizontal axes: arm 0.17, rod 0.32, shoulders 0.0339 further out than the balls."""

    shoulder, arm, rod, height = 0.0339, 0.17, 0.32, 0.4129

    def centres(self, q):
        return np.array([turn @ (self.shoulder + self.arm * np.cos(angle), 0, self.height + self.arm * np.sin(angle))
                         for turn, angle in zip(TURNS, q)])

    def ways(self, pose):
        """E cos q + F sin q = G for each arm, of the two the one that is near home."""
        angles = []
        for turn in TURNS:
            x, y, z = turn.T @ pose
            E, F = 2 * self.arm * (self.shoulder - x), 2 * self.arm * (self.height - z)
            G = self.rod**2 - self.arm**2 - y**2 - (self.shoulder - x) ** 2 - (self.height - z) ** 2
            both = np.arctan2(F, E) + np.array([-1, 1]) * np.arccos(G / np.hypot(E, F))
            both = (both + np.pi) % (2 * np.pi) - np.pi
            angles.append(both[np.argmin(np.abs(both))])
        return np.array(angles)

    def moved(self, pose, scales):
        q = self.ways(pose)
        return meeting(self.centres(q + scales * q), self.rod, pose) - pose


ROTARY = """\
format = "poesy-mechanism"
version = 1
name = "rotary"
geometry = { s = "33.9 mm", r = "30 mm", u = "170 mm", l = "320 mm", H = "412.9 mm" }
[platform]
origin = [0, 0, "H - sqrt(l*l - (s + u)*(s + u))"]
coordinates = ["x", "y", "z"]
workspace = { x = ["-60 mm", "60 mm"], y = ["-60 mm", "60 mm"], z = ["0 mm", "200 mm"] }
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "R", at = ["s + r", 0, "H"], axis = "-y", actuated = true },
  { name = "B", type = "U", at = ["s + r + u", 0, "H"], axis = "y", axis2 = ["sqrt(l*l - (s + u)*(s + u))", 0, "-s - u"] },
  { name = "C", type = "U", at = ["r", 0, "H - sqrt(l*l - (s + u)*(s + u))"], axis = ["sqrt(l*l - (s + u)*(s + u))", 0, "-s - u"], axis2 = "y" } ]
[[error]]
name = "gear"
limb = "each"
frame = "q"
component = "epsilon_z"
grows_with = "q"
"""

SCALE = """
[[error]]
name = "scale"
limb = {limb}
frame = "q"
component = "delta_z"
grows_with = "q"
{more}
"""


class GrowingErrors(ProgramTest):
    def machine(self, text, poses):
        self.write("machine.toml", text)
        self.poses = np.array(poses)
        self.write("poses.csv", "x,y,z\n" + "".join(",".join(map(repr, row)) + "\n" for row in self.poses.tolist()))

    def linear_delta(self, more=""):
        """P at 200 mm at home, drives 300 mm above it."""
        text = (DATA / "mechanisms/linear-delta-drawing.toml").read_text()
        text = text.split("features = [")[0] + SCALE.format(limb='"each"', more=more)
        self.machine(text, [(0.0, 0.0, 0.2), (0.0, 0.0, 0.24), (0.05, -0.03, 0.17), (-0.06, 0.02, 0.23)])

    def displacements(self, names, values=SCALES, unit=""):
        """Of the platform at each pose, by exact solves."""
        self.write("errors.csv", ",".join(name + unit for name in names) + "\n" + ",".join(map(repr, map(float, values))) + "\n")
        self.write("study.toml", STUDY.format(analysis='kind = "evaluate"').replace("errors = {", "# errors = {"))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "found.h5", "--quiet")
        with h5py.File(self.folder / "found.h5") as file:
            return np.stack([np.ravel(file["evaluate"][axis]) for axis in "xyz"], -1)

    def test_scale_of_a_linear_drive(self):
        self.linear_delta()
        own = [Linear(0.16, 0.3).moved(pose, SCALES, 0.2) for pose in self.poses]
        found = self.displacements(["scale_1", "scale_2", "scale_3"])
        np.testing.assert_allclose(found, own, atol=2e-14)
        np.testing.assert_allclose(found[0], 0.0, atol=1e-15)
        np.testing.assert_array_equal(found, self.displacements(["scale_1", "scale_2", "scale_3"], 1e3 * SCALES, " [mm/m]"))

    def test_scale_from_a_place(self):
        self.linear_delta('from = "-20 mm"')
        own = [Linear(0.16, 0.3).moved(pose, SCALES, 0.2, -0.02) for pose in self.poses]
        np.testing.assert_allclose(self.displacements(["scale_1", "scale_2", "scale_3"]), own, atol=2e-14)

    def test_gear_of_a_rotary_drive(self):
        self.machine(ROTARY, [(0.0, 0.0, 0.05), (0.05, 0.0, 0.05), (-0.025, 0.0433, 0.05), (-0.05, 0.0, 0.12)])
        own = [Rotary().moved(pose, SCALES) for pose in self.poses]
        np.testing.assert_allclose(self.displacements(["gear_1", "gear_2", "gear_3"]), own, atol=2e-14)

    def test_scale_between_bodies(self):
        """Rods in pairs on carriages, which are bodies of their own. The last frame's errors have the other sign."""
        text = (GALLERY / "delta-printer/delta-printer.toml").read_text()
        self.machine(text + SCALE.format(limb='"tower"', more='from = "10 mm"\nscale = -1'), [(0.0, 0.0, 0.0), (0.03, -0.02, 0.1), (-0.05, 0.01, 0.05)])
        own = [Linear(0.11, np.sqrt(0.26**2 - 0.11**2)).moved(pose, SCALES, 0.0, 0.01) for pose in self.poses]
        np.testing.assert_allclose(self.displacements(["scale_1", "scale_2", "scale_3"]), own, atol=2e-13)

    def scatter(self):
        """[poses x 3 x 3] What each scale does to x, y and z, per unit, by differences of the closed form."""
        step = 1e-5
        delta = Linear(0.16, 0.3)
        return np.array([[(delta.moved(pose, step * one, 0.2) - delta.moved(pose, -step * one, 0.2)) / (2 * step)
                          for one in np.eye(3)] for pose in self.poses])

    def run_study(self, analysis, name):
        self.write("study.toml", STUDY.format(analysis=analysis))
        self.succeeds("run", "study.toml", "-o", name, "--quiet")
        return h5py.File(self.folder / name)

    def test_kinds_that_draw(self):
        """Scatter, main effects and total indices are those of the closed form, to first order."""
        self.linear_delta()
        effects = 5e-4 * self.scatter()
        samples = 20000
        with self.run_study(f'kind = "monte-carlo"\ndraws = "per pose"\nsamples = {samples}', "mc.h5") as file:
            names = [name.decode() for name in file["response"][:]]
            found = np.stack([file["monte_carlo/rms"][names.index(axis)] for axis in "xyz"], -1)
            unit = file["factors/unit"][0].decode()
        self.assertEqual(unit, "1")
        own = np.sqrt((effects**2).sum(1))
        # The mean square of a normal number has a relative standard error of sqrt(2 / samples), its root half of it.
        # Five standard errors: alpha = 6e-7 each.
        np.testing.assert_allclose(found[1:], own[1:], rtol=5.0 * np.sqrt(0.5 / samples), atol=1e-12)
        with self.run_study('kind = "sensitivity"\nsamples = 4000', "sensitivity.h5") as file:
            index = file["sensitivity/local"][names.index("z")]
        np.testing.assert_allclose(np.abs(index[:, 1:]), np.abs(self.scatter()[1:, :, 2]).T, rtol=5.0 * np.sqrt(0.5 / 4000))
        with self.run_study('kind = "sobol"\nsamples = 1024', "sobol.h5") as file:
            total = file["sobol/aggregated/ST"][names.index("z")]
        share = (effects[..., 2] ** 2).sum(0)
        np.testing.assert_allclose(total, share / share.sum(), atol=0.06)

    def test_allocation_and_background(self):
        """A tolerance of the scales that keeps a limit, and machines whose scales are all off by the same."""
        self.linear_delta()
        parts = '[[analysis.parts]]\nname = "scales"\nfactors = "relative"\ncost = { law = "reciprocal", b = 1, unit = "%" }\nbounds = ["50 um/m", "1 %"]'
        analysis = f'kind = "allocation"\nlimits = {{ z = "0.05 mm" }}\nyield = 0.99\nsigmas = 3\nconfidence = 0.9\n{parts}'
        with self.run_study(analysis, "allocation.h5") as file:
            tolerance = file["allocation/tolerance"][0]
            certified, count = (file["allocation/certificate"][name][()] for name in ("yield", "machines"))
        draws = np.random.default_rng(5).normal(0.0, tolerance / 3.0, (200000, 3))
        own = (np.abs(draws @ self.scatter()[..., 2].T).max(1) <= 5e-5).mean()
        # The first-order map errs by 0.3 % of z at these poses. 4.5 standard errors: alpha = 7e-6.
        self.assertLess(abs(certified - own), 4.5 * np.sqrt(own * (1.0 - own) * (1.0 / count + 1.0 / len(draws))) + 1e-4)
        self.assertGreater(own, 0.985)
        held = 'kind = "monte-carlo"\ndraws = "per pose"\nsamples = 100\nfactors = ["scale_1"]\nbackground = { factors = ["scale_2", "scale_3"], relative = "0.1 %" }'
        with self.run_study(held, "held.h5") as file:
            names = [name.decode() for name in file["response"][:]]
            mean = file["monte_carlo/mean"][names.index("z")]
            self.assertIn("relative = 0.001", file["study/text"][()].decode())
        own = 1e-3 * self.scatter()[:, 1:, 2].sum(1)
        spread = 5e-4 * np.abs(self.scatter()[:, 0, 2]).max()
        self.assertLess(np.abs(mean - own).max(), 5.0 * spread / np.sqrt(100))

    def refuses(self, study, message, command="check"):
        done = self.poesy(command, study)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn(message, " ".join(done.stderr.decode().split()))

    def test_wrong_files(self):
        """Each with its place, what is wrong, and what to do."""
        self.linear_delta()
        right = (self.folder / "machine.toml").read_text()
        line = right[: right.index("[[error]]")].count("\n") + 1
        for old, new, message in (
            ('with = "q"', 'with = "qq"', f"{line + 5}:14: error[0].grows_with is 'qq', which no joint of limb 1 is named; did you mean 'q'?"),
            ('with = "q"', 'with = "O"', f"{line + 5}:14: error[0].grows_with is 'O', a fixed frame of limb 1, which has no displacement; name a joint that moves"),
            ('with = "q"', 'with = "B"', f"{line + 5}:14: error[0].grows_with is 'B', a joint of type U, which has several displacements; write its axes"),
            ('with = "q"', 'with = "q"\nfrom = "3 deg"', f"{line + 6}:8: error[0].from '3 deg' is an angle"),
            ('with = "q"', 'with = "q"\nfrom = 3', f"{line + 6}:8: error[0].from '3' is a number"),
            ('grows_with = "q"', 'from = "3 mm"', f"{line + 5}:8: error[0].from is set without grows_with; name the joint"),
            ('with = "q"', 'with = "q"\nscale = "1 mm"', f"{line + 6}:9: error[0].scale '1 mm' is a length"),
            ('"delta_z"', '"epsilon_z"', "scale is a number, but the error makes an angle, and grows with a length; write scale = \"1 / (1 m)\""),
            ('component = "delta_z"', 'components = { delta_z = 1, epsilon_z = 1 }', "epsilon_z '1' is a number, so the error, which grows, is not a number; where it grows with a length"),
            ('with = "q"', 'with = 3', f"{line + 5}:14: error[0].grows_with is the whole number 3"),
        ):  # fmt: skip
            self.assertIn(old, right)
            self.write("machine.toml", right.replace(old, new))
            with self.subTest(new):
                self.refuses("machine.toml", message, "models")

    def test_an_angle_along_a_length(self):
        """In rad/m, and several components together: what they do is what angles and lengths of that size do."""
        self.linear_delta()
        text = (self.folder / "machine.toml").read_text().split("\n[[error]]")[0]
        growing = ('\n[[error]]\nname = "twist"\nlimb = 1\nframe = "q"\ncomponents = { delta_x = 0.5, epsilon_y = "1 / (1 m)" }\n'
                   'grows_with = "q"\n[[error]]\nname = "yaw"\nlimb = 1\nframe = "q"\ncomponent = "epsilon_z"\n'
                   'scale = "1 / (1 m)"\ngrows_with = "q"\n')
        plain = growing.replace('grows_with = "q"\n', "").replace('scale = "1 / (1 m)"\n', "").replace('delta_x = 0.5, epsilon_y = "1 / (1 m)"', 'delta_x = "0.5 m", epsilon_y = 1')
        self.machine(text + growing, [(0.05, -0.03, 0.17)])
        found = self.displacements(["twist", "yaw"], (2e-3, 1e-3))
        way = Linear(0.16, 0.3).ways(self.poses[0], 0.2)[0]
        self.write("machine.toml", text + plain)
        np.testing.assert_allclose(found, self.displacements(["twist", "yaw"], (2e-3 * way, 1e-3 * way)), atol=1e-14)

    def test_a_size_in_the_place_of_a_distribution(self):
        """The message has a line that can be copied."""
        self.linear_delta()
        head = 'format = "poesy-study"\nversion = 1\nmechanism.file = "machine.toml"\nposes.count = 2\n'
        self.write("study.toml", head + 'errors.relative = "+-0.2 %"\n[analysis]\nkind = "monte-carlo"\n'
                                        'draws = "per pose"\n')
        self.refuses("study.toml", 'write a distribution, e.g. { distribution = "uniform", half_width = "0.1 %" }')

    def test_kinds_that_set_sizes_by_dimension(self):
        """They have a size for lengths and one for angles, and none for a number: refused, not left out."""
        text = (GALLERY / "tripteron" / "tripteron.toml").read_text()
        self.write("machine.toml", text + SCALE.format(limb='"each"', more="").replace('"q"', '"rail"'))
        head = 'format = "poesy-study"\nversion = 1\nmechanism.file = "machine.toml"\nposes.count = 2\n[analysis]\n'
        self.write("study.toml", head + 'kind = "identification"\nfactors = ["scale_1"]\n')
        self.refuses("study.toml", "study.toml:7:11: analysis.factors has 'scale_1', which is a number, but groups have no size for it; name errors that are lengths or angles")
        sources = '[[analysis.sources]]\nname = "{}"\nfactors = ["{}"]\n'
        self.write("study.toml", head + 'kind = "coupling"\n' + sources.format("rail", "delta_1_1_x") + sources.format("scale", "scale_1"))
        self.refuses("study.toml", "'scale_1', which is a number, but a coupling study has no size for it; name errors that are lengths or angles")

    def test_words(self):
        self.linear_delta('from = "-20 mm"')
        said = " ".join(self.succeeds("models", "machine.toml").split())
        self.assertIn("linear error along z of frame 2, grows with q, from -20 mm", said)
        template = self.succeeds("template", "machine.toml", "monte-carlo")
        self.assertIn('\nrelative = { distribution = "normal", sigma = 0.001 }', template)
        self.write("study.toml", STUDY.format(analysis='kind = "monte-carlo"').replace("0.05 %", "50 um"))
        self.refuses("study.toml", "study.toml:5:58: errors.relative.sigma is '50 um', but must be a number; write it without a unit, or like")
        self.write("study.toml", STUDY.format(analysis='kind = "monte-carlo"').replace("0.05 %", "200 %"))
        self.refuses("study.toml", "all of what it is a share of")


if __name__ == "__main__":
    main()
