"""What `poesy calibrate` refuses: each wrong table and each wrong key, with its place and a remedy."""

import os
import shutil
from pathlib import Path

from poesy_program import ProgramTest, main

FILES = Path(os.environ["POESY_DATA"]) / "calibration"
HEADER = "name,x [mm],y [mm],z [mm],deviation_z [um],to,distance [mm]"
ROWS = ["p0,0,0,0,-240,,", "p1,60,0,0,-528.5,p4,119.92", "p4,-60,0,0,-12.9,,"]
STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "delta-puu.toml"
errors.linear = { distribution = "normal", sigma = "0.3 mm" }
[analysis]
[analysis.calibration]
fit   = ["zero_1", "zero_2", "zero_3"]
noise = { z = "10 um", distance = "50 um" }
"""


def table(*rows, header=HEADER):
    return "\n".join([header, *(rows or ROWS)]) + "\n"


def replaced(row, text):
    return table(*(text if number == row else old for number, old in enumerate(ROWS)))


def titled(old, new):
    return table(header=HEADER.replace(old, new))


# Wrong tables: (text, place in the message, part of the message).
TABLES = [
    (titled("deviation_z", "devation_z"), "1:27", "column 'devation_z' is unknown; did you mean 'deviation_z'?"),
    (titled("deviation_z [um]", "deviation_z [deg]"), "1:27", "a unit of angle, but this column is a length"),
    (titled("deviation_z [um]", "deviation_z [furlong]"), "1:27", "an unknown unit"),
    (titled("deviation_z [um]", "deviation_position [um]"), "1:27", "'position' has no sign"),
    (titled("deviation_z [um]", "x [mm]"), "1:27", "column 'x' appears a second time"),
    (titled("x [mm],", ""), "1:1", "column 'x' is missing"),
    (titled("x [mm]", "q_1_2 [mm]"), "1:1", "the columns mix coordinates"),
    (titled("name", "part"), "1:1", "column 'part' is unknown"),
    (titled("name", "name [mm]"), "1:1", "it holds names"),
    (titled("to,", "sd_x,"), "1:44", "column 'sd_x' belongs to no measured column"),
    (titled("to,", "sd_z [um],"), "1:54", "column 'distance' needs a column 'to'"),
    (titled("name,", "sd_z,"), "1:44", "column 'to' needs a column 'name'"),
    (titled("distance [mm]", "distance [rad]"), "1:47", "a unit of angle, but this column is a length"),
    (titled("distance [mm]", "sd_z [um]"), "1:44", "column 'to' needs a column 'distance'"),
    ("name,x,y,z\np0,0,0,0\n", "1:1", "no column is measured: deviation_*, actual_*, or distance"),
    (titled("deviation_z", "actual_theta_z"), "1:27", "column 'actual_theta_z' is unknown"),
    (titled("deviation_z [um]", '"deviation_z'), "1:27", "begins with a quote, but does not end with one"),
    (HEADER.replace(",", "\t") + "\n", "1:1", "separated by tabs"),
    (HEADER.replace(",", ";") + "\n", "1:5", "semicolons"),
    ("", "1:1", "the file is empty"),
    (HEADER + "\n", "2:1", "there is no data below the column names"),
    (titled("deviation_z [um]", "deviation_z"), "2:1", "deviation_z of p0 is -2.4e+05 mm, which is more than a tenth of the mechanism's reach"),
    (titled("deviation_z [um]", "deviation_z [mm]"), "2:1", "'deviation_z [um]'"),
    (replaced(0, "p0,0,0,,-240,,"), "2:8", "z is missing"),
    (replaced(1, "p1,60,0,,-528.5,p4,119.92"), "3:9", "z is missing, and 'to' needs a pose"),
    (replaced(1, "p1,60,0,nan,-528.5,p4,119.92"), "3:9", "z is missing, and 'to' needs a pose"),
    (replaced(1, "p1,60,0,0,-528.5,p31,119.92"), "3:18", "'p31' is the name of no row"),
    (replaced(1, "p1,60,0,0,-528.5,p1,119.92"), "3:18", "'to' names its own row"),
    (replaced(1, "p1,60,0,0,-528.5,,119.92"), "3:1", "a distance is measured, but 'to' names no row"),
    (replaced(1, "p1,60,0,0,-528.5,p4,-119.92"), "3:1", "a distance is not above zero"),
    (replaced(2, "p1,-60,0,0,-12.9,,"), "4:1", "name 'p1' appears a second time, after line 3"),
    (replaced(2, "'p',-60,0,0,-12.9,,"), "4:1", "has a quote"),
    (replaced(2, "=p,-60,0,0,-12.9,,"), "4:1", "begins with '='"),
    (replaced(2, "p4,-60,0,0,-12.9,"), "4:1", "this line should have 7 cells, but has 6"),
    (replaced(2, "p4,-60,0,0,-12,9,,"), "4:19", "this line should have 7 cells, but has 8"),
    (replaced(2, "p4,-60,0,0,-12.9 um,,"), "4:12", "in column 'deviation_z'"),
    (replaced(2, "p4,-60,0,0,inf,,"), "4:12", "in column 'deviation_z'"),
    (replaced(2, "p4,sixty,0,0,-12.9,,"), "4:4", "'sixty' in column 'x'"),
    (replaced(1, ""), "3:1", "this line is blank"),
    ("x [mm],y [mm],z [mm],deviation_z [um],sd_z [um]\n0,0,0,-240,-5\n", "2:12", "a standard deviation is below zero"),
    ("x [mm],y [mm],z [mm],deviation_z [um]\n0,0,0,\n", "2:1", "no value is measured"),
    ("x [mm],y [mm],z [mm],deviation_z [um]\n0,0,0,1\n500,0,0,1\n0,1,0,2\n", "3:1", "pose 2 (x = 0.5 m, y = 0 m, z = 0 m) is out of reach"),
    ("x [mm],y [mm],z [mm],deviation_x [um]\n0,0,0,1\n0,10,0,1\n5,0,0,2\n", "1:1", "deviation_x has neither a column sd_x nor noise"),
    ("x [mm],y [mm],z [mm],deviation_z [um]\n0,0,0,1\n0,10,0,1\n", None, "3 fitted errors and 2 measured values; measure at more "
     "poses, fit fewer, or take prior = \"tolerances\""),
]

FIT = 'fit   = ["zero_1", "zero_2", "zero_3"]'
NOISE = 'noise = { z = "10 um", distance = "50 um" }'
# Wrong keys: (replaced text of the study, new text, place in the message, part of the message).
KEYS = [
    (FIT, "", "6:", "key 'fit' is missing"),
    (FIT, "fit = []", "7:7", "is empty"),
    (FIT, 'fit = ["zero_7"]', "7:8", "'zero_7', which is not an error, set or combination"),
    (FIT, 'fit = ["radius"]\ncombinations.radius = { foot_x_9 = 1 }', "8:", "unknown error 'foot_x_9'"),
    (FIT, 'fit = ["radius"]\ncombinations.radius = { }', "8:", "names no error"),
    (FIT, 'fit = ["radius"]\ncombinations.radius = { foot_x_1 = 0 }', "8:", "is 0"),
    (FIT, 'fit = ["radius"]\ncombinations.radius = { "feet_*" = 1 }', "8:", "matches no error of the mechanism"),
    (FIT, 'fit = ["radius"]\ncombinations.radius = { "foot_x_*" = 0 }', "8:", "is 0"),
    (FIT, 'fit = ["foot_x_1"]\ncombinations.foot_x_1 = { foot_x_2 = 1 }', "8:", "the name of the error 'foot_x_1'"),
    (FIT, 'fit = ["a-b"]\ncombinations.a-b = { foot_x_2 = 1 }', "8:", "cannot be used in expressions"),
    (FIT, 'fit = ["a"]\ncombinations."" = { foot_x_2 = 1 }', "8:", "cannot be used in expressions"),
    (FIT, 'fit = ["r", "r2"]\ncombinations.r = { foot_x_1 = 1 }\ncombinations.r2 = { foot_x_1 = 2 }', "7:",
     "combinations 'r' and 'r2' are the same direction"),
    (FIT, 'fit = ["foot_x_1", "foot_x_2", "r"]\ncombinations.r = { foot_x_1 = 1, foot_x_2 = 1 }', "7:",
     "combination 'r' is a sum of multiples of those before it"),
    (FIT, FIT + '\nmeasured = ["position"]', "8:", "which has no sign; measure x, y, z"),
    (FIT, FIT + '\nmeasured = ["x"]', "8:", "noise does not say how well x is measured"),
    (FIT, FIT + '\nframe = "bed"', "8:", "unknown"),
    (FIT, FIT + '\nrepeats = 0', "8:", "at least 1"),
    (FIT, FIT + '\npresent = { radius = "1 mm" }', "8:", "unknown fitted error 'radius'"),
    (FIT, FIT + '\npairs = [[1, 1]]', "8:", "is one pose twice"),
    (FIT, FIT + '\ncoordinates = ["x", "y"]', "8:", "has 2 coordinates, but a pose has 3"),
    (FIT, FIT + '\nmotors = [["q_1_2"]]', "8:", "has 1 motors, but there are 3 commanded coordinates"),
    (FIT, FIT + '\ncontroller.a = "R + zero_1*zero_2"', "8:", "R + zero_1"),
    (FIT, FIT + '\ncontroller.a = "R + nothing"', "8:", "nothing"),
    (FIT, FIT + '\ncontroller.a = "atan(zero_1)"', "8:17", "takes atan of a length; give it a number"),
    (FIT, FIT + '\ncontroller.a = "R + 2*rod_1"', "8:16",
     "controller number 'a' uses the error 'rod_1', which is not fitted alone; use fitted errors only, or add it to fit"),
    (FIT, 'fit = ["rods"]\ncombinations.rods = { "rod_*" = 1 }\ncontroller.a = "R + rod_1"', "9:",
     "'rod_1', which is not fitted alone; use the combination 'rods', which has this error"),
    (FIT, FIT + '\nnext = -1', "8:", "at least 0"),
    (FIT, FIT + '\nwrong = 1', "8:", "unknown key 'wrong'"),
    (NOISE, 'noise = { z = "-1 um" }', "8:", "below zero"),
    (NOISE, 'noise = { z = 5 }', "8:", "bare number"),
    (NOISE, 'noise = { position = "5 um" }', "8:", "has no sign"),
    (NOISE, 'noise = { z = "10 um", distance = 0 }', None, "some values have noise 0"),
]


class Refusals(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copyfile(FILES / "delta-puu.toml", self.folder / "delta-puu.toml")

    def refused(self, study, measured):
        self.write("study.toml", study)
        self.write("m.csv", measured)
        done = self.poesy("calibrate", "study.toml", "--measured", "m.csv", "-o", "r.h5")
        self.assertEqual(done.returncode, 2, done.stderr.decode() + done.stdout.decode())
        self.assertFalse((self.folder / "r.h5").exists())
        return done.stderr.decode()

    def test_tables(self):
        for text, place, message in TABLES:
            with self.subTest(message):
                said = self.refused(STUDY, text)
                self.assertIn(message, said)
                if place is not None:
                    self.assertIn(f"m.csv:{place}", said)
                self.assertIn(";", said)

    def test_keys(self):
        for old, new, place, message in KEYS:
            with self.subTest(message):
                said = self.refused(STUDY.replace(old, new), (FILES / "delta-heights.csv").read_text())
                self.assertIn(message, said)
                if place is not None:
                    self.assertIn(f"study.toml:{place}", said)

    def test_prior_without_tolerance(self):
        study = STUDY.replace("errors.linear", 'errors.override.zero_1').replace(FIT, FIT + '\nprior = "tolerances"')
        said = self.refused(study, table())
        self.assertIn('"tolerances", and zero_2 has no tolerance in [errors]', said)

    def test_study_that_is_run(self):
        self.write("study.toml", STUDY.replace("[analysis]", "poses = { count = 3 }\n[analysis]"))
        done = self.poesy("run", "study.toml", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn("analysis.calibration does not say what is measured", done.stderr.decode())

    def test_units_of_a_combination(self):
        shutil.copyfile(FILES / "delta-six-rods.toml", self.folder / "delta-six-rods.toml")
        study = STUDY.replace("delta-puu", "delta-six-rods").replace(
            FIT, 'fit = ["tower"]\ncombinations.tower = { tower_y_1 = 1, lean_x_1 = 1 }')
        said = self.refused(study, "x,y,z,rx,ry,rz,deviation_z\n0,0,0,0,0,0,1e-5\n")
        self.assertIn("tower_y_1 is a length and lean_x_1 an angle; give the factor a unit", said)
        self.assertIn("study.toml:8:", said)

    def test_more_motors_than_coordinates(self):
        mechanism = (FILES.parent / "mechanisms" / "lift-table.toml").read_text()
        self.write("lift-table.toml", mechanism)
        said = self.refused(STUDY.replace("delta-puu", "lift-table").replace(FIT, 'fit = ["leg_1"]'),
                            "z [mm],rx,ry,deviation_z [um]\n600,0,0,1\n650,0,0,2\n")
        self.assertIn("4 motors and 3 commanded coordinates; say which drives move together (motors), or what else is "
                      "commanded (coordinates)", said)

    def test_position_that_is_no_coordinate(self):
        """A mechanism whose poses are angles and one length does not command the position of its tool."""
        self.write("lift-table.toml", (FILES.parent / "mechanisms" / "lift-table.toml").read_text())
        study = STUDY.replace("delta-puu", "lift-table").replace(FIT, 'fit = ["leg_1"]\ncoordinates = ["tip_x", "tip_y", "tip_z"]')
        said = self.refused(study, "z [mm],rx,ry,deviation_z [um]\n600,0,0,1\n650,0,0,2\n")
        self.assertIn("study.toml:8:16: ", said)
        self.assertIn("is 'tip_x', but the coordinates of this mechanism are z, rx, ry", said)
        self.assertIn("use x, y, z as coordinates of the platform in the mechanism's file", said)
        built_in = STUDY.replace('file = "delta-puu.toml"', 'model = "3-prs"')
        built_in = built_in.replace(FIT, 'fit = ["a_x_1"]\ncoordinates = ["x", "alpha", "beta"]')
        built_in = built_in.replace(NOISE, 'noise = { z = "10 um" }')
        said = self.refused(built_in, "tip_x,tip_y,tip_z,deviation_z [um]\n0,0,0.8,1\n")
        self.assertIn("is 'x', but the coordinates of this mechanism are alpha, beta, z, ", said)
        self.assertNotIn("the mechanism's file", said)

    def test_lengths_and_angles_without_noise(self):
        study = STUDY.replace(NOISE, "noise = { z = 0, theta_x = 0 }")
        said = self.refused(study, "x,y,z,deviation_z [um],deviation_theta_x [mrad]\n" + "".join(
            f"{place},0,0,{place},0\n" for place in (0, 0.01, 0.02)))
        self.assertIn("noise is 0 and values have lengths and angles: say how they are weighed; state the noise of each", said)

    def test_errors_that_change_from_move_to_move(self):
        study = STUDY.replace("errors.linear", 'errors.override.zero_1 = { draws = "per pose" }\nerrors.linear')
        self.assertIn("'zero_1', which changes from move to move", self.refused(study, table()))

    def test_kinds_of_wrong_tables(self):
        """Each with its line and column."""
        places = [place for _, place, _ in TABLES if place]
        self.assertGreaterEqual(len(places), 40)
        self.assertTrue(all(place.split(":")[1] for place in places))

    def test_calibrated_beside_it(self):
        said = self.refused(STUDY.replace("[analysis]\n", "[analysis]\ncalibrated = true\n"), table())
        self.assertIn("is set beside calibrated = true", said)

    def test_more_places_than_values(self):
        study = STUDY.replace(FIT, FIT + '\nprior = "tolerances"\nframe = "plane"')
        said = self.refused(study, "x [mm],y [mm],z [mm],deviation_z [um]\n0,0,0,1\n0,10,0,1\n0,10,0,1\n")
        self.assertIn("3 numbers of frame and target and 3 measured values; measure at more poses", said)

    def test_study_without_the_table(self):
        said = self.refused(STUDY.split("[analysis]")[0], table())
        self.assertIn("there is no table [analysis.calibration]", said)


if __name__ == "__main__":
    main()
