"""Questions of users from public sources (threads, published tables, papers), stated as a mechanism and a study of
at most 40 lines together, and compared with independent kinematics (NumPy)."""

import h5py
import numpy as np

from own_kinematics import SixRods, rotation_vectors, rotations, six_legs, three_spheres
from poesy_program import ProgramTest, main

DISPLACEMENT = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
ROUND = np.radians(range(0, 360, 60))
BED = np.array([(0.0, 0.0, 0.0)] + [(0.05 * np.cos(a), 0.05 * np.sin(a), 0.0) for a in ROUND])
# The share of good machines is compared with that of as many machines drawn by NumPy, within 3.9 standard errors: alpha
# = 1e-4.
MACHINES = 20_000


def table(columns):
    """CSV of columns by name, to the last bit."""
    rows = zip(*(np.asarray(column).tolist() for column in columns.values()))
    return ",".join(columns) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)


class Case(ProgramTest):
    def say(self, mechanism, study, poses, coordinates="xyz"):
        """Writes what a user writes."""
        self.assertLessEqual(len((mechanism + study).splitlines()), 40)
        self.write("machine.toml", mechanism)
        self.write("study.toml", study)
        self.write("poses.csv", table(dict(zip(coordinates, np.transpose(poses)))))

    def evaluated(self, errors, *responses, options=()):
        """[poses x rows] of each response."""
        self.write("errors.csv", table(errors))
        done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet",
                          *options)
        self.assertIn(done.returncode, (0, 6), done.stderr)
        with h5py.File(self.folder / "rows.h5") as file:
            self.assertLessEqual(file["evaluate/status"][:].max(), 1)  # converged, or stagnated at rounding
            return np.array([file[f"evaluate/{name}"][:] for name in responses])

    def run_study(self, study=None):
        if study is not None:
            self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        return h5py.File(self.folder / "out.h5")

    def yield_of(self, study=None):
        with self.run_study(study) as file:
            return file["yield/value"][()]

    def assert_share(self, found, own, machines=MACHINES):
        self.assertLess(abs(found - own), 3.9 * np.sqrt(2.0 * own * (1.0 - own) / machines), (found, own))


# From Klipper3d/klipper #2810 and #615, and Smoothieware #713: a delta printer with a pair of rods on each carriage.
PRINTER = """\
format = "poesy-mechanism"
version = 1
name = "printer"
geometry = { L = "217 mm", D = "95 mm", r = "30 mm", w = "46 mm" }
errors = { about = "frame" }
error = [
  { name = "rod", limb = "each", frame = "B", component = "delta_x" },
  { name = "endstop_1", places = [{ limb = [1, 4], frame = "q", component = "delta_z" }] },
  { name = "endstop_2", places = [{ limb = [2, 5], frame = "q", component = "delta_z" }] },
  { name = "endstop_3", places = [{ limb = [3, 6], frame = "q", component = "delta_z" }] },
  { name = "tower", places = [{ limb = [1, 4], frame = 0, component = "delta_y" }] },
  { name = "lean", places = [{ limb = [1, 4], frame = 0, component = "epsilon_y" }] } ]
[platform]
origin = [0, 0, 0]
coordinates = ["x", "y", "z"]
workspace = { x = ["-60 mm", "60 mm"], y = ["-60 mm", "60 mm"], z = ["-10 mm", "100 mm"] }
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "P", at = ["D + r", "w/2", "sqrt(L^2 - D^2)"], axis = "z", actuated = "motor_*" },
  { name = "B", type = "S", at = ["D + r", "w/2", "sqrt(L^2 - D^2)"] },
  { name = "C", type = "S", at = ["r", "w/2", 0] } ]
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "P", at = ["D + r", "-w/2", "sqrt(L^2 - D^2)"], axis = "z", actuated = "motor_*" },
  { name = "B", type = "S", at = ["D + r", "-w/2", "sqrt(L^2 - D^2)"] },
  { name = "C", type = "S", at = ["r", "-w/2", 0] } ]
"""
PRINTERS = f"""\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
errors.linear = {{ distribution = "normal", sigma = "0.05 mm" }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = ["endstop_*"]
samples = {MACHINES}
limits = {{ z = "0.1 mm" }}
"""
RODS = [f"rod_{k}" for k in range(1, 7)]
OWN_NAMES = {"tower": "tower_y_1", "lean": "lean_y_1", **{f"rod_{k}": f"rod_left_{k}" for k in (1, 2, 3)},
             **{f"rod_{k + 3}": f"rod_right_{k}" for k in (1, 2, 3)}}


def of_printers(errors):
    """Displacement of the effector over the bed, [7 x N x 6]."""
    return SixRods().displacement({OWN_NAMES.get(name, name): values for name, values in errors.items()}, BED)


class Pairs(Case):
    """Case 02: errors of a carriage are in both of its rods."""

    def setUp(self):
        super().setUp()
        self.say(PRINTER, PRINTERS, BED)

    def test_displacements(self):
        names = [*RODS, "endstop_1", "endstop_2", "endstop_3", "tower", "lean"]
        rows = np.vstack([np.diag([5e-4] * 10 + [5e-3]), 3e-4 * np.random.default_rng(1).standard_normal((20, 11))])
        errors = dict(zip(names, rows.T))
        found = np.moveaxis(self.evaluated(errors, *DISPLACEMENT), 0, -1)
        np.testing.assert_allclose(found, of_printers(errors), rtol=1e-9, atol=1e-13)

    def test_yield_of_three_end_stops(self):
        """Six end stops, one for each rod, would look better."""
        stops = np.random.default_rng(2).normal(0.0, 5e-5, (3, MACHINES))
        z = of_printers({f"endstop_{k + 1}": stops[k] for k in range(3)})[..., 2]
        own = (np.abs(z) <= 1e-4).all(axis=0).mean()
        self.assertAlmostEqual(own, 0.9733, delta=0.005)
        self.assert_share(self.yield_of(), own)

    def test_tolerance_of_an_end_stop(self):
        """Found so that 95 % of the printers keep the limit: those that NumPy draws with it do so."""
        with self.run_study(PRINTERS.replace("monte-carlo", "allocation").replace('draws = "per machine"\n', "") +
                            'yield = 0.95\nsigmas = 3\nparts = [{ factors = ["endstop_*"] }]\n') as file:
            sigma = file["allocation/sigma"][0]
            self.assertEqual(file["allocation"].attrs["certified"], 1)
        stops = np.random.default_rng(3).normal(0.0, sigma, (3, MACHINES))
        z = of_printers({f"endstop_{k + 1}": stops[k] for k in range(3)})[..., 2]
        own = (np.abs(z) <= 1e-4).all(axis=0).mean()
        self.assertGreater(own, 0.95 - 3.9 * np.sqrt(0.95 * 0.05 / MACHINES))
        self.assertLess(own, 0.965)


class OneSided(Case):
    """Case 17 (aevyrie/tolstack #50): rods 217 +0/-0.1."""

    def test_yield(self):
        self.say(PRINTER, PRINTERS.replace('"normal", sigma = "0.05 mm"', '"uniform", limits = ["-0.1 mm", 0]')
                 .replace("endstop_*", "rod_*").replace('"0.1 mm"', '"0.06 mm"'), BED)
        rods = np.random.default_rng(4).uniform(-1e-4, 0.0, (6, MACHINES))
        z = of_printers(dict(zip(RODS, rods)))[..., 2]
        own = (np.abs(z) <= 6e-5).all(axis=0).mean()
        self.assertAlmostEqual(own, 0.193, delta=0.01)
        self.assert_share(self.yield_of(), own)
        # With the same width but symmetric about zero, the errors would be harmless.
        text = (self.folder / "study.toml").read_text()
        self.assertGreater(self.yield_of(text.replace('limits = ["-0.1 mm", 0]', 'half_width = "0.05 mm"')), 0.98)

    def test_a_background_of_the_same_errors_is_refused(self):
        self.say(PRINTER, PRINTERS + 'background = { factors = ["endstop_*"], linear = "-0.05 mm" }\n', BED)
        done = self.poesy("run", "study.toml", "-o", "out.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"study.toml:12:", done.stderr)
        self.assertIn(b"endstop_1", done.stderr)


class FlatBed(Case):
    """Case 11 (Klipper #2891): heights over the bed, by six rods. The printer is zeroed in the middle."""

    STUDY = PRINTERS.replace("endstop_*", "rod_*").replace('z = "0.1 mm"', 'rise = "0.04 mm"').replace(
        "[analysis]", 'response = [{ name = "rise", sum = { z = 1 }, relative_to = { x = 0, y = 0, z = 0 } }]\n[analysis]')

    def test_yields(self):
        """As it stands, zeroed in the middle, and by its flatness alone: three questions with three answers."""
        self.say(PRINTER, self.STUDY, BED)
        rods = np.random.default_rng(8).normal(0.0, 5e-5, (6, MACHINES))
        z = of_printers(dict(zip(RODS, rods)))[..., 2]
        for limit, own, stated in ((None, np.abs(z - z[0]).max(axis=0) <= 4e-5, 0.580),
                                   ('z = "0.04 mm"', np.abs(z).max(axis=0) <= 4e-5, 0.309),
                                   ('z = { spread = "0.08 mm" }', np.ptp(z, axis=0) <= 8e-5, 0.631)):
            self.assertAlmostEqual(own.mean(), stated, delta=3.9 * np.sqrt(stated * (1.0 - stated) / MACHINES))
            study = self.STUDY if limit is None else self.STUDY.replace('rise = "0.04 mm"', limit)
            self.assert_share(self.yield_of(study), own.mean())


# From spacetelescope/webbpsf #409: a mirror's hexapod (lsst-ts/ts_mthexapod, mm) whose drives have steps of 10 um.
FIXED = [(0, 1701.8, 607.3), (-1542.35, -719.21, 607.3), (1542.35, -719.21, 607.3), (493.79, 1460.49, 228.6),
         (-1256.87, -419.29, 228.6), (1256.87, -419.29, 228.6)]
MOVING = [(0, 1701.8, 114.3), (-1542.35, -719.21, 114.3), (1542.35, -719.21, 114.3), (0.79, 1460.49, 228.6),
          (-1503.37, 7.66, 228.6), (1503.37, 7.66, 228.6)]
MIRROR = """\
format = "poesy-mechanism"
version = 1
name = "mirror"
error = [ { name = "strut", limb = "each", frame = 4, component = "delta_z" } ]
[platform]
origin = [0, 0, "-703 mm"]
rotation = "xyz"
coordinates = ["x", "y", "z", "rx", "ry", "rz"]
workspace = { x = ["-6 mm", "6 mm"], y = ["-6 mm", "6 mm"], z = ["-709 mm", "-697 mm"], rx = ["-0.1 deg", "0.1 deg"], ry = ["-0.1 deg", "0.1 deg"], rz = ["-0.05 deg", "0.05 deg"] }
""" + "".join(f"""\
[[limb]]
joints = [ {{ name = "F", type = "S", at = {[f"{x} mm" for x in fixed]} }}, {{ name = "q", type = "P", from = "F", to = "M", actuated = true }}, {{ name = "M", type = "S", at = {[f"{x} mm" for x in moving]} }} ]
""" for fixed, moving in zip(FIXED, MOVING))
STEPS = f"""\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses.count = 20
errors.linear = {{ distribution = "uniform", half_width = "5 um", draws = "per pose" }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = {MACHINES}
limits = {{ theta_x = "0.6 arcsec", theta_y = "0.6 arcsec" }}
"""


class Steps(Case):
    """Case 12: each move rounds the drives anew. How many machines are good at all of 20 moves?"""

    def test_yield(self):
        self.say(MIRROR, STEPS, BED)
        arms, along = np.array(MOVING) / 1e3 - [0, 0, -0.703], np.array(MOVING) - FIXED
        along /= np.linalg.norm(along, axis=1)[:, None]
        tilt = np.degrees(np.linalg.inv(np.hstack([np.cross(arms, along), along]))[:2]) * 3600.0
        for study, moves, stated in ((STEPS, 20, 0.400), (STEPS.replace(', draws = "per pose"', ""), 1, 0.954)):
            struts = np.random.default_rng(9).uniform(-5e-6, 5e-6, (MACHINES, moves, 6))
            own = (np.abs(struts @ tilt.T) <= 0.6).all(axis=(1, 2)).mean()
            self.assertAlmostEqual(own, stated, delta=0.012)
            self.assert_share(self.yield_of(study), own)


# The printer with position zones (ISO 1101) of the balls on the effector. The zones are of bore axes perpendicular to
# the effector.
SEATS = PRINTER.replace(PRINTER[PRINTER.index("errors ="):PRINTER.index("[platform]")], "").replace('/2", 0] } ]\n', """\
/2", 0] } ]
features = [ { name = "seat", joint = "C", part = "after", kind = "axis", z = "z", x = "x", length = "10 mm", position = { zone = "0.1 mm", datums = "A" } } ]
""")


class RoundZone(Case):
    """Case 08: six balls, each in a circle of 0.1 mm. How many effectors turn by no more than 0.08 deg?"""

    STUDY = PRINTERS.replace('errors.linear = { distribution = "normal", sigma = "0.05 mm" }',
                             'errors.zones = { distribution = "normal", sigmas = 1 }').replace(
        '["endstop_*"]', '"all"').replace('z = "0.1 mm"', 'rotation = "0.08 deg"')

    @staticmethod
    def turned_by(seats):
        """[7 x N], of the places of the balls in the effector's own frame on the limbs, [N x 6 x 2]."""
        angle = 2.0 * np.pi * np.tile(np.arange(3), 2) / 3.0
        x = np.cos(angle) * seats[..., 0] - np.sin(angle) * seats[..., 1]
        y = np.sin(angle) * seats[..., 0] + np.cos(angle) * seats[..., 1]
        names = [f"{side}_{{}}_{k}" for side in ("ball_left", "ball_right") for k in (1, 2, 3)]
        errors = {name.format(axis): values[:, k] for axis, values in (("x", x), ("y", y)) for k, name in enumerate(names)}
        return np.linalg.norm(SixRods().displacement(errors, BED)[..., 3:], axis=-1)

    def setUp(self):
        super().setUp()
        self.say(SEATS, self.STUDY, BED)

    def test_normal_in_its_zone(self):
        """With one sigma to the edge of the zone, of which shift and tilt have half the variance each."""
        seats = np.random.default_rng(5).normal(0.0, 5e-5 / np.sqrt(2.0), (MACHINES, 6, 2))
        own = (self.turned_by(seats) <= np.radians(0.08)).all(axis=0).mean()
        self.assertTrue(0.3 < own < 0.9, own)
        self.assert_share(self.yield_of(), own)

    def test_uniform_in_its_zone(self):
        """Anywhere in the circle, of bores that are square to the effector."""
        self.say(SEATS.replace('position = {', 'perpendicularity = "1e-6 mm", position = {'),
                 self.STUDY.replace('"normal", sigmas = 1', '"uniform"'), BED)
        generator = np.random.default_rng(7)
        radius, angle = 5e-5 * np.sqrt(generator.uniform(size=(MACHINES, 6))), generator.uniform(0.0, 2.0 * np.pi, (MACHINES, 6))
        seats = radius[..., None] * np.stack([np.cos(angle), np.sin(angle)], -1)
        own = (self.turned_by(seats) <= np.radians(0.08)).all(axis=0).mean()
        self.assertAlmostEqual(own, 0.976, delta=0.01)
        self.assert_share(self.yield_of(), own)

    def test_given_places(self):
        """Uniform in the circle, as rows: the same machines are good."""
        generator = np.random.default_rng(6)
        radius, angle = 5e-5 * np.sqrt(generator.uniform(size=(4000, 6))), generator.uniform(0.0, 2.0 * np.pi, (4000, 6))
        seats = radius[..., None] * np.stack([np.cos(angle), np.sin(angle)], -1)
        good = (self.turned_by(seats) <= np.radians(0.08)).all(axis=0)
        self.assertAlmostEqual(good.mean(), 0.976, delta=0.01)
        self.write("parts.csv", table({f"seat_{axis}_{k + 1}": seats[:, k, i] for i, axis in enumerate("xy") for k in range(6)}))
        given = self.STUDY.replace("[analysis]", 'errors.machines = "parts.csv"\n[analysis]').replace(f"samples = {MACHINES}\n", "")
        with self.run_study(given.replace('factors = "all"', 'factors = ["seat_?_*"]')) as file:
            self.assertEqual(file["yield/machines"][()] - file["yield/rejects"][()], good.sum())


# A rotary delta, from Klipper's config/example-rotary-delta.cfg, #3339 and #1610.
ARMS = """\
format = "poesy-mechanism"
version = 1
name = "rotary-delta"
geometry = { s = "33.9 mm", r = "30 mm", u = "170 mm", l = "320 mm", H = "412.9 mm" }
error = [ { name = "zero", limb = "each", frame = "q", component = "epsilon_z" } ]
[platform]
origin = [0, 0, "H - sqrt(l^2 - (s + u)^2)"]
coordinates = ["x", "y", "z"]
workspace = { x = ["-60 mm", "60 mm"], y = ["-60 mm", "60 mm"], z = ["0 mm", "260 mm"] }
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "R", at = ["s + r", 0, "H"], axis = "-y", actuated = true },
  { name = "B", type = "U", at = ["s + r + u", 0, "H"], axis = "y", axis2 = ["sqrt(l^2 - (s + u)^2)", 0, "-s - u"] },
  { name = "C", type = "U", at = ["r", 0, "H - sqrt(l^2 - (s + u)^2)"], axis = ["sqrt(l^2 - (s + u)^2)", 0, "-s - u"], axis2 = "y" } ]
features = [
  { name = "shoulder", joint = "q", kind = "distance", direction = "x", tolerance = "0.3 mm" },
  { name = "arm", joint = "B", kind = "distance", direction = "x", tolerance = "0.3 mm" },
  { name = "rod", joint = "C", kind = "distance", direction = ["-s - u", 0, "-sqrt(l^2 - (s + u)^2)"], tolerance = "0.3 mm" } ]
"""


class RotaryDelta:
    """Rods between the elbows, each less the platform's joint, and the platform: three spheres."""

    s, u, l, H = 0.0339, 0.170, 0.320, 0.4129
    turns = 2.0 * np.pi * np.arange(3) / 3.0

    def drives(self, places):
        """Angles of the arms above the horizontal, [M x 3]."""
        c, s = np.cos(self.turns), np.sin(self.turns)
        out = places[:, :1] * c + places[:, 1:2] * s - self.s
        across = -places[:, :1] * s + places[:, 1:2] * c
        up = places[:, 2:] - self.H
        reach = out ** 2 + up ** 2
        return np.arctan2(up, out) + np.arccos((reach + self.u ** 2 - self.l ** 2 + across ** 2) / (2.0 * self.u * np.sqrt(reach)))

    def displacement(self, places, shoulder, arm, rod, zero):
        """Errors [N x 3]: [M x N x 3]. What an arm is too long is along the place of its drive, before the drive's zero."""
        q = self.drives(places)[:, None]
        out = self.s + shoulder + arm * np.cos(q) + self.u * np.cos(q + zero)
        up = self.H + arm * np.sin(q) + self.u * np.sin(q + zero)
        centres = np.stack([out * np.cos(self.turns), out * np.sin(self.turns), up], -1)
        radii = np.broadcast_to(self.l + rod, centres.shape[:-1])
        return three_spheres(centres, radii, places[:, None]) - places[:, None]


class Bowl(Case):
    """Case 03: a bed that is zeroed in the middle is a bowl, by shoulders, arms, rods and zeros."""

    PLACES = np.array([(r * np.cos(a), r * np.sin(a), 0.05) for r in (0.0, 0.025, 0.05) for a in np.radians((0, 60, 180))])
    STUDY = f"""\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
errors.zones = {{ distribution = "normal", sigmas = 3 }}
errors.angular = {{ distribution = "uniform", half_width = "0.1 deg" }}
[[response]]
name = "bowl"
sum = {{ z = 1 }}
relative_to = {{ x = 0, y = 0, z = "50 mm" }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = {MACHINES}
limits = {{ bowl = ["-0.06 mm", "0.07 mm"] }}
"""

    def setUp(self):
        super().setUp()
        self.say(ARMS, self.STUDY, self.PLACES)

    def test_displacements(self):
        rows = np.zeros((24, 4, 3))
        for kind in range(3):
            rows[kind, kind] = 1e-3
        rows[3, 3, 0] = np.radians(0.5)
        rows[4:] = np.random.default_rng(7).normal(0.0, 1e-3, (20, 4, 3))
        names = [f"{name}_{k}" for name in ("shoulder", "arm", "rod", "zero") for k in (1, 2, 3)]
        x, y, z, bowl = self.evaluated(dict(zip(names, rows.reshape(24, 12).T)), "x", "y", "z", "bowl")
        own = RotaryDelta().displacement(self.PLACES, *(rows[:, kind] for kind in range(4)))
        np.testing.assert_allclose(np.stack([x, y, z], -1), own, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(bowl, own[..., 2] - own[0, :, 2], rtol=0.0, atol=1e-12)
        # The answers of the case (um), in the middle and 50 mm off: shoulders 1 mm outwards, and rods 1 mm longer.
        for row, middle, edge in ((0, 655, 606), (2, -1193, -1179)):
            self.assertEqual((round(1e6 * z[0, row]), round(1e6 * z[7, row])), (middle, edge))

    def test_yield_of_the_bowl(self):
        generator = np.random.default_rng(8)
        lengths = generator.normal(0.0, 1e-4, (3, MACHINES, 3))
        zeros = generator.uniform(-np.radians(0.1), np.radians(0.1), (MACHINES, 3))
        z = RotaryDelta().displacement(self.PLACES, *lengths, zeros)[..., 2]
        bowl = z - z[:1]
        own = ((bowl >= -6e-5) & (bowl <= 7e-5)).all(axis=0).mean()
        self.assertTrue(0.1 < own < 0.9, own)
        self.assert_share(self.yield_of(), own)


class GearRatio(Case):
    """Case 19: the ratio of a gear is off by 0.1 %, so a drive is off by that share of its way from the end stop."""

    PLACES = np.array([(0.0, 0.0, 0.05), (0.05, 0.0, 0.05), (-0.025, 0.0433, 0.05), (-0.05, 0.0, 0.05)])
    STOP = np.array([(0.0, 0.0, 0.252)])

    def setUp(self):
        super().setUp()
        start = RotaryDelta().drives(self.STOP)[0, 0]
        mechanism = ARMS.replace('error = [ { name = "zero", limb = "each", frame = "q", component = "epsilon_z" } ]',
                                 'error = [ { name = "gear", limb = "each", frame = "q", component = "epsilon_z", '
                                 f'grows_with = "q", from = "{start.item()!r} rad" }} ]')
        study = Bowl.STUDY.replace('angular = { distribution = "uniform", half_width = "0.1 deg" }',
                                   'relative = { distribution = "normal", sigma = "0.1 %" }')
        study = study.replace('draws = "per machine"', 'draws = "per machine"\nfactors = ["gear_*"]')
        self.say(mechanism, study, self.PLACES)

    def displacement(self, gears):
        """[4 x N x 3]"""
        delta = RotaryDelta()
        ways = delta.drives(self.PLACES) - delta.drives(self.STOP)
        none = np.zeros((len(gears), 3))
        return np.concatenate([delta.displacement(place[None], none, none, none, gears * way)
                               for place, way in zip(self.PLACES, ways)])

    def test_displacements(self):
        gears = np.vstack([np.full(3, 1e-3), np.random.default_rng(14).normal(0.0, 1e-3, (20, 3))])
        found = np.moveaxis(self.evaluated({f"gear_{k + 1}": gears[:, k] for k in range(3)}, "x", "y", "z"), 0, -1)
        np.testing.assert_allclose(found, self.displacement(gears), rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(1e6 * found[:, 0, 2], [-277.2, -268.4, -268.4, -267.5], atol=0.05)

    def test_yield(self):
        z = self.displacement(np.random.default_rng(15).normal(0.0, 1e-3, (MACHINES, 3)))[..., 2]
        own = (np.abs(z) <= 2e-4).all(axis=0).mean()
        self.assertTrue(0.2 < own < 0.9, own)
        study = (self.folder / "study.toml").read_text()
        self.assert_share(self.yield_of(study.replace('bowl = ["-0.06 mm", "0.07 mm"]', 'z = "0.2 mm"')), own)


# From jlane1590/machinekit-files, modparakins.h (inches).
FEET = [(1.850, 0), (1.102, 0), (-0.925, 1.602), (-0.551, 0.954), (-0.925, -1.602), (-0.551, -0.954)]
BALLS = [(1.207, 1.012), (0.123, -0.698), (-1.480, 0.539), (0.543, 0.456), (0.274, -1.551), (-0.666, 0.243)]
CARRIAGES = """\
format = "poesy-mechanism"
version = 1
name = "paradex"
geometry = { A = "2.95300 in" }
error = [ { name = "foot", limb = "each", frame = 0, component = ["delta_x", "delta_y", "delta_z"] },
  { name = "rod", limb = "each", frame = 4, component = "delta_z" },
  { name = "ball", limb = "each", frame = 6, component = ["delta_x", "delta_y", "delta_z"] } ]
[platform]
origin = [0, 0, 0]
rotation = "zyx"
coordinates = ["x", "y", "z", "rx", "ry", "rz"]
workspace = { x = ["-0.2 in", "0.2 in"], y = ["-0.2 in", "0.2 in"], z = ["-0.2 in", "0.2 in"], rx = ["-5 deg", "5 deg"], ry = ["-5 deg", "5 deg"], rz = ["-5 deg", "5 deg"] }
""" + "".join(f"""\
[[limb]]
points = {{ C = ["{x} in", "{y} in", "sqrt(A^2 - ({x} in - {u} in)^2 - ({y} in - {v} in)^2)"] }}
joints = [ {{ name = "q", type = "P", at = "C", axis = "z", actuated = true }},
  {{ name = "U", type = "U", at = "C", axis = "x", axis2 = "y" }}, {{ name = "S", type = "S", at = ["{u} in", "{v} in", 0] }} ]
""" for (x, y), (u, v) in zip(FEET, BALLS))


class Inches(Case):
    """Case 05: six carriages on upright rails without any symmetry, rods of one length."""

    def test_displacements(self):
        generator = np.random.default_rng(9)
        poses = np.hstack([generator.uniform(-0.004, 0.004, (6, 3)), generator.uniform(-0.08, 0.08, (6, 3))])
        study = 'format = "poesy-study"\nversion = 1\nmechanism.file = "machine.toml"\nanalysis.kind = "evaluate"\n'
        self.say(CARRIAGES, study, poses, ("x", "y", "z", "rx", "ry", "rz"))
        rows = generator.normal(0.0, 2e-5, (30, 6, 7))
        names = [f"{name}_{k}" for k in range(1, 7)
                 for name in ("foot_x", "foot_y", "foot_z", "rod", "ball_x", "ball_y", "ball_z")]
        found = np.moveaxis(self.evaluated(dict(zip(names, rows.reshape(30, 42).T)), *DISPLACEMENT), 0, -1)

        rod = 2.953 * 0.0254
        feet = 0.0254 * np.column_stack([FEET, np.zeros(6)])
        balls = 0.0254 * np.column_stack([BALLS, np.zeros(6)])
        for pose, of_pose in zip(poses, found):
            rotation = np.eye(3)
            for axis in (2, 1, 0):
                rotation = rotation @ rotations(pose[3 + axis] * np.eye(3)[axis])
            seats = balls @ rotation.T + pose[:3]
            ends = feet.copy()
            ends[:, 2] = seats[:, 2] + np.sqrt(rod ** 2 - np.sum((seats - feet)[:, :2] ** 2, axis=1))
            turned, place = six_legs(ends + rows[..., :3], balls + rows[..., 4:], rod + rows[..., 3],
                                     np.tile(rotation, (30, 1, 1)), np.tile(pose[:3], (30, 1)))
            np.testing.assert_allclose(of_pose[:, :3], place - pose[:3], rtol=0.0, atol=1e-14)
            np.testing.assert_allclose(of_pose[:, 3:], rotation_vectors(turned @ rotation.T), rtol=0.0, atol=1e-12)


# The Orthoglide, from Caro, Wenger, Bennis, Chablat (arXiv 0708.4324).
ORTHOGLIDE = """\
format = "poesy-mechanism"
version = 1
name = "orthoglide"
geometry = { L = "310.58 mm" }
[platform]
origin = [0, 0, 0]
coordinates = ["x", "y", "z"]
metric_points = [["20 mm", 0, 0], [0, "20 mm", 0], [0, 0, "20 mm"]]    # all limbs end in one point
workspace = { x = ["-74 mm", "127 mm"], y = ["-74 mm", "127 mm"], z = ["-74 mm", "127 mm"] }
""" + "".join(f"""\
[[limb]]
joints = [ {{ name = "q", type = "P", at = [{corner}], axis = "{x}", actuated = true }},
  {{ name = "B", type = "U", at = [{corner}], axis = "{y}", axis2 = "{z}" }},
  {{ name = "C", type = "U", at = [0, 0, 0], axis = "{z}", axis2 = "{y}" }} ]
features = [ {{ name = "zero", joint = "B", kind = "distance", direction = "{x}", tolerance = "0.3 mm" }},
  {{ name = "leg", joint = "C", kind = "distance", direction = "{x}", tolerance = "0.3 mm" }} ]
""" for x, y, z, corner in (("x", "y", "z", '"-L", 0, 0'), ("y", "z", "x", '0, "-L", 0'), ("z", "x", "y", '0, 0, "-L"')))


class Orthoglide(Case):
    """Case 22: are the legs equal in what they do, and is the isotropic pose the least sensitive one?"""

    DIAGONAL = np.array([(t, t, t) for t in (-0.07365, -0.05, -0.025, 0.0, 0.025, 0.05, 0.075, 0.1, 0.12635)])
    STUDY = f"""\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
errors.zones = {{ distribution = "normal", sigmas = 3 }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = ["leg_*"]
samples = {MACHINES}
limits = {{ position = "0.25 mm" }}
"""
    L = 0.31058

    def displacement(self, places, zeros, legs):
        """Errors [N x 3]: [M x N x 3]."""
        squares = places ** 2
        drives = places - np.sqrt(self.L ** 2 - squares.sum(axis=1, keepdims=True) + squares)
        centres = (drives[:, None] + zeros)[..., None] * np.eye(3)
        radii = np.broadcast_to(self.L + legs, centres.shape[:-1])
        return three_spheres(centres, radii, places[:, None]) - places[:, None]

    def setUp(self):
        super().setUp()
        self.say(ORTHOGLIDE, self.STUDY, self.DIAGONAL)

    def test_displacements(self):
        rows = np.vstack([1e-4 * np.eye(6), np.random.default_rng(10).normal(0.0, 1e-4, (20, 6))])
        names = [f"{name}_{k}" for name in ("zero", "leg") for k in (1, 2, 3)]
        places = np.vstack([self.DIAGONAL, [(0.06, -0.07, 0.02)]])
        self.write("poses.csv", table(dict(zip("xyz", places.T))))
        found = np.moveaxis(self.evaluated(dict(zip(names, rows.T)), "x", "y", "z"), 0, -1)
        np.testing.assert_allclose(found, self.displacement(places, rows[:, :3], rows[:, 3:]), rtol=0.0, atol=1e-13)

    def test_published_claims(self):
        legs = np.random.default_rng(11).normal(0.0, 1e-4, (MACHINES, 3))
        own = (np.linalg.norm(self.displacement(self.DIAGONAL, 0.0 * legs, legs), axis=-1) <= 2.5e-4).all(axis=0).mean()
        self.assertTrue(0.1 < own < 0.9, own)
        self.assert_share(self.yield_of(), own)
        with h5py.File(self.folder / "out.h5") as file:
            at = list(file["responses/name"].asstr()).index("position")
            rms, shares = file["monte_carlo/rms"][at], file["yield/mean_square_share"][at]
        # On the diagonal all legs have equal shares. The shares are estimated from the machines, so the tolerance is
        # 0.01.
        np.testing.assert_allclose(shares, 1.0 / 3.0, atol=0.01)
        self.assertEqual(np.argmin(rms), 3)
        # At the isotropic pose each leg moves the platform by its own error, so three legs by sqrt(3) sigma; 3.9
        # standard errors.
        self.assertLess(abs(rms[3] / (1e-4 * np.sqrt(3.0)) - 1.0), 3.9 / np.sqrt(6.0 * MACHINES))


# A common alignment stage: drives U and V along x, W along y, each with a guide perpendicular to it.
STAGE = """\
format = "poesy-mechanism"
version = 1
name = "uvw"
geometry = { R = "62.5 mm" }
[platform]
origin = [0, 0, 0]
coordinates = ["x", "y", "rz"]
workspace = { x = ["-6 mm", "6 mm"], y = ["-6 mm", "6 mm"], rz = ["-5 deg", "5 deg"] }
""" + "".join(f"""\
[[limb]]
joints = [
  {{ name = "q", type = "P", at = {at}, axis = "{drive}", actuated = true }},
  {{ name = "guide", type = "P", at = {at}, axis = "{guide}" }},
  {{ name = "r", type = "R", at = {at}, axis = "z" }} ]
features = [ {{ name = "guide", joint = "guide", kind = "axis", length = "40 mm", x = "{drive}", perpendicularity = {{ zone = "0.012 mm", datums = "A" }} }} ]
""" for at, drive, guide in (('[0, "R", 0]', "x", "y"), ('[0, "-R", 0]', "x", "y"), ('["R", 0, 0]', "y", "x")))


class OutOfSquare(Case):
    """Case 25: a guide that is not square to its drive moves the stage by its way along the guide."""

    POSES = np.array([(0.0, 0.0, 0.0), (0.003, 0.004, np.radians(4.0)), (-0.005, 0.002, np.radians(-3.0))])
    R = 0.0625
    STUDY = f"""\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
errors.zones = {{ distribution = "normal", sigmas = 3 }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = ["guide_lean_x_*"]
samples = {MACHINES}
limits = {{ x = ["-0.4 um", "0.5 um"], theta_z = "2 arcsec" }}
"""

    def displacement(self, leans):
        """Angles between guide and drive [N x 3], less a right angle: x, y, rotation [M x N x 3]. Newton's method on the
        bearings, which lie on lines through where the drives put the guides."""
        homes = self.R * np.array([(0.0, 1.0), (0.0, -1.0), (1.0, 0.0)])
        along = np.stack([np.stack([np.sin(leans[:, k]), np.cos(leans[:, k])][::(1, 1, -1)[k]], -1) for k in range(3)], 1)
        square = np.stack([along[..., 1], -along[..., 0]], -1)

        def bearings(pose):
            turn = pose[..., 2:]
            c, s = np.cos(turn), np.sin(turn)
            return np.stack([pose[..., :1] + c * homes[:, 0] - s * homes[:, 1], pose[..., 1:2] + s * homes[:, 0] + c * homes[:, 1]], -1)

        found = []
        for nominal in self.POSES:
            at = bearings(nominal[None])[0]
            # The middles of the guides, which only the drives move.
            middles = np.array([(at[0, 0], homes[0, 1]), (at[1, 0], homes[1, 1]), (homes[2, 0], at[2, 1])])
            pose = np.tile(nominal, (len(leans), 1))
            for _ in range(6):
                off = np.sum((bearings(pose) - middles) * square, axis=-1)
                slopes = []
                for k in range(3):
                    step = np.zeros(3)
                    step[k] = 1e-6
                    slopes.append(np.sum((bearings(pose + step) - bearings(pose - step)) * square, axis=-1) / 2e-6)
                pose = pose - np.linalg.solve(np.stack(slopes, -1), off[..., None])[..., 0]
            assert np.abs(off).max() < 1e-16
            found.append(pose - nominal)
        return np.array(found)

    def setUp(self):
        super().setUp()
        self.say(STAGE, self.STUDY, self.POSES, ("x", "y", "rz"))

    def test_displacements(self):
        rows = np.vstack([4e-5 * np.eye(3), np.random.default_rng(12).normal(0.0, 4e-5, (20, 3))])
        found = self.evaluated({f"guide_lean_x_{k + 1}": rows[:, k] for k in range(3)}, "x", "y", "theta_z", "gap")
        own = self.displacement(rows / 0.04)
        np.testing.assert_allclose(np.moveaxis(found[:3], 0, -1), own, rtol=0.0, atol=2e-13)
        self.assertLess(found[3].max(), 1e-13)
        self.assertGreater(np.abs(own).max(), 1e-6)

    def test_out_of_the_plane(self):
        """The other lean has no effect in the plane: the limbs work against each other."""
        x, turned, gap = self.evaluated({"guide_lean_y_1": np.array([4e-5])}, "x", "theta_z", "gap")
        self.assertLess(np.abs(x).max(), 1e-7)
        self.assertLess(np.abs(turned).max(), 1e-6)
        self.assertGreater(gap.min(), 1e-6)
        models = self.succeeds("models", "machine.toml")
        self.assertIn("guide of limb 1 leans to x: its far end against its near end, 40 mm apart", models)

    def test_yield(self):
        leans = np.random.default_rng(13).normal(0.0, 4e-6, (MACHINES, 3)) / 0.04
        moved = self.displacement(leans)
        within = (moved[..., 0] >= -4e-7) & (moved[..., 0] <= 5e-7) & (np.abs(moved[..., 2]) <= np.radians(2.0 / 3600.0))
        own = within.all(axis=0).mean()
        self.assertTrue(0.1 < own < 0.9, own)
        self.assert_share(self.yield_of(), own)


if __name__ == "__main__":
    main()
