"""Commands that must end in time, on a machine that other programs have too."""

import os
import subprocess
import sys
import time
from pathlib import Path

from poesy_program import PROGRAM

LONGEST = 60.0 if os.environ.get("POESY_SANITIZE") else 10.0  # seconds
MOST_RETRIES = 3
TICKS = os.sysconf("SC_CLK_TCK")


def processor_seconds(process):
    """What all threads of a child have used so far."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


class Deadline:
    """Runs the program, each command for at most so many seconds. A command that took longer without having had a
    processor for that long is tried once more, which is said on stderr; a few such commands in all are one fault."""

    def __init__(self, longest=LONGEST, most_retries=MOST_RETRIES):
        self.longest = longest
        self.most_retries = most_retries
        self.slowest = 0.0
        self.retries = []

    def attempt(self, folder, command):
        """(how the command ended, seconds), or (nothing, seconds of a processor that it had)."""
        start = time.monotonic()
        with subprocess.Popen([PROGRAM, *command], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as process:
            try:
                out, messages = process.communicate(timeout=self.longest)
                seconds = time.monotonic() - start
                self.slowest = max(self.slowest, seconds)
                return subprocess.CompletedProcess(command, process.returncode, out, messages), seconds
            except subprocess.TimeoutExpired:
                return None, processor_seconds(process)
            finally:
                process.kill()

    def run(self, folder, command):
        """How the command ended and the seconds it took. Throws AssertionError where it does not end in time."""
        done, seconds = self.attempt(folder, command)
        if done is None:
            had = f"{command} has not ended after {self.longest:.0f} s, {seconds:.1f} s of them on a processor"
            if seconds >= self.longest:
                raise AssertionError(had)
            print(f"{had}; it is tried once more", file=sys.stderr)
            self.retries.append(had)
            done, seconds = self.attempt(folder, command)
        if done is None:
            raise AssertionError(f"{command} does not end")
        if len(self.retries) > self.most_retries:
            raise AssertionError("\n".join(["too many commands do not end at the first try", *self.retries]))
        return done, seconds
