"""The places of joints and frames: `poesy evaluate --frames` compared with geometry computed here, and the picture of a
report compared with `poesy evaluate --frames`."""

import csv
import io
import json
import re
from html.parser import HTMLParser

import numpy as np

from poesy_program import GALLERY, STUDY, ProgramTest, main

HEAD = 'format = "poesy-study"\nversion = 1\n'
SHORT = '[errors]\nlinear = { distribution = "normal", sigma = "0.1 mm" }\nangular = { distribution = "normal", sigma = "0.05 deg" }\n'
POSES = ((-0.2, 0.0, 0.0), (-0.19, 0.25, -0.3), (-0.23, -0.2, 0.35))
WITHIN = 1e-9  # mm
DRAWN = 6e-4  # mm: pictures have three decimals
PIXEL = 0.06


def rotation(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)]["xyz".index(axis)]
    R = np.eye(3)
    R[i, i] = R[j, j] = c
    R[i, j], R[j, i] = -s, s
    return R


class Frames:
    """The rows of --frames by pose, limb, what they are and number."""

    def __init__(self, rows):
        self.point, self.axes, self.names = {}, {}, {}
        for row in rows:
            key = (int(row["pose"]), int(row["limb"]), row["what"], int(row["number"]))
            self.names[key] = row["name"]
            self.point[key] = np.array([row[c] for c in "xyz"])
            self.axes[key] = np.array([[row[f"{axis}_{c}"] for c in "xyz"] for axis in "xyz"], dtype=float).T


class Pictures(HTMLParser):
    """Of each pose in a report its title, and the joints and links drawn, with their attributes."""

    def __init__(self, text):
        super().__init__()
        self.poses, self.data, self.inside, self.middle = [], "", None, None
        self.feed(text)
        self.figure = json.loads(self.data)["figures"]["robot"]

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        kinds = (given.get("class") or "").split()
        if "robot-pose" in kinds:
            self.poses.append({"title": "", "joints": [], "links": []})
        elif tag == "svg" and self.poses and self.middle is None:
            self.middle = [float(number) / 2 for number in given["viewbox"].split()[2:]]
        elif "joint" in kinds or "link" in kinds:
            self.poses[-1]["joints" if "joint" in kinds else "links"].append(given)
        self.inside = "title" if "plot-title" in kinds else "data" if given.get("id") == "report-data" else None

    def handle_data(self, data):
        if self.inside == "title":
            self.poses[-1]["title"] += data
        elif self.inside == "data":
            self.data += data

    def handle_endtag(self, tag):
        self.inside = None


def points(text):
    return np.array([[float(number) for number in point.split(",")] for point in text.split()])


class FramesTest(ProgramTest):
    def frames(self, study, names, poses):
        self.write("poses.csv", ",".join(names) + "\n" + "\n".join(",".join(map(repr, pose)) for pose in poses) + "\n")
        table = json.loads(self.succeeds("evaluate", study, "--poses", "poses.csv", "--frames", "json"))
        return Frames(table["rows"])

    def near(self, found, wanted, within=WITHIN):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=within)

    def parallel(self, found, wanted):
        self.near(np.cross(found, wanted), 0.0, 1e-12)
        self.near(np.linalg.norm(found), 1.0, 1e-12)

    def test_2upr_rpu_as_the_paper_has_it(self):
        self.write("study.toml", STUDY)
        found = self.frames("study.toml", ("z", "beta", "gamma"), POSES)
        l_A, l_B, c, d = 60.0, 150.0, 25.0, 115.0
        for m, (z, beta, gamma) in enumerate(POSES):
            R = rotation("x", beta) @ rotation("y", gamma)
            P = 1e3 * np.array([0.0, -z * np.tan(beta), z])
            v, x = R[:, 1], np.array([1.0, 0.0, 0.0])
            for i, (A, B) in enumerate((((l_A, 0, 0), (l_B, 0, 0)), ((-l_A, 0, 0), (-l_B, 0, 0)), ((0, l_A, 0), (0, l_B, 0)))):
                leg = P + R @ A - B
                home = np.array([0.0, 0.0, -200.0]) + A - np.array(B)
                point = lambda what, number: found.point[m, i + 1, what, number]
                axis = lambda number: found.axes[m, i + 1, "frame", number][:, 2]
                for number, wanted in enumerate((B, B, P + R @ A), 1):
                    self.near(point("joint", number), wanted)
                self.near(point("frame", 0), 0.0)
                self.near(point("frame", 5), P)
                self.near(found.axes[m, i + 1, "frame", 5], R, 1e-12)
                if i < 2:
                    self.near(point("frame", 1), np.array(B) + (1 if i == 0 else -1) * np.array([d, 0, 0]))
                    for number, wanted in ((1, x), (2, v), (3, leg / np.linalg.norm(leg)), (4, v)):
                        self.parallel(axis(number), wanted)
                    slide = 3
                else:
                    self.near(point("frame", 4), P + R @ np.array([0, l_A - c, 0]))
                    for number, wanted in ((1, x), (2, leg / np.linalg.norm(leg)), (3, x), (4, v)):
                        self.parallel(axis(number), wanted)
                    slide = 2
                moved = (1 - np.linalg.norm(home) / np.linalg.norm(leg)) * leg  # the frame moves with the slide
                self.near(point("frame", slide), np.array(B) + moved)

    def test_3prs_closes(self):
        self.write("study.toml", HEAD + '[mechanism]\nmodel = "3-prs"\n' + SHORT + '[analysis]\nkind = "sensitivity"\n')
        poses = ((0.0, 0.0, 0.75), (0.1, -0.2, 0.8), (-0.25, 0.15, 0.7))
        found = self.frames("study.toml", ("alpha", "beta", "z"), poses)
        for m, (alpha, beta, z) in enumerate(poses):
            P, R = found.point[m, 1, "frame", 5], found.axes[m, 1, "frame", 5]
            self.near(R[:, 2], rotation("x", alpha) @ rotation("y", beta) @ [0, 0, 1], 1e-12)
            self.near(R @ R.T, np.eye(3), 1e-12)
            self.near(P[2], 1e3 * z)
            for i in range(3):
                turn = rotation("z", 2 * np.pi * i / 3)
                rail, rod, ball = (found.point[m, i + 1, "joint", number] for number in (1, 2, 3))
                self.near(rail, turn @ [250, 0, 0])
                self.near(rod[:2], rail[:2])
                self.near(ball, P + R @ turn @ [135, 0, 0])
                self.near(np.linalg.norm(ball - rod), 570.0)
                self.near(ball @ turn[:, 1], 0.0)
                self.parallel(found.axes[m, i + 1, "frame", 3][:, 2], (ball - rod) / 570.0)

    def test_text_csv_and_json_say_the_same(self):
        self.write("study.toml", STUDY)
        found = self.frames("study.toml", ("z", "beta", "gamma"), POSES)
        command = ("evaluate", "study.toml", "--poses", "poses.csv", "--frames")
        rows = list(csv.DictReader(io.StringIO(self.succeeds(*command, "csv"))))
        self.assertEqual(len(rows), len(found.point))
        for row in rows:
            key = (int(row["pose"]), int(row["limb"]), row["what"], int(row["number"]))
            self.assertEqual([float(row[f"{c} [mm]"]) for c in "xyz"], list(found.point[key]))
            self.assertEqual(row["name"], found.names[key])
        text = self.succeeds(*command, "text")
        self.assertIn("Joints and frames without errors", text)
        self.assertEqual(text.count("U joint 1"), 3 * 2 * 3)
        self.assertIn("'xml' is not a form of a table", self.poesy(*command, "xml").stderr.decode())
        self.assertEqual(self.poesy(*command, "csv", "--errors", "poses.csv").returncode, 2)

    def check_report(self, study, home, coordinates):
        """Joints in the picture against --frames, and where they are drawn against the data that turn them."""
        self.succeeds("run", study, "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5", "-o", "r.html")
        pictures = Pictures((self.folder / "r.html").read_text())
        self.succeeds("export", "r.h5", "-d", "tables")
        with open(self.folder / "tables" / "poses.csv", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        columns = [next(c for c, head in enumerate(rows[0]) if head.split(" [")[0] == name) for name in coordinates]
        self.assertTrue(all(rows[0][c].endswith(("[m]", "[rad]")) for c in columns), rows[0])
        poses = [home] + [tuple(float(row[c]) for c in columns) for row in rows[1:]]
        found = self.frames(study, coordinates, poses)
        self.assertGreater(len(pictures.poses), 3)
        self.assertEqual(len(pictures.poses), len(pictures.figure["poses"]))
        apart = 0
        for picture in pictures.poses:
            number = re.match(r"Pose (\d+)", picture["title"])
            pose = 0 if number is None else int(number[1]) + 1
            self.assertEqual(number is None, picture["title"] == "At home" or picture["title"].startswith("At home;"))
            self.assertTrue(picture["joints"])
            for joint in picture["joints"]:
                limb, own = int(joint["data-limb"]), int(joint["data-joint"])
                wanted = found.point[pose, limb, "joint", own]
                self.near(points(joint["data-at"])[0], wanted, DRAWN)
                others = [point for key, point in found.point.items()
                          if key[:3] == (pose, limb, "joint") and key[3] != own]
                if min(np.linalg.norm(point - wanted) for point in others) > 20.0:
                    self.near(points(joint["data-p"])[0], wanted, DRAWN)
                    apart += 1
                self.check_place(pictures, joint)
        self.assertGreater(apart, 3)
        return pictures

    def check_place(self, pictures, joint):
        figure, (x, y) = pictures.figure, pictures.middle
        at = points(joint["data-p"])[0] - figure["centre"]
        if figure["down"]:
            at[1:] *= -1
        yaw, pitch = np.radians(figure["yaw"]), np.radians(figure["pitch"])
        deep = at[0] * np.sin(yaw) + at[1] * np.cos(yaw)
        wanted = (x + figure["scale"] * (at[0] * np.cos(yaw) - at[1] * np.sin(yaw)),
                  y - figure["scale"] * (at[2] * np.cos(pitch) + deep * np.sin(pitch)))
        found = [float(number) for number in re.findall(r"-?[\d.]+", joint["transform"])]
        self.near(found, wanted, PIXEL)

    def test_the_picture_of_a_mechanism_of_the_catalog(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 100"))
        pictures = self.check_report("study.toml", (-0.2, 0.0, 0.0), ("z", "beta", "gamma"))
        errors = {error["name"]: error["words"] for error in pictures.figure["errors"]}
        self.assertEqual(errors, {
            "delta_1_1_y": "limb 1, inside U joint 1: displacement along y of frame 1",
            "epsilon_1_4_z": "limb 1, between R joint 3 and the platform: rotation about z of the platform",
            "epsilon_3_0_y": "limb 3, between the base and R joint 1: rotation about y of the base"})

    def test_the_picture_of_a_mechanism_from_a_file(self):
        for name in ("3-rps.toml", "study.toml"):
            text = (GALLERY / "3-rps" / name).read_text()
            self.write(name, text.replace("samples = 1000", "samples = 20"))
        pictures = self.check_report("study.toml", (0.0, 0.0, 0.6), ("rx", "ry", "z"))
        at_home = {(joint["data-limb"], joint["data-joint"]): points(joint["data-at"])[0]
                   for joint in pictures.poses[0]["joints"]}
        for i in range(3):  # the points of the file
            turn = rotation("z", 2 * np.pi * i / 3)
            for number, wanted in (("1", (250, 0, 0)), ("2", (250, 0, 0)), ("3", (135, 0, 600))):
                self.near(at_home[str(i + 1), number], turn @ wanted, DRAWN)

    def test_shares_of_parts_add_up(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 100"))
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5")
        html = (self.folder / "r.html").read_text()
        shares = re.findall(r"data-table=\"shares_of_parts\".*?</table>", html, re.S)[0]
        numbers = [float(number) for number in re.findall(r"<td class=\"n\"[^>]*>([\d.]+)</td>", shares)]
        self.assertAlmostEqual(sum(numbers), 100.0, delta=0.1)

    def test_shares_of_groups_are_divided(self):
        """Parts are coloured by even divisions, but no error is given a share that only its group has."""
        kind = 'kind = "sobol"\nfactors = ["delta_1_1_x", "delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]\nsamples = 64\ngroups = "limb"\n'
        self.write("study.toml", STUDY.split("[analysis]")[0] + "[analysis]\n" + kind + "[run]\nseed = 5\n")
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5")
        html = (self.folder / "r.html").read_text()
        self.assertIn("That of a group is divided evenly among its errors", html)
        self.assertEqual({error["share"] for error in Pictures(html).figure["errors"]}, {""})
        self.assertIn("Make the errors of limb 1 smaller first; what has", html)  # its interval is above that of limb 3
        table = re.findall(r"data-table=\"where_errors_are\".*?</table>", html, re.S)[0]
        self.assertNotIn(">share", table)


if __name__ == "__main__":
    main()
