"""Hostile HDF5 files as input of commands that open results: none hangs, crashes, or prints content of another file.

POESY_HOSTILE: number of structures to test (default 200; 0: all). POESY_HOSTILE_SEED selects them from those that need
not be refused.
"""

import os
import random
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py

from deadline import run_in_time
from hostile_structures import MARK, Outside, Structure, external, replaced, structures
from hostile_texts import FROM_FILE, text_structures
from poesy_program import main
from resumption import ResumptionTest

COUNT = int(os.environ.get("POESY_HOSTILE", "200"))
SEED = int(os.environ.get("POESY_HOSTILE_SEED", "1"))
RULE = "a result is one tree that reads nothing but itself"
STUDY = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs", fidelity = "first-order" }
poses = { count = 3 }
analysis = { samples = 10 }
"""
COMMANDS = [("verify", "r.h5"), ("show", "r.h5"), ("show", "r.h5", "--json"), ("export", "r.h5", "-d", "tables"),
            ("report", "r.h5", "-o", "r.html"), ("tolerances", "r.h5", "--response", "tip_x", "-d", "tolerances"),
            ("replay", "r.h5", "a_x_1", "0", "1")]
# The same commands for a mechanism from a file, whose errors and responses have other names.
COMMANDS_FROM_FILE = [[{"tip_x": "position", "a_x_1": "delta_1_0_x"}.get(word, word) for word in command]
                      for command in COMMANDS]
CHANGED = b"was changed since it was written"
# Traces of the secrets in an output: as text, as numbers in any decimal unit, and as bytes that were read as numbers.
SIGNS = [MARK.encode(), b"4242424", b"4.242424", b"84,79,80", b"root:x:0"]


def commands_for(structure, commands):
    """All of them where each reads the structure in its own way. What is no tree of its own is refused where any file
    is opened: then `verify` and two of the others, which differ from one structure to the next."""
    if COUNT == 0 or structure.sort in ("text", "shape"):
        return commands
    verify, *others = commands
    return [verify, *random.Random(structure.name).sample(others, 2)]


class HostileFiles(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.outside = Outside(self.folder)

    def make(self, structure, sound="sound.h5"):
        """A folder with the hostile file, and with what it may look for beside itself."""
        folder = Path(tempfile.mkdtemp(dir=self.folder))
        for secret in (self.outside.text, self.outside.numbers, self.outside.file):
            os.link(secret, folder / secret.name)
        os.mkfifo(folder / "fifo.h5")
        shutil.copy(self.folder / sound, folder / "r.h5")
        with h5py.File(folder / "r.h5", "r+") as file:
            structure.change(file, self.outside)
        return folder

    def faults(self, structure, folder, command):
        """What is wrong with how the command took it."""
        there = {path.name for path in folder.iterdir()}
        done = run_in_time(folder, command)
        said = done.stdout + done.stderr
        written = [path for path in folder.rglob("*") if path.relative_to(folder).parts[0] not in there]
        told = said + b"".join(path.read_bytes() for path in written if path.is_file())
        found = [f"tells {sign}" for sign in SIGNS if sign in told]
        if done.returncode not in (0, 2, 3):
            found.append(f"ends with {done.returncode}")
        if structure.sort == "text":
            if done.returncode == 0 and CHANGED not in done.stderr:
                found.append("does not warn")
        elif structure.sort != "shape":
            if done.returncode != 3 or RULE.encode() not in done.stderr or written:
                found.append(f"is not refused: {done.returncode}, {said[-300:]}")
        return [f"{structure.name}: {command[0]}: {fault}" for fault in found]

    def put_through(self, structure, commands):
        folder = self.make(structure)
        commands = commands_for(structure, commands)
        try:
            return [fault for command in commands for fault in self.faults(structure, folder, command)]
        finally:
            shutil.rmtree(folder)

    def put_all_through(self, chosen, commands):
        with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
            faults = [fault for of_one in pool.map(lambda one: self.put_through(one, commands), chosen) for fault in of_one]
        print(f"{len(chosen)} structures, {sum(len(commands_for(one, commands)) for one in chosen)} commands")
        self.assertEqual(faults, [])

    def test_structures(self):
        self.succeeds("run", "study.toml", "-o", "sound.h5", "--quiet")
        chosen = structures()
        if COUNT != 0:
            must = [one for one in chosen if one.sort != "shape"]
            others = [one for one in chosen if one.sort == "shape"]
            chosen = must + random.Random(SEED).sample(others, max(0, min(len(others), COUNT - len(must))))
        self.put_all_through(chosen, COMMANDS)

    def test_texts(self):
        self.write("study.toml", FROM_FILE)
        self.succeeds("run", "study.toml", "-o", "sound.h5", "--quiet")
        for command in COMMANDS_FROM_FILE:
            self.succeeds(*["sound.h5" if word == "r.h5" else word for word in command])
        self.put_all_through(text_structures(), COMMANDS_FROM_FILE)

    def test_shards(self):
        for shard in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{shard}/2", "-o", f"{shard}.h5", "--quiet")
        with h5py.File(self.folder / "1.h5") as sound:
            paths = ["shard", "study", "poses", "run", "shard/state_1", "study/text", "poses/alpha"]
            self.assertTrue(all(path in sound for path in paths))
        own = Structure("external bytes shard/state_1", "outside",
                        replaced("shard/state_1", external(h5py.h5t.NATIVE_UINT8, "text")))
        fitting = [one for one in structures() if one.sort == "outside" and
                   one.name.split()[-1] in paths and "filter" not in one.name]
        self.assertGreater(len(fitting), 10)
        for structure in [own, *fitting]:
            with self.subTest(structure=structure.name):
                folder = self.make(structure, "1.h5")
                done = run_in_time(folder, ("merge", "r.h5", "../2.h5", "-o", "merged.h5"))
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertIn(RULE, done.stderr.decode())
                self.assertFalse((folder / "merged.h5").exists())

    def test_links_whose_names_are_paths(self):
        """No library writes such a name, so that its bytes are put into the file."""
        self.succeeds("run", "study.toml", "-o", "sound.h5", "--quiet")
        for name in (b"a/b\0", b"/ab\0", b"ab/\0", b".\0b\0"):
            def change(file, _):
                file.create_group("run/new")["a_b"] = 1.0
            folder = self.make(Structure("name", "tree", change))
            bytes_ = (folder / "r.h5").read_bytes()
            self.assertEqual(bytes_.count(b"a_b\0"), 1)
            (folder / "r.h5").write_bytes(bytes_.replace(b"a_b\0", name))
            for command in COMMANDS:
                with self.subTest(name=name, command=command[0]):
                    done = run_in_time(folder, command)
                    self.assertEqual(done.returncode, 3, done.stdout)
                    self.assertIn(RULE, done.stderr.decode())
                    self.assertIn("has no name of its own", done.stderr.decode())

    def study_with(self, what, path):
        """Name of a study that reads this file."""
        poses = 'poses = { count = 3 }'
        changed = {
            "poses": STUDY.replace(poses, f'poses = {{ select = "file", file = "{path}" }}'),
            "trajectory": STUDY.replace(poses, f'poses = {{ select = "trajectory", trajectory = {{ file = "{path}" }} }}'),
            "measured": STUDY + "[errors.override]\n"
                                f'a_x_1 = {{ distribution = "measured", file = "{path}", column = "x" }}\n',
            "mechanism": STUDY.replace('model = "3-prs", fidelity = "first-order"', f'file = "{path}"')}
        self.write(f"{what}.toml", changed[what])
        return f"{what}.toml"

    def test_what_is_no_file(self):
        """Said at once, by every command, whatever it was that was to be opened."""
        os.mkfifo(self.folder / "fifo")
        (self.folder / "folder").mkdir()
        for path, what in (("fifo", "is a FIFO"), ("folder", "is a folder"), ("/dev/zero", "is a device")):
            for command in [*COMMANDS, ("merge", "r.h5", "-o", "merged.h5")]:
                with self.subTest(path=path, command=command[0]):
                    done = run_in_time(self.folder, [path if word == "r.h5" else word for word in command])
                    self.assertIn(done.returncode, (2, 3), done.stderr)
                    self.assertIn(what, done.stderr.decode())
            for command in (("run", path), ("check", path), ("evaluate", path, "--poses", "p.csv", "--errors", "e.csv"),
                            ("evaluate", "study.toml", "--poses", path, "--errors", path), ("models", self.folder / path),
                            ("check", self.study_with("poses", path)), ("check", self.study_with("trajectory", path)),
                            ("check", self.study_with("measured", path)), ("check", self.study_with("mechanism", path))):
                with self.subTest(path=path, command=command[:2]):
                    done = run_in_time(self.folder, command)
                    self.assertIn(done.returncode, (2, 3), done.stderr)
                    self.assertIn(what, done.stderr.decode())


if __name__ == "__main__":
    main()
