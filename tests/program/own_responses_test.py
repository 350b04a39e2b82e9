"""Responses that a study defines: every kind of study has them, with values that follow from other responses."""

import json

import h5py
import numpy as np

from poesy_program import ProgramTest, main

HEAD = """\
format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs", fidelity = "{fidelity}" }}
poses = {{ count = 4 }}
[[response]]
name = "tilt"
norm = ["theta_x", "theta_y"]
description = "of the platform against the base"
[[response]]
name = "probe"
sum = {{ z = 1, theta_x = "-20 mm" }}
[analysis]
"""


class OwnResponses(ProgramTest):
    def run_study(self, name, analysis, fidelity="exact", arguments=()):
        self.write(f"{name}.toml", HEAD.format(fidelity=fidelity) + analysis)
        self.succeeds("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet", *arguments)
        return h5py.File(self.folder / f"{name}.h5")

    def shown(self, *arguments):
        return json.loads(self.succeeds("show", *arguments, "--json"))

    @staticmethod
    def rows(file, dataset):
        """Rows of a dataset [R x ...], by response."""
        names = [name.decode() for name in file["response"][:]]
        return dict(zip(names, file[dataset][:]))

    def test_draws(self):
        """Mean squares of a norm are the sum of those of its components, of the same draws."""
        analysis = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 400\nlimits = { tilt = "0.2 mrad", probe = "0.1 mm" }\n'
        with self.run_study("mc", analysis) as file:
            rms = self.rows(file, "monte_carlo/rms")
            within = self.rows(file, "yield/by_response")
            self.assertLess(file["yield/value"][()], 1.0)
            self.assertLessEqual(file["yield/value"][()], min(within["tilt"], within["probe"]))
        self.assertIn("of the platform against the base", self.succeeds("check", "mc.toml"))
        np.testing.assert_allclose(rms["tilt"] ** 2, rms["theta_x"] ** 2 + rms["theta_y"] ** 2, rtol=1e-12)

    def test_evaluated(self):
        self.write("s.toml", HEAD.format(fidelity="exact") + 'kind = "evaluate"\n')
        self.write("p.csv", "alpha,beta,z\n0,0,0.6\n0.1,-0.05,0.65\n")
        self.write("e.csv", "a_x_1,b_y_2,q_3\n1e-4,0,0\n1e-4,-2e-4,3e-4\n")
        self.succeeds("evaluate", "s.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as file:
            of = {name: file["evaluate"][name][:] for name in ("tilt", "probe", "theta_x", "theta_y", "z")}
        np.testing.assert_allclose(of["tilt"], np.hypot(of["theta_x"], of["theta_y"]), rtol=1e-15)
        np.testing.assert_allclose(of["probe"], of["z"] - 0.02 * of["theta_x"], rtol=0.0, atol=1e-19)
        self.assertGreater(np.abs(of["tilt"]).min(), 1e-6)

    def test_one_error_at_a_time(self):
        """Mean squares again, of each error alone."""
        with self.run_study("s", 'kind = "sensitivity"\nsamples = 200\n', "first-order") as file:
            means, deviations = (self.rows(file, f"sensitivity/{of}") for of in ("mean", "std"))
        square = {name: means[name] ** 2 + deviations[name] ** 2 * 199 / 200 for name in ("tilt", "theta_x", "theta_y")}
        np.testing.assert_allclose(square["tilt"], square["theta_x"] + square["theta_y"], rtol=1e-9, atol=1e-20)
        self.assertIn("tilt", self.succeeds("show", "s.h5", "--response", "tilt"))

    def test_every_kind(self):
        kinds = {"sobol": 'kind = "sobol"\nsamples = 64\n',
                 "coupling": 'kind = "coupling"\nlinear = ["0.1 mm"]\n',
                 "allocation": 'kind = "allocation"\nsamples = 1000\nlimits = { tilt = "0.2 deg" }\nyield = 0.9\nsigmas = 3\n'
                               '[[analysis.parts]]\nfactors = "rod-length"\neach = true\n'
                               'cost = { law = "reciprocal", b = 1, unit = "mm" }\n'
                               '[errors]\nlinear = { distribution = "normal", sigma = "10 um" }\n'
                               'angular = { distribution = "normal", sigma = "0.01 deg" }\n'}
        for kind, analysis in kinds.items():
            with self.subTest(kind=kind):
                self.run_study(kind, analysis, "first-order" if kind == "allocation" else "exact").close()
                self.assertIn("tilt", self.succeeds("show", f"{kind}.h5"))
                self.succeeds("export", f"{kind}.h5", "-d", f"{kind}-csv")
                self.succeeds("report", f"{kind}.h5", "-o", f"{kind}.html")

    def test_replayed_from_the_result(self):
        analysis = 'kind = "monte-carlo"\ndraws = "per pose"\nsamples = 300\n'
        for threads in (1, 2):
            self.run_study(f"t{threads}", analysis, arguments=("--threads", threads)).close()
        hashes = {self.shown(f"t{threads}.h5")["content_sha256"] for threads in (1, 2)}
        self.assertEqual(len(hashes), 1)
        with h5py.File(self.folder / "t1.h5") as file:
            self.write("again.toml", file["study/text"][()].decode())
        self.succeeds("run", "again.toml", "-o", "again.h5", "--quiet")
        self.assertIn(self.shown("again.h5")["content_sha256"], hashes)


if __name__ == "__main__":
    main()
