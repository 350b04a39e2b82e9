"""What a person sees at a terminal, and what a pipe receives: progress, tables, messages, colours."""

import os
import re
import subprocess
from pathlib import Path

from poesy_program import PROGRAM, STUDY as WITH_BACKGROUND, ProgramTest, main
from pseudo_terminal import PseudoTerminal

# Without a background, which would add a line before the progress (study_notes_test.py).
STUDY = "".join(line for line in WITH_BACKGROUND.splitlines(True) if not line.startswith("background"))
LONG = STUDY.replace("samples = 1500", "samples = 1000000000")
ESCAPE = b"\x1b"
SHARE = r"(?P<share>\d+\.\d) % "
RATE = r"(?P<rate>[\d.]+ [kMG]?)\s?samples/s"
FAILED = r"(?P<failed>\d+) not converged( \([\d.e+-]+ %\))?"
LEFT = r"(time left unknown|(\d+ (s|min|h|d) ?){1,2} ?left)"
LIVE = re.compile(rf" *{SHARE}\[#*\.*\]  +{RATE}  {FAILED}  {LEFT}")
PLAIN = re.compile(rf"{SHARE}done, {RATE}, {FAILED}, {LEFT}")


def frames(raw):
    """The live lines, one after another, as they were written."""
    return [frame.split(b"\x1b[K")[0].decode() for frame in raw.split(b"\r")[1:] if b"\x1b[K" in frame]


class Terminal(ProgramTest):
    def terminal(self, columns, *arguments, environment=(), stdout=None):
        return PseudoTerminal([PROGRAM, *arguments], columns, self.folder, environment, stdout)

    def keep(self, name, rows):
        """In the build tree, to be looked at."""
        if folder := os.environ.get("POESY_SCREENS"):
            Path(folder).mkdir(parents=True, exist_ok=True)
            (Path(folder) / name).write_text("\n".join(rows) + "\n")

    def run_live(self, columns):
        """The frames of a run that ends itself after two seconds, and its terminal."""
        self.write("long.toml", LONG)
        terminal = self.terminal(columns, "run", "long.toml", "-o", f"{columns}.h5", "--max-wall", "2 s")
        shown = []
        while terminal.read(0.05):
            rows = terminal.rows()
            if rows and not rows[0].startswith("poesy"):
                self.assertEqual(len(rows), 1, rows)  # no line is wrapped
                self.assertEqual(terminal.screen.cursor.y, 0)
                shown.append(rows[0])
        self.assertEqual(terminal.close(), 4)
        self.keep(f"progress_{columns}.txt", [*shown, "", "at the end:", *terminal.rows()])
        return shown, terminal

    def test_live_progress(self):
        for columns in (80, 200):
            with self.subTest(columns=columns):
                shown, terminal = self.run_live(columns)
                self.assertGreater(len(shown), 3)
                shares = []
                for frame in frames(terminal.raw)[:-1]:
                    match = LIVE.fullmatch(frame)
                    self.assertTrue(match, frame)
                    self.assertLess(len(frame), columns)
                    shares.append(float(match["share"]))
                    self.assertGreater(float(match["rate"].split()[0]), 0.0)
                self.assertEqual(shares, sorted(shares))
                # The progress line is removed before another message is printed.
                self.assertEqual(frames(terminal.raw)[-1], "")
                self.assertTrue(terminal.rows()[0].startswith("poesy: interrupted"), terminal.rows())
                self.assertNotIn("samples/s", "\n".join(terminal.rows()))

    def test_few_columns(self):
        for columns in (40, 20, 5):
            with self.subTest(columns=columns):
                shown, terminal = self.run_live(columns)
                self.assertTrue(all(len(frame) < columns for frame in frames(terminal.raw)))
                self.assertGreater(len(shown), 3 if columns > 5 else -1)
                if columns == 40:
                    self.assertIn("left", shown[-1])

    def test_line_follows_the_window(self):
        self.write("long.toml", LONG)
        terminal = self.terminal(120, "run", "long.toml", "--max-wall", "3 s")
        terminal.read(1.0)
        self.assertTrue(any(len(frame) > 80 for frame in frames(terminal.raw)))
        terminal.resize(60)
        terminal.read(0.5)
        before = len(terminal.raw)
        terminal.finish()
        later = frames(terminal.raw[before:])
        self.assertTrue(later)
        self.assertTrue(all(len(frame) < 60 for frame in later[1:]), later)

    def test_finished_run_leaves_an_empty_line(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 100000"))
        with (self.folder / "out.txt").open("wb") as out:
            terminal = self.terminal(80, "run", "study.toml", stdout=out)
            self.assertEqual(terminal.finish(), 0)
        self.assertEqual(terminal.rows(), [])
        self.assertEqual(terminal.screen.cursor.x, 0)

    def test_quiet_run_says_nothing(self):
        self.write("study.toml", STUDY.replace("samples = 1500", "samples = 100000"))
        with (self.folder / "out.txt").open("wb") as out:
            terminal = self.terminal(80, "run", "study.toml", "--quiet", stdout=out)
            self.assertEqual(terminal.finish(), 0)
        self.assertEqual(terminal.raw, b"")

    def test_terminal_without_cursor_control_gets_plain_lines(self):
        self.write("long.toml", LONG)
        terminal = self.terminal(80, "run", "long.toml", "--max-wall", "6 s", environment={"TERM": "dumb"})
        self.assertEqual(terminal.finish(), 4)
        self.assertNotIn(ESCAPE, terminal.raw)
        self.assertTrue(PLAIN.fullmatch(terminal.rows()[0]), terminal.rows())

    def test_pipe_gets_plain_lines(self):
        self.write("long.toml", LONG)
        done = self.poesy("run", "long.toml", "--max-wall", "6 s")
        self.assertEqual(done.returncode, 4)
        self.assertTrue(PLAIN.fullmatch(done.stderr.decode().splitlines()[0]), done.stderr)
        self.assertNotIn(ESCAPE, done.stdout + done.stderr)

    def test_pipes_get_no_escape_codes(self):
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "r.h5")
        environment = {**os.environ, "TERM": "xterm", "CLICOLOR_FORCE": "1"}
        environment.pop("NO_COLOR", None)
        for command in ("run study.toml -o again.h5", "check study.toml", "show r.h5", "models", "models 3-prs", "--help",
                        "run --help", "template 3-prs", "export r.h5 -d t", "verify r.h5", "--help-all", "completion bash",
                        "completion zsh", "show nothing.h5", "run", "rum", "show r.h5 --response x", "--version",
                        "tolerances r.h5 --response linear_deformation --extrapolate -d tolerances"):
            with self.subTest(command=command):
                done = subprocess.run([PROGRAM, *command.split()], cwd=self.folder, env=environment, capture_output=True,
                                      timeout=300, check=False)
                self.assertNotIn(ESCAPE, done.stdout + done.stderr)
                self.assertTrue(done.stdout + done.stderr)

    def test_colour_of_errors(self):
        for environment, coloured in (({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False), ({"TERM": ""}, False)):
            with self.subTest(environment=environment):
                terminal = self.terminal(80, "show", "nothing.h5", environment=environment)
                self.assertEqual(terminal.finish(), 3)
                self.assertEqual(ESCAPE in terminal.raw, coloured)
                self.assertTrue(terminal.rows()[0].startswith("poesy: nothing.h5: "), terminal.rows())
                self.assertEqual(terminal.screen.buffer[0][0].fg, "red" if coloured else "default")
                self.assertEqual(terminal.screen.buffer[0][7].fg, "default")

    def test_tables_and_help_do_not_wrap(self):
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "r.h5")
        for columns in (80, 200):
            for command in ("show r.h5", "--help", "run --help", "evaluate --help", "merge --help"):
                with self.subTest(columns=columns, command=command):
                    terminal = self.terminal(columns, *command.split())
                    self.assertEqual(terminal.finish(), 0)
                    rows = terminal.rows()
                    self.keep(f"{command.replace(' ', '_')}_{columns}.txt", rows)
                    self.assertEqual(len(rows), terminal.raw.rstrip(b"\r\n").count(b"\n") + 1, "\n".join(rows))


main()
