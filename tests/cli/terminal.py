"""A program that writes to a terminal."""
import os
import pty
import subprocess


def on_terminal(arguments, environment=None):
    """What it writes, both streams, and its exit code."""
    mine, theirs = pty.openpty()
    process = subprocess.Popen([str(argument) for argument in arguments], stdout=theirs, stderr=theirs, env=environment)
    os.close(theirs)
    text = b""
    while True:
        try:
            part = os.read(mine, 4096)
        except OSError:  # nobody writes any more
            break
        if not part:
            break
        text += part
    os.close(mine)
    return text.decode(), process.wait()
