"""Executes a notebook with this interpreter, whatever kernels are installed.

usage: notebook.py NOTEBOOK [OUTPUT]; exits with 77 if nbclient or ipykernel is missing
"""

import json
import os
import sys
import tempfile
from pathlib import Path

NOT_RUN = 77


def missing():
    """Which packages that this needs are absent."""
    absent = []
    for name in ("nbclient", "nbformat", "ipykernel"):
        try:
            __import__(name)
        except ImportError:
            absent.append(name)
    return absent


def executed(path):
    """The notebook with its outputs. Raises nbclient's CellExecutionError where a cell fails."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        kernel = Path(folder) / "kernels" / "this"
        kernel.mkdir(parents=True)
        argv = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        (kernel / "kernel.json").write_text(json.dumps({"argv": argv, "display_name": "this", "language": "python"}))
        os.environ["JUPYTER_PATH"] = folder
        os.environ.setdefault("IPYTHONDIR", folder)
        os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # otherwise the kernel warns about Python's own modules
        os.environ.pop("MPLBACKEND", None)  # so that figures are inline
        resources = {"metadata": {"path": folder}}
        nbclient.NotebookClient(notebook, timeout=300, kernel_name="this", resources=resources).execute()
    return notebook


def main(path, output=None):
    absent = missing()
    if absent:
        print(f"skipped: {', '.join(absent)} not installed (Debian's python3-nbclient python3-nbformat python3-ipykernel)")
        return NOT_RUN
    notebook = executed(path)
    if output:
        import nbformat

        nbformat.write(notebook, output)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    images = sum("image/png" in out.get("data", {}) for cell in cells for out in cell.outputs)
    print(f"{len(cells)} cells, {images} pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
