"""Shared by the tests of checkpoints: for each kind, a study that takes about a second, and stopping its run.

Work units complete in order, and a run looks at its time limit whenever one is complete. While one of two threads is held
up in the first unit, the other one can solve the next 7, because at most 4 units for each thread are in progress. So each
study has more than 8 units, and its run cannot end before it looks at the limit."""

import os
import re
import signal
import subprocess
import tempfile
from pathlib import Path

import h5py

from poesy_program import GALLERY, MECHANISMS, PROGRAM, ProgramTest

# A sanitizer takes about twenty times as long, so there are fewer poses.
POSES = 8 if os.environ.get("POESY_SANITIZE") else 16
HEAD = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "0.2 deg" }
[solver]
method = "gauss-newton"
[run]
seed = 5
"""
SENSITIVITY = HEAD + f"""\
[poses]
count = {POSES}
[analysis]
kind = "sensitivity"
factors = ["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]
samples = 12300
"""
BY_SERIES = SENSITIVITY.replace('method = "gauss-newton"', 'metric = "platform"').replace(
    'factors = ["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]\nsamples = 12300', 'factors = "deforming"\nsamples = 62300')
MONTE_CARLO = HEAD + f"""\
[poses]
count = {POSES * 3 // 4}
[analysis]
kind = "monte-carlo"
draws = "per pose"
factors = "deforming"
samples = 12300
"""
MACHINES = MONTE_CARLO.replace("per pose", "per machine") + """\
limits.linear_deformation = "0.5 mm"
"""
# The yield gradient of uniform errors uses a linear map, and a second pass over the machines at the end.
UNIFORM = MACHINES.replace('"normal", sigma = "1 mm"', '"uniform", half_width = "1 mm"')
# Responses that are differences between two poses.
RELATIVE = f"""\
format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs" }}
poses = {{ count = {POSES * 3 // 4} }}
errors = {{ linear = {{ distribution = "uniform", half_width = "0.1 mm" }} }}
[[response]]
name = "rise"
point = "tip"
direction = [0, 0, 1]
relative_to = {{ alpha = 0, beta = 0, z = "650 mm" }}
[[response]]
name = "step"
norm = ["theta_x", "theta_y"]
relative_to = "previous"
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = 9200
limits = {{ rise = "0.4 mm", step = "0.5 mrad" }}
"""
SOBOL = HEAD + """\
[poses]
count = 3
[analysis]
kind = "sobol"
factors = "deforming"
samples = 2100
"""
ALLOCATION = HEAD + """\
[poses]
count = 3
[analysis]
kind = "allocation"
factors = "deforming"
samples = 30000
limits.linear_deformation = "0.5 mm"
yield = 0.99
sigmas = 3
[[analysis.parts]]
factors = "linear"
each = true
cost = { law = "reciprocal", b = 1, unit = "mm" }
[[analysis.parts]]
factors = "angular"
cost = { law = "reciprocal", b = 1, unit = "deg" }
"""
CASES = HEAD + """\
[poses]
count = 4000
[analysis]
kind = "evaluate"
cases = [
""" + "".join(f'  {{ errors = {{ linear = "0.1 mm", angular = "{0.01 * k} deg" }} }},\n' for k in range(1, 16)) + "]\n"
IDENTIFICATION = HEAD + """\
[poses]
count = 1500
[analysis]
kind = "identification"
"""
COUPLING = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs" }
poses = { count = 5000 }
[analysis]
kind = "coupling"
linear = ["0.1 mm", "0.3 mm", "0.5 mm"]
sources = [{ name = "FS", factors = "platform-hinges" }, { name = "R", factors = "revolute-gap" },
           { name = "L", factors = "rod-length" }]
"""
FIDELITIES = f"""\
format = "poesy-study"
version = 1
mechanism = {{ model = "3-prs", fidelity = "both" }}
poses = {{ count = {POSES * 5 // 4} }}
errors = {{ linear = {{ distribution = "normal", sigma = "0.1 mm" }} }}
analysis = {{ kind = "sensitivity", samples = 12300 }}
"""
# A mechanism from a file. The text of the file is part of checkpoints and of the result.
FROM_FILE = HEAD.replace('model = "2upr-rpu"', f'file = "{GALLERY / "3-rrr/3-rrr.toml"}"') + """\
[poses]
count = 3
[analysis]
kind = "sensitivity"
factors = "in-plane"
samples = 2300
"""
# Machines with some errors that are drawn anew at each pose, and some that have a mean.
REPEATED = MACHINES.replace("[solver]", """\
[errors.override]
"delta_1_*" = { distribution = "uniform", half_width = "1 mm", draws = "per pose" }
"epsilon_2_*" = { distribution = "normal", sigma = "0.2 deg", mean = "0.1 deg", draws = "per pose" }
delta_3_1_y = { distribution = "triangular", limits = [0, "1 mm"] }
[solver]""", 1)
# A study as a designer states it: zones of a drawing, a loose hinge, errors with means, limits and fits, some of them
# drawn anew at each pose; limits with two ends, one end, a share of the poses and a spread; responses that the study
# defines.
DESIGNED_HEAD = f"""\
format = "poesy-study"
version = 1
mechanism.file = "{MECHANISMS / "designed-delta.toml"}"
poses.count = {POSES // 4}
[errors]
zones = {{ distribution = "normal", sigmas = 3 }}
linear = {{ distribution = "uniform", limits = ["-20 um", "5 um"] }}
[errors.override]
"stop_*" = {{ distribution = "normal", sigma = "5 um", draws = "per pose" }}
"seat_z_?" = {{ draws = "per pose" }}
sag_3 = {{ distribution = "normal", limits = "217 h6", sigmas = 3 }}
batch = {{ distribution = "triangular", half_width = "20 um", mean = "-4 um" }}
[[response]]
name = "gauge"
sum = {{ probe_z = 1, theta_x = "-20 mm" }}
"""
DESIGNED = DESIGNED_HEAD + """\
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = 12300
limits = { gauge = ["-60 um", "90 um"], push = { to = "80 um" }, tilt = { to = "0.3 mrad", share = 0.5 }, x = { spread = "0.1 mm" } }
"""
# Given machines, whose other errors are drawn, and responses that are differences between two poses.
GIVEN = (DESIGNED_HEAD[:DESIGNED_HEAD.index("[errors.override]")] + """\
machines = { columns = ["rail_x_1", "rod_2", "batch"], rows = [
""" + "".join(f"  [{k % 83 - 41}e-6, {k % 59 - 29}e-6, {k % 37 - 18}e-6],\n" for k in range(9200)) + """\
] }
[[response]]
name = "rise"
sum = { nozzle_z = 1 }
relative_to = { x = 0, y = 0, z = "200 mm" }
[[response]]
name = "step"
norm = ["probe_x", "probe_y"]
relative_to = "previous"
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = ["face_*", "rail_*", "rod_*", "stop_*", "batch"]
samples = 9200
limits = { rise = ["-6 um", "8 um"], step = "12 um" }
""")
ZONES = DESIGNED_HEAD + """\
[analysis]
kind = "allocation"
samples = 12000
limits = { probe_position = "0.15 mm", push = ["-0.12 mm", "0.15 mm"] }
yield = 0.95
parts = [{ zones = ["face.*", "rail.*", "hinge.*", "rod.*"], each = true, identical_limbs = [1, 2, 3], cost = { law = "reciprocal", b = 1, unit = "mm" } }]
"""
# A mechanism with bodies that is deformed by a load.
FORCES = f"""\
format = "poesy-study"
version = 1
mechanism.file = "{MECHANISMS / "linear-delta.toml"}"
poses.count = 12
[errors]
linear = {{ distribution = "normal", sigma = "0.05 mm" }}
angular = {{ distribution = "normal", sigma = "0.02 deg" }}
[analysis]
kind = "monte-carlo"
draws = "per pose"
samples = 200
limits = {{ position = "0.6 mm", strain_energy = "5 mJ" }}
"""
STUDIES = {"sensitivity": SENSITIVITY, "by series": BY_SERIES, "monte-carlo": MONTE_CARLO, "machines": MACHINES, "uniform errors": UNIFORM,
           "repeated machines": REPEATED, "relative responses": RELATIVE, "sobol": SOBOL,
           "designer's words": DESIGNED, "given machines": GIVEN, "forces": FORCES,
           "allocation": ALLOCATION, "allocation of zones": ZONES, "evaluate": CASES, "identification": IDENTIFICATION,
           "coupling": COUPLING, "fidelities": FIDELITIES}
# Replacements for tests that do not stop a run: each study has only a few work units, at least one for each of five
# shards.
FEWER = {"samples = 12300": "samples = 4300", "samples = 62300": "samples = 12300", "samples = 9200": "samples = 4200",
         "samples = 200\n": "samples = 100\n", "samples = 30000": "samples = 5000", "samples = 12000": "samples = 4000",
         "count = 4000": "count = 300", "count = 1500": "count = 100", "count = 5000": "count = 500"}


def with_few_units(study):
    for many, few in FEWER.items():
        study = study.replace(many, few)
    return study


ADAPTIVE = "samples = { min = 1000, max = 40000, relative_error = 0.01 }"
# Studies that take samples in rounds until their intervals are narrow.
ADAPTIVE_STUDIES = {
    "adaptive sensitivity": SENSITIVITY.replace("samples = 12300", ADAPTIVE),
    "adaptive machines": MACHINES.replace("samples = 12300", ADAPTIVE),
    "adaptive monte-carlo": MONTE_CARLO.replace("samples = 12300", ADAPTIVE.replace("0.01", "0.003")),
    "adaptive sobol": SOBOL.replace("samples = 2100", ADAPTIVE.replace("0.01", "0.1")),
}


class ResumptionTest(ProgramTest):
    """Runs the program in a folder in memory, if there is one: there checkpoints cost nothing, so there are many."""

    def setUp(self):
        shared = Path("/dev/shm")
        holder = tempfile.TemporaryDirectory(dir=shared if os.access(shared, os.W_OK) else None)
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.newer = self.folder / "out.h5.part"
        self.older = self.folder / "out.h5.part.1"

    def content_hash(self, name="out.h5"):
        with h5py.File(self.folder / name) as result:
            return result.attrs["content_sha256"]

    def errors_of(self, sample, pose):
        """The errors of a machine by name, as replay has them."""
        text = self.succeeds("replay", "out.h5", "all", pose, sample)
        part = text[text.index("errors that vary\n"):text.index("solved as in the run")]
        return dict(re.findall(r"^  (\S+) +(\S+)", part, re.MULTILINE))

    def undisturbed(self, study):
        """The content hash of the study's result."""
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", "undisturbed.h5", "--quiet")
        return self.content_hash("undisturbed.h5")

    def run_for(self, seconds, *options, number=signal.SIGKILL, study="study.toml"):
        """Runs the study until it ends or that time is over and the signal stops it; its exit code and messages."""
        command = [PROGRAM, "run", study, "-o", "out.h5", "--checkpoint-every", "0.01 s", *map(str, options)]
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as run:
            try:
                _, messages = run.communicate(timeout=seconds)
            except subprocess.TimeoutExpired:
                run.send_signal(number)
                _, messages = run.communicate(timeout=120)
        return run.returncode, messages.decode(errors="replace")

    def stop_early(self, *options):
        """Runs the study for a moment, so that a checkpoint stays."""
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--max-wall", "0.01 s", "--quiet", *options)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertTrue(self.newer.exists())

    def two_generations(self):
        self.stop_early()
        self.stop_early("--resume")
        self.assertTrue(self.older.exists())

    def resume(self, *options):
        return self.poesy("run", "study.toml", "-o", "out.h5", "--quiet", "--resume", *options)

    def resume_to_end(self, *options):
        """Resumes the run; the content hash of its result."""
        done = self.resume(*options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(list(self.folder.glob("out.h5.*")), [], "checkpoints stay behind")
        return self.content_hash()

    def generations(self):
        return {path.name: path.read_bytes() for path in (self.newer, self.older) if path.exists()}
