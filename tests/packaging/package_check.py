#!/usr/bin/env python3
"""Makes the packages of a build and uses them in a root that has only Debian's minimal base.

    package_check.py BUILD                     BUILD is a build folder in which the program is built; with the option
                                               POESY_PYTHON_MODULE poesy_solver too, and python3-poesy is also made
    package_check.py BUILD --no-development    without libpoesy-dev and the project that is built with it
    package_check.py BUILD --portable BUILD2   the tarball is made from BUILD2, configured by the preset portable; it
                                               must run in the root before anything is installed

cpack makes the packages, and lintian must find no error in them. In the root, `apt-get install ./poesy_*.deb` is the
only preparation for the published study; its ranking must be the one that bare_root.py expects. Then these are used in
turn: libpoesy-dev, with which a project is built and run; the tarball; python3-poesy, which the system's Python uses as
in use_python.py; and the Python package as installed by pip (engine/python), with its notebook. At the end the packages
are removed and must leave nothing behind.

The script must be started as root and needs mmdebstrap, lintian and dpkg-dev. Only its own processes see what it
mounts.
"""

import argparse
import gzip
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from bare_root import (REPOSITORY, Clock, Fault, check_comparison, check_table, follow, in_work_folder, installed, make_root,
                       run)

HOME = "root"  # path in the root
# The root need not survive a loss of power; with force-unsafe-io dpkg is several times as fast.
APT = "DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 -o Dpkg::Options::=--force-unsafe-io"
EXAMPLES = "/usr/share/doc/poesy/examples/2upr-rpu-sensitivity"
MECHANISMS = "usr/share/poesy/mechanisms"
INSTALLED = ("usr/bin/poesy", "usr/share/man/man1/poesy.1.gz", "usr/share/bash-completion/completions/poesy",
             "usr/share/zsh/vendor-completions/_poesy", "usr/share/doc/poesy/copyright",
             "usr/share/doc/poesy/changelog.Debian.gz", "usr/share/doc/poesy/changelog.gz",
             "usr/share/doc/poesy/notices/plot.txt", f"{MECHANISMS}/3-rps/3-rps.toml")
PYTHON_PLACE = "usr/lib/python3/dist-packages"
INSTALLED_FOR_PYTHON = (f"{PYTHON_PLACE}/poesy/__init__.py", f"{PYTHON_PLACE}/poesy_solver.pyi",
                        "usr/share/doc/python3-poesy/copyright", "usr/share/doc/python3-poesy/changelog.Debian.gz",
                        "usr/share/doc/python3-poesy/notices/pybind11-dev.txt")
RESULTS = ("platform.h5", "published.h5")
REPORTS = ("platform.html", "both.html")
# The headings are those of ./quickstart, because bare_root.py finds the tables by them.
STUDY = f"""set -e
echo '== Running the published study'
poesy run {EXAMPLES}/platform.toml -o platform.h5 --quiet
poesy run {EXAMPLES}/study.toml -o published.h5 --quiet
echo '== The errors that matter most'
poesy show platform.h5
echo '== The published ranking beside it'
poesy show platform.h5 published.h5
echo '== Writing the reports'
poesy report platform.h5 -o platform.html
poesy report platform.h5 published.h5 -o both.html
poesy verify platform.h5
poesy verify published.h5
echo '== A study of the gallery'
poesy run /{MECHANISMS}/3-rps/study.toml -o gallery.h5 --quiet
poesy template /{MECHANISMS}/3-rps/3-rps.toml > template.toml
poesy check template.toml > checked.txt
bash -c '. /usr/share/bash-completion/completions/poesy && complete -p poesy'
"""
PYTHON_PACKAGES = ("python3-venv python3-setuptools python3-wheel python3-numpy python3-h5py python3-xarray "
                   "python3-matplotlib python3-nbformat python3-nbclient python3-nbconvert python3-ipykernel")


def as_owner(build, arguments, **options):
    """Runs a program as the owner of the build folder, so that no file in there becomes root's."""
    owner = build.stat()
    run(arguments, user=owner.st_uid, group=owner.st_gid, extra_groups=[],
        env={key: value for key, value in os.environ.items() if not key.startswith("SUDO_")} | {"HOME": "/tmp"}, **options)


def make_packages(build, generator, work):
    """The folder with the packages that cpack makes of a build."""
    folder = work / generator
    folder.mkdir()
    os.chown(folder, build.stat().st_uid, build.stat().st_gid)
    as_owner(build, ["cpack", "--config", build / "CPackConfig.cmake", "-G", generator, "-B", folder])
    return folder


def only_one(folder, pattern):
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        raise Fault(f"{len(found)} files are named {pattern}")
    return found[0]


def has_module(build):
    """Whether the build has the module for Python, and so cpack a package with it."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    return re.search(r"^POESY_PYTHON_MODULE:BOOL=(ON|TRUE|1|YES)$", cache, re.MULTILINE) is not None


def debian_packages(folder, python):
    """Program, libraries and, where it is wanted and only there, the package for Python (else None)."""
    names = ["poesy_*.deb", "libpoesy-dev_*.deb", *["python3-poesy_*.deb"] * python]
    found = [only_one(folder, name) for name in names]
    others = sorted(set(folder.glob("*.deb")) - set(found))
    if others:
        raise Fault(f"cpack also makes {others[0].name}")
    return found if python else [*found, None]


def check_python_depends(depends, version, files):
    """That the package for Python wants the program of its version, and only the Python that its module is compiled for."""
    modules = re.findall(r"/poesy_solver\.cpython-(\d)(\d+)-\S+\.so$", files, re.MULTILINE)
    if len(modules) != 1:
        raise Fault(f"python3-poesy has {len(modules)} compiled modules")
    major, minor = modules[0]
    for wanted in (f"poesy (= {version})", f"python3 (>= {major}.{minor}~)", f"python3 (<< {major}.{int(minor) + 1})"):
        if wanted not in depends.split(", "):
            raise Fault(f"python3-poesy does not depend on {wanted}, but on {depends}")


def look_into_python(package):
    def told(*words):
        return subprocess.run(["dpkg-deb", *words], check=True, text=True, stdout=subprocess.PIPE).stdout

    check_python_depends(told("--field", package, "Depends").strip(), told("--field", package, "Version").strip(),
                         told("--contents", package))


def check_lintian(packages):
    """That lintian finds no error; its warnings are shown."""
    done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", *packages], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout, end="", flush=True)
    if done.returncode != 0:
        raise Fault(f"lintian ended with exit code {done.returncode}")


def version_of(build):
    """The version that the build's CMake package has."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    found = re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(\S+)$", cache, re.MULTILINE)
    if not found:
        raise Fault(f"{build} is not a build folder of a project with a version")
    return found[1]


def check_present(root, names):
    for name in names:
        file = root / name
        if not file.is_file() or file.stat().st_size == 0:
            raise Fault(f"/{name} is missing or empty")


def check_files(root):
    """That everything is where Debian's tools look for it, and not empty."""
    check_present(root, INSTALLED)
    manual = gzip.decompress((root / "usr/share/man/man1/poesy.1.gz").read_bytes()).decode()
    if not re.search(r"^\.TH ", manual, re.MULTILINE):
        raise Fault("the manual page has no title")


def check_python_files(root):
    """The same for python3-poesy, and that it was compiled for the Python that is installed."""
    check_present(root, INSTALLED_FOR_PYTHON)
    if not list((root / PYTHON_PLACE / "poesy/__pycache__").glob("__init__.cpython-*.pyc")):
        raise Fault("installing python3-poesy does not compile the package")


def check_study(root, output):
    """The published ranking, and what the commands leave."""
    check_table(output)
    check_comparison(output)
    for name in (*RESULTS, *REPORTS, "gallery.h5", "template.toml", "checked.txt"):
        file = root / HOME / name
        if not file.is_file() or file.stat().st_size == 0:
            raise Fault(f"{name} is missing or empty")


def check_gallery(output, prefix):
    """That the program names the files of the gallery that is installed with it, and that these are there."""
    files = re.findall(r"^  (/\S+\.toml)$", output, re.MULTILINE)
    if len(files) < 6 or not all(file.startswith(f"{prefix}/share/poesy/mechanisms/") for file in files):
        raise Fault(f"poesy models names {len(files)} files of mechanisms, not the gallery in {prefix}/share")


def check_needs(text, wanted):
    """That the tarball says what it needs: glibc, the C++ library and, as wanted, shared libraries or "none"."""
    if not re.search(r"\(glibc\) 2\.\d+ or newer", text) or not re.search(r"GLIBCXX_3\.4\.\d+ and CXXABI_1\.3", text):
        raise Fault("README.txt of the tarball does not say which glibc or which C++ library it needs")
    named = re.search(r"very names:\n((?: {8}\S+\n)+)", text)
    if not named or not re.search(wanted, named[1]):
        raise Fault(f"README.txt of the tarball does not name {wanted} as what it needs")


def check_removed(root):
    """That nothing of the packages is left."""
    places = (*INSTALLED, "usr/share/poesy", "usr/share/doc/poesy", "usr/share/doc/libpoesy-dev", "usr/include/poesy",
              "usr/lib/cmake/poesy", "usr/share/doc/python3-poesy")
    left = [name for name in places if (root / name).exists()]
    left += [str(file.relative_to(root)) for file in sorted((root / PYTHON_PLACE).glob("poesy*"))]
    if left:
        raise Fault(f"removed packages leave /{left[0]}")


def use_program(root, package, clock):
    shutil.copy(package, root / HOME)
    follow(root, f"echo '== Installing {package.name}' && {APT} update && "
           f"{APT} install --yes --no-install-recommends ./{package.name}", clock, HOME)
    check_files(root)
    check_study(root, follow(root, STUDY, clock, HOME))
    check_gallery(follow(root, "poesy models", clock, HOME), "/usr")


def use_libraries(root, package, version, clock):
    shutil.copy(package, root / HOME)
    shutil.copytree(REPOSITORY / "tests/packaging/downstream", root / HOME / "downstream")
    follow(root, f"echo '== Installing {package.name}' && "
           f"{APT} install --yes --no-install-recommends ./{package.name} cmake make g++ && "
           "echo '== Building a project that uses the libraries' && "
           f"cmake -S downstream -B built -D CMAKE_BUILD_TYPE=Release -D POESY_EXPECTED_VERSION={version} && "
           "cmake --build built && ./built/downstream", clock, HOME)


def use_tarball(root, tarball, wanted, clock):
    """What the root has must be enough for the program in the tarball."""
    folder = tarball.name.removesuffix(".tar.gz")
    run(["tar", "--extract", "--gzip", "--no-same-owner", "--file", tarball, "--directory", root / HOME])
    check_needs((root / HOME / folder / "README.txt").read_text(encoding="utf-8"), wanted)
    prefix = f"/{HOME}/{folder}"
    check_gallery(follow(root, f"echo '== The tarball' && {prefix}/bin/poesy models && {prefix}/bin/poesy run "
                         f"{prefix}/share/poesy/mechanisms/3-rps/study.toml -o tarball.h5 --quiet && "
                         f"{prefix}/bin/poesy verify tarball.h5", clock, HOME), prefix)


def use_python_package(root, package, clock):
    """With what the package depends on, and without what it only recommends."""
    for file in (package, REPOSITORY / "tests/packaging/use_python.py"):
        shutil.copy(file, root / HOME)
    follow(root, f"echo '== Installing {package.name}' && "
           f"{APT} install --yes --no-install-recommends ./{package.name} && "
           "echo '== The Python package of the system' && /usr/bin/python3 use_python.py /usr", clock, HOME)
    check_python_files(root)


def use_python(root, clock):
    """Gives engine/python to tests/packaging/python_install.py, at their places in the tree."""
    script = Path("tests/packaging/python_install.py")
    tree = root / HOME / "tree"
    shutil.copytree(REPOSITORY / "engine/python", tree / "engine/python",
                    ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info", ".venv"))
    for file in (script, Path("tests/python/notebook.py")):
        (tree / file).parent.mkdir(parents=True)
        shutil.copy(REPOSITORY / file, tree / file)
    follow(root, f"echo '== Installing the packages that the Python package needs' && "
           f"{APT} install --yes --no-install-recommends {PYTHON_PACKAGES} && echo '== The Python package' && "
           f"python3 -B tree/{script} --program /usr/bin/poesy", clock, HOME)


def remove(root, clock):
    follow(root, f"echo '== Removing the packages' && {APT} purge --yes '^(lib|python3-)?poesy(-dev)?$'", clock, HOME)
    check_removed(root)


def summary(clock, count):
    print(f"\nPackages in a bare root: {count} more for the program")
    for name, seconds in clock.seconds():
        print(f"{seconds:8.1f} s  {name[:100]}")


def try_out(build, portable, development, work):
    root, clock = work / "root", Clock()
    clock.begin("making the packages")
    folder = make_packages(build, "DEB", work)
    program, libraries, python = debian_packages(folder, has_module(build))
    tarball = only_one(make_packages(portable or build, "TGZ", work), "poesy-*.tar.gz")
    clock.begin("lintian")
    check_lintian([package for package in (program, libraries, python) if package])
    if python:
        look_into_python(python)
    clock.begin("making the root")
    make_root(root, work, ["ca-certificates"])
    before = installed(root)
    if portable:
        use_tarball(root, tarball, "none", clock)
    use_program(root, program, clock)
    count = len(installed(root) - before)
    if not portable:
        use_tarball(root, tarball, "libhdf5", clock)
    if development:
        use_libraries(root, libraries, version_of(build), clock)
    if python:
        use_python_package(root, python, clock)
    use_python(root, clock)
    remove(root, clock)
    summary(clock, count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, metavar="BUILD")
    parser.add_argument("--no-development", action="store_true")
    parser.add_argument("--portable", type=Path, metavar="BUILD2")
    asked = parser.parse_args()
    in_work_folder("package_check", lambda work: try_out(asked.build.resolve(), asked.portable and asked.portable.resolve(),
                                                         not asked.no_development, work))


if __name__ == "__main__":
    main()
