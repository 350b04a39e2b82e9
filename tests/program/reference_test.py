"""The reference of study files in the repository is the one that the program prints; templates are short, or explain
every key, and mean the same."""

from pathlib import Path

from poesy_program import ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "engine" / "docs" / "study-file.md"


class Reference(ProgramTest):
    def test_the_file_is_what_the_program_prints(self):
        self.assertEqual(REFERENCE.read_text(encoding="utf-8"), self.succeeds("template", "--reference"),
                         f"write it anew: poesy template --reference > {REFERENCE.relative_to(ROOT)}")

    def test_it_is_of_no_model(self):
        done = self.poesy("template", "2upr-rpu", "--reference")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn(b"--reference", done.stderr)

    def test_short_and_full_templates_are_the_same_study(self):
        for model, kind in (("2upr-rpu", "sensitivity"), ("2upr-rpu", "monte-carlo"), ("2upr-rpu", "allocation"),
                            ("2upr-rpu", "sobol"), ("2upr-rpu", "evaluate"), ("3-prs", "coupling")):
            with self.subTest(model=model, kind=kind):
                resolved = []
                for options in ((), ("--full",)):
                    text = self.succeeds("template", model, kind, *options)
                    self.write("study.toml", text)
                    study = self.succeeds("check", "study.toml")
                    resolved.append([line for line in study.splitlines() if not line.startswith(("title", "#"))])
                    lines = [line for line in text.splitlines() if line]
                    if not options:
                        self.assertLessEqual(len(lines), 29)
                        self.assertLessEqual(max(map(len, lines)), 120)
                self.assertEqual(*resolved)


if __name__ == "__main__":
    main()
