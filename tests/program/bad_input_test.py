"""Bad input gives one clear sentence with its place, exit code 2, and no file. An existing result is kept."""

from poesy_program import AN_OLDER_RESULT, MECHANISMS, STUDY, ProgramTest, main


def changed(old, new):
    assert old in STUDY
    return STUDY.replace(old, new)


HELIX = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
[poses]
select = "trajectory"
trajectory = { curve = "helix" }
[analysis]
samples = 10
"""


def helix(new, extra=""):
    return HELIX.replace('curve = "helix"', 'curve = "helix", ' + new if new else 'curve = "helix"').replace(
        '"3-prs"\n', '"3-prs"\n' + extra)


# name: (study, place in the message, words in the message)
BAD_STUDIES = {
    "unknown_key": (changed("count = 6", "count = 6\ncolour = 1"), "7:1", ["colour"]),
    "unknown_model": (changed('"2upr-rpu"', '"2upr-rpx"'), "4:", ["2upr-rpx", "2upr-rpu"]),
    "unknown_factor": (changed('"delta_1_1_y"', '"delta_9_1_y"'), "12:", ["delta_9_1_y"]),
    "unknown_unit": (changed('"1 mm" }\nangular', '"1 foot" }\nangular'), "8:", ["foot", "mm"]),
    "bare_number": (changed('sigma = "1 mm" }\n', "sigma = 1 }\n"), "8:", ["unit"]),
    "negative_sigma": (changed('"0.2 deg"', '"-0.2 deg"'), "9:", ["sigma"]),
    "zero_sigma": (changed('"0.2 deg"', '"0 deg"'), "9:", ["sigma"]),
    "one_sample": (changed("samples = 1500", "samples = 1"), "13:", ["samples", "2"]),
    "no_pose": (changed("count = 6", "count = 0"), "6:", ["count", "1"]),
    "reversed_range": (
        changed("count = 6", 'count = 6\nworkspace = { z = ["-0.18 m", "-0.3 m"], beta = ["-0.1 rad", "0.1 rad"], '
                'gamma = ["-0.1 rad", "0.1 rad"] }'),
        "7:", ["z"]),
    "out_of_reach": (
        changed("count = 6", 'count = 6\nworkspace = { z = ["0.18 m", "0.3 m"], beta = ["-0.1 rad", "0.1 rad"], '
                'gamma = ["-0.1 rad", "0.1 rad"] }'),
        "7:", ["z"]),
    "duplicate_factor": (changed('"epsilon_1_4_z"', '"delta_1_1_y"'), "12:", ["delta_1_1_y"]),
    "wrong_type": (changed("samples = 1500", 'samples = "many"'), "13:", ["samples"]),
    "empty_workspace": (
        changed("count = 6", 'count = 6\nlimits = { q_1_3 = ["500 mm", "600 mm"] }'), "7:",
        ["workspace is empty", "q_1_3 below 500 mm"]),
    "unknown_joint": (
        changed("count = 6", 'count = 6\nlimits = { q_1_9 = ["-500 mm", "600 mm"] }'), "7:", ["q_1_9"]),
    "boundary_too_dense": (
        changed("count = 6", 'select = "boundary"\ncount = 1000\nworkspace = { z = ["-0.25 m", "-0.24999999999999997 m"], '
                'beta = ["0.1 rad", "0.10000000000000002 rad"], gamma = ["0.1 rad", "0.10000000000000002 rad"] }'),
        "7:", ["separated at rounding"]),
    "case_of_unknown_error": (
        changed('kind = "sensitivity"', 'kind = "evaluate"\ncases = [{ errors = { delta_9_1_y = "1 mm" } }]')
        .replace('background', '# background'), "12:", ["delta_9_1_y", "delta_1_1_y"]),
    "no_case": (changed('kind = "sensitivity"', 'kind = "evaluate"').replace('background', '# background'), "10:",
                ["at least one case"]),
    "tool_too_short": (helix("", 'geometry = { h = "60 mm" }\n'), "8:14", ["point 1 of 201", "tip_x = 30 mm", "lengthen h"]),
    "stroke_left": (helix('origin = ["0 mm", "0 mm", "1200 mm"]'), "7:14", ["point ", "t = ", "below the lower end of its rail"]),
    "singular_on_the_way": (HELIX.replace("[analysis]", "max_condition = 1.5\n[analysis]"), "7:14", ["singular", "1.70002"]),
    "no_such_curve": (HELIX.replace('"helix"', '"helicoid"'), "7:24", ["helicoid", "growing-spiral"]),
    "curve_of_a_model_without": (HELIX.replace('"3-prs"', '"2upr-rpu"'), "7:24", ["2upr-rpu", "no curves", "file"]),
    "count_of_a_trajectory": (HELIX.replace("[analysis]", "count = 5\n[analysis]"), "8:1", ["count", "trajectory"]),
    "origin_without_unit": (helix("origin = [0, 0, 850]"), "7:43", ["bare number 0", "unit"]),
    "time_reversed": (helix('time = ["2 s", "1 s"]'), "7:40", ["from 2 s to 1 s"]),
    "time_outside": (helix('time = ["0 s", "9 s"]'), "7:40", ["0 s to 9 s", "0 s to 2 s"]),
    "trajectory_without_file": (HELIX.replace('curve = "helix"', "points = 5"), "7:14", ["neither curve nor file"]),
    "sigma_beyond_the_platform": (changed('sigma = "1 mm" }\n', 'sigma = "60 mm" }\n'), "8:",
                                  ["delta_1_1_y", "60 mm", "l_A"]),
    "coupling_beyond_the_platform": (HELIX.replace("samples = 10", 'kind = "coupling"\nlinear = ["0.1 mm", "140 mm"]'),
                                     "10:21", ["c_x_1", "140 mm", "radius c"]),
    "half_turns": (changed('sigma = "0.2 deg"', 'sigma = "180 deg"'), "9:", ["epsilon_1_4_z", "180 deg", "half a turn"]),
    "background_beyond_the_platform": (changed('linear = "1 mm", angular = "1 deg" }', 'linear = "-1 m" }'), "14:",
                                       ["-1000 mm", "l_A"]),
    "case_beyond_the_platform": (
        changed('kind = "sensitivity"', 'kind = "evaluate"\ncases = [{ errors = { delta_1_1_y = "70 mm" } }]')
        .replace('background', '# background'), "12:", ["delta_1_1_y", "70 mm"]),
    "range_in_degrees": (
        changed("count = 6", 'count = 6\nworkspace = { z = ["-0.3 m", "-180 mm"], beta = ["20 deg", "-20 deg"], '
                'gamma = ["-5 deg", "5 deg"] }'),
        "7:49", ["beta runs from 20 deg to -20 deg"]),
    "open_quote": (changed('model = "2upr-rpu"', 'model = "2upr-rpu'), "4:9",
                   ['begins here with " is not closed on its line', 'write " at its end']),
    "open_long_quote": (changed('model = "2upr-rpu"', 'model = """2upr-rpu'), "4:9",
                        ['begins here with """ is not closed up to the end of the file']),
    "missing_quote": (changed('sigma = "1 mm" }\n', 'sigma = 1 mm" }\n'), "8:", ["a quote too many, or one is missing"]),
    "folder_as_poses": (changed("count = 6", 'select = "file"\nfile = "."'), "7:8", ["poses.file names '.', which is a folder"]),
    "not_toml": (changed("[poses]", "[poses"), "5:", []),
    "rubbish": (bytes(range(256)) * 20, "", []),
    "empty": ("", "1:1", ["empty"]),
}

POSES = "z,beta,gamma\n-0.2,0.1,0.1\n-0.25,0,0.2\n"
ERRORS = "delta_1_1_y,epsilon_1_4_z\n0.001,0\n0,0.002\n"
BAD_TABLES = {
    "missing_column": ("z,beta\n-0.2,0.1\n", ERRORS, "poses.csv:1", ["gamma"]),
    "extra_column": ("z,beta,gamma,delta\n-0.2,0.1,0.1,0\n", ERRORS, "poses.csv:1", ["delta"]),
    "unknown_factor": (POSES, "delta_1_1_q\n0.001\n", "errors.csv:1", ["delta_1_1_q"]),
    "repeated_factor": (POSES, "delta_1_1_y,delta_1_1_y\n0.001,0.001\n", "errors.csv:1", ["delta_1_1_y"]),
    "not_a_number": (POSES, "delta_1_1_y\n0.001\nabc\n", "errors.csv:3", ["abc"]),
    "nan": (POSES, "delta_1_1_y\nnan\n", "errors.csv:2", ["nan"]),
    "infinite": ("z,beta,gamma\n-0.2,0.1,inf\n", ERRORS, "poses.csv:2", ["inf"]),
    "beyond_the_platform": (POSES, "delta_1_1_y\n0.001\n-0.06\n", "errors.csv:3:1", ["delta_1_1_y", "-60 mm", "l_A"]),
    "empty_file": ("", ERRORS, "poses.csv", []),
    "header_only": (POSES, "delta_1_1_y\n", "errors.csv", []),
    "short_row": (POSES, "delta_1_1_y,epsilon_1_4_z\n0.001\n", "errors.csv:2", []),
    "out_of_reach": ("z,beta,gamma\n-0.2,0.1,0.1\n0.2,0,0\n", ERRORS, "poses.csv:3", ["z"]),
    "degrees_as_radians": ("z,beta,gamma\n-0.2,20,0\n", ERRORS, "poses.csv:2", ["20 rad = 1145.92 deg", "SI"]),
}


class BadInput(ProgramTest):
    def check_refusal(self, done, place, words, result):
        message = done.stderr.decode()
        self.assertEqual(done.returncode, 2, message)
        self.assertEqual(message.count("\n"), 1, message)
        self.assertTrue(message.startswith("poesy: "), message)
        self.assertIn(place, message)
        for word in words:
            self.assertIn(word, message)
        self.assertEqual(done.stdout, b"")
        self.assertEqual(result.read_text(), AN_OLDER_RESULT, "an existing result was touched")
        self.assertEqual({path.suffix for path in self.folder.iterdir()} - {".toml", ".csv", ".h5"}, set(), "left over")

    def test_studies(self):
        for name, (study, place, words) in BAD_STUDIES.items():
            with self.subTest(name):
                result = self.write("out.h5", AN_OLDER_RESULT)
                path = self.write("bad.toml", study)
                place = f"bad.toml:{place}" if place else "bad.toml"
                self.check_refusal(self.poesy("run", path.name, "-o", result, "--quiet"), place, words, result)
                self.assertEqual(self.poesy("check", path.name).returncode, 2)

    def test_tables(self):
        self.write("study.toml", STUDY)
        for name, (poses, errors, place, words) in BAD_TABLES.items():
            with self.subTest(name):
                result = self.write("out.h5", AN_OLDER_RESULT)
                self.write("poses.csv", poses)
                self.write("errors.csv", errors)
                done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", result)
                self.check_refusal(done, place, words, result)

    def test_pairs_need_equal_numbers(self):
        self.write("study.toml", STUDY)
        result = self.write("out.h5", AN_OLDER_RESULT)
        self.write("poses.csv", POSES)
        self.write("errors.csv", ERRORS + "0,0\n")
        done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "-o", result)
        self.check_refusal(done, "errors.csv", ["3", "2"], result)

    def test_folder_as_study(self):
        (self.folder / "dir.toml").mkdir()
        result = self.write("out.h5", AN_OLDER_RESULT)
        self.check_refusal(self.poesy("run", "dir.toml", "-o", result), "dir.toml", [], result)

    def test_missing_output_folder(self):
        self.write("study.toml", STUDY)
        done = self.poesy("run", "study.toml", "-o", "nowhere/out.h5")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"nowhere", done.stderr)

    def test_command_lines(self):
        for arguments in [["fly"], ["run"], ["run", "a.toml", "--threads", "0"], ["run", "a.toml", "--threads", "x"],
                          ["run", "a.toml", "--seed", "-1"], ["show"], ["models", "9upr"], ["template", "9upr"],
                          ["template", "2upr-rpu", "poetry"], ["template", "3-prs", "identification"],
                          ["template", "xy-3-prs", "identification"], ["template", "2upr-rpu", "coupling"]]:
            with self.subTest(arguments):
                done = self.poesy(*arguments)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)

    def said_of(self, *arguments):
        done = self.poesy(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr.decode()

    def test_words_of_other_programs(self):
        for right, wrong, said in (('sigma = "1 mm"', 'std = "1 mm"', "did you mean 'sigma'?"),
                                   ('"normal", sigma = "1 mm"', '"gauss", sigma = "1 mm"', "did you mean 'normal'?"),
                                   ('"1 mm"', '"+-1 mm"', "is the range '+-1 mm'; write one number; a distribution takes the +- of a drawing as half_width")):
            self.write("s.toml", changed(right, wrong))
            self.assertIn(said, self.said_of("check", "s.toml"))

    def test_sweeps_of_geometry(self):
        self.write("s.toml", STUDY)
        for wrong, said in (("geometry.l_A=60:80:10",
                             "has no unit; write it once, after the last number: geometry.l_A=60:80:10mm, or geometry.l_A=60:80:10m\n"),
                            ("geometry.l_A=60,70", "after the last number: geometry.l_A=60,70mm, or geometry.l_A=60,70m\n"),
                            ("l_A=60:80:10mm", "names a parameter of the mechanism's geometry; write geometry.l_A=60:80:10mm\n")):
            self.assertIn(said, self.said_of("sweep", "s.toml", "--set", wrong))

    def test_sweeps_of_angles(self):
        """Degrees come first also for small numbers."""
        self.write("m.toml", (MECHANISMS / "bell-crank.toml").read_text())
        self.write("s.toml", 'format = "poesy-study"\nversion = 1\nmechanism.file = "m.toml"\nposes.count = 2\n'
                             '[analysis]\nkind = "monte-carlo"\ndraws = "per pose"\n')
        self.assertIn("after the last number: geometry.alpha=1,2,5deg, or geometry.alpha=1,2,5rad\n",
                      self.said_of("sweep", "s.toml", "--set", "geometry.alpha=1,2,5"))

    def test_tables_of_other_programs(self):
        self.write("s.toml", changed("count = 6", 'select = "file"\nfile = "p.csv"'))
        for table, said in ((b"z (mm),beta,gamma\n", "the unit of column 'z (mm)' is in parentheses; write 'z [mm]'"),
                            (b"z [mm]\tbeta [deg]\tgamma [deg]\n", "separated by tabs"),
                            (b"# z,beta,gamma\n", "the column names begin with '#'"),
                            (b"z,beta,gamma\n# home\n-0.2,0,0\n", ":2:1: this line begins with '#'"),
                            (b"z,beta,gamma\n-0.2,0,0\n\n-0.2,0,0\n", ":3:1: this line is blank"),
                            (b"PK\x03\x04\x14\x00", "is a spreadsheet or another archive, not a CSV file"),
                            ("\ufeffz,beta,gamma\n".encode("utf-16-le"), "is a text in UTF-16")):
            (self.folder / "p.csv").write_bytes(table)
            self.assertIn(said, self.said_of("check", "s.toml"))

    def test_a_singular_pose_of_a_file(self):
        # The rods are as long as the difference of the radii, so they are horizontal: the carriages cannot drive the
        # platform.
        self.write("p.csv", "alpha,beta,z\n0,0,0.3\n")
        study = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs", geometry = { l = "115.0000001 mm" } }
poses = { select = "file", file = "p.csv" }
analysis = { factors = "rod-length", samples = 10 }
"""
        self.write("s.toml", study)
        done = self.poesy("run", "s.toml", "--quiet")
        message = done.stderr.decode()
        self.assertEqual(done.returncode, 2, message)
        for word in ("p.csv:2:1", "pose 1 (alpha = 0", "singular", "condition number", "1e+08"):
            self.assertIn(word, message)
        self.write("e.csv", "l_1\n1e-4\n")
        done = self.poesy("evaluate", "s.toml", "--poses", "p.csv", "--errors", "e.csv", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"warning: p.csv:2: pose 1 is singular", done.stderr)

    def test_files_that_a_study_names(self):
        measured = 'override = { delta_1_1_y = { distribution = "measured", file = "absent.csv", column = "a" } }\n[analysis]'
        machines = changed('kind = "sensitivity"', 'kind = "monte-carlo"\ndraws = "per machine"').replace("background", "# ")
        studies = {
            "mechanism.file": (changed('model = "2upr-rpu"', 'file = "absent.csv"'), "4:8"),
            "poses.file": (changed("count = 6", 'select = "file"\nfile = "absent.csv"'), "7:8"),
            "poses.trajectory.file": (HELIX.replace('curve = "helix"', 'file = "absent.csv"'), "7:23"),
            "errors.override.delta_1_1_y.file": (changed("[analysis]", measured), "10:64"),
            "errors.machines": (machines.replace("[errors]", '[errors]\nmachines = "absent.csv"'), "8:12"),
        }
        (self.folder / "below").mkdir()
        for name, (study, place) in studies.items():
            with self.subTest(name):
                self.write("below/study.toml", study)
                done = self.poesy("check", "below/study.toml")
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual(done.stderr.decode(),
                                 f"poesy: below/study.toml:{place}: {name} names 'below/absent.csv', which cannot be read: No such "
                                 "file or directory; check the path, which is relative to the study's folder, and its permissions\n")

    def test_files_that_cannot_be_read(self):
        for arguments in [["run", "absent.toml"], ["show", "absent.h5"], ["verify", "absent.h5"]]:
            with self.subTest(arguments):
                self.assertEqual(self.poesy(*arguments).returncode, 3)


if __name__ == "__main__":
    main()
