"""Failed samples are listed and can be replayed. If there are too many, the exit code is 5 and the result is kept."""

import re

import h5py
import numpy

from poesy_program import ProgramTest, main

#: A study in which many samples do not converge: large errors, and few iterations of the published scheme.
STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 4
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "1 deg" }
[analysis]
kind = "sensitivity"
factors = ["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]
samples = 60
[solver]
method = "gauss-newton"
max_iterations = 12
"""

THREE_PRS = """\
format = "poesy-study"
version = 1
mechanism = { model = "MODEL", fidelity = "FIDELITY" }
poses = { count = 3 }
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "1 deg" }
[analysis]
factors = ["q_1", "theta_A_x_2"]
samples = 30
[solver]
max_iterations = 2
"""


class Replay(ProgramTest):
    def run_study(self, study, code=0):
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        self.succeeds("verify", "out.h5")
        return done

    def failures(self):
        with h5py.File(self.folder / "out.h5") as file:
            solver = file["solver"]
            names = list(solver["failed_status"].attrs["status_names"])
            return list(zip(solver["failed_factor"].asstr()[:], solver["failed_pose"][:], solver["failed_sample"][:],
                            [names[status] for status in solver["failed_status"][:]]))

    def replay(self, *address):
        """Status, iterations and responses as in the run; iterations shown; those of the reference."""
        done = self.poesy("replay", "out.h5", *address)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        text = done.stdout.decode()
        status, iterations = re.search(r"solved as in the run, method \S+: (\w+) after (\d+)", text).groups()
        reference = re.search(r"\nby the reference solver[^\n]*: (\w+) after (\d+) iterations\n", text)
        shown = len(re.findall(r"^ +\d+( +\S+)+$", text, re.M))
        own = text[:reference.start()].split("solved as in the run")[1]
        responses = [float(value) for value in re.findall(r"^  \w+ +(\S+)", own, re.M)]
        return status, int(iterations), responses, shown, (reference[1], int(reference[2])), text

    def check_cells(self, keeps_all):
        """The list against the counts, and each address against its replay."""
        with h5py.File(self.folder / "out.h5") as file:
            counts = numpy.atleast_2d(file["solver/not_converged"][:])
            self.assertEqual(file["solver"].attrs["failures"], counts.sum())
        failures = self.failures()
        self.assertEqual(len(failures), numpy.minimum(counts, 10).sum())
        self.assertGreater(len(failures), 3)
        for factor, pose, sample, status in failures[:: max(1, len(failures) // 12)]:
            found, iterations, _, shown, reference, text = self.replay(factor, pose, sample)
            self.assertEqual(found, status, text)
            self.assertEqual(shown, reference[1], text)
            if keeps_all:
                self.assertEqual((found, iterations), reference, text)
        return failures

    def test_failures_of_the_published_scheme(self):
        self.run_study(STUDY)
        failures = self.check_cells(keeps_all=True)
        shown = self.succeeds("show", "out.h5")
        self.assertIn("poesy replay out.h5 {} {} {}\n".format(*failures[0]), shown)
        self.succeeds("export", "out.h5", "-d", "tables")
        rows = (self.folder / "tables/failures.csv").read_text().splitlines()
        self.assertEqual(rows[1].split(",")[:3], [str(part) for part in failures[0][:3]])
        self.assertEqual(len(rows), 1 + len(failures))

    def test_newton_and_the_reference_are_told_apart(self):
        """What Gauss-Newton does not solve in 12 iterations, Newton mostly does: a replay shows both."""
        self.run_study(STUDY)
        failures = self.failures()[:8]
        self.run_study(STUDY.replace('method = "gauss-newton"\n', ""))
        solved = 0
        for factor, pose, sample, _ in failures:
            status, _, _, shown, reference, text = self.replay(factor, pose, sample)
            self.assertIn("method newton", text)
            self.assertIn("Gauss-Newton as published", text)
            self.assertEqual((reference, shown), (("iteration_cap", 12), 12))
            self.assertIn("status: the same" if status == reference[0] else "status: not the same", text)
            solved += status in ("converged", "stagnated")
        self.assertGreater(solved, 0)

    def test_a_sample_gives_the_bits_of_the_run(self):
        """Two samples at one pose: their mean is in the result, with every digit."""
        self.run_study(STUDY.replace("samples = 60", "samples = 2").replace("max_iterations = 12", "max_iterations = 200"))
        with h5py.File(self.folder / "out.h5") as file:
            mean, most = file["sensitivity/mean"][:], file["solver/iterations_max"][:]
        for p, factor in enumerate(("delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y")):
            both = [self.replay(factor, 2, sample) for sample in (0, 1)]
            self.assertTrue({one[0] for one in both} <= {"converged", "stagnated"})
            self.assertEqual(max(one[1] for one in both), most[p, 2])
            expected = (numpy.array(both[0][2]) + numpy.array(both[1][2])) / 2
            numpy.testing.assert_allclose(mean[:, p, 2], expected, rtol=1e-15, atol=0)

    def test_monte_carlo(self):
        study = STUDY.replace('"sensitivity"', '"monte-carlo"').replace("samples = 60", "samples = 1200")
        self.run_study(study)
        failures = self.check_cells(keeps_all=False)
        self.assertEqual({factor for factor, *_ in failures}, {"all"})
        self.assertIn("epsilon_3_0_y", self.replay(*failures[0][:3])[5])

    def test_three_prs(self):
        for model in ("3-prs", "xy-3-prs"):
            self.run_study(THREE_PRS.replace("MODEL", model).replace("FIDELITY", "exact"))
            self.check_cells(keeps_all=True)
            self.run_study(THREE_PRS.replace("MODEL", model).replace("FIDELITY", "first-order"))
            status, iterations, _, shown, reference, text = self.replay("q_1", 1, 7)
            self.assertEqual((status, iterations, shown), ("converged", 1, 0), text)
            self.assertEqual(reference, (status, iterations), text)

    def test_both_fidelities_list_the_first(self):
        self.run_study(THREE_PRS.replace("MODEL", "3-prs").replace("FIDELITY", "both"))
        self.check_cells(keeps_all=True)

    def test_poses_of_a_file_are_not_looked_for(self):
        self.write("poses.csv", "z,beta,gamma\n-0.25,0.1,0.2\n-0.2,0.4,-0.5\n")
        self.run_study(STUDY.replace("count = 4", 'select = "file"\nfile = "poses.csv"'))
        before = self.replay("epsilon_1_4_z", 1, 59)
        (self.folder / "poses.csv").unlink()
        self.assertEqual(self.replay("epsilon_1_4_z", 1, 59), before)

    def test_cases_and_evaluations(self):
        cases = STUDY[: STUDY.index("[analysis]")] + """\
[analysis]
kind = "evaluate"
cases = [{ name = "small", errors = { delta_1_1_y = "0.1 mm" } }, { name = "large", errors = { delta_1_1_y = "1 mm" } }]
"""
        self.run_study(cases)
        with h5py.File(self.folder / "out.h5") as file:
            expected = [file["evaluate"][name][1, 2] for name in
                        ("angular_deformation", "linear_deformation", "deformation_max", "iterations")]
        _, iterations, responses, *_ = self.replay("large", 2)
        self.assertEqual([*responses, iterations], expected)
        self.write("poses.csv", "z,beta,gamma\n-0.25,0.1,0.2\n-0.2,0.4,-0.5\n")
        self.write("errors.csv", "delta_1_1_y,epsilon_1_4_z\n0.001,0\n0.001,0.01\n")
        for pairing in ([], ["--paired"]):
            self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "out.h5", *pairing)
            with h5py.File(self.folder / "out.h5") as file:
                expected = file["evaluate/deformation_max"][1, -1]
            self.assertEqual(self.replay("all", 1, 0 if pairing else 1)[2][2], expected)

    def test_wrong_addresses_name_what_there_is(self):
        self.run_study(STUDY)
        for address, words in ((("delta_9_9_y", 0, 0), b"delta_1_1_y, epsilon_1_4_z, epsilon_3_0_y"),
                               (("all", 0, 0), b"delta_1_1_y"),
                               (("delta_1_1_y", 4, 0), b"from 0 to 3"),
                               (("delta_1_1_y", 0, 60), b"from 0 to 59"),
                               (("delta_1_1_y", 0), b"from 0 to 59"),
                               (("delta_1_1_y", "x", 0), b"POSE is 'x'"),
                               (("delta_1_1_y", "1.5", 0), b"POSE is '1.5'")):
            done = self.poesy("replay", "out.h5", *address)
            self.assertEqual((done.returncode, done.stdout), (2, b""), address)
            self.assertIn(words, done.stderr, address)
        self.assertEqual(self.poesy("replay", "absent.h5", "all", 0, 0).returncode, 3)

    def test_more_failures_than_the_limit(self):
        self.run_study(STUDY)
        with h5py.File(self.folder / "out.h5") as file:
            failed = int(file["solver/not_converged"][:].sum())
        total = 3 * 4 * 60
        just = repr(failed / total)
        self.run_study(STUDY + f"max_not_converged = {just}\n")
        below = repr((failed - 0.5) / total)
        done = self.run_study(STUDY + f"max_not_converged = {below}\n", code=5)
        for words in ("study.toml", f"{failed} of {total}", "solver.max_not_converged", below, "poesy show out.h5"):
            self.assertIn(words, done.stderr.decode())
        self.succeeds("show", "out.h5")
        done = self.run_study(STUDY + 'not_converged = "fail"\n', code=5)
        self.assertIn(b'not_converged = "fail"', done.stderr)

    def test_evaluate_has_the_limit_too(self):
        self.write("study.toml", STUDY.replace("max_iterations = 12", "max_iterations = 1\nmax_not_converged = 0.5"))
        self.write("poses.csv", "z,beta,gamma\n-0.25,0.1,0.2\n")
        self.write("errors.csv", "delta_1_1_y\n0.001\n0\n")
        arguments = ("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "out.h5")
        self.succeeds(*arguments)
        self.write("errors.csv", "delta_1_1_y\n0.001\n0.002\n0\n")
        done = self.poesy(*arguments)
        self.assertEqual(done.returncode, 5)
        self.assertIn(b"out.h5", done.stderr)
        self.succeeds("verify", "out.h5")

    def test_another_version_is_warned_of(self):
        self.run_study(STUDY)
        with h5py.File(self.folder / "out.h5", "r+") as file:
            file.attrs["git_commit"] = "another"
        done = self.poesy("replay", "out.h5", "delta_1_1_y", 0, 0)
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"may differ", done.stderr)


if __name__ == "__main__":
    main()
