"""Tables as output and input: exports keep the user's files and can be read again; units; names of rows."""

import csv
import json
import os
import re
import time

from poesy_program import STUDY, ProgramTest, main

MANIFEST = "poesy_manifest.txt"
POSES = "z,beta,gamma\n-0.2,0.1,0.05\n-0.25,0,-0.1\n"
MODELS = ("2upr-rpu", "3-prs", "xy-3-prs")


class Csv(ProgramTest):
    def table(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def evaluate(self, errors, *options, poses="poses.csv", result="r.h5"):
        self.write("errors.csv", errors)
        return self.succeeds("evaluate", "study.toml", "--poses", poses, "--errors", "errors.csv", "-o", result, "--quiet",
                             *options)

    def exported(self, result, folder):
        self.succeeds("export", result, "-d", folder)
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir()}


class Exports(Csv):
    def test_tables_of_the_user_are_never_replaced(self):
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        for name in ("poses.csv", "factors.csv"):
            path = self.write(name, POSES)
            before = sorted(self.folder.iterdir())
            done = self.poesy("export", "out.h5", "-d", ".")
            self.assertEqual(done.returncode, 2, done.stderr)
            for words in (name, "was not written by poesy", "name another folder with -d"):
                self.assertIn(words, done.stderr.decode())
            self.assertEqual(sorted(self.folder.iterdir()), before)
            self.assertEqual(path.read_text(), POSES)
            path.unlink()
        first = self.exported("out.h5", ".")
        self.assertEqual(self.exported("out.h5", "."), first)

    def listed(self, folder):
        """The result and the files that the folder's manifest names."""
        _, result, *names = (self.folder / folder / MANIFEST).read_text().splitlines()
        return result.removeprefix("# content_sha256 "), set(names)

    def test_a_folder_has_the_tables_of_one_result(self):
        self.write("a.toml", STUDY)
        self.write("b.toml", STUDY.replace("count = 6", "count = 7").replace('"sensitivity"', '"monte-carlo"'))
        hashes, tables = {}, {}
        for name in ("a", "b"):
            self.succeeds("run", f"{name}.toml", "--quiet")
            tables[name] = self.exported(f"{name}.h5", name)
            hashes[name] = self.listed(name)[0]
            self.assertIn(hashes[name], self.succeeds("verify", f"{name}.h5"))
        self.assertTrue(tables["a"].keys() - tables["b"].keys())
        for name in ("a", "b", "a", "a"):
            self.assertEqual(self.exported(f"{name}.h5", "both"), tables[name])
            self.assertEqual(self.listed("both"), (hashes[name], tables[name].keys() - {MANIFEST}))
        # A table that the user changed belongs to the user, like other files in the folder.
        self.write("both/mine.csv", POSES)
        self.write("both/global.csv", POSES)
        os.utime(self.folder / "both/global.csv", (time.time() + 1,) * 2)  # the clock may be too coarse
        before = {path.name: path.read_bytes() for path in (self.folder / "both").iterdir()}
        done = self.poesy("export", "b.h5", "-d", "both")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"both/global.csv: was changed since poesy wrote it", done.stderr)
        self.assertIn(b"name another folder with -d", done.stderr)
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "both").iterdir()}, before)

    def test_says_which_of_many_files_to_open(self):
        self.write("a.toml", STUDY)
        self.succeeds("run", "a.toml", "--quiet")
        done = self.poesy("export", "a.h5", "-d", "t")
        files = done.stdout.decode().split()
        self.assertGreater(len(files), 20)
        first = done.stderr.decode()
        self.assertRegex(first, f"^poesy: {len(files)} files; open these first: t/global.csv, ")
        named = first.strip().split(": ")[-1].split(", ")
        self.assertEqual(len(named), 3)
        self.assertLessEqual(set(named), set(files))

    def test_other_files_of_the_same_result_stay(self):
        self.write("a.toml", STUDY)
        self.succeeds("run", "a.toml", "--quiet")
        tables = self.exported("a.h5", "t").keys()
        self.succeeds("tolerances", "a.h5", "--response", "linear_deformation", "--extrapolate", "-d", "t")
        self.assertEqual({path.name for path in (self.folder / "t").iterdir()}, tables | {"tolerances.csv"})

    def test_what_is_exported_is_read_again(self):
        """Poses and errors go round twice, and neither they nor the responses lose a bit."""
        for model in MODELS:
            with self.subTest(model):
                template = self.succeeds("template", model, "--full")
                self.write("study.toml", re.sub(r"(?m)^count = \d+", "count = 4",
                                                re.sub(r"(?m)^samples = \d+", "samples = 50", template)))
                self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
                of_study = self.exported("out.h5", f"{model}-0")
                factors = [row["factor"] for row in self.table(f"{model}-0/factors.csv")][:3]
                self.evaluate(",".join(factors) + "\n1e-4,-0.00030000000000000003,0\n0.0001,7e-05,-3.3e-5\n",
                              poses=f"{model}-0/poses.csv", result=f"{model}-1.h5")
                once = self.exported(f"{model}-1.h5", f"{model}-1")
                self.assertEqual(once["poses.csv"], of_study["poses.csv"])
                self.evaluate(once["errors.csv"].decode(), poses=f"{model}-1/poses.csv", result=f"{model}-2.h5")
                self.assertEqual(self.exported(f"{model}-2.h5", f"{model}-2"), once)


class Tables(Csv):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.write("poses.csv", POSES)

    def test_units_in_the_header(self):
        self.evaluate("delta_1_1_y,epsilon_1_4_z\n0.012,0.001\n")
        si = self.table_of_solves("r.h5")
        self.write("poses.csv", "gamma [mrad],z [mm],beta [rad]\n50,-200,0.1\n-100,-250,0\n")
        self.evaluate("delta_1_1_y [mm],epsilon_1_4_z [mrad]\n12,1\n")
        self.assertEqual(self.table_of_solves("r.h5"), si)

    def test_bare_numbers_that_seem_to_have_another_unit(self):
        self.write("poses.csv", "z,beta,gamma\n-0.2,0,0\n-0.25,0,0.7\n")
        self.write("errors.csv", "delta_1_1_y,epsilon_1_4_z\n0.011,0.001\n")
        words = ("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--quiet")
        done = self.poesy(*words)
        self.assertEqual(done.returncode, 0)
        said = done.stderr.decode().splitlines()
        self.assertEqual(len(said), 2, said)
        self.assertIn("warning: poses.csv: gamma has no unit, so its numbers are in rad: pose 2 has gamma = 0.7 rad", said[0])
        self.assertIn("warning: errors.csv: delta_1_1_y has no unit, so its numbers are in m: one is 11 mm, more than 10 "
                      "times the size that the study gives this error (1 mm)", said[1])
        self.write("study.toml", STUDY.replace("count = 6", 'select = "file"\nfile = "poses.csv"'))
        for command in (("check", "study.toml"), ("run", "study.toml", "--quiet")):
            self.assertIn("poses.csv: gamma has no unit", self.poesy(*command).stderr.decode())
        self.write("poses.csv", "z [mm],beta,gamma [rad]\n-200,0,0\n-250,0,0.7\n")
        self.write("errors.csv", "delta_1_1_y [m],epsilon_1_4_z\n0.011,0.001\n")
        for command in (words, ("check", "study.toml"), ("run", "study.toml", "--quiet")):
            done = self.poesy(*command)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr.decode(), "poesy: warning: poses.csv: pose 2 has gamma = 40.107 deg, outside the workspace "
                                                   "from -34.3775 deg to 34.3775 deg; look at its sign and unit\n")

    def table_of_solves(self, result):
        self.succeeds("export", result, "-d", "tables")
        return self.table("tables/evaluate.csv")

    def test_named_parts_come_back(self):
        rows = "".join(f"{k},{(k * 7 % 40) * 1e-5}\n" for k in range(40))
        printed = self.evaluate("part,delta_1_1_y\n" + rows)
        worst = max(range(40), key=lambda k: k * 7 % 40)
        sentence = f"part {worst} is worst in linear_deformation: "
        self.assertIn(sentence, printed)
        self.assertIn(sentence, self.succeeds("show", "r.h5"))
        parts = json.loads(self.succeeds("show", "r.h5", "--json"))["tables"][1]
        self.assertEqual(parts["name"], "parts")
        self.assertEqual([row["label"] for row in parts["rows"]], [str(k) for k in range(40)])
        largest = {}
        for solve in self.table_of_solves("r.h5"):
            value = abs(float(solve["linear_deformation [m]"]))
            largest[solve["part"]] = max(largest.get(solve["part"], 0.0), value)
        self.assertEqual(max(largest, key=largest.get), str(worst))
        for row, of_table in zip(parts["rows"], self.table("tables/parts.csv")):
            extreme = float(of_table["linear_deformation_extreme [m]"])
            self.assertEqual(abs(extreme), largest[row["label"]])
            self.assertAlmostEqual(row["linear_deformation_extreme"], 1e3 * extreme, delta=1e-12)
        self.assertEqual([row["part"] for row in self.table("tables/errors.csv")], [str(k) for k in range(40)])
        self.succeeds("report", "r.h5")
        self.assertIn(sentence, (self.folder / "r.html").read_text())

    def test_how_many_parts_keep_a_limit(self):
        rows = "part,delta_1_1_y\n" + "".join(f"{k},{(k * 7 % 40) * 1e-5}\n" for k in range(40))
        self.evaluate(rows)
        self.succeeds("export", "r.h5", "-d", "tables")
        largest = sorted(abs(float(part["linear_deformation_extreme [m]"])) for part in self.table("tables/parts.csv"))
        limit = (largest[37] + largest[38]) / 2
        self.write("study.toml", STUDY.replace('"sensitivity"', '"monte-carlo"')
                   + f'[analysis.limits]\nlinear_deformation = "{limit} m"\n')
        done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "r.h5", "--quiet")
        self.assertEqual(done.returncode, 6, done.stderr)
        worst = max(range(40), key=lambda k: k * 7 % 40)
        for printed in (done.stdout.decode(), self.poesy("show", "r.h5").stdout.decode()):
            self.assertRegex(" ".join(printed.split()), rf"part {worst} is worst in linear_deformation: [^;]*; 38 of 40 pass")

    def test_names_go_with_poses_where_rows_are_paired(self):
        self.evaluate("name,delta_1_1_y\nleft,1e-4\nright,3e-4\n", "--paired")
        self.succeeds("export", "r.h5", "-d", "tables")
        self.assertEqual([(row["name"], row["pose"]) for row in self.table("tables/evaluate.csv")],
                         [("left", "0"), ("right", "1")])
        self.assertIn("name right is worst in linear_deformation", self.succeeds("show", "r.h5"))

    def test_what_is_refused(self):
        cases = {
            "delta_1_1_y;epsilon_1_4_z\n0;0\n": ("errors.csv:1:12", "separated by semicolons"),
            "delta_1_1_y,epsilon_1_4_z\n0,5,0,2\n": ("errors.csv:2:5", "decimal points"),
            "delta_1_1_y [deg]\n0\n": ("errors.csv:1:1", "unit of angle"),
            "delta_1_1_y\n12\n": ("errors.csv:2:1", "'delta_1_1_y [mm]'"),
            "delta_1_1_y [mm]\n75\n": ("errors.csv:2:1", "75 mm"),
            "part,delta_1_1_y\n=cmd,0\n": ("errors.csv:2:1", "begins with '='"),
            "part,delta_1_1_y\n17,0\n17,0\n": ("errors.csv:3:1", "second time, after line 2"),
        }
        for text, (place, words) in cases.items():
            with self.subTest(words):
                self.write("errors.csv", text)
                done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "no.h5")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertTrue(done.stderr.decode().startswith(f"poesy: {place}: "), done.stderr)
                self.assertIn(words, done.stderr.decode())
                self.assertFalse((self.folder / "no.h5").exists())


if __name__ == "__main__":
    main()
