"""`poesy evaluate` without --poses: the errors of a table at the poses that the study selects."""

import h5py
import numpy as np

from poesy_program import STUDY, ProgramTest, main

ERRORS = "delta_1_1_y,epsilon_1_4_z\n0.001,0\n0,0.002\n-0.0005,0.001\n"
AXES = ("z", "beta", "gamma")
TRAJECTORY = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs" }
poses = { select = "trajectory", trajectory = { file = "way.csv", points = 4 } }
"""


class OwnPoses(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.write("errors.csv", ERRORS)

    def evaluated(self, *options, study="study.toml"):
        self.succeeds("evaluate", study, "--errors", "errors.csv", *options, "-o", "rows.h5", "--quiet")
        with h5py.File(self.folder / "rows.h5") as file:
            return file["evaluate/linear_deformation"][:], np.array([file[f"poses/{axis}"][:] for axis in AXES]).T

    def table(self, poses):
        rows = [",".join(AXES)] + [",".join(map(repr, map(float, pose))) for pose in poses]
        return self.write("poses.csv", "\n".join(rows) + "\n")

    def refusal(self, *arguments):
        done = self.poesy(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertFalse((self.folder / "out.h5").exists())
        return done.stderr.decode()

    def test_are_those_of_the_run(self):
        self.succeeds("run", "study.toml", "-o", "run.h5", "--quiet")
        with h5py.File(self.folder / "run.h5") as file:
            expected = np.array([file[f"poses/{axis}"][:] for axis in AXES]).T
        values, poses = self.evaluated()
        np.testing.assert_array_equal(poses, expected)
        self.table(expected)
        np.testing.assert_array_equal(values, self.evaluated("--poses", "poses.csv")[0])
        # Poses of a table replace those of the study.
        self.table(expected[:2])
        np.testing.assert_array_equal(values[:2], self.evaluated("--poses", "poses.csv")[0])

    def test_of_a_file_that_the_study_names(self):
        (self.folder / "below").mkdir()
        self.table([[-0.2, 0.1, 0.1], [-0.25, 0.0, 0.2], [-0.22, -0.1, 0.0]])
        (self.folder / "poses.csv").rename(self.folder / "below/poses.csv")
        self.write("below/study.toml", STUDY.replace("count = 6", 'select = "file"\nfile = "poses.csv"'))
        values, poses = self.evaluated(study="below/study.toml")
        self.assertEqual(poses.tolist(), [[-0.2, 0.1, 0.1], [-0.25, 0.0, 0.2], [-0.22, -0.1, 0.0]])
        pairs = self.evaluated("--paired", study="below/study.toml")[0]
        np.testing.assert_array_equal(pairs.ravel(), np.diag(values))
        message = self.refusal("evaluate", "below/study.toml", "--errors", "errors.csv", "-o", "below/poses.csv")
        self.assertIn("below/poses.csv", message)  # the result must not replace the poses

    def test_along_the_file_of_a_trajectory(self):
        self.write("way.toml", TRAJECTORY)
        self.write("way.csv", "t,alpha,beta,z\n0,0,0,0.8\n1,0.05,0,0.82\n")
        self.write("l.csv", "l_1\n1e-4\n")
        self.succeeds("evaluate", "way.toml", "--errors", "l.csv", "-o", "way.h5", "--quiet")
        with h5py.File(self.folder / "way.h5") as file:
            np.testing.assert_allclose(file["poses/alpha"][:], np.linspace(0, 0.05, 4))

    def test_frames(self):
        text = self.succeeds("evaluate", "study.toml", "--frames", "csv")
        self.assertEqual({line.split(",")[0] for line in text.splitlines()[1:]}, set("012345"))

    def test_refusals(self):
        arguments = ("--errors", "errors.csv", "-o", "out.h5")
        self.write("none.toml", STUDY.replace("[poses]\ncount = 6\n", ""))
        self.assertIn("none.toml:1:1: key 'poses' is missing; write it, or give a table of poses: --poses P.csv",
                      self.refusal("evaluate", "none.toml", *arguments))
        self.write("empty.toml", STUDY.replace("count = 6\n", ""))
        self.assertIn("empty.toml:5:1: key 'count' is missing in [poses]", self.refusal("evaluate", "empty.toml", *arguments))
        self.assertIn("3 rows of errors for 6 poses", self.refusal("evaluate", "study.toml", *arguments, "--paired"))
        # With a table of poses the study need not have poses.
        self.table([[-0.2, 0.1, 0.1]])
        self.succeeds("evaluate", "none.toml", "--poses", "poses.csv", *arguments, "--quiet")


if __name__ == "__main__":
    main()
