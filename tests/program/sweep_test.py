"""`poesy sweep`: designs that differ in a key. Each has the bits of its own run; how certain their differences are."""

import csv
import io
import json
import math
import os
import signal
import subprocess
import time

import h5py

from poesy_program import GALLERY, PROGRAM, ProgramTest, main

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[solver]
metric = "platform"
[poses]
count = 6
[errors]
linear = { distribution = "uniform", half_width = "0.04 mm" }
angular = { distribution = "normal", sigma = "0.01 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "deforming-all"
samples = 2000
limits = { gap = "0.04 mm" }
"""
LENGTHS = ("60 mm", "70 mm", "80 mm")
SET = "geometry.l_A=60:80:10mm"
Z = 3.9  # two-sided alpha 1e-4


def least_holding(count, share):
    """So many of `count` intervals at least hold the truth, except with a probability of 1e-4."""
    below = 0.0
    for k in range(count + 1):
        below += math.comb(count, k) * share**k * (1.0 - share) ** (count - k)
        if below > 1e-4:
            return k
    return count


class Sweep(ProgramTest):
    def hash_of(self, study, *options):
        self.write("single.toml", study)
        done = self.poesy("run", "single.toml", "-o", "single.h5", "--quiet", *options)
        self.assertIn(done.returncode, (0, 6), done.stderr)
        with h5py.File(self.folder / "single.h5") as file:
            found = file.attrs["content_sha256"], float(file["yield/value"][()]) if "yield" in file else None
        return found

    def swept(self, *options, study=STUDY, codes=(0,), keys=(SET,)):
        self.write("study.toml", study)
        words = [word for key in keys for word in ("--set", key)]
        done = self.poesy("sweep", "study.toml", *words, "-o", "sweep.h5", "--quiet", *options)
        self.assertIn(done.returncode, codes, done.stderr)
        return done.stdout.decode()

    def content(self):
        with h5py.File(self.folder / "sweep.h5") as file:
            self.assertEqual(file.attrs["kind"], "sweep")
            return file.attrs["content_sha256"], [text.decode() for text in file["sweep/content_sha256"][()]]

    def test_each_design_is_its_single_run(self):
        shown = self.swept()
        self.assertIn("sweep.h5: 3 designs, 36000 solves in ", shown)
        whole, hashes = self.content()
        for length, expected in zip(LENGTHS, hashes):
            study = STUDY.replace('model = "2upr-rpu"', f'model = "2upr-rpu"\ngeometry = {{ l_A = "{length}" }}')
            self.assertEqual(self.hash_of(study)[0], expected, length)
        self.assertEqual(len(set(hashes)), 3)
        for threads in (1, 3):
            self.swept("--threads", threads)
            self.assertEqual(self.content(), (whole, hashes))
        self.succeeds("verify", "sweep.h5")

    def test_every_kind_that_has_a_figure_of_merit(self):
        other = "errors.angular.sigma=0.01,0.02 deg"
        sensitivity = STUDY.split("[analysis]")[0] + '[analysis]\nkind = "sensitivity"\nsamples = 100\nfactors = "deforming-all"\n'
        per_pose = STUDY.replace("per machine", "per pose").replace('limits = { gap = "0.04 mm" }\n', "").replace("2000", "1100")
        sobol = sensitivity.replace('"sensitivity"', '"sobol"').replace("samples = 100", "samples = 64")
        for study in (sensitivity, per_pose, sobol):
            self.swept(study=study, keys=(other,))
            hashes = self.content()[1]
            expected = [self.hash_of(study.replace('"0.01 deg"', f'"{size} deg"'))[0] for size in (0.01, 0.02)]
            self.assertEqual(hashes, expected)

    def test_given_errors(self):
        """Whose figure of merit is exact, so that every change is certain."""
        head = 'format = "poesy-study"\nversion = 1\n[mechanism]\nmodel = "3-prs"\n[poses]\ncount = 3\n[analysis]\n'
        cases = head + 'kind = "evaluate"\ncases = [{ name = "one", errors = { linear = "0.1 mm" } }]\n'
        coupling = head + 'kind = "coupling"\nlinear = ["0.1 mm", "0.2 mm"]\n'
        for study in (cases, coupling):
            self.swept(study=study, keys=("geometry.l=565,570,575 mm",))
            rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
            for row in rows[1:]:
                self.assertEqual((row["low"], row["high"]), (row["value"], row["value"]))
                self.assertEqual(row["change"], row["value"] - rows[0]["value"])
                self.assertEqual(row["verdict"], "worse" if row["change"] > 0 else "better")
            self.assertNotIn(b"each interval alone", self.poesy("show", "sweep.h5").stdout)
            self.succeeds("report", "sweep.h5", "-o", "sweep.html")
            page = (self.folder / "sweep.html").read_text()
            for words in ("tends to be too good", "take more samples", "told apart from it"):
                self.assertNotIn(words, page)
            self.swept(study=study, keys=("geometry.l=570,570.0,575 mm",))
            rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
            self.assertEqual(rows[1]["verdict"], "equal")

    def test_changes_count_the_same_machines(self):
        self.swept()
        with h5py.File(self.folder / "sweep.h5") as file:
            found = {name: file[f"sweep/{name}"][()] for name in ("merit", "change", "change_low", "change_high", "gained", "lost")}
            self.assertEqual([name.decode() for name in file["quantity"][()]], ["yield", "root mean square of gap"])
            self.assertEqual(list(file["sweep/machines"][()]), [2000] * 3)
            self.assertEqual(list(file["sweep/is_paired"][()]), [1, 0])
        yields = found["merit"][0]
        for d, length in enumerate(LENGTHS):
            study = STUDY.replace('model = "2upr-rpu"', f'model = "2upr-rpu"\ngeometry = {{ l_A = "{length}" }}')
            self.assertAlmostEqual(100.0 * self.hash_of(study)[1], yields[d], places=10)
        for d in (1, 2):
            gained, lost = int(found["gained"][d]), int(found["lost"][d])
            self.assertAlmostEqual(100.0 * (gained - lost) / 2000, yields[d] - yields[0], places=9)
            self.assertAlmostEqual(found["change"][0][d], yields[d] - yields[0], places=9)
            # Fewer machines change sides than with independent draws.
            independent = 2000 * (yields[d] * (100 - yields[0]) + yields[0] * (100 - yields[d])) / 1e4
            self.assertLess(gained + lost, 0.8 * independent)
            low, high = found["change_low"][0][d], found["change_high"][0][d]
            self.assertLess(low, found["change"][0][d])
            self.assertLess(found["change"][0][d], high)
            half = 1.96 * 100 * math.sqrt(gained + lost - (gained - lost) ** 2 / 2000) / 2000  # Wald's interval
            self.assertAlmostEqual(high - low, 2 * half, delta=0.03 * half + 0.1)

    def changes(self, name):
        """The changes of the yield with their intervals, by the design's length: [length] (value, low, high)."""
        with h5py.File(self.folder / "sweep.h5") as file:
            lengths = [text.decode() for text in file["sweep/value"][:, 0]]
            columns = [file[f"sweep/{name}{end}"][0] for end in ("", "_low", "_high")]
        return dict(zip(lengths, zip(*columns)))

    def test_changes_from_the_best_design(self):
        """They are what the changes from the first design are, if the best design is the first."""
        lengths = ["60 mm", "60.2 mm", "80 mm"]
        orders = [lengths, [lengths[1], lengths[2], lengths[0]]]
        found = {}
        for order in orders:
            self.swept(keys=("geometry.l_A=" + ",".join(order),))
            found[order[0]] = self.changes("change"), self.changes("from_best")
            with h5py.File(self.folder / "sweep.h5") as file:
                best = order[int(file["sweep/merit"][0].argmax())]
        self.swept(keys=("geometry.l_A=" + ",".join([best, *(length for length in lengths if length != best)]),))
        expected = self.changes("change")
        for _, from_best in found.values():
            for length in lengths:
                if length != best:
                    self.assertEqual(from_best[length], expected[length])
            self.assertTrue(math.isnan(from_best[best][0]))
        self.assertNotEqual(*(changes for changes, _ in found.values()))

    def test_what_is_not_told_apart_from_the_best(self):
        self.swept(keys=("geometry.l_A=80,60,60.02,70 mm",))
        table = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]
        verdicts = {row["mechanism_geometry_l_A"]: row["verdict_on_best"] for row in table["rows"]}
        near = [f"{length:g}" for length, verdict in verdicts.items() if verdict == "not told apart"]
        self.assertEqual(sorted(verdicts.values()), ["not told apart", "the best", "worse", "worse"])
        self.assertIn("each interval alone has the level 95 %; the best design was chosen", table["notes"][-1])
        self.succeeds("report", "sweep.h5", "-o", "sweep.html")
        page = (self.folder / "sweep.html").read_text()
        self.assertRegex(page, r"The yield is largest at l_A = [0-9.]+ mm: [0-9.]+ %; "
                               rf"not told apart from it: {near[0]} mm\. At l_A = 80 mm, the first design, it is ")
        self.assertIn("To tell the designs apart that are near the best, take more samples.", page)
        self.assertIn("; all others are told apart from it.", self.page_of("geometry.l_A=60,70,80 mm"))

    def page_of(self, key):
        self.swept(keys=(key,))
        self.succeeds("report", "sweep.h5", "-o", "sweep.html")
        return (self.folder / "sweep.html").read_text()

    def test_paired_intervals_hold_the_truth(self):
        """Statistical: alpha 1e-4 for intervals that hold with 0.93 at least."""
        few = STUDY.replace("samples = 2000", "samples = 300")
        keys = ("geometry.l_A=60,66 mm",)
        self.swept(study=few.replace("samples = 300", "samples = 60000"), keys=keys)
        with h5py.File(self.folder / "sweep.h5") as file:
            truth = file["sweep/change"][0][1]
            error = (file["sweep/change_high"][0][1] - file["sweep/change_low"][0][1]) / 3.92
        seeds, held, widths = 40, 0, 0.0
        for seed in range(1, seeds + 1):
            self.swept("--seed", seed, study=few, keys=keys)
            with h5py.File(self.folder / "sweep.h5") as file:
                low, high = file["sweep/change_low"][0][1], file["sweep/change_high"][0][1]
            held += low <= truth <= high
            widths += (high - low) / seeds
        self.assertLess(error, 0.1 * widths)  # so the error of `truth` is negligible
        self.assertGreaterEqual(held, least_holding(seeds, 0.93))

    def test_a_grid_of_two_keys(self):
        self.swept(keys=("geometry.l_A=60,70 mm", "errors.angular.sigma=0.005,0.01,0.02 deg"))
        rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
        self.assertEqual([(row["mechanism_geometry_l_A"], row["errors_angular_sigma"]) for row in rows],
                         [(60, 0.005), (60, 0.01), (60, 0.02), (70, 0.005), (70, 0.01), (70, 0.02)])
        self.assertGreater(rows[0]["value"], rows[2]["value"])
        self.assertEqual(rows[2]["verdict"], "worse")
        self.succeeds("report", "sweep.h5", "-o", "sweep.html")
        page = (self.folder / "sweep.html").read_text()
        self.assertIn("sigma = 0.02 deg", page)
        self.assertIn("The best design is at an end of l_A and of sigma: look beyond it.", page)

    def test_no_best_design_of_other_limits(self):
        self.swept(keys=("analysis.limits.gap=0.04,0.05 mm", "errors.angular.sigma=0.01,0.005 deg"))
        rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
        self.assertEqual([row["verdict"] for row in rows[1:]], ["better", "other limits", "other limits"])
        self.succeeds("report", "sweep.h5", "-o", "sweep.html")
        page = (self.folder / "sweep.html").read_text()
        self.assertIn("No design is called best, because the limits differ (gap): the yield is ", page)
        self.assertIn("Compare designs with the same limits.", page)
        self.assertNotIn("The yield is largest", page)

    def test_no_best_design_of_other_draws_or_poses(self):
        for key, topic, table in (("errors.linear.draws=per machine,per pose", "draws", 0),
                                  ("poses.select=interior,boundary", "poses", 1)):
            self.swept(keys=(key,))
            rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][table]["rows"]
            self.assertEqual(rows[1]["verdict"], f"other {topic}")

    def test_no_best_design_that_reaches_less_of_the_workspace(self):
        """Rods of 260 mm reach all of the workspace, of 170 mm not its corners: these designs have other poses."""
        mechanism = (GALLERY / "delta-printer/delta-printer.toml").read_text(encoding="utf-8")
        self.write("delta-printer.toml", mechanism)
        study = ('format = "poesy-study"\nversion = 1\nmechanism = { file = "delta-printer.toml" }\nposes = { count = 20 }\n'
                 'errors = { linear = { distribution = "normal", sigma = "2 um" } }\n'
                 'analysis = { kind = "monte-carlo", draws = "per machine", samples = 300, limits = { position = "0.1 mm" } }\n')
        self.write("study.toml", study)
        said = self.succeeds("sweep", "study.toml", "--set", "geometry.L=260,170mm", "-o", "sweep.h5", "--quiet")
        self.assertIn("no design is called better", " ".join(said.split()))
        (row,) = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"][1:]
        self.assertEqual(row["verdict"], "other poses")
        with h5py.File(self.folder / "sweep.h5") as file:
            left_out = list(file["sweep/left_out"])
            self.assertEqual(list(file["sweep/has_first_poses"]), [1, 0])
        results = []
        for length in (260, 170):
            name = f"{length}.toml"
            self.write(name, study.replace('"delta-printer.toml"', f'"delta-printer.toml", geometry = {{ L = "{length} mm" }}'))
            self.succeeds("run", name, "-o", f"{length}.h5", "--quiet")
            with h5py.File(self.folder / f"{length}.h5") as file:
                results.append(sum(file["poses/rejected/count"][()]) if "poses/rejected/count" in file else 0)
        self.assertEqual(left_out[0], 0.0)
        self.assertAlmostEqual(left_out[1], results[1] / (20 + results[1]), places=12)
        self.assertIn("other poses", self.succeeds("show", "260.h5", "170.h5"))
        self.assertIn("left out of the workspace: 0 % in A", " ".join(self.succeeds("show", "260.h5", "170.h5").split()))

    def test_show_export_and_report(self):
        self.swept()
        text = " ".join(self.succeeds("show", "sweep.h5").split())
        for words in ("The yield by l_A, and its change from the first and from the best design", "those of a change are paired",
                      "The root mean square of gap by l_A"):
            self.assertIn(words, text)
        self.succeeds("export", "sweep.h5", "-d", "tables")
        rows = list(csv.DictReader(io.StringIO((self.folder / "tables/sweep.csv").read_text())))
        self.assertEqual([row["design"] for row in rows], [f"l_A = {length}" for length in LENGTHS])
        self.assertEqual([float(row["mechanism.geometry.l_A [mm]"]) for row in rows], [60, 70, 80])
        with h5py.File(self.folder / "sweep.h5") as file:
            self.assertEqual([float(row["yield [%]"]) for row in rows], list(file["sweep/merit"][0]))
        self.assertEqual([row["content_sha256"] for row in rows], self.content()[1])
        self.succeeds("report", "sweep.h5", "-o", "sweep.html")
        page = (self.folder / "sweep.html").read_text()
        self.assertIn("The yield is ", page)
        self.assertIn("change from the first design", page)

    def test_exit_codes_of_limits(self):
        asked = STUDY + "yield = 0.99\n"
        done = self.swept(study=asked, codes=(6,))
        self.assertIn("FAIL", done)
        self.assertNotIn("not kept", done)
        self.assertIn("Written: sweep.h5, with what the tables below show. The whole results of the designs are not written.", done)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"study.toml", "sweep.h5"})
        self.swept(study=asked, keys=("analysis.limits.gap=0.04,1 mm",))
        rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
        self.assertEqual([row["limits"] for row in rows], ["FAIL", "PASS"])
        with h5py.File(self.folder / "sweep.h5") as file:
            self.assertEqual([text.decode() for text in file["sweep/verdict"][()]], ["not kept", "kept"])

    def interrupted(self, command, number):
        """Stops a run as soon as its first checkpoint is there; false if it was done before."""
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            while not (self.folder / "sweep.h5.part").exists() and run.poll() is None:
                time.sleep(0.002)
            run.send_signal(number)
            run.wait(timeout=120)
        return (self.folder / "sweep.h5.part").exists()

    def test_killed_and_resumed(self):
        study = STUDY.replace("2000", "30000")
        self.swept(study=study)
        expected = self.content()
        command = [PROGRAM, "sweep", "study.toml", "--set", SET, "-o", "sweep.h5", "--quiet", "--checkpoint-every", "0.02 s"]
        for number in (signal.SIGKILL, signal.SIGTERM):
            (self.folder / "sweep.h5").unlink()
            self.assertTrue(self.interrupted(command, number))
            for _ in range(3):
                if not self.interrupted([*command, "--resume"], number):
                    break
            done = self.poesy(*command[1:], "--resume", "--threads", 1)
            # 2: nothing is left to resume, because the sweep ended before the signal.
            self.assertIn(done.returncode, (0, 2), done.stderr)
            self.assertEqual(self.content(), expected)
            self.assertFalse((self.folder / "sweep.h5.part").exists())

    def test_a_checkpoint_of_other_designs(self):
        study = STUDY.replace("2000", "30000")
        self.write("study.toml", study)
        command = [PROGRAM, "sweep", "study.toml", "--set", SET, "-o", "sweep.h5", "--quiet", "--checkpoint-every", "0.02 s"]
        self.assertTrue(self.interrupted(command, signal.SIGKILL))
        done = self.poesy("sweep", "study.toml", "--set", "geometry.l_A=60:90:10mm", "-o", "sweep.h5", "--resume")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"another study", done.stderr)

    def test_a_mechanism_of_a_file(self):
        self.write("tricept.toml", (GALLERY / "tricept/tricept.toml").read_text())
        study = (GALLERY / "tricept/study.toml").read_text().replace("samples = 1000", "samples = 20").replace("count = 20", "count = 2")
        self.swept("--response", "tip_position", study=study, keys=("geometry.a=200:300:50mm",))
        rows = json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["rows"]
        self.assertEqual([row["mechanism_geometry_a"] for row in rows], [200, 250, 300])
        self.assertEqual(json.loads(self.succeeds("show", "sweep.h5", "--json"))["tables"][0]["name"],
                         "predicted_root_mean_square_of_tip_position")

    def test_refusals(self):
        self.write("study.toml", STUDY)
        for words, said in [
            ((), "poesy sweep needs --set KEY=VALUES"),
            (("--set", "l_A"), "--set l_A names no key and its values; write KEY=FROM:TO:STEP or KEY=A,B,C"),
            (("--set", "geometry.l_A=60"), "has one value only"),
            (("--set", "geometry.l_A=60:80:0mm"), "makes no step"),
            (("--set", "geometry.l_A=60,70"), "has no unit; write it once, after the last number: geometry.l_A=60,70mm, or geometry.l_A=60,70m"),
            (("--set", "geometry.l_A=.06,.07"), "after the last number: geometry.l_A=.06,.07m, or geometry.l_A=.06,.07mm"),
            (("--set", "geometry.l_B_=60,70 mm"), "l_B_"),
            (("--set", "geometry.l_A=0,70 mm"), "with mechanism.geometry.l_A = 0 mm: "),
            (("--set", "analysis.kind=monte-carlo,sensitivity"), "with analysis.kind = sensitivity"),
            (("--set", "nothing.at.all=1,2"), "nothing"),
            (("--set", SET, "--set", SET), "names mechanism.geometry.l_A twice"),
            (("--set", SET, "--response", "gapp"), "did you mean 'gap'?"),
        ]:
            with self.subTest(words):
                done = self.poesy("sweep", "study.toml", *words, "-o", "sweep.h5", "--quiet")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(said, done.stderr.decode())
                self.assertEqual(sorted(os.listdir(self.folder)), ["study.toml"])
        self.write("study.toml", STUDY.split("[analysis]")[0] + '[analysis]\nkind = "identification"\n')
        done = self.poesy("sweep", "study.toml", "--set", SET)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"studies of kind identification have no figure of merit", done.stderr)
        self.assertIn(b"sweep a study of kind ", done.stderr)

    def test_files_that_were_changed(self):
        self.swept()
        whole = (self.folder / "sweep.h5").read_bytes()
        with h5py.File(self.folder / "sweep.h5", "r+") as file:
            file["sweep/value"][1, 0] = "60 mm"  # so that the designs do not form a grid
        for command in (("show",), ("export", "-d", "tables"), ("report", "-o", "changed.html")):
            done = self.poesy(*command, "sweep.h5")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(b"was changed since it was written", done.stderr)
        for dataset in ("sweep/value", "sweep/merit", "key", "solver"):
            self.write("sweep.h5", whole)
            with h5py.File(self.folder / "sweep.h5", "r+") as file:
                del file[dataset]
            done = self.poesy("show", "sweep.h5")
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn(b"is damaged", done.stderr)

    def test_replay_and_tolerances_refuse_a_sweep(self):
        self.swept()
        for command in (("replay", "sweep.h5", "all", 0, 0), ("tolerances", "sweep.h5", "--response", "gap", "--limit", "1 mm")):
            done = self.poesy(*command)
            self.assertEqual(done.returncode, 2, done.stderr)


if __name__ == "__main__":
    main()
