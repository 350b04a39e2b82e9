"""The response that tables, reports and templates show first: with a limit, else of the tool, else of the platform."""

import json
import os
import re
import shutil
from pathlib import Path

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
STUDY = """\
format = "poesy-study"
version = 1
mechanism = {{ file = "delta.toml", fidelity = "first-order" }}
poses = {{ select = "interior", count = 4 }}
errors.zones = {{ distribution = "normal", sigmas = 3 }}
[analysis]
{analysis}
"""


class LeadingResponse(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(DATA / "mechanisms/linear-delta-drawing.toml", self.folder / "delta.toml")

    def run_study(self, name, analysis):
        self.write(f"{name}.toml", STUDY.format(analysis=analysis))
        done = self.poesy("run", f"{name}.toml", "-o", f"{name}.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        return json.loads(self.succeeds("show", f"{name}.h5", "--json"))["tables"]

    def without_tool(self):
        path = self.folder / "delta.toml"
        path.write_text("".join(line for line in path.read_text().splitlines(True) if not line.startswith("tool =")))

    def test_without_limits(self):
        """The tool's, also for features; without a tool the platform's."""
        for response in ("tip_position", "position"):
            with self.subTest(response):
                tables = {table["name"]: table for table in self.run_study(response, 'kind = "sensitivity"\nsamples = 64')}
                captions = " ".join(table["caption"] for table in tables.values())
                self.assertIn(f"Effect of each error on {response} at", captions)
                self.assertIn(f"features of the drawing do to {response} in", captions)
                for kind, sign in (("allocation", ""), ("monte-carlo", "# ")):
                    template = self.succeeds("template", "delta.toml", kind, "--full")
                    self.assertIn(f'\n{sign}limits = {{ {response} = "0.05 mm" }}', template)
                self.succeeds("report", f"{response}.h5", "-o", f"{response}.html")
                text = (self.folder / f"{response}.html").read_text()
                self.assertTrue(f"effect on {response}" in text)
                self.without_tool()

    def test_limited(self):
        """Of several limits the one that is missed most often, also where the mechanism does not put it first."""
        limits = 'limits = { x = "0.2 mm", tip_z = "0.03 mm", rotation = "0.2 deg" }'
        per_machine = self.run_study("machines", f'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 400\n{limits}')
        per_pose = self.run_study("draws", f'kind = "monte-carlo"\ndraws = "per pose"\nsamples = 400\njudge = "share"\nshare = 0.9\n{limits}')
        evaluated = self.run_study(
            "cases", f'kind = "evaluate"\n{limits}\n[[analysis.cases]]\nerrors = {{ linear = "0.01 mm" }}')
        order = ["tip_z", "x", "rotation"]
        for name, tables in (("machines", per_machine), ("draws", per_pose)):
            with self.subTest(name):
                overall = next(table for table in tables if table["name"] == "overall")
                self.assertEqual([row["response"] for row in overall["rows"]][:4], [*order, "tip_position"])
                drawing = next(table for table in tables if "features of the drawing" in table["caption"])
                self.assertIn("do to tip_z in", drawing["caption"])
        self.assertRegex(evaluated[1]["columns"][3]["heading"], "^(tip_z|x|rotation) ")
        self.succeeds("report", "machines.h5", "-o", "machines.html")
        text = re.sub(r"<[^>]*>", " ", (self.folder / "machines.html").read_text())
        self.assertTrue(re.search(r"Answer\s+tip_z is ", text))
        shown = self.succeeds("show", "machines.h5", "--response", "x")
        self.assertIn("do to x in", shown)


if __name__ == "__main__":
    main()
