"""Machines with several assembly modes: for errors of any size the solved mode continues the nominal one as the
errors grow from zero, and there is none if a singularity comes first. Compared with independent kinematics that are
followed too."""

import os
from pathlib import Path

import h5py
import numpy as np

from own_kinematics import FlatDelta, SixLegs, SixRods, three_spheres
from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"]) / "mechanisms"
CONVERGED, STAGNATED, NOT_ASSEMBLED = 0, 1, 5
MOVES = ("x", "y", "z", "theta_x", "theta_y", "theta_z")


class AssemblyModes(ProgramTest):
    def solved(self, file, pose, errors):
        """Status [N], displacement [N x 6], and the machines that are solved [N]."""
        self.write(file, (DATA / file).read_text())
        self.write("pose.csv", ",".join(pose) + "\n" + ",".join(map(repr, map(float, pose.values()))))
        rows = np.column_stack(list(errors.values()))
        self.write("errors.csv", "\n".join([",".join(errors), *(",".join(map(repr, map(float, row))) for row in rows)]))
        self.write("s.toml", f'format = "poesy-study"\nversion = 1\nmechanism.file = "{file}"\nanalysis.kind = "evaluate"\n')
        self.succeeds("evaluate", "s.toml", "--poses", "pose.csv", "--errors", "errors.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as result:
            group = result["evaluate"]
            status = group["status"][0]
            self.assertLessEqual(set(status), {CONVERGED, STAGNATED, NOT_ASSEMBLED})
            return status, np.stack([group[name][0] for name in MOVES], -1), status != NOT_ASSEMBLED

    def check(self, machine, place, errors, least):
        """Of these at least so many cannot be assembled near the nominal pose."""
        pose = dict(zip("xyz", place))
        if "rx" in machine.coordinates:
            pose |= {"rx": 0.0, "ry": 0.0, "rz": 0.0}
        status, found, solved = self.solved(machine.file, pose, errors)
        assembled, wanted = machine.followed(errors, np.array(place))
        np.testing.assert_array_equal(solved, assembled)
        np.testing.assert_allclose(found[solved, :3], wanted[solved, :3], rtol=0.0, atol=1e-9)
        small = solved & (np.linalg.norm(found[:, 3:], axis=-1) < 1.5)
        np.testing.assert_allclose(found[small, 3:], wanted[small, 3:], rtol=0.0, atol=1e-8)
        self.assertGreaterEqual((~assembled).sum(), least)
        self.assertGreater(assembled.mean(), 0.5)

    def test_six_rods(self):
        generator = np.random.default_rng(21)
        for size, least in ((1e-3, 0), (3e-3, 0), (6e-3, 15)):
            errors = {name: (size / 0.1 if name.startswith("lean") else size) * generator.standard_normal(300)
                      for name in SixRods.names}
            self.check(SixRods(), (0.03, -0.02, 0.04), errors, least)

    def test_six_legs(self):
        generator = np.random.default_rng(22)
        for size, least in ((1e-3, 0), (5e-3, 0), (15e-3, 20)):
            errors = {name: size * generator.standard_normal(300) for name in SixLegs.names}
            self.check(SixLegs(), (0.0, 0.0, 0.8), errors, least)

    def test_three_rods_that_are_nearly_flat(self):
        """Two ways to assemble them, above and below their ends. Rods too long by far lead away from the singularity."""
        lengths = np.concatenate([-np.geomspace(1e-6, 1e-2, 60), np.geomspace(1e-6, 4e-2, 60)])
        errors = {f"rod_{k}": lengths for k in (1, 2, 3)}
        status, found, solved = self.solved(FlatDelta.file, FlatDelta.pose, errors)
        np.testing.assert_array_equal(solved, FlatDelta().margins(errors, len(lengths)) > 0.0)
        ends = 0.16 * np.array([[np.cos(a), np.sin(a), 0.0] for a in 2.0 * np.pi * np.arange(3) / 3.0])
        rods = np.hypot(0.16, 0.005) + lengths
        ends, rods = np.tile(ends, (len(lengths), 1, 1)), np.tile(rods[:, None], (1, 3))
        below = three_spheres(ends[solved], rods[solved], np.array([0.0, 0.0, -1.0]))
        np.testing.assert_allclose(found[solved, 2], below[:, 2] + 0.005, rtol=0.0, atol=1e-9)


if __name__ == "__main__":
    main()
