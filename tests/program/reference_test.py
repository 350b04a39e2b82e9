"""The reference of study files in the repository is the one that the program prints."""

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


if __name__ == "__main__":
    main()
