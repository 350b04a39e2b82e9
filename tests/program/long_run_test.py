"""A run of more than a day asks for confirmation at a terminal. Without one it is refused, except with --yes."""

import sys
import unittest

from poesy_program import STUDY as WITH_BACKGROUND, ProgramTest, main

try:
    import pyte  # noqa: F401
    from pseudo_terminal import PseudoTerminal
except (ImportError, SystemExit):
    PseudoTerminal = None

from poesy_program import PROGRAM

STUDY = "".join(line for line in WITH_BACKGROUND.splitlines(True) if not line.startswith("background"))
# 2e14 solves take 200 days at ten million per second.
LONG = STUDY.replace("samples = 1500", "samples = 10000000000000")
NEEDS_A_TERMINAL = unittest.skipIf(PseudoTerminal is None, "the Debian package python3-pyte is missing")


class LongRun(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("long.toml", LONG)

    def expect_nothing_written(self):
        self.assertEqual([path.name for path in self.folder.iterdir()], ["long.toml"])

    def test_refused_without_a_terminal(self):
        for options in ((), ("--quiet",), ("--resume",), ("--max-wall", "2000 h"), ("--shard", "1/2")):
            with self.subTest(options=options):
                done = self.poesy("run", "long.toml", *options)
                message = done.stderr.decode().splitlines()[-1]
                self.assertEqual((done.returncode, done.stdout), (2, b""), message)
                self.assertRegex(message, r"^poesy: long\.toml: this run takes about [\d ]+ d( \d+ h)? on \d+ threads of this "
                                          r"machine; give --yes to start it all the same, or ask for fewer samples or poses$")
                self.expect_nothing_written()

    def test_a_sweep_of_short_runs_is_long(self):
        """A design takes some hours at most, and all of them weeks: 2e10 solves each."""
        self.write("long.toml", STUDY.replace("samples = 1500", "samples = 1000000000"))
        done = self.poesy("sweep", "long.toml", "--set", "errors.linear.sigma=1:400:1um")
        message = done.stderr.decode().splitlines()[-1]
        self.assertEqual((done.returncode, done.stdout), (2, b""), message)
        self.assertRegex(message, r"^poesy: long\.toml: this run takes about [\d ]+ d")

    def test_check_says_so(self):
        self.assertRegex(self.succeeds("check", "long.toml"), r"# time: .* d.*; poesy run asks before it starts, or wants --yes\n")
        self.write("study.toml", STUDY)
        self.assertNotIn("--yes", self.succeeds("check", "study.toml"))

    def test_started_with_yes(self):
        done = self.poesy("run", "long.toml", "--yes", "--max-wall", "0.5 s")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(b"--yes", done.stderr.split(b"continue with: ")[1])

    def test_a_run_that_ends_by_itself_and_one_that_goes_on_are_not_asked_about(self):
        self.assertEqual(self.poesy("run", "long.toml", "--max-wall", "0.5 s", "-o", "r.h5").returncode, 4)
        self.assertEqual(self.poesy("run", "long.toml", "--max-wall", "0.5 s", "-o", "r.h5", "--resume").returncode, 4)

    def answered(self, text):
        terminal = PseudoTerminal([PROGRAM, "run", "long.toml", "--quiet"], 120, self.folder)
        while not any("[y/N]" in row for row in terminal.rows()):
            self.assertTrue(terminal.read(0.1), terminal.rows())
        terminal.type(text)
        return terminal

    @NEEDS_A_TERMINAL
    def test_asked_on_a_terminal(self):
        for no in ("n\n", "\n", "no, thanks\n"):
            with self.subTest(no):
                terminal = self.answered(no)
                self.assertEqual(terminal.finish(), 2)
                self.assertIn("give --yes", " ".join(terminal.rows()))
                self.expect_nothing_written()

    @NEEDS_A_TERMINAL
    def test_started_by_a_yes(self):
        terminal = self.answered("yes\n")
        while not (self.folder / "long.h5.lock").exists():
            self.assertTrue(terminal.read(0.1), terminal.rows())
        terminal.read(1.0)
        self.assertNotIn("give --yes", " ".join(terminal.rows()))
        terminal.type("\x03")
        terminal.process.terminate()  # the program is not in the terminal's foreground group
        self.assertIn(terminal.finish(), (4, -2, -15))

    @NEEDS_A_TERMINAL
    def test_interrupted_where_it_asks(self):
        terminal = self.answered("")
        terminal.process.terminate()
        self.assertEqual(terminal.finish(), 4)
        self.assertIn("interrupted before anything was solved", " ".join(terminal.rows()))
        self.expect_nothing_written()


if __name__ == "__main__":
    if PseudoTerminal is None:
        print("without python3-pyte nobody is asked", file=sys.stderr)
    main()
