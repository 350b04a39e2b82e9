"""Poses along a trajectory: the published helix, from a study file to errors over time, and what is refused."""

import csv
import math

from poesy_program import ProgramTest, main

HEAD = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
"""
HELIX = 'trajectory = { curve = "helix", points = 401 }'
CASES = """\
[analysis]
kind = "evaluate"
cases = [
  { name = "FS", errors = { platform-hinges = { linear = "0.1 mm" } } },
  { name = "T", errors = { initial-position = { linear = "0.1 mm" } } },
  { name = "R", errors = { revolute-gap = { linear = "0.1 mm" } } },
  { name = "L", errors = { rod-length = { linear = "0.1 mm" } } },
]
"""
# The largest |x|, |y|, |z| displacement of the tip (mm) for h = 171.7 mm, computed independently.
MAXIMA = {"FS": (.04621, .04714, .00618), "T": (0, 0, .1), "R": (.02307, .02364, .07933), "L": (.00011, .00010, .10216)}


def study(trajectory, mechanism="", model="3-prs", poses=""):
    head = HEAD.replace("3-prs", model)
    return head + mechanism + f'[poses]\nselect = "trajectory"\n{trajectory}\n{poses}' + CASES


def circle(rows=9, radius=0.03, height=0.85):
    """A circle of the tip as CSV, once round in 2 s."""
    text = "t,tip_x,tip_y,tip_z\n"
    for k in range(rows):
        angle = 2 * math.pi * k / (rows - 1)
        text += f"{2 * k / (rows - 1)},{radius * math.cos(angle)},{radius * math.sin(angle)},{height}\n"
    return text


class Trajectory(ProgramTest):
    def run_study(self, text):
        self.write("study.toml", text)
        self.succeeds("run", "study.toml", "-o", "study.h5", "--quiet")
        self.succeeds("export", "study.h5", "-d", "tables")
        with open(self.folder / "tables" / "evaluate.csv", newline="") as file:
            return list(csv.DictReader(file))

    def refused(self, text, words, place="bad.toml:7:14"):
        self.write("bad.toml", text)
        for command in [("run", "bad.toml", "-o", "out.h5", "--quiet"), ("check", "bad.toml")]:
            done = self.poesy(*command)
            message = done.stderr.decode()
            self.assertEqual(done.returncode, 2, message)
            self.assertEqual(message.count("\n"), 1, message)
            self.assertTrue(message.startswith(f"poesy: {place}"), message)
            for word in words:
                self.assertIn(word, message)
        self.assertFalse((self.folder / "out.h5").exists())

    def test_maxima_of_the_published_helix(self):
        rows = self.run_study(study(HELIX, 'fidelity = "first-order"\n'))
        self.assertEqual(len(rows), 4 * 401)
        for name, expected in MAXIMA.items():
            own = [row for row in rows if row["case"] == name]
            self.assertEqual([float(row["time [s]"]) for row in own], [2.0 * k / 400 for k in range(401)])
            for axis, wanted in zip("xyz", expected):
                largest = max(abs(float(row[f"tip_{axis} [m]"])) for row in own) * 1e3
                self.assertAlmostEqual(largest, wanted, delta=5.1e-6, msg=f"{name} {axis}")

    def test_check_says_where_it_leads(self):
        self.write("study.toml", study(HELIX))
        self.assertIn("# trajectory: 401 poses from 0 s to 2 s, alpha -", self.succeeds("check", "study.toml"))

    def test_a_file_in_any_coordinates(self):
        self.write("curve.csv", circle())
        by_tip = self.run_study(study('trajectory = { file = "curve.csv" }'))
        with open(self.folder / "tables" / "poses.csv", newline="") as file:
            poses = list(csv.DictReader(file))
        self.assertEqual([float(pose["time [s]"]) for pose in poses], [0.25 * k for k in range(9)])
        columns = {"t": "time [s]", "alpha": "alpha [rad]", "beta": "beta [rad]", "z": "z [m]"}
        self.write("curve.csv", "\n".join([",".join(columns)] + [",".join(p[c] for c in columns.values()) for p in poses]))
        self.assertEqual(self.run_study(study('trajectory = { file = "curve.csv" }')), by_tip)
        self.assertEqual(len(self.run_study(study('trajectory = { file = "curve.csv", points = 21 }'))), 4 * 21)

    def test_any_mechanism_takes_a_file(self):
        self.write("curve.csv", "t,z,beta,gamma\n0,-0.2,0,0\n1,-0.22,0.1,0\n2,-0.24,0.1,0.2\n3,-0.22,0,0.2\n")
        cases = '[analysis]\nkind = "evaluate"\ncases = [{ errors = { linear = "0.1 mm" }, name = "all" }]\n'
        text = study('trajectory = { file = "curve.csv", time = ["0.5 s", "2500 ms"], points = 5 }', model="2upr-rpu")
        rows = self.run_study(text.replace(CASES, cases))
        self.assertEqual([float(row["time [s]"]) for row in rows], [0.5, 1, 1.5, 2, 2.5])

    def test_poses_of_a_table_in_a_chart(self):
        self.write("study.toml", study(HELIX))
        self.write("errors.csv", "q_1,q_2,q_3\n1e-4,1e-4,1e-4\n")
        self.write("poses.csv", "q_1,q_2,q_3\n0.2,0.21,0.19\n")
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "out.h5", "--quiet")
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables" / "joint_displacements.csv", newline="") as file:
            joints = next(csv.DictReader(file))
        for name, wanted in {"q_1": 0.2, "q_2": 0.21, "q_3": 0.19}.items():
            self.assertAlmostEqual(float(joints[f"{name} [rad or m]"]), wanted, delta=1e-14)
        for poses, place, words in [("q_1,q_2,q_3\n0.2,0.2,0.2\n0,0,2\n", "3", ["q_3 = 2 m", "closer together", "SI"]),
                                    ("q_1,q_2,tip_z\n0.2,0.2,0.8\n", "1", ["mix", "alpha,beta,z | tip_x,tip_y,tip_z | q_1"]),
                                    ("alpha,beta,z\n20,0,0.8\n", "2", ["alpha = 20 rad = 1145.92 deg", "SI: metres and rad"])]:
            self.write("poses.csv", poses)
            done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv")
            message = done.stderr.decode()
            self.assertEqual(done.returncode, 2, message)
            self.assertTrue(message.startswith(f"poesy: poses.csv:{place}"), message)
            for word in words:
                self.assertIn(word, message)

    def test_a_tool_too_short(self):
        for h in ("60 mm", "70.3 mm"):
            self.refused(study(HELIX, f'geometry = {{ h = "{h}" }}\n').replace('model = "3-prs"\n', 'model = "3-prs" # \n'),
                         ["point 1 of 401, at t = 0 s (tip_x = 30 mm, tip_y = 0 mm, tip_z = 850 mm)", "lengthen h"],
                         "bad.toml:8:14")
        self.assertEqual(len(self.run_study(study(HELIX, 'geometry = { h = "70.5 mm" }\n'))), 4 * 401)

    def test_a_stroke_left(self):
        self.refused(study('trajectory = { curve = "helix", origin = ["0 mm", "0 mm", "700 mm"] }'),
                     ["point ", " of 201, at t = ", "limb ", "above the upper end of its rail", "origin"])

    def test_a_singular_point(self):
        self.refused(study(HELIX, poses="max_condition = 1.69\n"),
                     ["singular", "condition number 1.70002", "max_condition, 1.69"])

    def test_bad_files(self):
        lines = circle().splitlines(keepends=True)
        for text, place, words in [("".join(lines[:4] + lines[3:]), "curve.csv:5:1", ["t = 0.5 s", "second time", "line 4"]),
                                   ("".join(lines[:3] + lines[1:]), "curve.csv:4:1", ["t = 0.0 s", "t = 0.25 s", "line 3"]),
                                   ("".join(lines[:2]), "curve.csv:3:1", ["at least two"]),
                                   (circle().replace("tip_x", "x"), "curve.csv:1:3", ["'x'"]),
                                   (circle(radius=0.2), "curve.csv:2:1", ["point 1 of 9", "tip_x = 200 mm", "lengthen h"]),
                                   ("t,alpha,beta,z\n0,0,0,0.8\n1,20,0,0.8\n", "curve.csv:3:1", ["alpha = 1145.92 deg", "SI"])]:
            with self.subTest(place + words[0]):
                self.write("curve.csv", text)
                words = [word.replace("0.0 s", "0 s") for word in words]
                self.refused(study('trajectory = { file = "curve.csv" }'), words, place)

    def test_quantities_without_unit(self):
        self.refused(study('trajectory = { curve = "helix", origin = [0, "0 mm", "850 mm"] }'), ["bare number 0", "unit"],
                     "bad.toml:7:43")
        self.refused(study('trajectory = { curve = "helix", time = [0, 2] }'), ["bare number 0", "unit", '"1 s"'],
                     "bad.toml:7:41")
        self.refused(study('trajectory = { curve = "helix", time = ["0 s", "3 s"] }'), ["0 s to 3 s", "0 s to 2 s"], "bad.toml:7:40")


if __name__ == "__main__":
    main()
