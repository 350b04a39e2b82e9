#!/usr/bin/env python3
"""Plants faults in what container_check.py reads and inspects: it must find each fault, and none in correct input."""

import tempfile
import unittest
from pathlib import Path
from unittest import mock

import container_check
from bare_root import REPOSITORY, Clock, Fault

FILE = """# A note
FROM docker.io/library/debian:13-slim AS build
COPY . /poesy
WORKDIR /poesy
ENV A="b c" D=e
RUN ./quickstart packages

FROM docker.io/library/debian:12-slim
COPY --from=build /poesy/poesy_*.deb /packages/
RUN one && \\
    two
WORKDIR /work
WORKDIR below
ENTRYPOINT ["poesy", "--quiet"]
"""
README = """```
podman build -t poesy -f engine/packaging/container/Containerfile .   # builds
podman run --rm -v "$PWD:/work" poesy run study.toml                  # runs
```
"""


class ContainerCheckTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)
        self.context = self.work / "context"

    def expect_fault(self, words, function, *arguments):
        with self.assertRaises(Fault) as raised:
            function(*arguments)
        self.assertIn(words, str(raised.exception))

    def write(self, *names):
        for name in names:
            path = self.work / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(name, encoding="utf-8")

    def test_stages(self):
        first, second = container_check.stages(FILE)
        self.assertEqual((first.suite, first.name), ("trixie", "build"))
        self.assertEqual((second.suite, second.name), ("bookworm", ""))
        self.assertEqual(first.steps[-1], ("RUN", "./quickstart packages"))
        self.assertEqual(second.steps[1], ("RUN", "one && two"))

    def test_faults_of_the_containerfile(self):
        for words, old, new in (("not known which Debian", "docker.io/library/debian:13-slim", "alpine"), ("does not know ADD", "COPY .", "ADD ."),
                                ("comes before FROM", "FROM docker.io/library/debian:13-slim AS build\n", ""),
                                ("one ENTRYPOINT", "ENTRYPOINT", "RUN")):
            self.expect_fault(words, container_check.stages, FILE.replace(old, new))
        for text in ("poesy", '{"a": 1}', "[]", "[1]"):
            self.expect_fault("not a list of words", container_check.entry_point, text)

    def test_the_steps_are_done(self):
        self.write("context/quickstart", "context/build/old", "bookworm/etc/dpkg/dpkg.cfg.d/x", "trixie/etc/dpkg/dpkg.cfg.d/x")
        (self.context / ".dockerignore").write_text("# a note\nbuild\n", encoding="utf-8")
        done = []

        def follow(root, command, _clock, folder):
            done.append((root.name, command, folder))
            (root / folder / "poesy_1.deb").write_text("made", encoding="utf-8")

        with mock.patch.object(container_check, "follow", follow), mock.patch("builtins.print"):
            place = container_check.build_all(FILE.replace("/packages/", "/a/b/"), self.context, self.work, Clock())
        self.assertEqual(done, [("stage0", "export A='b c'; export D=e; ./quickstart packages", "poesy"),
                                ("stage1", "one && two", "")])
        self.assertEqual((place.folder, place.entry, place.environment), ("/work/below", ["poesy", "--quiet"], {}))
        self.assertTrue(place.path(".").is_dir())
        self.assertEqual((self.work / "stage1/a/b/poesy_1.deb").read_text(encoding="utf-8"), "made")
        self.assertTrue((self.work / "stage0/poesy/quickstart").is_file())
        self.assertFalse((self.work / "stage0/poesy/build").exists())

    def test_faults_of_copies(self):
        self.write("context/quickstart", "context/.dockerignore")
        (self.context / ".dockerignore").write_text("build\n", encoding="utf-8")
        place = container_check.Place(self.work / "root")
        for words, text in (("names no stage", "--from=other /a /b"), ("names no stage", "--chown=1 . /b"), ("there is no", "x /b")):
            self.expect_fault(words, container_check.copy, text, place, self.context, {})
        for line in ("*/build", "!build", "a/b", "/build"):
            self.expect_fault("only plain names", container_check.ignored, line)

    def test_commands_of_the_readme(self):
        self.assertEqual(container_check.commands(README, "/work"), ["run", "study.toml"])
        for words, old, new in (("does not say", "podman build", "docker build"), ("does not say", "podman run", "podman start"),
                                ("builds Containerfile", "engine/packaging/container/", ""),
                                ("starts other", '" poesy', '" other'), ("in /here", ":/work", ":/here")):
            self.expect_fault(words, container_check.commands, README.replace(old, new), "/work")

    def test_our_own(self):
        text = (REPOSITORY / container_check.CONTAINERFILE).read_text(encoding="utf-8")
        last = container_check.stages(text)[-1].steps
        folder = [rest for instruction, rest in last if instruction == "WORKDIR"][-1]
        self.assertIn("run", container_check.commands((REPOSITORY / "README.md").read_text(encoding="utf-8"), folder))
        self.assertEqual(container_check.ignored((REPOSITORY / ".dockerignore").read_text(encoding="utf-8")), {"build"})

    def test_version(self):
        container_check.check_version("poesy 0.2.0 (abc)\nGCC 14\n", "abc")
        for printed in ("poesy 0.2.0 (unknown)\n", "poesy 0.2.0 (abc-dirty)\n", ""):
            self.expect_fault("of commit abc", container_check.check_version, printed, "abc")

    def test_image(self):
        status = "var/lib/dpkg/status"
        self.write(status, *container_check.NOTICES)
        container_check.check_image(self.work)
        (self.work / status).write_text("Package: g++\nStatus: install ok installed\n", encoding="utf-8")
        self.expect_fault("g++", container_check.check_image, self.work)
        (self.work / container_check.NOTICES[1]).unlink()
        self.expect_fault("is missing", container_check.check_image, self.work)


if __name__ == "__main__":
    unittest.main()
