"""README.md: its study runs and has a verdict, its rankings are those of the published study with both metrics, and
it is short."""

import re
from pathlib import Path

from poesy_program import ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
STUDIES = ROOT / "results/2upr-rpu-sensitivity"
MOST_WORDS = 1300


def block(language, containing):
    """The one fenced block in this language with this text."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
    found = [code for of, code in blocks if of == language and containing in code]
    assert len(found) == 1, f"{len(found)} blocks with {containing!r}"
    return found[0]


class Readme(ProgramTest):
    def test_it_is_short(self):
        self.assertLess(len(README.split()), MOST_WORDS)

    def test_its_study_runs_and_is_judged(self):
        study = self.write("machine.toml", block("toml", "poesy-study"))
        self.assertLessEqual(len(study.read_text().splitlines()), 10)
        text = " ".join(README.split())
        angle = re.search(r"the angles get `\"([^\"]*)\"`", text)[1]
        drawing = study.read_text()
        tighter = drawing.replace("0.01 deg", angle)
        half = drawing.replace("0.02 mm", "0.01 mm")
        percentages = re.findall(r"(?<!\d)\d\d\.\d\d(?= % are good everywhere)|(?<=\*\*PASS\*\*, )[\d.]+(?= %)|(?<=instead gives )[\d.]+(?= %)", text)
        self.assertEqual(len(percentages), 3)
        for changed, code, verdict, share in zip((drawing, tighter, half), (6, 0, 6), ("FAIL", "PASS", "FAIL"), percentages):
            self.write("machine.toml", changed)
            done = self.poesy("run", "machine.toml", "-o", "machine.h5")
            self.assertEqual(done.returncode, code, done.stderr.decode())
            self.assertRegex(self.succeeds("show", "machine.h5"), rf"{verdict}: the yield .*: {share} % of 20 000 machines")

    def test_its_study_ranks_as_the_readme_says(self):
        analysis = re.search(r"`(analysis = \{ kind = \"sensitivity\".*?\})`", README.replace("\n", " "))[1]
        study = re.sub(r"^analysis = .*$", analysis, block("toml", "poesy-study"), flags=re.MULTILINE)
        self.write("ranking.toml", study)
        for command in block("", "poesy show ranking.h5").splitlines():
            self.assertEqual(command.split()[0], "poesy")
            shown = self.succeeds(*command.split("#")[0].split()[1:])
        ranked = re.findall(r"^ +\d+ +(delta|epsilon)_", shown, re.MULTILINE)
        angles, errors = map(int, re.search(r"The first (\d+) of (\d+) ranks are angles", README).groups())
        self.assertEqual((ranked.index("delta"), len(ranked)), (angles, errors))

    def test_its_rankings_are_of_the_published_study(self):
        rankings = (STUDIES / "rankings.txt").read_text(encoding="utf-8").splitlines()
        rows = [line for line in block("", "epsilon_1_4_z").splitlines() if re.match(r"(delta|epsilon)_", line)]
        self.assertGreaterEqual(len(rows), 5)
        for row in rows:
            self.assertIn(row, rankings)

    def test_what_its_page_says_of_the_metrics(self):
        text = " ".join((STUDIES / "README.md").read_text(encoding="utf-8").split())
        self.assertIn("results/2upr-rpu-sensitivity/README.md", README)
        rankings = " ".join((STUDIES / "rankings.txt").read_text(encoding="utf-8").split())
        dependence = (STUDIES / "dependence.txt").read_text(encoding="utf-8").splitlines()
        published = dependence[:next(n for n, line in enumerate(dependence) if line.startswith("platform metric"))]
        metre, _, millimetre = (float(x) for x in next(x for x in published if x.startswith("epsilon_3_4_z")).split()[1:4])
        self.assertIn(f"the index of epsilon_3_4_z is {millimetre:.6f} mm/deg instead of {metre} mm/deg.", text)
        taus = next(line for line in published if line.startswith("tau with the platform's")).split()[-4:]
        self.assertIn(f"Kendall's tau of the two rankings is {taus[0]} at 1 deg and {taus[3]} at 0.01 deg", text)
        self.assertIn(f"Kendall's tau of the two rankings is {taus[0]}, over 25 errors", rankings)


if __name__ == "__main__":
    main()
