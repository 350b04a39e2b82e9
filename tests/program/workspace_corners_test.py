"""What `check`, `run` and reports say of a workspace: the travel of the drives, compared with closed-form kinematics, and
the machines that miss a limit only at a corner, compared with runs at these poses."""

import itertools
import os
import re
from pathlib import Path

import h5py
import numpy as np

from linear_delta import Linear
from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
SIDES = {"x": (-0.05, 0.05), "y": (-0.04, 0.06), "z": (0.15, 0.25)}
CENTRE = [(0.0, 0.01, 0.2)]
CORNERS = list(itertools.product(*SIDES.values()))
HOME = 0.2
BOX = ", ".join(f'{name} = ["{low} m", "{high} m"]' for name, (low, high) in SIDES.items())
ONE_POSE = f'select = "grid", count = {{ x = 1, y = 1, z = 1 }}, workspace = {{ {BOX} }}'
STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "machine.toml"
poses = {{ {poses} }}
errors = {{ linear = {{ distribution = "normal", sigma = "0.02 mm" }} }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = 100
limits = {{ {limit} }}
"""
ZEROS = """
[[error]]
name = "zero"
limb = "each"
frame = "q"
component = "delta_z"
"""


class WorkspaceCorners(ProgramTest):
    def setUp(self):
        super().setUp()
        text = (DATA / "mechanisms/linear-delta-drawing.toml").read_text()
        self.write("machine.toml", text.split("features = [")[0] + ZEROS)

    def check(self, poses, limit):
        self.write("study.toml", STUDY.format(poses=poses, limit=limit))
        return self.poesy("check", "study.toml").stdout.decode()

    def rejects(self, poses, limit):
        """The number of machines that a run at these poses rejects."""
        self.write("poses.csv", "x,y,z\n" + "".join(",".join(map(repr, pose)) + "\n" for pose in poses))
        self.write("study.toml", STUDY.format(poses='select = "file", file = "poses.csv"', limit=limit))
        (self.folder / "out.h5").unlink(missing_ok=True)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as file:
            return file["yield/rejects"][()]

    def test_machines_that_miss_a_limit_only_at_a_corner(self):
        limit = 'position = "0.03 mm"'
        at_centre, with_corners = self.rejects(CENTRE, limit), self.rejects(CENTRE + CORNERS, limit)
        self.assertLess(0, at_centre)
        self.assertLess(at_centre, with_corners)
        said = self.check(ONE_POSE, limit)
        self.assertIn(f"# corners: of the first 100 machines, {at_centre} miss a limit at the poses of the study, and "
                      f"{with_corners - at_centre} more at a corner of the workspace; to study the corners, write "
                      'select = "grid", count = { x = 2, y = 2, z = 2 }\n', said)

    def test_a_run_and_its_report_say_what_the_verdict_does_not_cover(self):
        study = STUDY.replace("samples", 'factors = ["zero_1", "zero_3"]\nyield = 0.5\nsamples').replace("100", "3000")
        self.write("study.toml", study.format(poses=ONE_POSE, limit='position = "0.03 mm"'))
        left_out = "eft out: 1 of the 3 errors of the mechanism does not vary and is zero: zero_2"
        at_corners = re.compile(r"of the first 100 machines, \d+ miss a limit at the poses of the study, and \d+ more at a corner", re.I)
        messages = " ".join(self.poesy("run", "study.toml", "-o", "out.h5").stderr.decode().split())
        self.assertIn("poesy: l" + left_out, messages)
        self.assertRegex(messages, at_corners)
        self.assertIn("l" + left_out, " ".join(self.succeeds("show", "out.h5").split()))
        self.succeeds("report", "out.h5", "-o", "out.html")
        advice = re.search("What to do</dt>\\s*<dd>(.*?)</dd>", (self.folder / "out.html").read_text(encoding="utf-8"), re.S)[1]
        self.assertIn("L" + left_out, advice)
        self.assertRegex(advice, at_corners)

    def test_corners_that_are_studied(self):
        said = self.check(ONE_POSE.replace("= 1", "= 2"), 'position = "0.03 mm"')
        self.assertRegex(said, "# corners: of the first 100 machines, [1-9][0-9]* miss a limit at the poses of the study, and "
                               "no further one at a corner of the workspace\n")

    def test_limits_over_several_poses_are_left_out(self):
        self.assertNotIn("# corners", self.check(ONE_POSE, 'z = { spread = "0.05 mm" }'))

    def test_travel_of_drives(self):
        ways = np.array([Linear(0.16, 0.3).ways(pose, HOME) for pose in CENTRE + CORNERS])
        said = self.check(ONE_POSE, 'position = "0.03 mm"')
        line = re.search("# travel of the drives from home, at these poses and at the corners of the workspace: (.*)\n", said)[1]
        found = re.findall(r"q_\d_\d from (\S+) mm to (\S+) mm", line)
        own = 1e3 * np.stack([ways.min(axis=0), ways.max(axis=0)], -1)
        np.testing.assert_allclose(np.array(found, float), own, rtol=6e-4)

    def test_travel_at_poses_of_a_file(self):
        self.write("poses.csv", "x,y,z\n" + ",".join(map(repr, CORNERS[0])) + "\n")
        said = self.check('select = "file", file = "poses.csv"', 'position = "0.03 mm"')
        self.assertIn("# travel of the drives from home, at these poses: ", said)
        self.assertNotIn("# corners", said)


if __name__ == "__main__":
    main()
