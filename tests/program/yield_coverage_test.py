"""How often the interval of a yield holds the truth, for limits of all kinds, errors drawn anew at each pose, given
machines, features of a drawing and clearances. The truth is by linear kinematics (NumPy), so all studies are of
first order."""

import h5py
import numpy as np

from poesy_program import MECHANISMS, ProgramTest, main
from six_rods import PLACES, machines, rod_effects

SEEDS, MACHINES = 30, 300  # number of studies of each kind, and of machines in each
DRAWS = 400_000  # machines for the truth: its standard error is below a fifth of that of all studies together
Z = 3.9  # two-sided alpha 1e-4, for each of three checks of each kind
RODS = [f"rod_{k}" for k in range(1, 7)]
STUDY = """\
format = "poesy-study"
version = 1
mechanism = {{ file = "{file}", fidelity = "first-order" }}
poses = {{ select = "file", file = "places.csv" }}
errors = {{ {errors} }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = {factors}
samples = {samples}
limits = {{ {limits} }}
"""


def table(names, rows):
    return ",".join(names) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows.tolist())


def least_holding(count, share=0.95):
    """So many of `count` intervals at least hold the truth, except with a probability of 1e-4."""
    k = np.arange(count)
    falls = np.cumsum(np.log((count - k) / (k + 1.0)))
    tail = np.exp(np.concatenate([[0.0], falls]) + np.arange(count + 1) * np.log(share) +
                  (count - np.arange(count + 1)) * np.log1p(-share))
    return int(np.searchsorted(np.cumsum(tail), 1e-4))


def chi_square_quantile(freedoms, z):
    """By Wilson and Hilferty, from that of a normal."""
    return freedoms * (1.0 - 2.0 / (9.0 * freedoms) + z * np.sqrt(2.0 / (9.0 * freedoms))) ** 3


class Coverage(ProgramTest):
    def holds(self, truth, given=None, places=PLACES, **study):
        """Runs studies with many seeds. `truth` is the share of good machines; `given` writes the machines of a seed."""
        self.assertTrue(0.2 < truth < 0.95, truth)
        self.write("places.csv", table(["x [m]", "y [m]", "z [m]"], places))
        self.write("study.toml", STUDY.format(samples=MACHINES, **study))
        rejects, held = [], 0
        for seed in range(1, SEEDS + 1):
            if given is not None:
                given(seed)
            done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet", "--seed", seed)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(self.folder / "out.h5") as file:
                self.assertEqual(file["yield/machines"][()], MACHINES)
                rejects.append(int(file["yield/rejects"][()]))
                held += file["yield/ci_low"][()] <= truth <= file["yield/ci_high"][()]
        # Clopper-Pearson intervals hold the truth at least as often as stated.
        self.assertGreaterEqual(held, least_holding(SEEDS))
        # The rejects have no bias, and scatter like those of independent machines.
        variance = MACHINES * truth * (1.0 - truth)
        offset = np.mean(rejects) - MACHINES * (1.0 - truth)
        error = np.sqrt(variance / SEEDS + MACHINES ** 2 * truth * (1.0 - truth) / DRAWS)
        self.assertLess(abs(offset), Z * error)
        spread = np.square(np.array(rejects) - np.mean(rejects)).sum() / variance
        self.assertGreater(spread, chi_square_quantile(SEEDS - 1, -Z))
        self.assertLess(spread, chi_square_quantile(SEEDS - 1, Z))


class YieldCoverage(Coverage):
    def test_limits_of_all_kinds(self):
        rods = np.random.default_rng(1).normal(0.0, 5e-5, (DRAWS, 6))
        turn_x, _, _, x, y, z = np.moveaxis(rod_effects() @ rods.T, 0, -1)  # each [machines x places]
        good = ((z >= -7e-5) & (z <= 1e-4)).all(axis=1) & (x <= 3e-4).all(axis=1)
        good &= (np.abs(y) <= 1.5e-4).sum(axis=1) >= 5
        good &= np.ptp(turn_x, axis=1) <= 8e-4
        self.holds(good.mean(), file=MECHANISMS / "delta6.toml", factors=RODS,
                   errors='linear = { distribution = "normal", sigma = "0.05 mm" }',
                   limits='z = ["-0.07 mm", "0.1 mm"], x = { to = "0.3 mm" }, theta_x = { spread = "0.8 mrad" }, '
                          'y = { from = "-0.15 mm", to = "0.15 mm", share = 0.7 }')

    def test_draws_per_pose(self):
        """Beside errors that a machine keeps."""
        generator = np.random.default_rng(2)
        nominal = machines(np.zeros((1, 6)))
        # [places x 6] cosines of the angles between the rods and the vertical.
        along = nominal.legs()[..., 2] / np.linalg.norm(nominal.legs(), axis=-1)
        rods = generator.normal(0.0, 3e-5, (DRAWS, 6))
        z = np.empty((DRAWS, len(PLACES)))
        for place, effect in enumerate(rod_effects()[:, 5]):
            stops = generator.uniform(-3e-5, 3e-5, (DRAWS, 6))
            z[:, place] = rods @ effect + stops @ (effect * along[place])
        self.holds((np.abs(z) <= 5e-5).all(axis=1).mean(), file=MECHANISMS / "delta6.toml", factors=["rod_*", "stop_*"],
                   errors='linear = { distribution = "normal", sigma = "0.03 mm" }, '
                          'override = { "stop_*" = { distribution = "uniform", half_width = "0.03 mm", draws = "per pose" } }',
                   limits='z = "0.05 mm"')

    def test_given_machines(self):
        """Each seed has other parts, which have a mean; three rods are drawn."""
        def parts(generator, count):
            return np.column_stack([generator.normal(3e-5, 4e-5, count), generator.exponential(3e-5, count),
                                    generator.uniform(-9e-5, 0.0, count)])

        def write(seed):
            self.write("parts.csv", table(RODS[:3], parts(np.random.default_rng(1000 + seed), MACHINES)))

        generator = np.random.default_rng(3)
        rods = np.hstack([parts(generator, DRAWS), generator.normal(0.0, 3e-5, (DRAWS, 3))])
        z = rods @ rod_effects()[:, 5].T
        self.holds((np.abs(z) <= 5e-5).all(axis=1).mean(), write, file=MECHANISMS / "delta6.toml", factors=RODS,
                   errors='linear = { distribution = "normal", sigma = "0.03 mm" }, machines = "parts.csv"',
                   limits='z = "0.05 mm"')


class Legs:
    """Of a linear Delta whose legs are a rod between two universal joints: to first order a leg holds the distance of its two
    joints, and the platform's turning about what is square to both axes of a joint."""

    R, r, rise, height = 0.220, 0.060, 0.300, 0.200

    def __init__(self, place):
        turns = 2.0 * np.pi * np.arange(3) / 3.0
        self.out = np.stack([np.cos(turns), np.sin(turns), np.zeros(3)], -1)
        self.hinge = np.stack([-np.sin(turns), np.cos(turns), np.zeros(3)], -1)
        self.lower = place + self.r * self.out
        self.upper = self.R * self.out
        rod = np.hypot(self.R - self.r, self.rise)
        self.upper[:, 2] = place[2] + np.sqrt(rod ** 2 - np.sum((self.upper - self.lower)[:, :2] ** 2, axis=1))
        self.rod = (self.lower - self.upper) / rod
        across = np.cross(self.hinge, np.cross(self.hinge, self.rod))
        self.square = across / np.linalg.norm(across, axis=1, keepdims=True)
        # Rows: displacement along each rod, rotation about the normal of each leg's hinge and cross pin. Columns:
        # rotation, displacement of the origin.
        self.held = np.vstack([np.hstack([np.cross(self.lower - place, self.rod), self.rod]),
                               np.hstack([self.square, np.zeros((3, 3))])])

    def effects(self, limb, turn, point, displacement):
        """Displacement of the origin where what is behind a place of the limb is turned and displaced: `point` is where the
        displacement is. Columns of [3 x n] each: [3 x n]."""
        at = self.lower[limb][:, None] - point[:, None]
        moved = np.zeros((6, turn.shape[1]))
        moved[limb] = self.rod[limb] @ (displacement + np.cross(turn, at, axis=0))
        moved[3 + limb] = self.square[limb] @ turn
        return np.linalg.solve(self.held, moved)[3:]


DELTA = """\
format = "poesy-mechanism"
version = 1
name = "delta"
geometry = { R = "220 mm", r = "60 mm", h = "300 mm", e = "200 mm" }
[platform]
origin = [0, 0, "e"]
coordinates = ["x", "y", "z"]
workspace = { x = ["-80 mm", "80 mm"], y = ["-80 mm", "80 mm"], z = ["150 mm", "250 mm"] }
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "P", at = ["R", 0, "e + h"], axis = "z", x = "x", actuated = true },
  { name = "B", type = "U", at = ["R", 0, "e + h"], axis = "y", axis2 = ["h", 0, "r - R"] },
  { name = "C", type = "U", at = ["r", 0, "e"], axis = ["h", 0, "r - R"], axis2 = "y" } ]
features = [
  { name = "rail", joint = "q", kind = "axis", length = "500 mm", at = ["R", 0, "300 mm"], position = { zone = "0.05 mm", datums = "A|B" }, perpendicularity = { zone = "0.02 mm", datums = "A" } },
  { name = "rod", joint = "C", kind = "distance", direction = ["r - R", 0, "-h"], tolerance = "0.02 mm" } ]
clearances = [ { name = "play", joint = "B", length = "40 mm", fit = "8 H7/g6" } ]
"""


class DrawingCoverage(Coverage):
    POSES = np.array([(0.0, 0.0, 0.2), (0.08, -0.08, 0.15), (-0.05, 0.03, 0.24)])

    def displacements(self, generator, loose):
        """[machines x poses x 3]: rails and rods, which a machine keeps, and the clearance at each pose."""
        middle, lean = np.sqrt(5e-5 ** 2 - 2e-5 ** 2) / 6.0, 2e-5 / 3.0
        kept = [(generator.normal(0.0, middle, (2, DRAWS)), generator.normal(0.0, lean, (2, DRAWS)),
                 generator.normal(0.0, 2e-5 / 3.0, DRAWS)) for _ in range(3)]
        # Fit 8 H7/g6: each end of the pin touches the bore, so it is off by half the clearance (5 to 29 um, root mean
        # square 17.2 um) in a random direction. `end` is its standard deviation along an axis (m). Shift and tilt have
        # equal parts of the variance.
        end = 17.2481883107e-6 / np.sqrt(8.0)
        found = np.zeros((DRAWS, len(self.POSES), 3))
        for m, pose in enumerate(self.POSES):
            legs = Legs(pose)
            for k, (at, leans, longer) in enumerate(kept):
                up, out, side = np.array([0.0, 0.0, 1.0]), legs.out[k], legs.hinge[k]
                plane = np.column_stack([out, side])
                foot = legs.R * out + [0.0, 0.0, 0.3]
                none = np.zeros((3, 2))
                found[:, m] += (legs.effects(k, none, foot, plane) @ at).T
                tilts = np.column_stack([side, -out]) / 0.5
                found[:, m] += (legs.effects(k, tilts, foot, none) @ leans).T
                found[:, m] += np.outer(longer, legs.effects(k, none[:, :1], foot, legs.rod[k][:, None])[:, 0])
                if loose:
                    plane = np.column_stack([out, up])
                    tilts = np.column_stack([np.cross(side, out), np.cross(side, up)]) / 0.04
                    shifts = legs.effects(k, none, legs.upper[k], plane)
                    turns = legs.effects(k, tilts, legs.upper[k], none)
                    found[:, m] += (shifts @ generator.normal(0.0, end / np.sqrt(2.0), (2, DRAWS))).T
                    found[:, m] += (turns @ generator.normal(0.0, end * np.sqrt(2.0), (2, DRAWS))).T
        return found

    def holds_of(self, limit, loose):
        self.write("delta.toml", DELTA if loose else DELTA[:DELTA.index("clearances")])
        moved = self.displacements(np.random.default_rng(4), loose)
        good = (np.linalg.norm(moved, axis=-1) <= limit).all(axis=1)
        self.holds(good.mean(), file="delta.toml", places=self.POSES, factors='"all"', limits=f'position = "{limit} m"',
                   errors='zones = { distribution = "normal", sigmas = 3 }')

    def test_features(self):
        self.holds_of(3.5e-5, loose=False)

    def test_clearances(self):
        self.holds_of(7e-5, loose=True)


if __name__ == "__main__":
    main()
