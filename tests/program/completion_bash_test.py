"""Completion in bash: the function of the script, called in the way bash calls it."""

import shutil
import subprocess
import sys

from poesy_program import ProgramTest, main

if not shutil.which("bash"):
    print("skipped: there is no bash")
    sys.exit(77)

ASK = """
source ./poesy.bash
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_poesy poesy "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""


class Bash(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("poesy.bash", self.succeeds("completion", "bash"))
        for name in ("one.toml", "two words.toml", "r.h5", "s.h5", "p.csv", "p.html", "a*b.toml"):
            self.write(name, "")
        (self.folder / "studies").mkdir()

    def offers(self, *words):
        """What is offered for the last word."""
        done = subprocess.run(["bash", "--noprofile", "--norc", "-c", ASK, "bash", "poesy", *words], cwd=self.folder,
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return set(done.stdout.split("\n")) - {""}

    def test_commands(self):
        self.assertLessEqual({"run", "check", "show", "template", "completion"}, self.offers(""))
        self.assertEqual(self.offers("te"), {"template"})
        self.assertEqual(self.offers("--v"), {"--version"})

    def test_options(self):
        self.assertEqual(self.offers("run", "--m"), {"--max-wall"})
        self.assertLessEqual({"--threads", "--resume", "-o", "--output", "--help"}, self.offers("run", "study.toml", "-"))
        self.assertNotIn("--resume", self.offers("show", "-"))
        self.assertEqual(self.offers("version", ""), {"-h", "--help"})

    def test_files(self):
        self.assertEqual(self.offers("run", ""), {"one.toml", "two words.toml", "a*b.toml", "studies"})
        self.assertEqual(self.offers("run", "tw"), {"two words.toml"})
        self.assertEqual(self.offers("run", "--threads", "2", "--quiet", "o"), {"one.toml"})
        self.assertEqual(self.offers("run", "one.toml", "-o", ""), {"r.h5", "s.h5", "studies"})
        self.assertEqual(self.offers("run", "one.toml", "--output", "=", "r"), {"r.h5"})
        self.assertEqual(self.offers("run", "one.toml", "--output", "="), {"r.h5", "s.h5", "studies"})
        self.assertEqual(self.offers("merge", "r.h5", "s"), {"s.h5", "studies"})
        self.assertEqual(self.offers("evaluate", "one.toml", "--poses", ""), {"p.csv", "studies"})
        self.assertEqual(self.offers("export", "r.h5", "-d", ""), {"studies"})
        self.assertEqual(self.offers("report", "r.h5", "s"), {"s.h5", "studies"})
        self.assertEqual(self.offers("report", "r.h5", "-o", ""), {"p.html", "studies"})

    def test_words(self):
        self.assertEqual(self.offers("template", ""), {"2upr-rpu", "3-prs", "xy-3-prs"})
        self.assertEqual(self.offers("models", "2"), {"2upr-rpu"})
        self.assertEqual(self.offers("template", "3-prs", "mo"), {"monte-carlo"})
        self.assertEqual(self.offers("template", "3-prs", "a"), {"allocation"})
        self.assertEqual(self.offers("completion", ""), {"bash", "zsh"})
        self.assertLessEqual({"linear_deformation", "angular_deformation", "theta_x", "tip_position"},
                             self.offers("tolerances", "r.h5", "--response", ""))
        self.assertEqual(self.offers("show", "r.h5", "--response", "linear"), {"linear_deformation"})

    def test_values_that_nobody_can_guess(self):
        self.assertEqual(self.offers("run", "--threads", ""), set())
        self.assertEqual(self.offers("replay", "r.h5", ""), set())


main()
