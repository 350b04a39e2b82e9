"""The same study gives the same content for any number of threads and in every repetition."""

import itertools

import h5py

from poesy_program import STUDY, ProgramTest, main
from resumption import DESIGNED, DESIGNED_HEAD, FORCES, GIVEN, ZONES


class Determinism(ProgramTest):
    def content_hash(self, study, *options):
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", *options)
        self.succeeds("verify", "out.h5")
        with h5py.File(self.folder / "out.h5") as result:
            return result.attrs["content_sha256"]

    def test_threads_and_repetitions(self):
        hashes = {self.content_hash(STUDY, "--threads", n) for n in (1, 2, 3, 7, 1)}
        self.assertEqual(len(hashes), 1, hashes)

    def test_seeds_differ(self):
        self.assertNotEqual(self.content_hash(STUDY), self.content_hash(STUDY, "--seed", "6"))
        self.assertEqual(self.content_hash(STUDY), self.content_hash(STUDY, "--seed", "5"))

    def test_monte_carlo(self):
        study = STUDY.replace('"sensitivity"', '"monte-carlo"')
        self.assertEqual(len({self.content_hash(study, "--threads", n) for n in (1, 2, 3)}), 1)

    def test_every_fidelity(self):
        for model, kind in itertools.product(("3-prs", "xy-3-prs"), ("sensitivity", "monte-carlo")):
            by_fidelity = []
            for fidelity in ("exact", "first-order"):
                study = f"""\
format = "poesy-study"
version = 1
mechanism = {{ model = "{model}", fidelity = "{fidelity}" }}
poses = {{ count = 5 }}
errors = {{ linear = {{ distribution = "normal", sigma = "0.1 mm" }} }}
analysis = {{ kind = "{kind}", samples = 1200 }}
"""
                hashes = {self.content_hash(study, "--threads", n) for n in (1, 2, 3)}
                self.assertEqual(len(hashes), 1, (model, kind, fidelity))
                by_fidelity.append(hashes.pop())
            self.assertNotEqual(*by_fidelity)

    def test_both_fidelities(self):
        study = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs", fidelity = "both" }
poses = { count = 5 }
analysis = { factors = "platform-hinges", samples = 1200 }
"""
        self.assertEqual(len({self.content_hash(study, "--threads", n) for n in (1, 2, 3)}), 1)

    def test_coupling(self):
        by_fidelity = []
        for fidelity in ("exact", "first-order"):
            study = f"""\
format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs", fidelity = "{fidelity}" }}
poses = {{ select = "grid", count = {{ alpha = 5, beta = 5, z = 3 }} }}
analysis = {{ kind = "coupling", linear = ["0.1 mm", "0.3 mm", "0.5 mm"], limbs = "independent" }}
"""
            hashes = {self.content_hash(study, "--threads", n) for n in (1, 2, 3)}
            self.assertEqual(len(hashes), 1, fidelity)
            by_fidelity.append(hashes.pop())
        self.assertNotEqual(*by_fidelity)

    def test_designers_words(self):
        for study in (DESIGNED, GIVEN, ZONES, FORCES):
            self.assertEqual(len({self.content_hash(study, "--threads", n) for n in (1, 2, 5)}), 1, study)

    def test_designers_words_in_other_kinds(self):
        zeroed = '[[response]]\nname = "rise"\nsum = { nozzle_z = 1 }\nrelative_to = { x = 0, y = 0, z = "200 mm" }\n'
        errors = 'factors = ["rail_*", "rod_?", "batch", "sag_?"]\n'
        for analysis in ('kind = "sensitivity"\nsamples = 1200\n', 'kind = "sobol"\nsamples = 256\n',
                         'kind = "monte-carlo"\ndraws = "per pose"\nsamples = 1200\nlimits = { rise = "0.2 mm" }\n'):
            study = DESIGNED_HEAD + zeroed + "[analysis]\n" + analysis + errors
            self.assertEqual(len({self.content_hash(study, "--threads", n) for n in (1, 2, 5)}), 1, analysis)

    def test_identification_and_cases(self):
        head, rest = STUDY.split("[analysis]")
        head = head.replace("count = 6", 'select = "boundary"\ncount = 30')
        solver = rest[rest.index("[solver]"):]
        for analysis in ('kind = "identification"\n',
                         'kind = "evaluate"\ncases = [{ errors = { linear = "1 mm", angular = "1 deg" } }, '
                         '{ errors = { epsilon_1_4_z = "1 deg" } }]\n'):
            study = head + "[analysis]\n" + analysis + solver
            self.assertEqual(len({self.content_hash(study, "--threads", n) for n in (1, 2, 3, 7)}), 1)

    def test_evaluate(self):
        self.write("study.toml", STUDY)
        self.write("poses.csv", "gamma,z,beta\n" + "".join(f"{0.1 * k},-0.25,0.1\n" for k in range(4)))
        self.write("errors.csv", "epsilon_1_4_z\n" + "".join(f"{1e-4 * k}\n" for k in range(700)))
        hashes = set()
        for threads in (1, 2, 7):
            self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "out.h5",
                          "--threads", threads, "--quiet")
            with h5py.File(self.folder / "out.h5") as result:
                hashes.add(result.attrs["content_sha256"])
        self.assertEqual(len(hashes), 1)


if __name__ == "__main__":
    main()
