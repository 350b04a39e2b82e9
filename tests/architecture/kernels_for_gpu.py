#!/usr/bin/env python3
"""Compiles the unchanged kernels for a GPU (nvptx64), with numbers instead of packs: they must not need the host.

Usage: kernels_for_gpu.py ROOT    Exits with 77 if there is no clang++ that knows nvptx64.
"""

import re
import subprocess
import sys
from pathlib import Path

KERNELS = ("models/assembly/kernels.cpp", "models/chain/block_kernels.cpp", "models/three_prs/kernels.cpp")
SKIPPED = 77
# External functions that a GPU has too: square root, rounding, memory, allocation, and the throw if an allocation
# fails.
OF_A_DEVICE = re.compile(r"sqrt|nearbyint|mem(cpy|move|set)|_Znwm|_ZdlPv\w*|_ZSt\d+__throw_\w+|llvm\..*")
FUNCTION = re.compile(r"^declare .*?@\"?([\w.]+)", re.MULTILINE)
STATE = re.compile(r"^@\"?([\w.$]+)\"? = (?:[\w()]+ )*global ", re.MULTILINE)


def clang(*arguments, text=""):
    try:
        return subprocess.run(["clang++", *arguments], input=text, capture_output=True, text=True, timeout=280, check=False)
    except FileNotFoundError:
        return None


def include_folders():
    """The folders in which the host's clang++ looks for system headers."""
    said = clang("-E", "-x", "c++", "-", "-v").stderr
    return said.partition("#include <...> search starts here:")[2].partition("End of search list")[0].split()


def compiled(root, source, folders):
    """LLVM's text of a kernel compiled for the device, or None; and what the compiler says."""
    # The system headers are those of the host, so they need the macros of the host's word size and GNU functions.
    done = clang("--target=nvptx64-nvidia-cuda", "-std=c++20", "-O1", "-S", "-emit-llvm", "-o", "-", "-fno-exceptions",
                 "-fno-rtti", "-Wno-pass-failed", "-D_GNU_SOURCE", "-D__x86_64__", "-D__LP64__", f"-I{root}",
                 *(f"-isystem{folder}" for folder in folders), "-DPOESY_KERNEL_ISA=plain", "-DPOESY_KERNEL_OF_NUMBERS",
                 "-DPOESY_MOST_LANES=1", source)
    return (done.stdout if done.returncode == 0 else None), done.stderr


def problems(text):
    """text: LLVM's. What in it is of the host alone."""
    for name in FUNCTION.findall(text):
        if not OF_A_DEVICE.fullmatch(name):
            yield f"calls {name}, which a GPU does not have"
    for name in STATE.findall(text):
        yield f"has the global variable {name}"


def main(root):
    targets = clang("--print-targets")
    if targets is None or "nvptx64" not in targets.stdout:
        print("there is no clang++ that compiles for nvptx64")
        return SKIPPED
    folders = include_folders()
    found = False
    for kernel in KERNELS:
        text, said = compiled(root, str(Path(root) / kernel), folders)
        for problem in [said] if text is None else problems(text):
            found = True
            print(f"{kernel}: {problem}")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
