"""Allocations under limits over all poses of a machine, compared with closed-form kinematics (NumPy)."""

import os
from pathlib import Path

import h5py
import numpy as np

from linear_delta import Linear
from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
POSES = np.array([(x, y, z) for x, y in ((0.0, 0.0), (0.06, 0.0), (-0.03, 0.05), (-0.03, -0.05)) for z in (0.17, 0.24)])
ERRORS = """
[[error]]
name = "zero"
limb = "each"
frame = "q"
component = "delta_z"
[[error]]
name = "scale"
limb = "each"
frame = "q"
component = "delta_z"
grows_with = "q"
"""
STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ select = "file", file = "poses.csv" }}
[analysis]
kind = "allocation"
limits = {{ {limits} }}
yield = 0.9
sigmas = 3
samples = 20000
[[analysis.parts]]
name = "zeros"
factors = "linear"
cost = {{ law = "reciprocal", b = 1, unit = "mm" }}
[[analysis.parts]]
name = "scales"
factors = "relative"
cost = {{ law = "reciprocal", b = 0.3, unit = "%" }}
"""


def first_order():
    """[poses x 6 x 3] What each zero and scale does to x, y, z per unit."""
    delta, step = Linear(0.16, 0.3), 1e-6
    slopes = np.empty((len(POSES), 6, 3))
    for m, pose in enumerate(POSES):
        ways = delta.ways(pose, 0.2)
        for e in range(6):
            one = np.eye(3)[e % 3]
            sized = one / ways if e < 3 else one  # a zero error of 1 m equals a scale error of 1 / travel
            slopes[m, e] = (delta.moved(pose, step * sized, 0.2) - delta.moved(pose, -step * sized, 0.2)) / (2.0 * step)
    return slopes


class AllocationOverPoses(ProgramTest):
    def setUp(self):
        super().setUp()
        text = (DATA / "mechanisms/linear-delta-drawing.toml").read_text().split("features = [")[0]
        self.write("machine.toml", text + ERRORS)
        self.write("poses.csv", "x,y,z\n" + "".join(",".join(map(repr, row)) + "\n" for row in POSES.tolist()))
        self.normals = np.random.default_rng(8).normal(size=(100000, 6))
        self.slopes = first_order()

    def loads(self, tolerances, load):
        """Of machines whose errors have a third of these tolerances as standard deviation."""
        errors = self.normals * np.repeat(tolerances, 3) / 3.0
        return load(np.einsum("ne,mea->anm", errors, self.slopes))

    def check_limits(self, limits, load):
        self.write("study.toml", STUDY.format(limits=limits))
        done = self.poesy("run", "study.toml", "-o", "found.h5", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "found.h5") as file:
            tolerances = file["allocation/tolerance"][:]
            certified, count = (file["allocation/certificate"][name][()] for name in ("yield", "machines"))
            cost = file["allocation"].attrs["cost"]
        loads = self.loads(tolerances, load)
        own = (loads <= 1.0).mean()
        # The first-order map errs by less than 0.3 % of a load. 4.5 standard errors: alpha = 7e-6.
        linear = (np.abs(loads - 1.0) < 0.003).mean()
        self.assertLess(abs(certified - own), 4.5 * np.sqrt(own * (1.0 - own) * (1.0 / count + 1.0 / len(loads))) + linear)
        # Tolerances with other ratios but the same yield do not cost much less.
        for ratio in np.geomspace(0.2, 5.0, 21):
            tried = tolerances * np.array([ratio, 1.0])
            tried /= np.quantile(self.loads(tried, load), own)
            self.assertGreater((np.array([1e-3, 0.3e-2]) / tried).sum(), 0.99 * cost, ratio)
        return self.succeeds("show", "found.h5")

    def test_spread(self):
        shown = self.check_limits('z = { spread = "0.05 mm" }', lambda y: np.ptp(y[2], axis=1) / 5e-5)
        self.assertIn("z: a spread of 0.05 mm", " ".join(shown.split()))
        done = self.poesy("run", "found_certificate.toml", "-o", "again.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)

    def test_share(self):
        """At six of eight poses, between two ends."""
        def load(y):
            return np.sort(np.maximum(y[0] / 4e-5, -y[0] / 3e-5), axis=1)[:, 5]
        shown = self.check_limits('x = { from = "-0.03 mm", to = "0.04 mm", share = 0.75 }', load)
        self.assertIn("75 %", shown)

    def test_with_a_limit_at_each_pose(self):
        def load(y):
            return np.maximum(np.ptp(y[2], axis=1) / 8e-5, np.abs(y[0]).max(axis=1) / 4e-5)
        self.check_limits('z = { spread = "0.08 mm" }, x = "0.04 mm"', load)

    def test_a_spread_without_sign(self):
        self.write("study.toml", STUDY.format(limits='position = { spread = "0.05 mm" }'))
        done = self.poesy("check", "study.toml")
        self.assertEqual(done.returncode, 2)
        message = " ".join(done.stderr.decode().split())
        self.assertIn("study.toml:7:23: analysis.limits.position is a limit on the spread over the poses, but position has no sign", message)
        self.assertIn("limit the spread of a response with a sign", message)


if __name__ == "__main__":
    main()
