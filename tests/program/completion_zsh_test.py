"""Completion in zsh: the beginning of a word and the tab key are typed at a terminal."""

import shutil
import subprocess
import sys

from poesy_program import ProgramTest, main
from pseudo_terminal import PseudoTerminal

if not shutil.which("zsh"):
    print("skipped: the Debian package zsh is missing")
    sys.exit(77)

PROMPT = "ready> "


class Zsh(ProgramTest):
    def setUp(self):
        super().setUp()
        functions = self.folder / "functions"
        functions.mkdir()
        (functions / "_poesy").write_text(self.succeeds("completion", "zsh"))
        self.write(".zshrc", f"PS1='{PROMPT}'; fpath=(functions $fpath); autoload -U compinit; compinit -u -D\n"
                             "unsetopt list_ambiguous; setopt auto_list\n")
        for name in ("one.toml", "result.h5"):
            self.write(name, "")

    def test_syntax(self):
        done = subprocess.run(["zsh", "-n", "functions/_poesy"], cwd=self.folder, capture_output=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, b""))

    def screen_after(self, typed, wanted):
        """The terminal's rows once they show what is wanted, or after ten seconds."""
        zsh = PseudoTerminal(["zsh", "-i"], 100, self.folder, {"ZDOTDIR": str(self.folder), "HISTFILE": ""})
        self.until(zsh, PROMPT.strip())
        zsh.type(typed + "\t")
        self.until(zsh, wanted)
        rows = zsh.rows()
        zsh.process.kill()
        zsh.finish()
        return "\n".join(rows)

    def until(self, zsh, wanted):
        for _ in range(50):
            if wanted in "\n".join(zsh.rows()):
                return
            zsh.read(0.2)

    def test_completes(self):
        for typed, wanted in (("poesy templ", "poesy template"), ("poesy run --max", "poesy run --max-wall"),
                              ("poesy run o", "poesy run one.toml"), ("poesy show r", "poesy show result.h5"),
                              ("poesy run one.toml -o ", "result.h5"), ("poesy models xy", "poesy models xy-3-prs"),
                              ("poesy template 3-prs mon", "poesy template 3-prs monte-carlo"),
                              ("poesy show result.h5 --response lin", "--response linear_deformation"),
                              ("poesy t", "tolerances")):
            with self.subTest(typed=typed):
                self.assertIn(wanted, self.screen_after(typed, wanted))


main()
