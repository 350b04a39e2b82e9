"""A printer that is zeroed in the middle: its height over the bed minus that in the middle, of the same machine.
Expected values are computed from the rods. Named points and responses of a mechanism's file, and steps from pose to
pose."""

import json
import os
import re
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main
from six_rods import PLACES, rod_effects

PRINTER = (Path(os.environ["POESY_DATA"]) / "mechanisms/delta6.toml").read_text()
BED = PLACES[:, :2]
RODS = [f"rod_{k}" for k in range(1, 7)]
ZERO = 'relative_to = { x = 0, y = 0, z = 0 }\n'
HEIGHT = '[[response]]\nname = "height"\nsum = { z = 1 }\n'
NOZZLE = np.array([0.0, 0.0, -0.07])
STUDY = """\
format = "poesy-study"
version = 1
mechanism = {{ file = "delta6.toml"{fidelity} }}
poses = {{ select = "file", file = "bed.csv" }}
errors.linear = {{ distribution = "{distribution}", {size} }}
{responses}
[analysis]
kind = "{kind}"
factors = ["rod_*"]
{analysis}
"""


class RelativeResponses(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("bed.csv", "x [m],y [m],z [m]\n" + "".join(f"{x:.17g},{y:.17g},0\n" for x, y in BED))
        self.write("delta6.toml", PRINTER)

    def run_study(self, analysis, responses=HEIGHT + ZERO, kind="monte-carlo", size='sigma = "0.05 mm"', code=0,
                  distribution="normal", fidelity="", name="s"):
        self.write(f"{name}.toml", STUDY.format(analysis=analysis, responses=responses, kind=kind, size=size, fidelity=fidelity,
                                                distribution=distribution))
        done = self.poesy("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet")
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return h5py.File(self.folder / f"{name}.h5")

    def test_a_reference_outside_the_workspace_is_asked_about(self):
        inside = STUDY.format(fidelity="", distribution="normal", size='sigma = "0.1 mm"', kind="monte-carlo", analysis="samples = 10",
                              responses=HEIGHT + ZERO)
        for z, asked in (("0", False), ('"-900 mm"', True)):
            self.write("study.toml", inside.replace("z = 0 }", f"z = {z} }}"))
            done = self.poesy("check", "study.toml")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual("height is relative to a pose with z = -900 mm, outside the mechanism's workspace" in done.stderr.decode(), asked)

    def test_yield_of_a_zeroed_printer(self):
        """30.9 % of the printers keep 0.04 mm as they are, 58.0 % if they are zeroed in the middle. alpha 1e-4."""
        machines = 60000
        rods = np.random.default_rng(0).normal(0.0, 5e-5, (1000000, 6))
        height = rods @ rod_effects()[:, 5].T
        right = (np.abs(height - height[:, :1]) <= 4e-5).all(1).mean()
        self.assertAlmostEqual(right, 0.580, delta=0.002)
        analysis = f'draws = "per machine"\nsamples = {machines}\nlimits = {{ height = "0.04 mm" }}\n'
        with self.run_study(analysis) as file:
            self.assertAlmostEqual(file["yield/value"][()], right, delta=3.9 * np.sqrt(right * (1 - right) / machines))
            names = list(file["responses/name"].asstr())
            height, z = (file["monte_carlo/rms"][names.index(name)] for name in ("height", "z"))
            shares = file["yield/mean_square_share"][-1]
        self.assertLess(height[0], 1e-15)
        self.assertGreater(z[0], 1e-5)
        of_rod = ((rod_effects()[:, 5] - rod_effects()[:1, 5]) ** 2).sum(0)
        np.testing.assert_allclose(shares, of_rod / of_rod.sum(), atol=0.03)
        checked = self.succeeds("check", "s.toml")
        self.assertIn("height is less its value at x = 0 mm, y = 0 mm, z = 0 mm: each machine is solved once more there", checked)

    def test_norm_of_differences(self):
        norm = '[[response]]\nname = "off"\nnorm = ["z", "x", "y"]\n'
        analysis = 'draws = "per machine"\nsamples = 4000\nlimits = { off = "0.1 mm" }\n'
        with self.run_study(analysis, norm + ZERO) as file:
            names = list(file["responses/name"].asstr())
            rms = dict(zip(names, file["monte_carlo/rms"][:]))
            shares = file["yield/mean_square_share"][-1]
        np.testing.assert_allclose(rms["off"] ** 2, rms["off_x"] ** 2 + rms["off_y"] ** 2 + rms["off_z"] ** 2, rtol=1e-12)
        of_rod = ((rod_effects()[:, 3:] - rod_effects()[:1, 3:]) ** 2).sum((0, 1))
        np.testing.assert_allclose(shares, of_rod / of_rod.sum(), atol=0.04)
        right = np.sqrt(((rod_effects()[:, 3:] - rod_effects()[:1, 3:]) ** 2).sum((1, 2))) * 5e-5
        np.testing.assert_allclose(rms["off"], right, rtol=0.06, atol=1e-15)

    def test_uniform_errors(self):
        """The gradient of the yield takes the linear map of the differences."""
        half = 9e-5
        rods = np.random.default_rng(1).uniform(-half, half, (1000000, 6))
        height = rods @ (rod_effects()[:, 5] - rod_effects()[:1, 5]).T
        right = (np.abs(height) <= 4e-5).all(1).mean()
        analysis = 'draws = "per machine"\nsamples = 20000\nlimits = { height = "0.04 mm" }\n'
        with self.run_study(analysis, distribution="uniform", size='half_width = "0.09 mm"') as file:
            self.assertAlmostEqual(file["yield/value"][()], right, delta=3.9 * np.sqrt(right * (1 - right) / 20000))
        shown = self.succeeds("show", "s.h5")
        self.assertIn("height", shown)

    def test_allocation(self):
        """Rods of which each costs the same are as exact as each other; the limit is that of the difference."""
        analysis = ('samples = 20000\nlimits = { height = "0.04 mm" }\nyield = 0.95\nsigmas = 3\n'
                    '[[analysis.parts]]\nfactors = ["rod_1", "rod_2", "rod_3", "rod_4", "rod_5", "rod_6"]\n'
                    'cost = { law = "reciprocal", b = 1, unit = "mm" }\n')
        for fidelity in ("", ', fidelity = "first-order"'):
            with self.run_study(analysis.replace("factors = [\"rod_*\"]\n", ""), kind="allocation", fidelity=fidelity) as file:
                tolerance = file["allocation/tolerance"][0]
            rods = np.random.default_rng(2).normal(0.0, tolerance / 3.0, (1000000, 6))
            height = rods @ (rod_effects()[:, 5] - rod_effects()[:1, 5]).T
            right = (np.abs(height) <= 4e-5).all(1).mean()
            self.assertGreater(right, 0.949)
            self.assertLess(right, 0.958)

    def test_steps(self):
        step = ('[[response]]\nname = "step"\nnorm = ["x", "y", "z"]\nrelative_to = "previous"\n'
                '[[response]]\nname = "climb"\npoint = "origin"\ndirection = [1, 0, 2]\nrelative_to = "previous"\n')
        rods = np.random.default_rng(3).normal(0.0, 5e-5, (700, 6))
        self.write("e.csv", ",".join(RODS) + "\n" + "".join(",".join(f"{v:.17g}" for v in row) + "\n" for row in rods))
        self.write("s.toml", STUDY.format(analysis="", responses=step + HEIGHT + ZERO, kind="monte-carlo", size='sigma = "0.05 mm"',
                                          fidelity="", distribution="normal").replace("factors = [\"rod_*\"]", 'draws = "per machine"'))
        self.succeeds("evaluate", "s.toml", "--poses", "bed.csv", "--errors", "e.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as file:
            of = {name: file["evaluate"][name][:] for name in ("x", "y", "z", "step", "climb", "height")}
        self.assertEqual(of["x"].shape, (7, 700))
        moved = np.array([of[axis] for axis in "xyz"])
        way = np.diff(moved, axis=1, prepend=moved[:, :1])
        np.testing.assert_allclose(of["step"], np.sqrt((way**2).sum(0)), rtol=0, atol=1e-16)
        np.testing.assert_allclose(of["climb"], (way[0] + 2 * way[2]) / np.sqrt(5), rtol=0, atol=1e-16)
        np.testing.assert_allclose(of["height"], of["z"] - of["z"][:1], rtol=0, atol=1e-16)
        np.testing.assert_array_equal(of["step"][0], 0.0)
        replayed = self.succeeds("replay", "e.h5", "all", 3, 650)
        self.assertAlmostEqual(float(re.search(r"^  step +(\S+) m", replayed, re.MULTILINE)[1]), of["step"][3, 650], delta=1e-16)
        done = self.poesy("evaluate", "s.toml", "--poses", "bed.csv", "--errors", "e.csv", "--paired")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"is relative to the pose before, which has other errors with --paired", done.stderr)

    def test_replay(self):
        step = '[[response]]\nname = "step"\nnorm = ["x", "y", "z"]\nrelative_to = "previous"\n'
        analysis = 'draws = "per machine"\nsamples = 300\nlimits = { height = "0.04 mm" }\n'
        self.run_study(analysis, HEIGHT + ZERO + step).close()

        def values(pose):
            text = self.succeeds("replay", "s.h5", "all", pose, 42)
            run, trace = text.split("by the reference solver")
            return [{name: float(value) for name, value in re.findall(r"^  (\w+) +(-?[\d.]+(?:e-?\d+)?) m =", part, re.MULTILINE)}
                    for part in (run.split("solved as in the run")[1], trace)], trace
        (here, traced), text = values(4)
        (before, _), _ = values(3)
        (middle, _), _ = values(0)
        self.assertAlmostEqual(here["height"], here["z"] - middle["z"], delta=1e-16)
        self.assertAlmostEqual(traced["height"], here["height"], delta=1e-14)
        way = [here[axis] - before[axis] for axis in "xyz"]
        self.assertAlmostEqual(here["step"], float(np.linalg.norm(way)), delta=1e-16)
        self.assertIn("not shown, because it is relative to another pose", text)

    def test_other_kinds(self):
        """Where each draw is a machine at one pose and at the reference."""
        for kind, analysis in {"sensitivity": "samples = 200\n", "sobol": "samples = 64\n",
                               "monte-carlo": 'draws = "per pose"\nsamples = 300\n'}.items():
            with self.subTest(kind=kind):
                step = '[[response]]\nname = "step"\nnorm = ["x", "z"]\nrelative_to = "previous"\n' if kind == "sobol" else ""
                self.run_study(analysis, HEIGHT + ZERO + step, kind=kind, name=kind).close()
                self.assertIn("height", self.succeeds("show", f"{kind}.h5", "--response", "height")
                              if kind == "sensitivity" else self.succeeds("show", f"{kind}.h5"))
                self.succeeds("report", f"{kind}.h5", "-o", f"{kind}.html")

    def test_of_the_mechanism(self):
        """Points and responses of a mechanism's file, and a study's own behind them."""
        printer = PRINTER.replace('z = ["-10 mm", "100 mm"] }\n', 'z = ["-10 mm", "100 mm"] }\npoints.nozzle = [0, 0, "-70 mm"]\n')
        self.write("delta6.toml", printer + HEIGHT.replace("z = 1", "nozzle_z = 1") + ZERO +
                   '[[response]]\nname = "aside"\nnorm = ["nozzle_x", "nozzle_y"]\n')
        analysis = 'draws = "per machine"\nsamples = 4000\nlimits = { height = "0.04 mm", aside = "0.5 mm" }\n'
        own = '[[response]]\nname = "edge"\npoint = "nozzle"\ndirection = [1, 1, 0]\n'
        with self.run_study(analysis, own) as file:
            names = list(file["responses/name"].asstr())
            rms = dict(zip(names, file["monte_carlo/rms"][:]))
            first = file["yield/value"][()]
        self.assertEqual(names[-7:], ["nozzle_x", "nozzle_y", "nozzle_z", "nozzle_position", "height", "aside", "edge"])
        nozzle = np.array([np.cross(s[:3], NOZZLE, axis=0) + s[3:] for s in rod_effects()])
        for axis, name in enumerate(("nozzle_x", "nozzle_y", "nozzle_z")):
            np.testing.assert_allclose(rms[name], 5e-5 * np.sqrt((nozzle[:, axis] ** 2).sum(1)), rtol=0.06)
        edge = (nozzle[:, 0] + nozzle[:, 1]) / np.sqrt(2)
        np.testing.assert_allclose(rms["edge"], 5e-5 * np.sqrt((edge**2).sum(1)), rtol=0.06)
        np.testing.assert_allclose(rms["aside"] ** 2, rms["nozzle_x"] ** 2 + rms["nozzle_y"] ** 2, rtol=1e-12)
        self.assertLess(rms["height"][0], 1e-15)
        self.assertIn("nozzle", self.succeeds("models", "delta6.toml"))
        self.assertIn(">nozzle<", (self.succeeds("models", "delta6.toml", "-o", "p.svg"), (self.folder / "p.svg").read_text())[1])
        self.succeeds("report", "s.h5", "-o", "s.html")
        shown = json.loads(self.succeeds("show", "s.h5", "--json"))
        # The resolved study has the mechanism file's text, so its result is the same.
        with h5py.File(self.folder / "s.h5") as file:
            self.write("again.toml", file["study/text"][()].decode())
        self.succeeds("run", "again.toml", "-o", "again.h5", "--quiet")
        self.assertEqual(json.loads(self.succeeds("show", "again.h5", "--json"))["content_sha256"], shown["content_sha256"])
        self.assertGreater(first, 0.2)

    def test_refused_in_mechanisms(self):
        def refused(text, *words):
            self.write("m.toml", PRINTER + text)
            done = self.poesy("models", "m.toml")
            message = done.stderr.decode()
            self.assertEqual(done.returncode, 2, message)
            for word in ("m.toml:", *words):
                self.assertIn(word, message)
        refused(HEIGHT + 'relative_to = "previous"\n', "a mechanism has no list of poses", "write this response in the study")
        refused(HEIGHT + 'relative_to = { x = "1 m", y = 0, z = 0 }\n', "'height' is relative to a pose that the mechanism does not reach")
        refused(HEIGHT.replace("z = 1", "zz = 1"), "names 'zz', which is not a response of the mechanism", "did you mean 'z'")
        refused(HEIGHT.replace('"height"', '"position"'), "is the name of another response")
        refused(HEIGHT + HEIGHT, "for the second time")
        refused('[response]\nname = "a"\n', "response", "list")
        study = STUDY.format(analysis="", responses=HEIGHT, kind="sensitivity", size='sigma = "0.05 mm"', fidelity="",
                             distribution="normal")
        self.write("delta6.toml", PRINTER + HEIGHT)
        self.write("s.toml", study)
        done = self.poesy("check", "s.toml")
        self.assertIn(b"is 'height', which is the name of another response", done.stderr)

    def test_resume_knows_the_pose(self):
        analysis = 'draws = "per machine"\nsamples = 400000\nlimits = { height = "0.04 mm" }\n'
        self.write("s.toml", STUDY.format(analysis=analysis, responses=HEIGHT + ZERO, kind="monte-carlo",
                                          size='sigma = "0.05 mm"', fidelity="", distribution="normal"))
        done = self.poesy("run", "s.toml", "-o", "s.h5", "--max-wall", "0.05 s", "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)
        text = (self.folder / "s.toml").read_text()
        self.write("s.toml", text.replace("relative_to = { x = 0,", 'relative_to = { x = "1 mm",'))
        done = self.poesy("run", "s.toml", "-o", "s.h5", "--resume", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"relative_to", done.stderr)


if __name__ == "__main__":
    main()
