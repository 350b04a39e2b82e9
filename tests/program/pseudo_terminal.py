"""A terminal without a window: runs a program in it, and tells what a person would see (python3-pyte)."""

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time

try:
    import pyte
except ImportError:
    print("skipped: the Debian package python3-pyte is missing")
    sys.exit(77)

LINES = 200


class PseudoTerminal:
    """So many columns, in which `command` runs. Its stdout goes there too unless it is given elsewhere."""

    def __init__(self, command, columns, folder, environment=(), stdout=None):
        self.screen = pyte.Screen(columns, LINES)
        self.stream = pyte.ByteStream(self.screen)
        self.raw = b""
        self.master, slave = pty.openpty()
        self.resize(columns)
        self.process = subprocess.Popen(
            list(map(str, command)), cwd=folder, stdin=slave, stderr=slave, stdout=slave if stdout is None else stdout,
            env={**os.environ, "TERM": "xterm", "NO_COLOR": "", **dict(environment)}, start_new_session=True)
        os.close(slave)

    def resize(self, columns):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", LINES, columns, 0, 0))
        self.screen.resize(LINES, columns)

    def type(self, text):
        os.write(self.master, text.encode())

    def read(self, seconds):
        """What is written until so much time has passed or the program is gone: False at its end."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if not select.select([self.master], [], [], left)[0]:
                return True
            try:
                chunk = os.read(self.master, 65536)
            except OSError:  # the other end is closed
                chunk = b""
            if not chunk:
                return False
            self.raw += chunk
            self.stream.feed(chunk)
        return True

    def finish(self, timeout=300):
        """Reads to the end; the exit code."""
        end = time.monotonic() + timeout
        while self.read(1.0):
            if time.monotonic() > end:
                self.process.kill()
        return self.close()

    def close(self):
        code = self.process.wait(60)
        os.close(self.master)
        return code

    def rows(self):
        """The rows of the screen down to the last that shows anything."""
        rows = [row.rstrip() for row in self.screen.display]
        while rows and not rows[-1]:
            rows.pop()
        return rows
