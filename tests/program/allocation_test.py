"""Tolerances under limits: the certificate is what its study finds, tables agree, and the bits are the same however
a study is run. Also limits that cannot be reached, tolerances that are not certified, and studies that are refused."""

import csv
import json
import re
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy

from poesy_program import EACH_A_PART, GALLERY, PROGRAM, main
from resumption import ALLOCATION, ResumptionTest

CHOICES = Path(__file__).resolve().parents[1] / "fuzz/corpus/study/allocation"
PARTS = EACH_A_PART + """\
[run]
seed = 5
"""
ERRORS = """\
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
angular = { distribution = "normal", sigma = "0.05 deg" }
"""
GAP = """\
format = "poesy-study"
version = 1
mechanism = { model = "2upr-rpu" }
poses = { count = 8 }
solver = { metric = "platform" }
""" + ERRORS + """\
[analysis]
kind = "allocation"
samples = 10000
limits = { gap = "0.03 mm" }
yield = 0.99
sigmas = 3
""" + PARTS.replace("each = true", "each = true\nidentical_limbs = [1, 2]")
TIP = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs" }
poses = { count = 4 }
""" + ERRORS + """\
[analysis]
kind = "allocation"
samples = 5000
limits = { tip_position = "0.3 mm", rotation = "0.1 deg" }
yield = 0.99
sigmas = 3
""" + PARTS
FROM_FILES = GAP.replace('model = "2upr-rpu"', 'file = "2upr-rpu.toml"').replace("samples = 10000", "samples = 2000").replace(
    "poses = { count = 8 }", 'poses = { select = "file", file = "poses.csv" }')
SMALL = ALLOCATION.replace("samples = 30000", "samples = 2500")
FEWEST = 299  # the fewest machines that certify a yield of 0.99, if all are good


class Allocation(ResumptionTest):
    def run_study(self, study, code=0, output="out.h5"):
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def refused(self, study, *words, options=()):
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "out.h5", *options)
        self.assertEqual(done.returncode, 2, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr.decode())
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"study.toml"})

    def check_certificate(self, result, certificate):
        """The result of the study beside a result counts what that result says."""
        with h5py.File(self.folder / result) as found, h5py.File(self.folder / certificate) as again:
            group = found["allocation/certificate"]
            self.assertEqual(again.attrs["kind"], "monte-carlo")
            for name in ("rejects", "machines", "unsolved"):
                self.assertEqual(group[name][()], again["yield"][name][()], name)
            self.assertEqual(group["yield"][()], again["yield/value"][()])
            self.assertEqual(group["ci_low"][()], again["yield/ci_low"][()])
            self.assertLessEqual(group["rejects"][()], group["most_rejects"][()])
            self.assertLessEqual(group["design_rejects"][()], group["design_most"][()])

    def check_no_part_is_idle(self, result, parts):
        """Each part made coarser alone breaks the yield, or is as coarse as it may be."""
        with h5py.File(self.folder / result) as found:
            certificate = found["allocation/certificate"]
            machines = int(certificate["design_machines"][()])
            # The design uses all rejects that it may have; otherwise some tolerance could be larger.
            self.assertEqual(certificate["design_rejects"][()], certificate["design_most"][()])
            most = 1 - certificate["design_most"][()] / machines
            bounds = found["allocation/bound"][:]
            coarser = found["allocation/coarser_yield"][:]
        self.assertEqual(len(coarser), parts)
        for part, (share, bound) in enumerate(zip(coarser, bounds)):
            self.assertTrue(share < most or bound == 2, f"part {part}: {machines * (1 - share)} rejects, bound {bound}")

    def test_errors_in_no_part_are_named(self):
        lengths = PARTS.split("[[analysis.parts]]")[1]
        some = TIP.replace(PARTS, "[[analysis.parts]]" + lengths).replace("0.05 deg", "0.002 deg")
        self.write("study.toml", some)
        said = " varied errors are in no part; their sizes stay as [errors] states them: "
        self.assertIn(said, self.succeeds("check", "study.toml"))
        done = self.poesy("run", "study.toml", "-o", "out.h5")
        self.assertIn(said, done.stderr.decode())
        tables = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]
        rows = next(table["rows"] for table in tables if table["name"] == "in_no_part")
        self.assertEqual({(row["distribution"], row["sigma"], row["unit"]) for row in rows}, {("normal", 0.002, "deg")})
        self.assertIn(f"{len(rows)} of ", self.succeeds("show", "out.h5", "--method"))

    def test_no_part_could_be_coarser(self):
        for study, parts in ((GAP, 47), (TIP, 60)):
            self.run_study(study)
            self.check_no_part_is_idle("out.h5", parts)

    def test_the_certificate_is_what_its_study_finds(self):
        done = self.run_study(GAP)
        self.assertTrue(done.stdout.decode().splitlines()[1].startswith("out_certificate.toml: "), done.stdout)
        self.assertIn("PASS", done.stdout.decode())
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(len(file["factors/name"]), 71)
            self.assertEqual(len(file["part"]), 47)  # 24 errors of limb 1 and of limb 2 share 24 tolerances
            self.assertEqual(file["allocation"].attrs["certified"], 1)
            text = file["allocation/certificate_study"].asstr()[()]
            self.assertAlmostEqual(file["allocation/share"][:].sum(), 1.0)
            self.assertAlmostEqual(file["allocation/cost"][:].sum() / file["allocation"].attrs["cost"], 1.0)
        beside = (self.folder / "out_certificate.toml").read_text(encoding="utf-8")
        self.assertTrue(beside.endswith(text))
        again = self.succeeds("run", "out_certificate.toml", "-o", "again.h5", "--quiet")
        self.assertIn("PASS", again)
        self.check_certificate("out.h5", "again.h5")

    def test_its_study_needs_no_file_of_the_first(self):
        (self.folder / "studies").mkdir()
        (self.folder / "results").mkdir()
        (self.folder / "elsewhere").mkdir()
        shutil.copy(GALLERY / "2upr-rpu/2upr-rpu.toml", self.folder / "studies")
        self.write("studies/poses.csv", "gamma,z,beta\n0,-0.2,0\n0.2,-0.25,-0.1\n-0.3,-0.22,0.3\n")
        self.write("studies/study.toml", FROM_FILES)
        self.succeeds("run", "studies/study.toml", "-o", "results/r.h5", "--quiet")
        self.assertEqual({path.name for path in (self.folder / "results").iterdir()},
                         {"r.h5", "r_certificate.toml", "r_certificate_mechanism.toml", "r_certificate_poses.csv"})
        shutil.rmtree(self.folder / "studies")
        done = subprocess.run([PROGRAM, "run", "../results/r_certificate.toml", "-o", "again.h5", "--quiet"],
                              cwd=self.folder / "elsewhere", capture_output=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_certificate("results/r.h5", "elsewhere/again.h5")

    def test_a_study_that_names_fewer_files_leaves_none_behind(self):
        """So the next one finds no file that no study names."""
        shutil.copy(GALLERY / "2upr-rpu/2upr-rpu.toml", self.folder)
        self.write("poses.csv", "gamma,z,beta\n0,-0.2,0\n0.2,-0.25,-0.1\n-0.3,-0.22,0.3\n")
        for study, beside in ((FROM_FILES, {"out_certificate_mechanism.toml", "out_certificate_poses.csv"}), (SMALL, set()),
                              (FROM_FILES, {"out_certificate_mechanism.toml", "out_certificate_poses.csv"})):
            self.run_study(study)
            self.assertEqual({path.name for path in self.folder.glob("out_certificate_*")}, beside)

    def test_same_bits(self):
        hashes = set()
        for threads in (1, 2, 3):
            self.write("study.toml", SMALL)
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--threads", threads)
            self.succeeds("verify", "out.h5")
            hashes.add(self.content_hash())
        self.assertEqual(len(hashes), 1)

    def test_tables_agree(self):
        self.run_study(SMALL)
        with h5py.File(self.folder / "out.h5") as file:
            names = list(file["part"].asstr())
            tolerance = dict(zip(names, file["allocation/tolerance"][:]))
            units = dict(zip(names, file["allocation/unit"].asstr()))
            cost = dict(zip(names, file["allocation/cost"][:]))
        self.assertEqual(len(names), 7)
        shown = {"mm": 1e-3, "deg": numpy.pi / 180}
        tables = {table["name"]: table for table in json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]}
        self.assertTrue(tables["yield"]["caption"].startswith("certified: at least 99 % of the machines"))
        rows = tables["drawing"]["rows"]
        self.assertEqual({row["part"] for row in rows}, set(names))
        for row in rows:
            self.assertAlmostEqual(row["tolerance"] * shown[row["unit"]] / tolerance[row["part"]], 1.0, places=12)
            self.assertAlmostEqual(row["cost"] / cost[row["part"]], 1.0, places=12)
            # The rounded tolerance of the drawing is never larger than the exact one.
            sign, size, unit = row["drawing"].replace("+-", "+- ").split()
            self.assertEqual((sign, unit), ("+-", row["unit"]))
            self.assertLessEqual(float(size), row["tolerance"])
            self.assertGreater(float(size), 0.999 * row["tolerance"])
        self.assertEqual([row["cost"] for row in rows], sorted(cost.values(), reverse=True))
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables/allocation.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["part"] for row in rows], names)
        for row in rows:
            self.assertEqual(float(row["tolerance [m or rad]"]), tolerance[row["part"]])
            self.assertEqual(row["unit"], units[row["part"]])
        for name in ("limits", "poses", "stages", "curves", "certificate"):
            self.assertTrue((self.folder / f"tables/allocation_{name}.csv").exists(), name)

    def test_calibration_saves(self):
        cost = []
        tip = TIP.replace("samples = 5000", "samples = 20000")
        for study in (tip, tip.replace("sigmas = 3", "sigmas = 3\ncalibrated = true")):
            self.run_study(study)
            with h5py.File(self.folder / "out.h5") as file:
                self.assertEqual(file["allocation"].attrs["certified"], 1)
                cost.append(file["allocation"].attrs["cost"])
            self.succeeds("run", "out_certificate.toml", "-o", "again.h5", "--quiet")
            self.check_certificate("out.h5", "again.h5")
        self.assertLess(cost[1], 0.95 * cost[0])

    def test_limits_that_cannot_be_kept(self):
        often = ("--checkpoint-every", "0.000001 s", "--keep-checkpoint")
        bounded = SMALL.replace('unit = "mm" }', 'unit = "mm" }\nbounds = ["0.05 mm", "1 mm"]')
        for options in ((), often):
            tight = bounded.replace("0.5 mm", "0.01 mm")
            self.refused(tight, "the limit of 0.01 mm on linear_deformation at pose ", "cannot be kept",
                         "with every tolerance at its lowest", "widen the limit", options=options)
            rare = bounded.replace("0.5 mm", "0.06 mm").replace("0.99", "0.995").replace("0.05 mm", "0.06 mm")
            self.refused(rare, "99.5 % of the machines", "cannot be reached", "of 2500 machines", options=options)
        # `check` accepts a limit that cannot be reached, because it solves nothing.
        self.write("study.toml", tight)
        self.assertIn("# valid: ", self.succeeds("check", "study.toml"))
        held = SMALL.replace('factors = "linear"', 'factors = ["delta_1_0_y"]').replace("0.5 mm", "0.01 mm")
        self.refused(held, "the background and the errors of no part alone give", "list them as parts")

    def test_machines_that_errors_in_no_part_reject(self):
        """No tolerance helps where other errors alone reject too many machines, although their root mean square is small."""
        held = SMALL.replace('factors = "linear"', 'factors = ["delta_1_0_y"]')
        self.assertNotEqual(held, SMALL)
        self.write("study.toml", held.replace("0.5 mm", "0.01 mm"))
        for _ in range(20):
            said = self.poesy("run", "study.toml", "-o", "out.h5").stderr.decode()
            alone = re.search(r"give a root mean square of ([\d.]+) mm", said)
            if alone is None:
                break
            self.write("study.toml", held.replace("0.5 mm", f"{1.1 * float(alone[1])} mm"))
        self.assertRegex(said, r"cannot be reached: errors that are in no part alone reject \d+ of 2500 machines \(\w+")
        self.assertIn("no tolerance of a part can help", said)

    def test_not_certified(self):
        fewest = SMALL.replace("samples = 2500", f"samples = {FEWEST}")
        self.refused(fewest.replace(str(FEWEST), str(FEWEST - 1)), f"{FEWEST - 1} machines cannot certify a yield of 0.99",
                     f"samples = {FEWEST} or more")
        codes = set()
        for seed in range(1, 30):
            self.write("study.toml", fewest.replace("seed = 5", f"seed = {seed}"))
            done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
            with h5py.File(self.folder / "out.h5") as file:
                self.assertEqual(file["allocation/certificate/most_rejects"][()], 0)
                rejects = int(file["allocation/certificate/rejects"][()])
                decision = file["allocation/certificate/decision"].asstr()[()]
                certified = file["allocation"].attrs["certified"]
            self.assertEqual(done.returncode, 6 if rejects else 0, done.stderr)
            self.assertEqual(certified, 0 if rejects else 1)
            caption = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"][0]["caption"]
            self.assertEqual(caption.startswith("certified: "), not rejects)
            codes.add(done.returncode)
            if rejects:
                self.assertIn("study.toml: the tolerances are not certified", done.stderr.decode())
                self.assertIn("take more samples", done.stderr.decode())
                self.assertNotIn("PASS", done.stdout.decode())
                self.assertIn(f"not certified: {'fewer than' if decision == 'not_kept' else 'it is not shown'}", caption)
                self.assertIn(f"({rejects} of {FEWEST} fresh machines rejected, 0 were allowed)", caption)
                again = self.poesy("run", "out_certificate.toml", "-o", "again.h5", "--quiet")
                self.assertIn("FAIL" if decision == "not_kept" else "UNDECIDED", again.stdout.decode())
            if codes == {0, 6}:
                return
        self.fail(f"only exit codes {codes}")

    def test_limits_that_other_errors_use_up(self):
        """Root mean squares cannot be made as small as some trials ask for: still the tolerances are not the lowest ones."""
        study = CHOICES.read_text(encoding="utf-8")
        cost = {}
        for samples in (2000, 20000):
            self.run_study(study.replace("samples = 500", f"samples = {samples}"))
            with h5py.File(self.folder / "out.h5") as file:
                cost[samples] = file["allocation"].attrs["cost"]
                self.assertEqual(list(file["allocation/chosen"].asstr())[4], "IT7")
        self.assertLess(abs(cost[2000] / cost[20000] - 1), 0.05)

    def test_other_commands(self):
        self.run_study(SMALL)
        said = self.succeeds("check", "study.toml")
        for word in ('kind = "allocation"', "[[analysis.parts]]", "# valid: about 5 x 3 poses x 2500 machines",
                     "for the effects of 25 errors"):
            self.assertIn(word, said)
        self.assertIn("matches", self.succeeds("verify", "out.h5"))
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        for words in ("What goes on the drawing", "Is it certified", "The study that repeats the certificate"):
            self.assertIn(words, page)
        self.succeeds("report", "out.h5", "out.h5", "-o", "both.html")
        for command, words in ((("replay", "all", 0, 3), "kind allocation keeps no addresses"),
                               (("tolerances", "--response", "linear_deformation", "--limit", "0.5 mm"), "a sensitivity study")):
            done = self.poesy(command[0], "out.h5", *command[1:])
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr.decode())
        self.run_study(SMALL)  # replaces its own files
        self.assertEqual(self.succeeds("template", "2upr-rpu", "allocation").count("each = true"), 2)

    def test_other_samples_are_another_study(self):
        self.write("study.toml", SMALL)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--keep-checkpoint")
        for samples in (2000, 2501, 5000):
            self.write("study.toml", SMALL.replace("2500", str(samples)))
            done = self.resume()
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"is of another study: it has 'samples = 2500' where this study has 'samples = {samples}'",
                          done.stderr.decode())
        self.write("study.toml", SMALL)
        expected = self.content_hash()
        self.assertEqual(self.resume_to_end(), expected)

    def test_files_of_the_user_beside_the_result_stay(self):
        for name in ("out_certificate.toml", "out_certificate_poses.csv", "out_certificate_mechanism.toml"):
            notes = self.write(name, "notes")
            done = self.run_study(SMALL, code=2)
            self.assertIn(name + ": exists and was not written with this result", done.stderr.decode())
            self.assertEqual(notes.read_text(), "notes")
            notes.unlink()

    def test_an_earlier_certificate_is_replaced_and_what_its_kill_left_removed(self):
        self.run_study(SMALL)
        certificate = self.folder / "out_certificate.toml"
        first = certificate.read_text()
        self.write("out_certificate.toml.tmp.0123456789ab", "half")
        certificate.write_text(first + "# later\n")
        self.run_study(SMALL)
        self.assertEqual(certificate.read_text(), first)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"study.toml", "out.h5", "out_certificate.toml"})

    def test_refusals(self):
        self.refused(SMALL.replace("sigmas = 3\n", ""), "has neither sigmas nor cpk")
        self.refused(SMALL.replace('limits.linear_deformation = "0.5 mm"\n', ""), "'limits' is missing")
        self.refused(SMALL.replace("samples = 2500", "samples = { max = 1000, relative_error = 0.1 }"),
                     "a certificate needs a number of machines that is fixed before")
        self.write("out_certificate.toml", SMALL)
        done = self.poesy("run", "out_certificate.toml", "-o", "out.h5", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn("would be replaced by the study that confirms the result", done.stderr.decode())
        (self.folder / "out_certificate.toml").unlink()
        self.refused(SMALL, "divides no study of kind allocation", "run it whole, or with mpirun", options=("--shard", "1/2"))


if __name__ == "__main__":
    main()
