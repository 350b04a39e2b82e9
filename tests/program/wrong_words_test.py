"""Every key for designers with a mistake is refused at its line, with a remedy. Nothing is written."""

from poesy_program import MECHANISMS, ProgramTest, main
from wrong_words import ALLOCATION, PARTS, STUDY, WRONG_ALLOCATIONS, WRONG_MECHANISMS, WRONG_PARTS, WRONG_STUDIES

MECHANISM = (MECHANISMS / "designed-delta.toml").read_text()
FILES = {"machine.toml": MECHANISM, "study.toml": STUDY, "parts.csv": PARTS, "zones.toml": ALLOCATION}


def first_difference(text, other):
    return next(k for k, (a, b) in enumerate(zip(text.split("\n"), other.split("\n")), 1) if a != b)


class WrongWords(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, text in FILES.items():
            self.write(name, text)

    def refused(self, file, wrong, *command):
        text = FILES[file]
        for right, word, said in wrong:
            with self.subTest(word):
                self.assertIn(right, text)
                changed = text.replace(right, word)
                self.write(file, changed)
                done = self.poesy(*command)
                message = done.stderr.decode()
                self.assertEqual(done.returncode, 2, message)
                self.assertRegex(message, rf"^poesy: {file}:{first_difference(text, changed)}:\d+: [^\n]+\n$")
                self.assertIn("; ", said)
                self.assertIn(said, message)
                self.assertEqual({path.name for path in self.folder.iterdir()}, set(FILES))
        self.write(file, text)
        self.succeeds(*command)

    def test_mechanisms(self):
        self.refused("machine.toml", WRONG_MECHANISMS, "models", "machine.toml")

    def test_studies(self):
        self.refused("study.toml", WRONG_STUDIES, "check", "study.toml")

    def test_given_machines(self):
        self.refused("parts.csv", WRONG_PARTS, "check", "study.toml")

    def test_zones_as_tolerances(self):
        self.refused("zones.toml", WRONG_ALLOCATIONS, "check", "zones.toml")

    def test_they_are_many(self):
        count = sum(map(len, (WRONG_MECHANISMS, WRONG_STUDIES, WRONG_PARTS, WRONG_ALLOCATIONS)))
        self.assertGreaterEqual(count, 140)

    def test_a_clearance_is_at_no_other_pose(self):
        """It is drawn anew at each pose though the study does not say so."""
        self.write("study.toml", STUDY.replace("direction = [0, 0, 1]", 'direction = [0, 0, 1]\nrelative_to = "previous"'))
        done = self.poesy("check", "study.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"machines draw 'play_x_1' anew at each pose, and 'lift' is the difference from its value at another pose; name errors "
                      b"without it in analysis.factors", done.stderr)


if __name__ == "__main__":
    main()
