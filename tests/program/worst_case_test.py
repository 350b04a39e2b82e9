"""The worst case of a coupling study is the largest value of all corners: a planar 3-RPR by independent kinematics,
solved for every combination of signs."""

import itertools
import json
import math

import h5py
import numpy
from poesy_program import ProgramTest, main

RADIUS, PLATFORM = 0.1, 0.04
MECHANISM = """\
format = "poesy-mechanism"
version = 1
name = "rpr3"

[platform]
origin = [0, 0, 0]
coordinates = ["x", "y", { phi = "rz" }]
workspace = { x = ["-20 mm", "20 mm"], y = ["-20 mm", "20 mm"], phi = ["-50 deg", "50 deg"] }

[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "A", type = "R", at = ["100 mm", 0, 0], axis = "z" },
  { name = "q", type = "P", from = "A", to = "C", actuated = true },
  { name = "C", type = "R", at = ["40 mm * cos(60 deg)", "40 mm * sin(60 deg)", 0], axis = "z" } ]

[[error]]
name = "base"
limb = "each"
frame = 0
component = ["delta_x", "delta_y"]

[[error]]
name = "leg"
limb = "each"
frame = 2
component = "delta_z"

[[error]]
name = "plat"
limb = "each"
frame = 3
component = ["delta_x", "delta_y"]

[sets]
base = ["base_*"]
leg = ["leg_*"]
plat = ["plat_*"]
"""
STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "rpr.toml"
poses = {{ select = "file", file = "poses.csv" }}
[analysis]
kind = "coupling"
linear = {sizes}
limbs = "independent"
components = "independent"
sources = [{{ name = "base", factors = {base} }}, {{ name = "leg", factors = "leg" }}, {{ name = "plat", factors = {plat} }}]
"""
ALL = {"base": '"base"', "plat": '"plat"'}
ERRORS = ([f"base_{axis}_{limb}" for limb in (1, 2, 3) for axis in "xy"] + [f"leg_{limb}" for limb in (1, 2, 3)]
          + [f"plat_{axis}_{limb}" for limb in (1, 2, 3) for axis in "xy"])
OWN = {"x": 0, "y": 1, "theta_z": 2, "position": 3}

AZIMUTH = 2 * numpy.pi * numpy.arange(3) / 3
BASE = RADIUS * numpy.stack([numpy.cos(AZIMUTH), numpy.sin(AZIMUTH)], -1)
HINGE = PLATFORM * numpy.stack([numpy.cos(AZIMUTH + numpy.pi / 3), numpy.sin(AZIMUTH + numpy.pi / 3)], -1)


def turned(angle, vectors):
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.stack([c * vectors[..., 0] - s * vectors[..., 1], s * vectors[..., 0] + c * vectors[..., 1]], -1)


def own_kinematics(errors, pose):
    """x, y, theta_z, position [n x 4] of the platform with these errors [n x 15], by Newton on the lengths of its legs."""
    base, leg, hinge = errors[:, :6].reshape(-1, 3, 2), errors[:, 6:9], errors[:, 9:].reshape(-1, 3, 2)
    x0, y0, phi0 = pose
    place = numpy.tile([x0, y0], (len(errors), 1)).astype(float)
    angle = numpy.full(len(errors), float(phi0))
    length = numpy.linalg.norm([x0, y0] + turned(numpy.full(3, phi0), HINGE) - BASE, axis=1) + leg
    for _ in range(12):
        arm = turned(angle[:, None] * numpy.ones(3), HINGE + hinge)
        rod = place[:, None] + arm - (BASE + base)
        now = numpy.linalg.norm(rod, axis=2)
        along = rod / now[..., None]
        slope = numpy.concatenate([along, (arm[..., 0] * along[..., 1] - arm[..., 1] * along[..., 0])[..., None]], -1)
        step = numpy.linalg.solve(slope, (length - now)[..., None])[..., 0]
        place += step[:, :2]
        angle += step[:, 2]
    assert numpy.abs(step).max() < 1e-12
    moved = place - [x0, y0]
    return numpy.column_stack([moved, angle - phi0, numpy.hypot(moved[:, 0], moved[:, 1])])


def corners(names, size):
    """All combinations of signs of these errors, [2^n x 15]."""
    signs = numpy.array(list(itertools.product([-1.0, 1.0], repeat=len(names))))
    errors = numpy.zeros((len(signs), len(ERRORS)))
    errors[:, [ERRORS.index(name) for name in names]] = size * signs
    return errors


class WorstCase(ProgramTest):
    def run_study(self, poses, sizes, sources=None, name="out"):
        self.write("rpr.toml", MECHANISM)
        self.write("poses.csv", "x [mm],y [mm],phi [deg]\n" + "".join(f"{x},{y},{phi}\n" for x, y, phi in poses))
        self.write("study.toml", STUDY.format(sizes=json.dumps(sizes), **(sources or ALL)))
        self.succeeds("run", "study.toml", "-o", f"{name}.h5", "--quiet")
        return h5py.File(self.folder / f"{name}.h5")

    def check_signs(self, file, size, pose, response):
        """The signs that the file names give the value that it states."""
        at = list(file["responses/name"].asstr()).index(response)
        signs = dict(zip(file["factors/name"].asstr(), file["coupling/worst_case_signs"][at, 0, -1]))
        errors = size * numpy.array([[signs[name] for name in ERRORS]])
        own = own_kinematics(errors, pose)[0, OWN[response]]
        self.assertAlmostEqual(abs(own) / file["coupling/worst_case_max"][at, 0, -1], 1.0, places=9)

    def test_all_corners_of_few_errors(self):
        few = {"base": '["base_x_1", "base_y_2", "base_x_3"]', "plat": '["plat_y_1", "plat_x_2", "plat_y_3"]'}
        names = {"base": json.loads(few["base"]), "leg": ["leg_1", "leg_2", "leg_3"], "plat": json.loads(few["plat"])}
        poses = [(0, 0, 0), (10, 5, -40)]
        with self.run_study(poses, ["0.1 mm", "1 mm"], few) as file:
            responses, subsets = list(file["responses/name"].asstr()), list(file["subset"].asstr())
            found = file["coupling/worst_case"][:]
            self.assertEqual(file["coupling/unsolved_corners"][:].sum(), 0)
        short = []
        for (k, subset), (z, size), (m, pose) in itertools.product(
                enumerate(subsets), enumerate((1e-4, 1e-3)), enumerate(poses)):
            errors = corners([name for source in subset.split("+") for name in names[source]], size)
            own = numpy.abs(own_kinematics(errors, (pose[0] / 1e3, pose[1] / 1e3, math.radians(pose[2])))).max(axis=0)
            for response, at in OWN.items():
                share = found[responses.index(response), z, k, m] / own[at]
                self.assertLess(share, 1 + 1e-9, (subset, size, pose, response))
                if response == "position":
                    self.assertGreater(share, 0.9)  # for a norm, single flips of signs may miss the worst corner
                elif share < 1 - 1e-9:
                    short.append((subset, size, pose, response, share))
        self.assertEqual(short, [])

    def test_all_32768_corners(self):
        """+-0.1 mm on 15 lengths near the singular pose: the sum of single effects says 1.8001 deg, a corner has 1.9908 deg;
        at +-1 mm, -40 deg it says 9.62 deg, and a corner has 14.51 deg."""
        for size, angle, by_sum, by_corner in ((0.1, -50, 1.8001, 1.9908), (1.0, -40, 9.62, 14.51)):
            pose = (0.010, 0.005, math.radians(angle))
            own = numpy.abs(own_kinematics(corners(ERRORS, size / 1e3), pose)).max(axis=0)
            self.assertAlmostEqual(math.degrees(own[OWN["theta_z"]]), by_corner, delta=0.005)
            with self.run_study([(10, 5, angle)], [f"{size} mm"]) as file:
                responses = list(file["responses/name"].asstr())
                at = responses.index("theta_z")
                self.assertAlmostEqual(math.degrees(file["coupling/first_order_sum"][at, 0, -1, 0]), by_sum, delta=0.005)
                self.assertAlmostEqual(file["coupling/worst_case"][at, 0, -1, 0] / own[OWN["theta_z"]], 1.0, places=9)
                self.assertLess(file["coupling/corners"][0, -1, 0], 1500)
                for response in OWN:
                    self.check_signs(file, size / 1e3, pose, response)

    def test_it_is_shown_as_found_and_as_no_bound(self):
        self.run_study([(10, 5, -40)], ["1 mm"]).close()
        shown = " ".join(self.succeeds("show", "out.h5", "--response", "theta_z").split())
        self.assertIn("14.509", shown)
        self.assertIn("9.6201", shown)
        self.assertIn("first-order sum", shown)
        self.assertIn("No bound", shown)
        self.assertRegex(shown, r"worst case of base\+leg\+plat: pose 0 \(.*\), with [+-]base_x_1, ")
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("which is not a bound", page)
        self.succeeds("export", "out.h5", "-d", "tables")
        rows = (self.folder / "tables/coupling_corners.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(rows), 1 + 7 * len(ERRORS))

    def test_check_counts_the_corners(self):
        self.run_study([(0, 0, 0)], ["1 mm"]).close()
        self.assertRegex(self.succeeds("check", "study.toml"), r"and about \d+(\.\d+)?(e\+\d+)? for the worst cases")


if __name__ == "__main__":
    main()
