"""Messages of the program about a study: which errors it holds constant, what looks like a mistake, and what may
help if samples did not converge."""

import html
import re

from poesy_program import GALLERY, STUDY, ProgramTest, main

HELD = "held constant: 30 errors of set 'benign' at 1 mm and 1 deg"
RESULTS = GALLERY.parent
CASES = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 2
[analysis]
kind = "evaluate"
background = { factors = "benign", linear = "20 um", angular = "1 arcmin" }
cases = [{ errors = { delta_1_1_y = "1 mm" } }]
"""
RPS = """\
format = "poesy-study"
version = 1
mechanism = { file = "rps.toml" }
poses = { count = 1 }
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
[analysis]
kind = "sensitivity"
factors = ["delta_1_1_x"]
samples = 20
"""

WRIST = """format = "poesy-mechanism"
version = 1
name = "wrist"
title = "3-SPS-1-S"
[platform]
origin = [0, 0, "180 mm"]
coordinates = ["rx", "ry", "rz"]
rotation = "xyz"
workspace = { rx = ["-15 deg", "15 deg"], ry = ["-15 deg", "15 deg"], rz = ["-80 deg", "80 deg"] }
metric_points = [["90 mm", 0, "25 mm"], ["-45 mm", "78 mm", "25 mm"], ["-45 mm", "-78 mm", "25 mm"]]
[[limb]]
copies = { count = 3, about = "z" }
joints = [
  { name = "A", type = "S", at = ["150 mm", 0, 0] },
  { name = "q", type = "P", from = "A", to = "B", actuated = true },
  { name = "B", type = "S", at = ["90 mm * cos(50 deg)", "90 mm * sin(50 deg)", "205 mm"] } ]
[[limb]]
name = "post"
joints = [ { name = "C", type = "S", at = [0, 0, "180 mm"] } ]
"""
PAN_TILT = """format = "poesy-mechanism"
version = 1
name = "pan-tilt"
title = "Pan-tilt"
[platform]
origin = [0, 0, "200 mm"]
coordinates = ["rz", "ry"]
rotation = "zyx"
workspace = { rz = ["-180 deg", "180 deg"], ry = ["-5 deg", "20 deg"] }
metric_points = [["100 mm", 0, 0], [0, "100 mm", 0], [0, 0, "100 mm"]]
[[body]]
name = "table"
at = [0, 0, 0]
[[limb]]
to = "table"
joints = [ { name = "pan", type = "R", at = [0, 0, 0], axis = "z", actuated = true } ]
[[limb]]
from = "table"
joints = [ { name = "hinge", type = "R", at = [0, 0, "200 mm"], axis = "y" } ]
[[limb]]
from = "table"
joints = [
  { name = "A", type = "S", at = ["-300 mm", 0, "220 mm"] },
  { name = "q", type = "P", from = "A", to = "B", actuated = true },
  { name = "B", type = "S", at = [0, 0, "300 mm"] } ]
"""


class StudyNotes(ProgramTest):
    def write_rps(self, study=RPS, of_file=("", "")):
        self.write("rps.toml", (GALLERY / "3-rps/3-rps.toml").read_text().replace(*of_file))
        self.write("study.toml", study)

    def errors_of(self, *arguments):
        """What a command that succeeds says on stderr."""
        done = self.poesy(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr.decode()

    def test_what_is_held_is_said_everywhere(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 20"))
        self.assertIn(f"\n# {HELD}\n", self.succeeds("check", "study.toml"))
        self.assertIn(f"poesy: {HELD}\n", self.poesy("run", "study.toml", "-o", "r.h5").stderr.decode())
        self.assertEqual(self.poesy("run", "study.toml", "-o", "r.h5", "--quiet").stderr, b"")
        self.assertIn(f"\n{HELD}\n", self.succeeds("show", "r.h5"))

    def test_nothing_is_said_where_nothing_is_held(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 20").replace("background =", "# background ="))
        done = self.poesy("run", "study.toml", "-o", "r.h5")
        for text in (done.stderr.decode(), self.succeeds("check", "study.toml"), self.succeeds("show", "r.h5")):
            self.assertNotIn("held constant", text)

    def test_cases_and_tables_of_errors(self):
        self.write("study.toml", CASES)
        self.succeeds("run", "study.toml", "-o", "r.h5")
        self.assertIn("held constant, unless a case sets another value: 30 errors of set 'benign' at 0.02 mm and "
                      "0.0166667 deg", " ".join(self.succeeds("show", "r.h5").split()))
        self.write("poses.csv", "z,beta,gamma\n-0.25,0.1,0.2\n")
        self.write("errors.csv", "delta_1_1_y\n0.001\n")
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "e.h5")
        self.assertNotIn("held constant", self.succeeds("show", "e.h5"), "the table sets all errors")

    def test_the_template_holds_errors_of_the_study_size(self):
        template = self.succeeds("template", "2upr-rpu", "--full")
        for sigma, size in (("1 mm", "1 mm"), ("20 um", "0.02 mm")):
            self.write("study.toml", template.replace('sigma = "1 mm"', f'sigma = "{sigma}"'))
            self.assertIn(f"30 errors of set 'benign' at {size} and 1 deg", self.succeeds("check", "study.toml"))

    def test_a_platform_larger_than_its_base(self):
        wide = STUDY.replace('"2upr-rpu"', '"2upr-rpu"\ngeometry = { l_A = "800 mm", l_B = "200 mm" }')
        self.write("study.toml", wide.replace("count = 6", 'count = 1\nmax_condition = 1e30'))
        asked = "the platform (l_A = 800 mm) is larger than the base (l_B = 200 mm); is that meant?\n"
        self.assertIn(f"poesy: warning: {asked}", self.errors_of("check", "study.toml"))
        self.assertNotIn("# hint", self.succeeds("check", "study.toml"), "it is said once")
        self.write("study.toml", STUDY)
        self.assertNotIn("that meant", self.errors_of("check", "study.toml"))

    def test_a_workspace_without_home(self):
        """Every command that solves the mechanism, or shows what was solved, asks about it."""
        self.write_rps(of_file=('z = ["500 mm", "700 mm"]', 'z = ["650 mm", "750 mm"]'))
        asked = "home has z = 600 mm, outside the workspace from 650 mm to 750 mm (coordinates are absolute); is that meant?"
        self.assertIn(f"poesy: warning: {asked}\n", self.errors_of("check", "study.toml"))
        self.assertEqual(self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"), f"poesy: warning: {asked}\n")
        swept = self.errors_of("sweep", "study.toml", "--set", "errors.linear.sigma=0.1,0.2mm", "-o", "s.h5", "--quiet")
        self.assertEqual(swept.count(asked), 1, swept)
        self.assertIn(asked, self.errors_of("tolerances", "r.h5", "--response", "position", "-d", "t"))
        self.assertIn(f"warning: {asked}", " ".join(self.succeeds("show", "r.h5").split()))
        self.succeeds("report", "r.h5")
        self.assertIn(asked, (self.folder / "r.html").read_text())

    def test_a_workspace_with_home(self):
        self.write_rps()
        self.assertEqual(self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"), "")
        self.assertNotIn("warning", self.succeeds("show", "r.h5"))

    def test_errors_without_a_size(self):
        without = RPS.replace('[errors]\nlinear = { distribution = "normal", sigma = "0.1 mm" }\n', "")
        self.write_rps(without)
        default = 'so it is the default, { distribution = "normal", sigma = "1 mm" }; write errors.linear\n'
        self.assertEqual(self.errors_of("check", "study.toml"),
                         f"poesy: warning: [errors] does not state the size of the error delta_1_1_x, {default}")
        self.write_rps(RPS.replace('"delta_1_1_x"', '"delta_1_1_x", "delta_2_1_x", "delta_3_1_x", "epsilon_1_1_x"'))
        self.assertEqual(self.errors_of("check", "study.toml"),
                         "poesy: warning: [errors] does not state the size of the error epsilon_1_1_x, so it is the default, "
                         '{ distribution = "normal", sigma = "1 deg" }; write errors.angular\n')
        self.write("study.toml", STUDY)
        self.assertEqual(self.errors_of("check", "study.toml"), "", "a built-in mechanism has the sizes of its paper")

    def test_a_standard_deviation_as_large_as_a_link(self):
        self.write_rps(RPS.replace("0.1 mm", "80 mm"))
        said = self.errors_of("check", "study.toml")
        self.assertRegex(said, r"^poesy: warning: the error delta_1_1_x has a standard deviation of 80 mm, .* is \d+.* mm; "
                               r"is that meant\?\n$")
        self.write_rps(RPS.replace("0.1 mm", "2 mm"))
        self.assertEqual(self.errors_of("check", "study.toml"), "")

    def test_geometry_with_a_decimal_point_in_the_wrong_place(self):
        for a, asked in (("25 mm", True), ("24 mm", True), ("2500 mm", True), ("26 mm", False), ("240 mm", False)):
            self.write_rps(RPS.replace('"rps.toml"', f'"rps.toml", geometry = {{ a = "{a}" }}'))
            said = self.poesy("check", "study.toml").stderr.decode()
            self.assertEqual(f"a = {a}; the mechanism's file has 250 mm; is that meant?" in said, asked, (a, said))

    def test_sizes_in_a_table_of_machines(self):
        self.write_rps(RPS.replace("0.1 mm", "80 mm"))
        bound = float(re.search(r" is ([\d.]+) mm; is that meant", self.errors_of("check", "study.toml"))[1])
        machines = RPS.replace('kind = "sensitivity"', 'kind = "monte-carlo"\ndraws = "per machine"')
        machines = machines.replace("samples = 20\n", "").replace("[errors]", '[errors]\nmachines = "machines.csv"')
        for share, asked in ((0.4, False), (0.6, True)):
            self.write_rps(machines)
            self.write("machines.csv", f"delta_1_1_x [mm]\n0.1\n{share * bound}\n")
            said = self.errors_of("check", "study.toml")
            self.assertEqual("errors.machines has delta_1_1_x = " in said and "are these sizes?" in said, asked, said)

    def test_poses_with_a_singular_pose_between_them(self):
        """A planar 3-RPR (over-constrained) is singular at -60 deg, a Tricept nowhere in its workspace."""
        self.write("rpr3.toml", (GALLERY.parents[1] / "tests/data/mechanisms/rpr3.toml").read_text()
                   .replace('phi = ["-50 deg", "50 deg"]', 'phi = ["-100 deg", "50 deg"]'))
        study = RPS.replace("rps.toml", "rpr3.toml").replace("count = 1", 'select = "file", file = "poses.csv"')
        self.write("study.toml", study.replace("delta_1_1_x", "leg_1"))
        for last, asked in ((50, False), (-50, False), (-70, True)):
            self.write("poses.csv", f"x [mm],y [mm],phi [deg]\n1,2,0\n1,2,20\n1,2,{last}\n")
            said = self.errors_of("check", "study.toml")
            self.assertEqual("poses 0 and 2 are on different sides of singular poses" in said, asked, said)
        self.write_tricept('["-800 mm", "-600 mm"]')
        self.assertNotIn("different sides", self.errors_of("check", "study.toml"))

    def test_poses_with_a_singular_pose_between_them_in_a_wrist_of_ball_joints(self):
        """A 3-SPS-1-S is singular where its legs meet the axis through the pivot: at 50 deg against the twist."""
        self.write("wrist.toml", WRIST)
        self.write("study.toml", RPS.replace("rps.toml", "wrist.toml").replace("count = 1", 'select = "file", file = "poses.csv"')
                   .replace("delta_1_1_x", "delta_1_0_x"))
        for last, asked in ((40, False), (-40, False), (-60, True)):
            self.write("poses.csv", f"rx [deg],ry [deg],rz [deg]\n5,5,0\n5,0,{0.5 * last}\n5,5,{last}\n")
            said = self.errors_of("check", "study.toml")
            self.assertEqual("poses 0 and 2 are on different sides of singular poses" in said, asked, said)

    def test_an_idle_freedom_that_turns_with_the_machine_is_not_a_singular_pose(self):
        """The leg of a pan-tilt spins idly; at 135 and 180 deg of pan its direction is nearly the opposite one."""
        self.write("pan-tilt.toml", PAN_TILT)
        self.write("study.toml", RPS.replace("rps.toml", "pan-tilt.toml").replace("count = 1", 'select = "file", file = "poses.csv"')
                   .replace("delta_1_1_x", "delta_3_0_x"))
        self.write("poses.csv", "rz [deg],ry [deg]\n0,5\n135,5\n180,6\n")
        self.assertNotIn("different sides", self.errors_of("check", "study.toml"))

    def write_tricept(self, z):
        self.write("tricept.toml", (GALLERY / "tricept/tricept.toml").read_text())
        box = f'workspace = {{ rx = ["-20 deg", "20 deg"], ry = ["-20 deg", "20 deg"], z = {z} }}'
        study = (GALLERY / "tricept/yield.toml").read_text().replace("count = 20", f"count = 5\n{box}")
        self.write("study.toml", re.sub("samples = .*", "samples = 20", study))

    def test_a_workspace_of_a_study_with_another_sign(self):
        """Every command that selects the poses, or shows results at them, asks about it."""
        self.write_tricept('["600 mm", "800 mm"]')
        asked = ("[poses] workspace: z is from 600 mm to 800 mm, in the mechanism's workspace from -800 mm to -600 mm; "
                 "is that meant?")
        warned = f"poesy: warning: {asked}\n"
        self.assertEqual(self.errors_of("check", "study.toml"), warned)
        self.assertIn(warned, self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"))
        swept = self.errors_of("sweep", "study.toml", "--set", "geometry.a=250,260mm", "-o", "s.h5", "--quiet")
        self.assertEqual(swept.count(asked), 1, swept)
        for result in ("r", "s"):
            self.assertIn(f"warning: {asked}", " ".join(self.succeeds("show", f"{result}.h5").split()))
            self.succeeds("report", f"{result}.h5")
            self.assertIn(asked, html.unescape((self.folder / f"{result}.html").read_text()))

    def test_a_workspace_of_a_study_that_is_shifted_a_little(self):
        self.write_tricept('["-820 mm", "-650 mm"]')
        self.assertEqual(self.errors_of("check", "study.toml"), "")

    def test_the_workspaces_of_the_stored_studies(self):
        of_box = [path for path in RESULTS.rglob("*.toml")
                  if re.search(r"\[poses\][^\[]*^workspace", path.read_text(), re.M)]
        self.assertGreater(len(of_box), 5)
        for path in of_box:
            self.assertNotIn("is that meant?", self.errors_of("check", path), path)

    def test_geometry_far_from_the_files(self):
        for given, asked in (("-250 mm", "a = -250 mm"), ("2.6 m", "a = 2600 mm"), ("24 mm", "a = 24 mm")):
            self.write_rps(RPS.replace("}", f', geometry = {{ a = "{given}" }} }}', 1))
            asked += "; the mechanism's file has 250 mm; is that meant?\n"
            self.assertIn(f"poesy: warning: {asked}", self.errors_of("check", "study.toml"))
            self.assertIn(f"poesy: warning: {asked}", self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"))
        self.write_rps()
        swept = self.errors_of("sweep", "study.toml", "--set", "geometry.a=250,-250mm", "-o", "s.h5", "--quiet")
        self.assertEqual(swept.count("poesy: warning: with mechanism.geometry.a = -250 mm: a = -250 mm;"), 1, swept)

    def test_a_load_without_stiffness(self):
        self.write_rps(RPS.replace("}", ', load = { force = [0, 0, "-50 N"] } }', 1))
        self.assertIn("the load has no effect, because no joint, link or limb has stiffness", self.errors_of("check", "study.toml"))

    def test_geometry_like_the_files_or_zero(self):
        for given in ("300 mm", "26 mm"):
            self.write_rps(RPS.replace("}", f', geometry = {{ a = "{given}" }} }}', 1))
            self.assertNotIn("that meant", self.errors_of("check", "study.toml"))

    def said_of_yield(self, study, limit):
        """What `run` says on stderr if half of the machines are to keep the limit."""
        self.write_rps(study.replace("LIMIT", limit).replace("limits =", "yield = 0.5\nlimits ="))
        return self.poesy("run", "study.toml", "-o", "r.h5").stderr.decode()

    def test_limits_in_another_unit(self):
        """Of a yield of 0 or 100 % the ratio of limit and root mean square is said where it is far from 1."""
        machines = RPS.replace('"sensitivity"', '"monte-carlo"\ndraws = "per machine"\nlimits = { position = "LIMIT" }')
        for limit, said in (("0.1 um", "The root mean square of position is "), ("0.2 m", "The limit of position is ")):
            self.write_rps(machines.replace("LIMIT", limit))
            self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
            shown = " ".join(self.succeeds("show", "r.h5").split())
            self.assertRegex(shown, said + r"\S+ times its (limit|root mean square): look at the units of limits and sigmas")
            self.succeeds("report", "r.h5")
            self.assertIn(said, (self.folder / "r.html").read_text())
            self.assertIn(said, self.said_of_yield(machines, limit))
        for limit in ("0.1 mm", "5 um"):
            self.write_rps(machines.replace("LIMIT", limit))
            self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
            self.assertNotIn("look at the units", self.succeeds("show", "r.h5"))
            self.assertNotIn("look at the units", self.said_of_yield(machines, limit))

    def test_poses_with_units_outside_the_workspace(self):
        self.write_rps(RPS.replace("count = 1", 'select = "file", file = "p.csv"'))
        said = "p.csv: pose 2 has z = 900 mm, outside the workspace from 500 mm to 700 mm; look at its sign and unit"
        self.write("p.csv", "rx [deg],ry [deg],z [mm]\n5,5,600\n5,5,900\n")
        self.assertEqual(self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"), f"poesy: warning: {said}\n")
        self.write("p.csv", "rx [deg],ry [deg],z [mm]\n5,5,600\n5,5,700\n")
        self.assertEqual(self.errors_of("run", "study.toml", "-o", "r.h5", "--quiet"), "")

    def warning(self, study):
        """What is said on stderr of samples that did not converge."""
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "r.h5", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr.decode()

    def test_advice_is_of_what_the_study_does_not_use(self):
        few = STUDY.replace("samples = 1500", "samples = 20").replace('"gauss-newton"', '"gauss-newton"\nmax_iterations = 8')
        self.assertIn('take method = "newton"', self.warning(few))
        large = STUDY.replace('"sensitivity"', '"monte-carlo"').replace("0.2 deg", "1 deg").replace("background =", "# background =")
        large = large.replace("samples = 1500", "samples = 300").replace('factors = ["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]',
                                                                        'factors = "all"')
        of_newton = self.warning(large.replace('"gauss-newton"', '"newton"'))
        self.assertIn("did not converge and are left out", of_newton)
        self.assertNotIn("method", of_newton)
        self.assertIn("study smaller errors, or raise solver.max_iterations above 50", of_newton)
        by_platform = self.warning(large.replace('"gauss-newton"', '"gauss-newton"\nmetric = "platform"\nmax_iterations = 2'))
        self.assertNotIn("method", by_platform, "both methods are the same there")
        self.assertIn("study smaller errors, or raise solver.max_iterations above 2", by_platform)

    def test_what_the_study_allows_is_no_warning(self):
        allowed = '"gauss-newton"\nmax_iterations = 8\nmax_not_converged = 0.9'
        self.assertEqual(self.warning(STUDY.replace("samples = 1500", "samples = 20").replace('"gauss-newton"', allowed)), "")


main()
