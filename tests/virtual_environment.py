"""Virtual environments of the checks that compare with other programs."""

import os
import subprocess
import sys


def python_of(folder, requirements):
    """The Python of the environment in `folder`, which has what the file `requirements` lists. It is made anew where the list changed."""
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    installed, wanted = folder / "requirements.txt", requirements.read_text()
    if not installed.exists() or installed.read_text() != wanted:
        subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", requirements], check=True)
        installed.write_text(wanted)
    return python
