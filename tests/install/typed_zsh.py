"""An interactive zsh on a terminal of its own, into which a test types."""

import fcntl
import os
import pty
import select
import signal
import struct
import termios
import time

PATIENCE = 60  # s


class TypedZsh:
    def __init__(self, functions, programs, folder):
        """`functions`: a folder of completions; `programs`: a folder for PATH; `folder`: where it runs."""
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", ZDOTDIR=str(folder), PATH=f"{programs}:{os.environ['PATH']}")
            os.execlp("zsh", "zsh", "-f", "-i")
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 100, 200, 0, 0))
        self.said = ""
        self.type(f"fpath=({functions} $fpath); autoload -U compinit; compinit -u -D; echo rea''dy\n")
        self.wait_for("ready")

    def type(self, keys):
        self.said = ""
        os.write(self.terminal, keys.encode())

    def wait_for(self, text):
        deadline = time.monotonic() + PATIENCE
        while text not in self.said:
            if time.monotonic() > deadline:
                raise AssertionError(f"zsh did not say {text!r}, but {self.said!r}")
            if select.select([self.terminal], [], [], 0.1)[0]:
                self.said += os.read(self.terminal, 65536).decode(errors="replace")

    def close(self):
        os.close(self.terminal)
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
