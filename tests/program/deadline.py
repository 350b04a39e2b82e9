"""Runs commands that must end in time, however busy the machine is."""

import os
import signal
import subprocess

from poesy_program import PROGRAM

LONGEST = 60 if os.environ.get("POESY_SANITIZE") else 10  # seconds of processor time
WAIT = 10  # limit of the wall-clock time in units of LONGEST, for commands that wait for ever


def run_in_time(folder, command):
    """How the command ended. Throws AssertionError where it does not end in time."""
    limited = ["prlimit", f"--cpu={LONGEST}:{LONGEST + 2}", PROGRAM, *command]
    try:
        done = subprocess.run(limited, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=WAIT * LONGEST,
                              check=False)
    except subprocess.TimeoutExpired as expired:
        raise AssertionError(f"{command} has not ended after {expired.timeout:.0f} s") from expired
    if done.returncode == -signal.SIGXCPU:
        raise AssertionError(f"{command} has not ended after {LONGEST} s of a processor")
    return done
