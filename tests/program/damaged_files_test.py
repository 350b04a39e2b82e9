"""Files that were truncated or have flipped bits: no command crashes or hangs, and no number changes without a warning.

Tests each kind of result, a shard and a checkpoint. POESY_DAMAGES: number of damages of each file by flips of 1 to 64
bits (default 5); a fifth as many truncations are made too. POESY_DAMAGE_SEED selects which damages.
"""

import json
import os
import random
import re
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from deadline import run_in_time
from poesy_program import main
from resumption import STUDIES, ResumptionTest

FLIPS = int(os.environ.get("POESY_DAMAGES", "5"))
TRUNCATIONS = max(1, FLIPS // 5)
SEED = int(os.environ.get("POESY_DAMAGE_SEED", "1"))
# Facts about the run on a report page, which the content hash does not cover: in its section "What was run", and the
# number of solves below the title.
RUN_FACTS = re.compile(rb"""<tr><th scope="row">(?:date \(UTC\)|machine|processor|threads|ranks|wall time \[s\]|solves|samples|"""
                       rb"""samples per second)</th><td class="long">[^<]*</td></tr>\n|(?<= poses, )[^,;<]* (?:solves|samples)(?=[;<])""")
CHANGED = b"was changed since it was written"
# Replacements that make the study of each kind so small that it ends at once.
SMALLER = [("samples = 12300", "samples = 60"), ("samples = 62300", "samples = 60"), ("samples = 2100", "samples = 64"), ("samples = 30000", "samples = 3000"),
           ("count = 4000", "count = 20"), ("count = 1500", "count = 20"), ("count = 5000", "count = 30")]
READERS = [("verify", "r.h5"), ("show", "r.h5"), ("show", "r.h5", "--json"), ("export", "r.h5", "-d", "tables"),
           ("report", "r.h5", "-o", "r.html")]
SENSITIVITY_READERS = [("tolerances", "r.h5", "--response", "linear_deformation", "--extrapolate", "-d",
                        "tolerances"), ("replay", "r.h5", "delta_1_1_y", "0", "1")]


def smaller(study):
    for large, small in SMALLER:
        study = study.replace(large, small)
    return study


def damages(content, chooser):
    """(what was done, bytes) of each damage."""
    for _ in range(TRUNCATIONS):
        end = chooser.randrange(len(content))
        yield f"cut off after {end} of {len(content)} bytes", content[:end]
    for _ in range(FLIPS):
        bits = chooser.sample(range(8 * len(content)), chooser.choice((1, 2, 4, 8, 16, 32, 64)))
        changed = bytearray(content)
        for bit in bits:
            changed[bit // 8] ^= 1 << bit % 8
        yield f"bits {sorted(bits)} turned over", bytes(changed)


class DamagedFiles(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.counts = dict.fromkeys(("refused", "warned", "as before"), 0)

    def run_in(self, folder, command):
        """How the command ended."""
        return run_in_time(folder, command)

    @staticmethod
    def told(folder, command, done):
        """Everything that the command says or writes of the result's content; without what is said of the run."""
        if command[0] == "report":
            return RUN_FACTS.sub(b"", (folder / "r.html").read_bytes())
        if command[0] in ("export", "tolerances"):
            written = {path.name: path.read_bytes() for path in (folder / command[-1]).iterdir()}
            return done.stdout, written
        if "--json" in command:
            content = json.loads(done.stdout)
            del content["run"]
            return content
        return re.sub(rb"[0-9]+ (?:solves|samples) in .*\n", b"", done.stdout)

    def fault(self, folder, command, sound):
        """What is wrong with how a reader takes a damaged file, if anything is."""
        for left in ("tables", "tolerances"):
            shutil.rmtree(folder / left, ignore_errors=True)
        (folder / "r.html").unlink(missing_ok=True)
        done = self.run_in(folder, command)
        if done.returncode not in (0, 2, 3):
            return f"ends with {done.returncode}: {done.stderr[-300:]}"
        if done.returncode != 0:
            self.counts["refused"] += 1
            return None if done.stderr.startswith(b"poesy: ") else f"says {done.stderr[-300:]}"
        if CHANGED in done.stderr:
            self.counts["warned"] += 1
            return None
        self.counts["as before"] += 1
        return None if self.told(folder, command, done) == sound[command] else "has other content, and does not warn"

    def faults(self, name, content, readers, sound):
        faults = []
        chooser = random.Random(f"{SEED} {name}")
        with tempfile.TemporaryDirectory(dir=self.folder) as holder:
            folder = Path(holder)
            for what, damaged in damages(content, chooser):
                (folder / "r.h5").write_bytes(damaged)
                for command in readers:
                    fault = self.fault(folder, command, sound)
                    if fault:
                        faults.append(f"{name}, {what}: {command[0]} {fault}")
        return faults

    def of_kind(self, kind):
        with tempfile.TemporaryDirectory(dir=self.folder) as holder:
            folder = Path(holder)
            (folder / "study.toml").write_text(smaller(STUDIES[kind]))
            made = self.run_in(folder, ("run", "study.toml", "-o", "r.h5", "--quiet"))
            self.assertIn(made.returncode, (0, 6), made.stderr)
            readers = READERS + (SENSITIVITY_READERS if kind == "sensitivity" else [])
            sound = {}
            for command in readers:
                done = self.run_in(folder, command)
                self.assertEqual(done.returncode, 0, done.stderr)
                sound[command] = self.told(folder, command, done)
            return self.faults(kind, (folder / "r.h5").read_bytes(), readers, sound)

    def test_results(self):
        with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
            faults = [fault for of_one in pool.map(self.of_kind, STUDIES) for fault in of_one]
        print(f"{len(STUDIES)} results, {FLIPS} flips and {TRUNCATIONS} truncations each: {self.counts}")
        self.assertEqual(faults, [])
        self.assertGreater(self.counts["refused"], 0)

    def test_shards(self):
        self.write("study.toml", smaller(STUDIES["machines"]).replace("samples = 60", "samples = 3000"))
        for number in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{number}/2", "-o", f"{number}.h5", "--quiet")
        self.succeeds("merge", "1.h5", "2.h5", "-o", "sound.h5")
        for what, damaged in damages((self.folder / "1.h5").read_bytes(), random.Random(SEED)):
            with self.subTest(what):
                self.write("damaged.h5", damaged)
                done = self.run_in(self.folder, ("merge", "damaged.h5", "2.h5", "-o", "out.h5"))
                self.assertIn(done.returncode, (0, 2, 3), done.stderr)
                self.assertEqual((self.folder / "out.h5").exists(), done.returncode == 0)
                if done.returncode == 0:
                    self.assertEqual(self.content_hash("out.h5"), self.content_hash("sound.h5"))
                    (self.folder / "out.h5").unlink()

    def test_checkpoints(self):
        """Without an older one beside it."""
        for kind in ("machines", "sobol", "coupling"):
            self.write("study.toml", smaller(STUDIES[kind]))
            self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
            expected = self.content_hash()
            content = self.newer.read_bytes()
            (self.folder / "out.h5").unlink()
            resume = ("run", "study.toml", "-o", "out.h5", "--resume", "--quiet")
            for what, damaged in damages(content, random.Random(SEED)):
                with self.subTest(kind=kind, damage=what):
                    self.newer.write_bytes(damaged)
                    done = self.run_in(self.folder, resume)
                    self.assertEqual(done.returncode, 3, done.stderr)
                    self.assertEqual({path.name for path in self.folder.iterdir()}, {"study.toml", "out.h5.part"})
            self.newer.write_bytes(content)
            self.succeeds(*resume)
            self.assertEqual(self.content_hash(), expected)
            (self.folder / "out.h5").unlink()


if __name__ == "__main__":
    main()
