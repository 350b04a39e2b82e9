"""What the program prints for command lines that it does not understand."""

from poesy_program import STUDY, ProgramTest, main


class CommandLine(ProgramTest):
    def refuses(self, line, message):
        with self.subTest(line=line):
            done = self.poesy(*line.split())
            self.assertEqual((done.returncode, done.stdout), (2, b""))
            self.assertEqual(done.stderr.decode(), f"poesy: {message}\n")

    def test_commands(self):
        self.refuses("rn study.toml", "no command 'rn'; did you mean 'run'? see poesy --help")
        self.refuses("toler r.h5", "no command 'toler'; did you mean 'tolerances'? see poesy --help")
        self.refuses("frobnicate --help", "no command 'frobnicate'; see poesy --help")

    def test_help_and_version_by_name(self):
        self.assertEqual(self.succeeds(), self.succeeds("--help"))
        self.assertEqual(self.succeeds("help"), self.succeeds("--help"))
        for command in ("run", "replay", "help", "version"):
            self.assertEqual(self.succeeds("help", command), self.succeeds(command, "--help"))
        self.assertEqual(self.succeeds("version"), self.succeeds("--version"))
        self.assertEqual(self.succeeds("-v"), self.succeeds("--version"))
        self.refuses("help rn", "no command 'rn'; did you mean 'run'? see poesy --help")

    def test_models_in_capitals(self):
        for command in (("models",), ("template",)):
            self.assertEqual(self.succeeds(*command, "2UPR-RPU"), self.succeeds(*command, "2upr-rpu"))
        self.refuses("models 2UPR-RPX", "no model '2UPR-RPX'; did you mean '2upr-rpu'?")
        self.write("study.toml", STUDY)
        self.write("capitals.toml", STUDY.replace("2upr-rpu", "2Upr-RPU"))
        resolved = [self.succeeds("check", name).split("# valid")[0] for name in ("study.toml", "capitals.toml")]
        self.assertEqual(resolved[0], resolved[1])

    def test_empty_values(self):
        """As of a script whose variable is not set."""
        self.write("study.toml", STUDY)
        for line, shown, told in ((("run", "study.toml", "--max-wall", ""), "--max-wall", "--max-wall TIME"),
                                  (("run", "study.toml", "-o", ""), "--output", "-o, --output RESULT.h5"),
                                  (("show", "r.h5", "--response", ""), "--response", "--response RESPONSE"),
                                  (("run", ""), "STUDY.toml", "STUDY.toml"), (("export", "r.h5", "-d", ""), None, " DIR")):
            with self.subTest(line=line):
                done = self.poesy(*line)
                self.assertEqual((done.returncode, done.stdout), (2, b""))
                message = done.stderr.decode()
                self.assertIn(f"poesy: {shown} is empty; write {told}, see poesy {line[0]} --help" if shown else told, message)
                self.assertIn("is empty", message)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["study.toml"])

    def test_options_in_the_place_of_values(self):
        self.write("study.toml", STUDY)
        self.refuses("run study.toml -o --quiet", "--output has the option '--quiet' for its value; write -o, --output RESULT.h5, "
                                                  "see poesy run --help")
        self.refuses("run study.toml --output=--quiet", "--output has the option '--quiet' for its value; write -o, --output "
                                                        "RESULT.h5, see poesy run --help")
        done = self.poesy("export", "r.h5", "-d", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"--directory has the option '--quiet' for its value", done.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["study.toml"])
        self.write("--study.toml", STUDY)  # after "--" this is the name of a file
        self.succeeds("check", "--", "--study.toml")

    def test_too_many_results(self):
        self.refuses("report" + 27 * " a", "poesy report takes at most 26 results, not 27; write poesy report RESULT.h5 ... [options], "
                                     "see poesy report --help")

    def test_options(self):
        self.refuses("--versio", "poesy has no option '--versio'; did you mean '--version'? see poesy --help")
        self.refuses("run --thread 2 s.toml", "poesy run has no option '--thread'; did you mean '--threads'? see poesy run --help")
        self.refuses("run s.toml --thred=2", "poesy run has no option '--thred'; did you mean '--threads'? see poesy run --help")
        self.refuses("run s.toml -x", "poesy run has no option '-x'; see poesy run --help")
        self.refuses("show r.h5 --frobnicate", "poesy show has no option '--frobnicate'; see poesy show --help")

    def test_values(self):
        for value in ("x", "0", "1025", "2threads", ""):
            self.refuses(f"run s.toml --threads={value}" if value else "run s.toml --threads",
                         f"--threads is '{value}'; give a whole number from 1 to 1024" if value else
                         "--threads needs a value; write --threads N, see poesy run --help")
        self.refuses("run s.toml --seed -1", "--seed is '-1'; give a whole number from 0 to 9223372036854775807")
        self.refuses("run s.toml -o a.h5 -o b.h5", "--output is there 2 times; give it once, see poesy run --help")
        self.refuses("replay r.h5 all one", "POSE is 'one'; give a whole number from 0 to 9223372036854775807")

    def test_arguments(self):
        self.refuses("show", "poesy show needs RESULT.h5; write poesy show RESULT.h5 ... [options], see poesy show --help")
        self.refuses("evaluate s.toml --poses p.csv", "poesy evaluate needs --errors E.csv; write poesy evaluate STUDY.toml "
                     "--errors E.csv [options], see poesy evaluate --help")
        self.refuses("check a.toml b.toml", "'b.toml' is one too many; write poesy check STUDY.toml [options], see poesy check --help")
        self.refuses("template", "MODEL is required; see poesy template --help")
        self.refuses("template --reference 3-prs", "MODEL and --reference do not go together; leave one out, "
                     "see poesy template --help")
        self.refuses("template 3-prs copling", "no template of kind 'copling'; did you mean 'coupling'?")
        self.refuses("completion fish", "no completion for 'fish'; give bash or zsh")


main()
