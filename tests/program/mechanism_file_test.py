"""Mechanisms from files: reference cases, all steps of a study, and results that are complete without the file."""

import csv
import json
import math
import os
from pathlib import Path

import h5py
import numpy

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
WITHIN = 1e-10

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
file = "{name}.toml"
[poses]
count = 4
[analysis]
kind = "sensitivity"
factors = "all"
samples = 300
[solver]
{solver}
"""


def table(rows, names):
    lines = [",".join(repr(row.get(name, 0.0)) for name in names) for row in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def turned(beta, gamma):
    """Rx(beta) Ry(gamma)."""
    (cb, sb), (cg, sg) = ((numpy.cos(angle), numpy.sin(angle)) for angle in (beta, gamma))
    return numpy.array([[1, 0, 0], [0, cb, -sb], [0, sb, cb]]) @ numpy.array([[cg, 0, sg], [0, 1, 0], [-sg, 0, cg]])


def quantities(points):
    return "[" + ", ".join("[" + ", ".join(f'"{value!r} m"' for value in point) + "]" for point in points) + "]"


class MechanismFile(ProgramTest):
    def take(self, name):
        self.write(f"{name}.toml", (DATA / "mechanisms" / f"{name}.toml").read_bytes())

    def study(self, name, solver="", file="study.toml"):
        self.take(name)
        return self.write(file, STUDY.format(name=name, solver=solver))

    def check_cases(self, name, cases, key, solver, share):
        self.study(name, solver)
        factors = sorted({factor for case in cases for factor in case["errors"]})
        self.write("poses.csv", table([case["pose"] for case in cases], list(cases[0]["pose"])))
        self.write("errors.csv", table([case["errors"] for case in cases], factors))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "-o", "all.h5")
        with h5py.File(self.folder / "all.h5") as result:
            group = result["evaluate"]
            for m, case in enumerate(cases):
                self.assertLess(group["status"][m, 0], 2)
                found = case if key is None else case[key]
                deformations = {name: value for name, value in found.items() if isinstance(value, float)}
                within = WITHIN if share == 0.0 else 3e-8 + share * found["response"]["rotation"]
                for response, value in {**found["response"], **deformations}.items():
                    self.assertAlmostEqual(group[response][m, 0], value, delta=within, msg=response)

    def test_reference_cases(self):
        mechanisms = json.loads((DATA / "mechanisms.json").read_text())["mechanisms"]
        for name, mechanism in mechanisms.items():
            cases = mechanism["cases"]
            metrics = {"metric": "platform", "published": "published"} if "metric" in cases[0] else {None: None}
            for key, metric in metrics.items():
                for method in ("newton", "gauss-newton"):
                    solver = f'method = "{method}"\n' + (f'metric = "{metric}"\n' if metric else "")
                    if metric == "platform":
                        solver += f"points = {quantities(mechanism['metric_points'])}\n"
                    # With the platform metric the reference compares limbs in pairs, which is the same only to first
                    # order.
                    share = 1e-5 if metric == "platform" else 0.0
                    with self.subTest(mechanism=name, metric=metric, method=method):
                        self.check_cases(name, cases, key, solver, share)

    def test_what_was_understood(self):
        self.take("upr2-rpu")
        shown = self.succeeds("models", "upr2-rpu.toml", "-o", "picture.svg")
        self.assertIn("12 joints (3 actuated), rank 9 of 12 loop equations: 3 freedoms, 3 over-constraints", shown)
        self.assertIn("delta_1_0_x", shown)
        picture = (self.folder / "picture.svg").read_text()
        self.assertIn("<svg", picture)
        self.assertIn("</svg>", picture)
        self.succeeds("models", "upr2-rpu.toml", "-o", "picture.svg")  # a picture by poesy may be replaced
        self.write("drawing.svg", "<svg>somebody's own</svg>")
        for name, wanted in (("drawing.svg", "would be lost"), ("picture.png", "PICTURE.svg")):
            done = self.poesy("models", "upr2-rpu.toml", "-o", name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(wanted, done.stderr.decode())
        done = self.poesy("models", "upr2-rpu")
        self.assertIn("write 'upr2-rpu.toml'", done.stderr.decode())

    def test_a_template_runs(self):
        for name in ("rps3", "upr2-rpu", "ups6"):
            self.take(name)
            template = self.succeeds("template", f"{name}.toml", "monte-carlo", "--full")
            template = template.replace("count = 158", "count = 2").replace("samples = 1000", "samples = 20")
            self.write("template.toml", template)
            self.assertIn("# mobility:", self.succeeds("check", "template.toml"))
            self.succeeds("run", "template.toml", "--quiet")
            self.succeeds("report", "template.h5")

    def displacements_by_unit(self, factors, points, poses):
        """How errors move points of the platform (its frame), by differences of exact solves: [pose, 3 x points, error]."""
        step = 1e-6
        rows = [{factor: sign * step} for factor in factors for sign in (1, -1)]
        self.write("errors.csv", table(rows, factors))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "differences.h5")
        with h5py.File(self.folder / "differences.h5") as result:
            found = {name: result["evaluate"][name][:] for name in ("x", "y", "z", "theta_x", "theta_y", "theta_z", "status")}
        self.assertTrue((found["status"] < 2).all())
        by_unit = []
        for m, (_, beta, gamma) in enumerate(poses):
            twist = numpy.array([(found[name][m, ::2] - found[name][m, 1::2]) / (2 * step)
                                 for name in ("x", "y", "z", "theta_x", "theta_y", "theta_z")])
            arms = points @ turned(beta, gamma).T
            by_unit.append(numpy.concatenate([twist[:3] + numpy.cross(twist[3:].T, arm).T for arm in arms]))
        return numpy.array(by_unit) / numpy.sqrt(len(points))

    def test_what_calibration_can_remove(self):
        self.study("upr2-rpu")
        text = (self.folder / "upr2-rpu.toml").read_text()
        # Without [errors] the file has all errors, including those along the drives.
        self.write("upr2-rpu.toml", text[: text.index("\n[errors]")])
        poses = [(-0.25, 0.2, -0.3), (-0.2, -0.3, 0.1)]
        self.write("poses.csv", "z,beta,gamma\n" + "\n".join(",".join(map(str, pose)) for pose in poses) + "\n")
        self.write("study.toml", (self.folder / "study.toml").read_text().replace("count = 4", 'select = "file"\nfile = "poses.csv"'))
        self.succeeds("run", "study.toml", "--quiet")
        with h5py.File(self.folder / "study.h5") as result:
            factors = list(result["factors/name"].asstr()[:])
            found = {name: result["separation"][name][:] for name in ("effect", "residual", "removable_local")}
            self.assertEqual(set(result["separation/published"].asstr()[:]), {""})
        points = numpy.array([(0.06, 0, 0), (-0.06, 0, 0), (0, 0.06 - 0.025, 0)])  # the last joints of the limbs (m)
        drives = [factors.index(name) for name in ("delta_1_3_z", "delta_2_3_z", "delta_3_2_z")]
        for m, by_unit in enumerate(self.displacements_by_unit(factors, points, poses)):
            left = by_unit - by_unit[:, drives] @ numpy.linalg.lstsq(by_unit[:, drives], by_unit, rcond=None)[0]
            effect, residual = numpy.linalg.norm(by_unit, axis=0), numpy.linalg.norm(left, axis=0)
            numpy.testing.assert_allclose(found["effect"][:, m], effect, rtol=1e-6, atol=1e-7)
            numpy.testing.assert_allclose(found["residual"][:, m], residual, rtol=1e-6, atol=1e-7)
            moves = effect > 1e-6
            self.assertGreater(moves.sum(), 60)
            numpy.testing.assert_allclose(found["removable_local"][moves, m], 1 - residual[moves] / effect[moves], atol=1e-5)
        shown = self.succeeds("show", "study.h5")
        self.assertIn("What calibration can remove of each error's effect", shown)
        self.assertIn("root mean square displacement of the platform's points, without the gap between its limbs", shown)
        self.assertNotIn("published class", shown)
        self.succeeds("report", "study.h5")
        self.assertIn('id="calibration"', (self.folder / "study.html").read_text())

    def test_calibration_of_six_drives_removes_everything(self):
        self.study("ups6")
        self.succeeds("run", "study.toml", "--quiet")
        with h5py.File(self.folder / "study.h5") as result:
            removable = result["separation/removable"][:]
            self.assertEqual(result["separation/removable_together"][()], 1.0)
            self.assertEqual(result["separation"].attrs["measure"], "root mean square displacement of the platform's points")
        numpy.testing.assert_array_equal(removable[~numpy.isnan(removable)], 1.0)
        self.assertGreater((~numpy.isnan(removable)).sum(), 100)

    def test_negligible_errors_do_not_stand_in_the_way_of_tolerances(self):
        # In the planar 3-RRR, errors across the second link have a quadratic and almost negligible effect.
        gallery = DATA.parent.parent / "results" / "gallery" / "3-rrr"
        self.write("3-rrr.toml", (gallery / "3-rrr.toml").read_bytes())
        self.write("study.toml", (gallery / "study.toml").read_text().replace("samples = 1000", "samples = 300"))
        self.succeeds("run", "study.toml", "--quiet")
        asked = ["tolerances", "study.h5", "--response", "position"]
        printed = " ".join(self.succeeds(*asked, "--limit", "0.05 mm", "-d", "out").split())
        self.assertIn("3 negligible errors have the size studied as tolerance: the index on position changes with size", printed)
        with (self.folder / "out/tolerances.csv").open(newline="") as file:
            rows = {row["factor"]: row for row in csv.DictReader(file)}
        negligible = [f"delta_{limb}_2_y" for limb in (1, 2, 3)]
        for name in negligible:
            for way in ("limit_equal_effect", "limit_equal_tolerance"):
                self.assertEqual(float(rows[name][way]), 1e-4)
            self.assertIn(f"{name} (0.1 mm)", printed)
        for row in rows.values():
            self.assertLessEqual(float(row["limit_equal_effect"]), 1e-4 if row["unit"] == "m" else math.radians(0.05))
        for way in ("equal_effect", "equal_tolerance"):
            self.assertIn(self.poesy("run", f"out/confirm_{way}.toml", "-o", f"{way}.h5", "--quiet").returncode, (0, 6))
            with h5py.File(self.folder / f"{way}.h5") as file:
                at = list(file["response"].asstr()).index("position")
                rms = math.hypot(file["monte_carlo/overall_mean"][at], file["monte_carlo/overall_std"][at])
            self.assertAlmostEqual(rms / 0.05e-3, 1.0, delta=0.05)
        # With a negligible error as the reference, all other tolerances would be absurdly tight.
        done = self.poesy(*asked, "-d", "none")
        self.assertEqual(done.returncode, 2)
        self.assertIn("or count from another error (--reference)", done.stderr.decode())
        self.succeeds(*asked, "--reference", "delta_1_0_x=0.01 mm", "-d", "counted")
        with (self.folder / "counted/tolerances.csv").open(newline="") as file:
            rows = {row["factor"]: row for row in csv.DictReader(file)}
        for name in negligible:
            self.assertEqual(float(rows[name]["equal_effect"]), 1e-4)

    def poses_of(self, result):
        with h5py.File(self.folder / result) as file:
            return list(zip(*(file["poses"][name][()] for name in ("rx", "ry", "z")), strict=True))

    def test_own_words_do_not_hide_where_an_error_is(self):
        text = (DATA / "mechanisms" / "rps3.toml").read_text()
        self.write("named.toml", text + '\n[[error]]\nname = "rod"\nlimb = 1\nframe = 1\ncomponent = "delta_z"\ndescription = "rod too long"\n')
        shown = self.succeeds("models", "named.toml")
        self.assertRegex(shown, r"  rod +m rod too long\n")
        self.assertRegex(shown, r"\nwhere these errors are, .*\n(  .*\n)*  rod +limb 1, joint .* against joint .*: linear error along z of frame 1\n")

    def test_poses_by_drives_and_by_the_tool(self):
        self.study("rps3")
        shown = self.succeeds("models", "rps3.toml")
        for name, columns in (("tip", "rx, ry, tip_z"), ("actuators", "q_1_2, q_2_2, q_3_2")):
            self.assertIn(f"\nposes may be given by {name}\n", shown)
            self.assertIn(f"# Chart {name} in which a file may give poses: {columns}\n", self.succeeds("template", "rps3.toml", "--full"))
        poses = [(0.1 * k - 0.2, 0.3 - 0.13 * k, 0.52 + 0.03 * k) for k in range(5)]
        self.write("poses.csv", table([dict(zip(("rx", "ry", "z"), pose, strict=True)) for pose in poses], ["rx", "ry", "z"]))
        self.write("errors.csv", "delta_1_0_x [mm]\n0.1\n")
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "poses.h5")
        with h5py.File(self.folder / "poses.h5") as file:
            names = [name.decode() for name in file["evaluate/joint"]]
            joints = file["evaluate/joint_displacements"][()]
        drives = ["q_1_2", "q_2_2", "q_3_2"]
        self.write("drives.csv", table([{d: float(row[names.index(d)]) for d in drives} for row in joints], drives))
        # The tool is 0.1 m from P along the platform's z axis, and (rx, ry, 0) is the rotation vector of the platform.
        tips = [{"rx": rx, "ry": ry, "tip_z": z + 0.1 * math.cos(math.hypot(rx, ry))} for rx, ry, z in poses]
        self.write("tips.csv", table(tips, ["rx", "ry", "tip_z"]))
        for name in ("drives", "tips"):
            self.succeeds("evaluate", "study.toml", "--poses", f"{name}.csv", "--errors", "errors.csv", "-o", f"{name}.h5")
            for found, wanted in zip(self.poses_of(f"{name}.h5"), poses, strict=True):
                for a, b in zip(found, wanted, strict=True):
                    self.assertAlmostEqual(a, b, delta=1e-13)
            self.write("given.toml", STUDY.format(name="rps3", solver="").replace("count = 4", f'select = "file"\nfile = "{name}.csv"'))
            self.succeeds("run", "given.toml", "--quiet", "-o", f"given_{name}.h5")
            self.assertEqual(self.poses_of(f"given_{name}.h5"), self.poses_of(f"{name}.h5"))
        self.write("far.csv", "q_1_2 [mm],q_2_2 [mm],q_3_2 [mm]\n0,0,0\n600,0,0\n")
        done = self.poesy("evaluate", "study.toml", "--poses", "far.csv", "--errors", "errors.csv", "-o", "far.h5")
        self.assertEqual(done.returncode, 2)
        for words in ("far.csv:3:", "out of reach: the way there from home ends after 4", "drives do not hold it", "nearer to home"):
            self.assertIn(words, done.stderr.decode())
        self.write("way.csv", "t,q_1_2 [mm],q_2_2 [mm],q_3_2 [mm]\n0,0,0,0\n1,50,0,0\n")
        self.write("way.toml", STUDY.format(name="rps3", solver="").replace(
            "count = 4", 'select = "trajectory"\ntrajectory = { file = "way.csv", points = 5 }'))
        self.succeeds("run", "way.toml", "--quiet")
        self.assertEqual(len(self.poses_of("way.h5")), 5)

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def test_rounded_numbers_are_told_and_kept(self):
        """Joint B of each limb leans by the digits of a drawing, so that the limbs of the planar robot do not quite fit."""
        self.study("rrr3")
        exact = (self.folder / "rrr3.toml").read_text()
        upright = 'at = "elbow", axis = "z"'
        self.assertIn(upright, exact)
        self.write("poses.csv", "x,y,phi\n0.03,-0.02,0.2\n0,0.04,-0.3\n")
        self.write("errors.csv", "l_1 [mm],pin_x_2 [mm]\n0,0\n0.1,0.05\n")
        told = "the file's numbers leave up to "
        found = {}
        for name, axis in (("exact", upright), ("rounded", 'at = "elbow", axis = [0.0000037, 0, 1]')):
            self.write("rrr3.toml", exact.replace(upright, axis))
            self.succeeds("run", "study.toml", "--quiet")
            self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5")
            for command in (["models", "rrr3.toml"], ["check", "study.toml"], ["show", "study.h5"], ["show", "rows.h5"]):
                self.assertEqual(told in " ".join(self.succeeds(*command).split()), name == "rounded", command)
            shown = self.succeeds("models", "rrr3.toml")
            self.assertIn("9 joints (3 actuated), rank 6 of 12 loop equations: 3 freedoms, 6 over-constraints", shown)
            self.assertIn("the same at 20 of 20 poses tried in the workspace", shown)
            with h5py.File(self.folder / "rows.h5") as file:
                found[name] = {response: file["evaluate"][response][()] for response in ("gap", "x", "y", "theta_z")}
        for response in ("x", "y", "theta_z"):
            numpy.testing.assert_allclose(found["rounded"][response], found["exact"][response], rtol=1e-4, atol=1e-13)
        self.assertTrue((found["exact"]["gap"] < 1e-15).all())
        self.assertTrue((found["rounded"]["gap"] > 1e-9).all(), "what the numbers leave is subtracted from nothing")
        leaning = exact.replace(upright, 'at = "elbow", axis = [0.008, 0, 1]')
        self.write("rrr3.toml", leaning)
        done = self.poesy("models", "rrr3.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("look at joint 'B' of limb 1 and its copies: with its axis along (0, 0, 1)", done.stderr.decode())

    def test_no_error_depends_on_where_the_base_stands(self):
        self.study("rps3")
        text = (self.folder / "rps3.toml").read_text()
        for old, new in (('h = {', 'floor = "0 mm"\nh = {'), ('origin      = [0, 0, "h"]', 'origin = [0, 0, "h + floor"]'),
                         ('at = ["a", 0, 0]', 'at = ["a", 0, "floor"]'), ('at = ["c", 0, "h"]', 'at = ["c", 0, "h + floor"]'),
                         ('z = ["500 mm", "700 mm"]', 'z = ["500 mm + floor", "700 mm + floor"]')):
            self.assertIn(old, text)
            text = text.replace(old, new)
        indices = {}
        for about in ("joint", "frame"):
            self.write("rps3.toml", text.replace('about = "frame"', f'about = "{about}"'))
            for floor, poses in (("0 mm", "0.1,-0.2,0.55"), ("1000 mm", "0.1,-0.2,1.55")):
                self.write("poses.csv", f"rx,ry,z\n{poses}\n")
                study = STUDY.format(name="rps3", solver="").replace("count = 4", 'select = "file"\nfile = "poses.csv"')
                self.write("study.toml", study.replace("[poses]", f'geometry = {{ floor = "{floor}" }}\n[poses]'))
                self.succeeds("run", "study.toml", "--quiet")
                with h5py.File(self.folder / "study.h5") as file:
                    at = list(file["response"].asstr()).index("tip_position")
                    indices[about, floor] = file["sensitivity/global"][at]
        scale = indices["joint", "0 mm"].max()
        for about, moves in (("joint", False), ("frame", True)):
            apart = numpy.abs(indices[about, "1000 mm"] - indices[about, "0 mm"]).max() / scale
            self.assertEqual(apart > 0.5, moves, (about, apart))
            self.assertTrue(moves or apart < 1e-9, apart)

    def test_a_result_is_complete_without_the_file(self):
        self.study("upr2-rpu")
        self.succeeds("run", "study.toml", "--quiet")
        text = (self.folder / "upr2-rpu.toml").read_text()
        with h5py.File(self.folder / "study.h5") as result:
            self.assertEqual(result["mechanism/text"].asstr()[()], text)
            self.assertEqual(result.attrs["model"], "upr2-rpu")
            factor = result["factors/name"].asstr()[3]
        (self.folder / "upr2-rpu.toml").unlink()
        self.succeeds("replay", "study.h5", factor, "1", "2")
        self.succeeds("report", "study.h5")
        report = (self.folder / "study.html").read_text()
        self.assertIn('id="mechanism"', report)
        self.assertIn("<svg", report)
        self.succeeds("tolerances", "study.h5", "--response", "gap", "--limit", "0.03 mm", "--extrapolate", "-d", "tables")
        (confirming,) = (self.folder / "tables").glob("confirm*equal_effect*.toml")
        self.succeeds("check", confirming)

    def test_shards_are_of_one_mechanism(self):
        self.study("rps3")
        for n in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{n}/2", "-o", f"s{n}.h5", "--quiet")
        self.succeeds("run", "study.toml", "--quiet")
        changed = (self.folder / "rps3.toml").read_text().replace('axis = "y"', 'axis = "-y"')
        self.assertNotEqual(changed, (self.folder / "rps3.toml").read_text())
        self.write("rps3.toml", changed)
        self.succeeds("run", "study.toml", "--shard", "2/2", "-o", "other.h5", "--quiet")
        done = self.poesy("merge", "s1.h5", "other.h5", "-o", "mixed.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is of another mechanism", done.stderr.decode())
        (self.folder / "rps3.toml").unlink()
        self.succeeds("merge", "s1.h5", "s2.h5", "-o", "all.h5")
        self.assertEqual(self.content_hash("all.h5"), self.content_hash("study.h5"))

    def test_the_gallery_is_valid(self):
        gallery = DATA.parent.parent / "results" / "gallery"
        folders = sorted(study.parent for study in gallery.glob("*/study.toml"))
        self.assertGreaterEqual(len(folders), 12)
        for folder in folders:
            mechanism = folder / f"{folder.name}.toml"
            self.assertIn("mobility", self.succeeds("models", mechanism))
            for study in sorted(set(folder.glob("*.toml")) - {mechanism}):
                self.assertIn("# valid:", self.succeeds("check", study))

    def test_mistakes_name_their_place(self):
        self.take("rps3")
        self.study("rps3")
        text = (self.folder / "rps3.toml").read_text()
        for old, new, wanted in (('type = "S"', 'type = "Z"', ["rps3.toml:", "'Z'"]), ("actuated = true", "", ["rps3.toml:"]),
                                 ('name    = "rps3"', 'name = "rps 3"', ["rps3.toml:3:"])):
            self.assertIn(old, text)
            self.write("rps3.toml", text.replace(old, new))
            for command in (["models", "rps3.toml"], ["check", "study.toml"]):
                done = self.poesy(*command)
                self.assertEqual(done.returncode, 2)
                for words in wanted:
                    self.assertIn(words, done.stderr.decode())
        done = self.poesy("models", "none.toml")
        self.assertEqual(done.returncode, 3)
        done = self.poesy("run", "rps3.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("poesy template FILE", done.stderr.decode())

    def test_a_study_in_place_of_a_mechanism(self):
        self.take("rps3")
        self.study("rps3")
        done = self.poesy("models", self.folder / "study.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"is a study, not a mechanism; give the file of the study's mechanism instead: {self.folder}/rps3.toml",
                      done.stderr.decode())

    def test_advice_names_the_file(self):
        self.take("rps3")
        self.study("rps3")
        text = (self.folder / "study.toml").read_text()
        self.write("study.toml", text + '\n[errors.override]\n"nothing_*" = { distribution = "normal", sigma = "1 mm" }\n')
        done = self.poesy("check", "study.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("'poesy models rps3.toml' lists them", done.stderr.decode())


if __name__ == "__main__":
    main()
