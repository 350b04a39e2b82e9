"""Shared by the tests of the Python package: the package from the tree, the program, and studies that are quick."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ["POESY_PROGRAM"]
os.environ["POESY"] = PROGRAM
os.environ.setdefault("MPLBACKEND", "agg")
os.environ["PYTHONPATH"] = str(ROOT / "engine" / "python")  # for processes that a test starts
sys.path.insert(0, os.environ["PYTHONPATH"])

import poesy  # noqa: E402

NOT_RUN = 77
ERRORS = {
    "linear": {"distribution": "normal", "sigma": "0.05 mm"},
    "angular": {"distribution": "normal", "sigma": "0.02 deg"},
}
PLATFORM = {"metric": "platform"}
HOPELESS = {"method": "gauss-newton", "max_iterations": 1, "not_converged": "fail"}  # a solver that never converges


def study(analysis, model="2upr-rpu", poses=4, **more):
    """A study of a few poses as a dict."""
    solver = {"solver": PLATFORM} if model == "2upr-rpu" else {}
    errors = {} if analysis["kind"] in ("evaluate", "identification", "coupling") else {"errors": ERRORS}
    return {"mechanism": {"model": model}, "poses": {"count": poses}, **errors, **solver, "analysis": analysis, **more}


PARTS = [
    {"factors": kind, "each": True, "identical_limbs": [1, 2], "cost": {"law": "reciprocal", "b": 1, "unit": unit}}
    for kind, unit in (("linear", "mm"), ("angular", "deg"))
]
# Studies of all kinds, with one study for each form of result file that a kind has.
STUDIES = {
    "sensitivity": study({"kind": "sensitivity", "samples": 200}),
    "sensitivity of the 3-prs": study({"kind": "sensitivity", "samples": 200}, model="3-prs"),
    "monte-carlo": study({"kind": "monte-carlo", "draws": "per pose", "samples": 400}),
    "monte-carlo, adaptive": study({"kind": "monte-carlo", "draws": "per pose",
                                    "samples": {"min": 200, "max": 800, "relative_error": 0.05}}),
    "machines": study(
        {"kind": "monte-carlo", "draws": "per machine", "samples": 1000, "yield": 0.9,
         "limits": {"gap": "0.2 mm", "angular_deformation": "0.3 deg"}}
    ),  # fmt: skip
    "sobol": study({"kind": "sobol", "samples": 128}),
    "sobol of groups": study({"kind": "sobol", "samples": 128, "groups": "limb", "second_order": True, "shapley": True}),
    "allocation": study(
        {"kind": "allocation", "limits": {"gap": "0.05 mm"}, "yield": 0.95, "sigmas": 3, "samples": 4000, "parts": PARTS}
    ),
    "identification": study({"kind": "identification", "groups": [{"linear": "0.1 mm", "angular": "0.1 deg"}]}),
    "coupling": study({"kind": "coupling", "linear": ["0.1 mm", "0.5 mm"]}, model="3-prs"),
    "evaluate": study(
        {"kind": "evaluate", "cases": [{"name": "all", "errors": {"linear": "0.1 mm", "angular": "0.1 deg"}}],
         "limits": {"gap": "0.05 mm"}}
    ),  # fmt: skip
    "trajectory": {
        "mechanism": {"model": "3-prs"},
        "poses": {"select": "trajectory", "trajectory": {"curve": "helix", "points": 5}},
        "analysis": {"kind": "evaluate", "cases": [{"name": "rods", "errors": {"rod-length": {"linear": "0.1 mm"}}}]},
    },
}
_results = {}


def result(name):
    """The result of one of STUDIES, run once for all tests of a file."""
    if name not in _results:
        _results[name] = poesy.run(STUDIES[name])
    return _results[name]


class FolderTest(unittest.TestCase):
    """Works in a folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)


def main():
    unittest.main(argv=[sys.argv[0], "-v"])
