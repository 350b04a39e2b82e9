"""Compares poesy.evaluate and poesy.mechanism with the program's command and with results of studies."""

import json
import unittest
import warnings
from pathlib import Path

import numpy as np
from package import HOPELESS, PLATFORM, ROOT, FolderTest, main, poesy

from poesy import _program

MECHANISMS = sorted((ROOT / "tests" / "data" / "mechanisms").glob("*.toml"))
BUILT_IN = ("2upr-rpu", "3-prs", "xy-3-prs")
RPS3 = {
    "name": "rps3",
    "title": "3-RPS",
    "geometry": {"a": {"value": "250 mm"}, "c": {"value": "135 mm"}, "h": {"value": "600 mm"}},
    "platform": {
        "origin": [0, 0, "h"],
        "coordinates": ["rx", "ry", "z"],
        "workspace": {"rx": ["-20 deg", "20 deg"], "ry": ["-20 deg", "20 deg"], "z": ["500 mm", "700 mm"]},
    },
    "limb": [
        {
            "copies": {"count": 3, "about": "z"},
            "joints": [
                {"name": "A", "type": "R", "at": ["a", 0, 0], "axis": "y"},
                {"name": "q", "type": "P", "from": "A", "to": "S", "actuated": True},
                {"name": "S", "type": "S", "at": ["c", 0, "h"]},
            ],
        }
    ],
}


class Evaluate(FolderTest):
    def setUp(self):
        super().setUp()
        self.random = np.random.default_rng(19)
        self.known = poesy.mechanism("2upr-rpu")
        lower = np.array([one.lower for one in self.known.coordinates])
        upper = np.array([one.upper for one in self.known.coordinates])
        self.poses = lower + (upper - lower) * self.random.uniform(0.2, 0.8, (3, 3))
        self.errors = self.random.normal(0.0, 1e-4, (5, 71))

    def test_numbers_are_those_of_the_command(self):
        found = poesy.evaluate("2upr-rpu", self.poses, self.errors, solver=PLATFORM)
        Path("s.toml").write_text(
            'format = "poesy-study"\nversion = 1\nmechanism = { model = "2upr-rpu" }\nsolver = { metric = "platform" }\n'
        )
        names = ",".join(one.name for one in self.known.errors)
        for name, header, table in (("p.csv", "z,beta,gamma", self.poses), ("e.csv", names, self.errors)):
            np.savetxt(name, table, delimiter=",", header=header, comments="", fmt="%.17g")
        _program.call("evaluate", "s.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "r.h5")
        expected = poesy.read("r.h5").to_xarray("evaluate")
        self.assertEqual(set(found), {"gap", "angular_deformation", "linear_deformation"})
        for name, values in found.items():
            self.assertEqual(values.shape, (3, 5))
            np.testing.assert_array_equal(values, expected[name].values)
        np.testing.assert_array_equal(found.status, expected["status"].values)
        np.testing.assert_array_equal(found.joints, expected["joint_displacements"].values)
        self.assertEqual(found.details["delta_mu_21"].shape, (3, 5, 6))
        self.assertEqual(found.status_names[0], "converged")
        self.assertTrue(found.converged.all())
        self.assertEqual(found.units["gap"], "m")

    def test_pairs_are_the_diagonal(self):
        whole = poesy.evaluate(self.known, self.poses, self.errors[:3], solver=PLATFORM)
        pairs = poesy.evaluate(self.known, self.poses, self.errors[:3], solver=PLATFORM, paired=True, threads=1)
        for name in whole:
            np.testing.assert_array_equal(pairs[name], np.diag(whole[name]))
        self.assertEqual(pairs.status.shape, (3,))
        with self.assertRaisesRegex(poesy.StudyError, "5 rows of errors for 3 poses"):
            poesy.evaluate(self.known, self.poses, self.errors, paired=True)

    def test_columns_by_name(self):
        by_name = {one.name: column for one, column in zip(self.known.errors, self.errors.T)}
        pose = dict(zip(("gamma", "z", "beta"), self.poses[:, [2, 0, 1]].T))
        whole = poesy.evaluate("2upr-rpu", self.poses, self.errors)
        for name, values in poesy.evaluate("2upr-rpu", pose, by_name).items():
            np.testing.assert_array_equal(values, whole[name])
        one = poesy.evaluate("2upr-rpu", self.poses[0], {"delta_1_1_y": [1e-4, 2e-4], "epsilon_1_1_x": 1e-3})
        table = np.zeros((2, 71))
        names = [each.name for each in self.known.errors]
        table[:, names.index("delta_1_1_y")] = [1e-4, 2e-4]
        table[:, names.index("epsilon_1_1_x")] = 1e-3
        for name, values in poesy.evaluate("2upr-rpu", self.poses[:1], table).items():
            np.testing.assert_array_equal(values, one[name])

    def test_units_may_hold_a_blank(self):
        lines = ["  force_1                 N magnitude of the force", "  moment_1              N m its moment", "  x   m along x"]
        found = [(one.name, one.unit, one.description) for one in poesy._mechanism._named(lines)]
        self.assertEqual(found, [("force_1", "N", "magnitude of the force"), ("moment_1", "N m", "its moment"),
                                 ("x", "m", "along x")])
        self.assertEqual(poesy._units.shown("N m"), ("N m", 1.0))
        self.assertEqual(poesy._units.labelled("mean", "N m"), "mean [N m]")

    def test_another_description_of_a_pose(self):
        mechanism = poesy.mechanism(RPS3)
        at_home = poesy.evaluate(mechanism, {"q_1_2": 0.0, "q_2_2": 0.0, "q_3_2": 0.0}, np.zeros(108))
        np.testing.assert_allclose(at_home["position"], 0.0, atol=1e-12)
        np.testing.assert_allclose(at_home.joints, 0.0, atol=1e-12)

    def test_geometry_fidelity_and_files(self):
        plain = poesy.evaluate(RPS3, [[0, 0, 0.6]], {"delta_1_1_x": 1e-3})
        self.assertEqual(plain["position"].shape, (1, 1))
        wider = poesy.evaluate(RPS3, [[0, 0, 0.6]], {"delta_1_1_x": 1e-3}, geometry={"a": "300 mm"})
        first = poesy.evaluate(RPS3, [[0, 0, 0.6]], {"delta_1_1_x": 1e-3}, fidelity="first-order")
        self.assertNotEqual(plain["position"][0, 0], wider["position"][0, 0])
        self.assertNotEqual(plain["position"][0, 0], first["position"][0, 0])
        np.testing.assert_allclose(first["position"], plain["position"], rtol=0.05)
        poesy.mechanism(RPS3, path="mine.toml")
        for written in ("mine.toml", Path("mine.toml"), self.folder / "mine.toml"):
            np.testing.assert_array_equal(poesy.evaluate(written, [0, 0, 0.6], {"delta_1_1_x": 1e-3})["x"], plain["x"])

    def test_what_does_not_converge_is_data(self):
        with self.assertWarnsRegex(poesy.PoesyWarning, "100 % of the samples did not converge"):
            found = poesy.evaluate("2upr-rpu", self.poses, self.errors * 10, solver=HOPELESS)
        self.assertFalse(found.converged.any())
        for values in found.values():
            self.assertTrue(np.isnan(values).all())
        self.assertEqual({found.status_names[code] for code in found.status.ravel()}, {"iteration_cap"})

    def test_poses_in_the_wrong_unit(self):
        """Millimetres for metres: a warning names the pose, and the advice is about it."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = poesy.evaluate(RPS3, [[0, 0, 600]], np.zeros(108))
        said = [str(one.message) for one in caught if one.category is poesy.PoesyWarning]
        self.assertIn("pose 1 has z = 600000 mm, outside the workspace from 500 mm to 700 mm", said[0])
        for words in said[1:]:
            self.assertIn("look at the units of the poses", words)
        self.assertEqual(np.isnan(found["position"]).all(), not found.converged.all())

    def test_what_is_refused(self):
        cases = (
            ((self.poses[:, :2], self.errors), r"poses has shape \(3, 2\); it needs 3 columns, .*\(z, beta, gamma\)"),
            ((self.poses, self.errors[:, :7]), r"errors has shape \(5, 7\); it needs 71 columns"),
            ((self.poses, np.zeros((2, 2, 71))), r"errors has shape \(2, 2, 71\)"),
            ((self.poses, {"delta_1_1_y": [1, 2], "delta_1_1_z": [1, 2, 3]}), r"differ in length: delta_1_1_y \(2,\)"),
            ((self.poses, {"delta_1_1_yy": 1e-4}), "did you mean 'delta_1_1_y'"),
            ((self.poses, {}), "at least one name"),
            (([[-0.2, 3.0, 0]], self.errors), "poses.csv:2: pose 1 .* out of reach"),
            ((self.poses, self.errors * np.nan), "errors.csv:2"),
        )
        for arguments, words in cases:
            with self.subTest(words), self.assertRaisesRegex(poesy.StudyError, words):
                poesy.evaluate("2upr-rpu", *arguments)
        with self.assertRaisesRegex(poesy.StudyError, "absent"):
            poesy.evaluate("absent", self.poses, self.errors)


class Mechanisms(FolderTest):
    def test_all_are_understood(self):
        """Names, units and words are those of a study's result; so is the number of frames."""
        for named in (*BUILT_IN, *MECHANISMS):
            with self.subTest(str(named)):
                known = poesy.mechanism(named)
                case = {"name": "none", "errors": {known.errors[0].name: "1e-6 " + known.errors[0].unit}}
                result = poesy.run({"mechanism": known, "poses": {"count": 1}, "analysis": {"kind": "evaluate", "cases": [case]}})
                told = json.loads(result.show("--json"))
                for own, theirs in ((known.errors, told["errors"]), (known.responses, told["responses"])):
                    self.assertEqual([one._asdict() for one in own], theirs)
                poses = result.to_xarray("poses")
                self.assertEqual([one.name for one in known.coordinates], list(poses.attrs["coordinates"]))
                for one in known.coordinates:
                    self.assertEqual(one.unit, poses[one.name].attrs["unit"])
                    self.assertTrue(one.lower - 1e-6 <= float(poses[one.name]) <= one.upper + 1e-6, one)
                    self.assertTrue(one.description)
                self.assertEqual(known.name, result.model)
                joints = result.to_xarray("evaluate").sizes["joint"]
                moving = [frame for frame in known.frames if frame.type not in ("", "fixed")]
                self.assertEqual(len(moving), joints if known.path else 0)

    def test_frames_at_home(self):
        known = poesy.mechanism(RPS3)
        frames = {frame.name: frame for frame in known.frames}
        self.assertEqual((frames["1_2"].joint, frames["1_2"].type, frames["1_2"].actuated), ("q", "P", True))
        self.assertEqual(frames["1_1"].point, (0.25, 0.0, 0.0))
        np.testing.assert_allclose(frames["platform"].point, (0, 0, 0.6))
        for frame in known.frames:
            z, x = np.array(frame.z), np.array(frame.x)
            np.testing.assert_allclose([z @ z, x @ x, z @ x], [1, 1, 0], atol=1e-5)

    def test_metrics(self):
        known = poesy.mechanism("2upr-rpu")
        names = [one.name for one in known.responses_by_metric["platform"]]
        self.assertEqual(names, ["gap", "angular_deformation", "linear_deformation"])
        self.assertEqual(known.responses, known.responses_by_metric["published"])
        self.assertEqual(known.table(), {"model": "2upr-rpu"})
        self.assertEqual(poesy.mechanism(RPS3).responses_by_metric, {})

    def test_files_of_dicts(self):
        written = poesy.mechanism(RPS3, path="mine.toml")
        self.assertEqual(written.path, Path("mine.toml"))
        self.assertEqual(poesy.mechanism("mine.toml").errors, written.errors)
        kept = poesy.mechanism(RPS3)
        folder = kept.path.parent
        self.assertEqual(kept.path.name, "rps3.toml")
        self.assertTrue(folder.exists())
        self.assertRegex(kept._repr_html_(), '^<img alt="rps3: 3-RPS, [^"]*" src="data:image/svg.xml;base64,[^"]*">$')
        self.assertIsNone(poesy.mechanism("3-prs")._repr_html_())
        self.assertTrue(kept.picture("rps3.svg").exists())
        del kept
        self.assertFalse(folder.exists())
        with self.assertRaises(poesy.NotInResult):
            poesy.mechanism("3-prs").picture("a.svg")

    def test_what_is_refused(self):
        wrong = json.loads(json.dumps(RPS3))
        wrong["limb"][0]["joints"][1]["type"] = "Q"
        with self.assertRaisesRegex(poesy.StudyError, r"^mechanism, line \d+ \(type = \"Q\"\): "):
            poesy.mechanism(wrong)
        with self.assertRaisesRegex(poesy.FileError, "nowhere/x.toml: cannot be written"):
            poesy.mechanism(RPS3, path="nowhere/x.toml")
        with self.assertRaisesRegex(poesy.Error, "absent.toml"):
            poesy.mechanism("absent.toml")

    def test_in_a_study(self):
        known = poesy.mechanism(RPS3)
        for place, named in ((known, "rps3.toml"), ({"file": known}, "rps3.toml"), ({"file": known.path}, str(known.path))):
            found = poesy.run({"mechanism": place, "poses": {"count": 1}, "analysis": {"samples": 10}})
            self.assertEqual((found.model, found.study["mechanism"]["file"]), ("rps3", named))


if __name__ == "__main__":
    main()
