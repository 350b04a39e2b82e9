"""The reference of study files in the repository is the one that the program prints. Templates are short or explain
every key, and both forms mean the same."""

from pathlib import Path

from poesy_program import GALLERY, MECHANISMS, ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "engine" / "docs" / "study-file.md"
KINDS = ("sensitivity", "identification", "evaluate", "monte-carlo", "sobol", "allocation", "coupling")


class Reference(ProgramTest):
    def test_the_file_is_what_the_program_prints(self):
        self.assertEqual(REFERENCE.read_text(encoding="utf-8"), self.succeeds("template", "--reference"),
                         f"write it anew: poesy template --reference > {REFERENCE.relative_to(ROOT)}")

    def test_it_is_of_no_model(self):
        done = self.poesy("template", "2upr-rpu", "--reference")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn(b"--reference", done.stderr)

    def models(self):
        """The mechanisms that the program lists, and those of files."""
        listed = [line.split()[0] for line in self.succeeds("models").splitlines()]
        self.assertGreaterEqual(len(listed), 3)
        return listed, sorted(path for folder in (GALLERY, MECHANISMS) for path in folder.rglob("*.toml")
                              if "\n[[limb]]" in path.read_text())

    def templates(self):
        """The models and kinds that have a template."""
        listed, files = self.models()
        count = 0
        for model in listed + files:
            for kind in KINDS:
                done = self.poesy("template", model, kind)
                if done.returncode == 2 and (kind in ("identification", "coupling") or b"has clearances" in done.stderr):
                    continue  # the mechanism does not support this kind
                self.assertEqual(done.returncode, 0, done.stderr)
                count += 1
                yield model, kind, done.stdout.decode(), model in listed
        self.assertGreater(count, 5 * len(files))

    def test_short_templates_are_at_most_25_lines(self):
        for model, kind, text, is_listed in self.templates():
            with self.subTest(model=str(model), kind=kind):
                lines = text.splitlines()
                self.assertLessEqual(len(lines), 25, text)
                self.assertTrue(all(line.strip() for line in lines))
                for line in lines[1:]:
                    self.assertLessEqual(line.count("  # "), 1)
                    if len(line) > 120:  # for mechanisms with many coordinates or long names
                        self.assertRegex(line, "^(workspace = |limits = |  { )")
                self.assertIn("poesy template --full", text)
                if is_listed:
                    self.write("study.toml", text)
                    self.succeeds("check", "study.toml")

    def test_short_and_full_templates_are_the_same_study(self):
        for model, kind in (("2upr-rpu", "sensitivity"), ("2upr-rpu", "monte-carlo"), ("2upr-rpu", "allocation"),
                            ("2upr-rpu", "identification"), ("2upr-rpu", "sobol"), ("2upr-rpu", "evaluate"),
                            ("3-prs", "coupling")):
            with self.subTest(model=model, kind=kind):
                resolved = []
                for options in ((), ("--full",)):
                    self.write("study.toml", self.succeeds("template", model, kind, *options))
                    study = self.succeeds("check", "study.toml")
                    resolved.append([line for line in study.splitlines() if not line.startswith(("title", "#"))])
                self.assertEqual(*resolved)


if __name__ == "__main__":
    main()
