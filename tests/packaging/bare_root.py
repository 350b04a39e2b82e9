#!/usr/bin/env python3
"""Follows README.md like a new user, in a root that has only Debian's minimal base, ca-certificates and git.

    bare_root.py         the first command under "Start": it must build without a warning, succeed, print the ranked
                         table and the published ranking next to it, and write results and reports; it must not install
                         packages that only tests need
    bare_root.py test    the second command: all tests must pass
    bare_root.py python  the third command: the next step that it prints must rank the errors, the environment must pass
                         use_python.py, and a second run must include changes of the sources
    bare_root.py program python    the first command, then the third in the same root, which builds the program once

With --suite bookworm or --suite trixie the root has this release of Debian, otherwise the release of this machine. The
root is made by mmdebstrap from this machine's sources of Debian packages, with a clone of the commit that is checked
out here, at the same path as here, and is removed at the end. With --keep-build its build folder is moved to this
repository, if that has none, and ./quickstart here goes on with it. The script must be started as root. Only its own
processes see what it mounts.
"""

import argparse
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
CLONE = str(REPOSITORY).lstrip("/")  # path in the root: the same as here, so that a build there can go on here
BUILD = "build/release"
ERRORS = 25  # number of errors of the published study
MOST_PACKAGES = {"bookworm": 155, "trixie": 195}  # upper limits; 143 and 184 are needed
FOR_TESTS_ALONE = {"libgtest-dev", "libbenchmark-dev", "npm", "nodejs", "octave", "octave-dev", "chromium", "doxygen", "pandoc",
                   "python3-numpy", "gnuplot-nox", "zsh", "man-db", "help2man"}
FOR_PYTHON = {"python3-numpy"}  # those of FOR_TESTS_ALONE that Python needs
MOST_FOR_PYTHON = {"bookworm": 265, "trixie": 310}  # upper limits; 253 and 296 are needed
ENVIRONMENT = "build/python-venv"
RESULTS = ("build/2upr-rpu-platform.h5", "build/2upr-rpu-published.h5")
REPORTS = ("build/2upr-rpu-platform.html", "build/2upr-rpu-both.html")
HOSTS = "127.0.0.1 localhost\n::1 localhost\n"
# Folder of certificates that this machine trusts in addition to those of Debian; npm needs them.
CERTIFICATES = "usr/local/share/ca-certificates"
# Runs a command in new mount and process namespaces, so its mounts and processes end with it.
ENTER = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c",
         'mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" && mount -t sysfs sysfs "$1/sys" && '
         'root=$1 && shift && exec chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin '
         'NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt "$@"', "enter"]


class Fault(Exception):
    """What is wrong, in a sentence."""


class Clock:
    """Names phases of the work and tells how long each took."""

    def __init__(self):
        self.phases = []

    def begin(self, name):
        self.phases.append((name, time.monotonic()))

    def seconds(self):
        ends = [begin for _, begin in self.phases[1:]] + [time.monotonic()]
        return [(name, end - begin) for (name, begin), end in zip(self.phases, ends)]


def commands(readme):
    """The lines of the first code block under "## Start" that call quickstart, without their comments."""
    start = re.search(r"^## Start$(.*?)(?=^## |\Z)", readme, re.DOTALL | re.MULTILINE)
    block = start and re.search(r"^```[^\n]*\n(.*?)^```", start[1], re.DOTALL | re.MULTILINE)
    lines = [line.split("#")[0].strip() for line in block[1].splitlines()] if block else []
    if not lines or not lines[0].startswith("./quickstart"):
        raise Fault("README.md has no code block under '## Start' whose first line calls ./quickstart")
    return [line for line in lines if line.startswith("./quickstart")]


def command_of(readme, wanted):
    """The first command; with "test" or "python" the one that has this word."""
    found = commands(readme)
    if wanted:
        found = [command for command in found if command.split() == ["./quickstart", wanted]]
    if not found:
        raise Fault(f"README.md's code block under '## Start' does not have ./quickstart {wanted}")
    return found[0]


def debian_sources(files, codename):
    """Of the texts of apt's sources those that are Debian's own, as text for one file each kind: (lines, stanzas)."""
    suites = {codename, f"{codename}-updates", f"{codename}-security", f"{codename}/updates"}
    lines, stanzas = [], []
    for name, text in files.items():
        if name.endswith(".sources"):
            for stanza in re.split(r"\n\s*\n", text.strip()):
                named = re.search(r"^Suites:(.*)$", stanza, re.MULTILINE)
                if named and suites & set(named[1].split()):
                    stanzas.append(stanza + "\n")
        else:
            for line in text.splitlines():
                words = re.sub(r"\[[^]]*\]", "", line).split()
                if words[:1] == ["deb"] and len(words) > 2 and words[2] in suites:
                    lines.append(line + "\n")
    if not lines and not stanzas:
        raise Fault(f"apt on this machine has no source for Debian {codename}")
    return "".join(lines), "\n".join(stanzas)


def of_suite(sources, codename, suite):
    """Sources of one Debian release as those of another."""
    return re.sub(rf"\b{codename}\b", suite, sources)


def ranked_rows(output):
    """The rows of the ranked table as dicts by the words of its last heading line."""
    _, found, text = output.partition("== The errors that matter most")
    table = re.search(r"^( *rank .*)\n(?: *\[.*\n)?((?: *\d+ .*\n)+)", text, re.MULTILINE)
    if not found or not table:
        raise Fault("the ranked table is not there")
    heading = table[1].split()
    return [dict(zip(heading, row.split())) for row in table[2].splitlines()]


def check_table(output):
    """That all errors of the study stand there, the largest effect first, each with an interval."""
    rows = ranked_rows(output)
    names = {row.get("error", "") for row in rows}
    if len(rows) != ERRORS or len(names) != ERRORS:
        raise Fault(f"the ranked table has {len(rows)} rows and {len(names)} errors instead of {ERRORS}")
    strange = [name for name in names if not re.fullmatch(r"(delta|epsilon)_\d_\d_[xyz]", name)]
    if strange:
        raise Fault(f"the ranked table names what is not an error: {', '.join(strange)}")
    try:
        ranks = [int(row["rank"]) for row in rows]
        effects = [float(row["effect"]) for row in rows]
        intervals = [(float(row["low"]), float(row["high"])) for row in rows]
    except (KeyError, ValueError) as error:
        raise Fault(f"the ranked table lacks a column or a number: {error}") from error
    if ranks != list(range(1, ERRORS + 1)) or effects != sorted(effects, reverse=True):
        raise Fault("the ranked table is not in the order of the effects")
    if any(low > high for low, high in intervals):
        raise Fault("an interval of the ranked table has its ends exchanged")
    if rows[0]["error"] != "epsilon_1_1_x" or not 0.5 < effects[0] < 0.7:
        raise Fault(f"the first error is {rows[0]['error']} with {effects[0]} mm, not epsilon_1_1_x with 0.6 mm")


def check_comparison(output):
    """All errors are listed with the rank that each metric gives them, and how well the rankings agree."""
    _, found, text = output.partition("== The published ranking beside it")
    rows = [line.split() for line in text.splitlines() if re.match(r"(delta|epsilon)_\d_\d_[xyz] +\d", line)]
    tau = re.search(r"Kendall's tau of the two rankings is (-?[\d.]+),", text)
    if not found or not tau:
        raise Fault("the two rankings are not compared")
    if len(rows) != ERRORS or [int(row[1]) for row in rows] != list(range(1, ERRORS + 1)):
        raise Fault("the two rankings are not those of all errors, in the order of the first")
    if sorted(int(row[3]) for row in rows) != list(range(1, ERRORS + 1)) or not -1 <= float(tau[1]) < 0.8:
        raise Fault("the published ranking is not another one")


def check_packages(before, after, suite, python=False):
    """That little was installed, and nothing that only tests need."""
    unneeded = sorted((FOR_TESTS_ALONE - (FOR_PYTHON if python else set())) & after)
    most = (MOST_FOR_PYTHON if python else MOST_PACKAGES)[suite]
    if unneeded:
        raise Fault(f"packages of tests are installed for the program: {', '.join(unneeded)}")
    if len(after - before) > most:
        raise Fault(f"{len(after - before)} packages are installed; {most} are allowed")


def check_warnings(output):
    """That the compiler of this release warns of nothing."""
    found = re.findall(r"^\S+\.(?:h|cpp|cxx):\d+:\d+: warning: .*$", output, re.MULTILINE)
    if found:
        raise Fault(f"the compiler warns {len(found)} times, first: {found[0]}")


def check_tests(output):
    if not re.search(r"^100% tests passed, 0 tests failed out of [1-9]\d{2,}", output, re.MULTILINE):
        raise Fault("not all tests passed")


def next_step(output):
    """What ./quickstart python says to type next: the lines below its last heading, to the first empty one."""
    found = re.search(r"^== Next: .*\n((?:.+\n)+)", output, re.MULTILINE)
    if not found or f"{ENVIRONMENT}/bin/activate" not in found[1] or "import poesy" not in found[1]:
        raise Fault("./quickstart python does not say how to activate the environment and what to do then")
    return found[1]


def check_python_ranking(output):
    """That the errors of the published study are ranked, the one that matters most first."""
    rows = re.findall(r"^ *(\d+) +((?:delta|epsilon)_\d_\d_[xyz]) +([\d.]+) ", output, re.MULTILINE)
    if len(rows) < 20 or [int(rank) for rank, _, _ in rows] != list(range(1, len(rows) + 1)):
        raise Fault(f"Python prints {len(rows)} lines of a ranking, not the first 20")
    if rows[0][1] != "epsilon_1_1_x" or not 0.5 < float(rows[0][2]) < 0.7:
        raise Fault(f"Python's first error is {rows[0][1]} with {rows[0][2]} mm, not epsilon_1_1_x with 0.6 mm")


def installed(root):
    """Names of the packages in the root."""
    status = (root / "var/lib/dpkg/status").read_text(encoding="utf-8")
    return set(re.findall(r"^Package: (\S+)\nStatus: install ok installed$", status, re.MULTILINE))


def run(arguments, **options):
    done = subprocess.run(arguments, check=False, **options)
    if done.returncode != 0:
        raise Fault(f"{arguments[0]} ended with exit code {done.returncode}: {' '.join(map(str, arguments))}")


def own_suite():
    """The release of Debian that this machine has."""
    codename = re.search(r"^VERSION_CODENAME=(\w+)$", Path("/etc/os-release").read_text(encoding="utf-8"), re.MULTILINE)
    if not codename:
        raise Fault("/etc/os-release does not say which Debian this is")
    return codename[1]


def make_root(root, work, packages, suite=None):
    """Debian's minimal base with these packages too, from this machine's sources; of its own release, or of another."""
    codename = own_suite()
    places = [Path("/etc/apt/sources.list"), *sorted(Path("/etc/apt/sources.list.d").glob("*"))]
    texts = {str(place): place.read_text(encoding="utf-8") for place in places if place.is_file()}
    sources = []
    for name, text in zip(("debian.list", "debian.sources"), debian_sources(texts, codename)):
        if text:
            (work / name).write_text(of_suite(text, codename, suite or codename), encoding="utf-8")
            sources.append(work / name)
    run(["mmdebstrap", "--quiet", "--variant=minbase", f"--include={','.join(packages)}", suite or codename, root, *sources])
    shutil.copyfile("/etc/resolv.conf", root / "etc/resolv.conf")
    (root / "etc/hosts").write_text(HOSTS, encoding="utf-8")
    for certificate in Path("/", CERTIFICATES).glob("*.crt"):
        shutil.copy(certificate, root / CERTIFICATES)
    run([*ENTER, root, "update-ca-certificates"], stdout=subprocess.DEVNULL)


def clone(root, work, folder=CLONE):
    """The commit that is checked out here, without its history. git may distrust the owner of this repository."""
    (work / ".gitconfig").write_text("[safe]\n\tdirectory = *\n", encoding="utf-8")
    environment = os.environ | {"HOME": str(work), "GIT_CONFIG_NOSYSTEM": "1"}
    run(["git", "clone", "--quiet", "--depth", "1", f"file://{REPOSITORY}", root / folder], env=environment)
    run(["git", "-C", root / folder, "log", "--oneline", "--max-count=1"], env=environment)


def follow(root, command, clock, folder=CLONE):
    """Runs a command in a folder of the root, shows and returns what it prints; a phase begins with each line "== ..."."""
    lines = []
    with subprocess.Popen([*ENTER, root, "sh", "-c", f"cd {shlex.quote(f'/{folder}')} && {command}"], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, errors="replace") as process:
        try:
            for line in process.stdout:
                if line.startswith("== "):
                    clock.begin(line[3:].strip())
                print(line, end="", flush=True)
                lines.append(line)
        except BaseException:
            process.kill()
            raise
    if process.returncode != 0:
        raise Fault(f"{command} ended with exit code {process.returncode}")
    return "".join(lines)


def check_program(root, output):
    check_table(output)
    check_comparison(output)
    for name in (*RESULTS, *REPORTS):
        file = root / CLONE / name
        if not file.is_file() or file.stat().st_size == 0:
            raise Fault(f"{name} is missing or empty")
    for name in RESULTS:
        run([*ENTER, root, f"/{CLONE}/{BUILD}/bin/poesy", "verify", f"/{CLONE}/{name}"])


def check_python(root, command, output, clock):
    """What the command says, what the environment has, and that the command renews it."""
    print("== What ./quickstart python says to type next", flush=True)
    check_python_ranking(follow(root, next_step(output), clock))
    follow(root, f"echo '== The environment' && {ENVIRONMENT}/bin/python -B tests/packaging/use_python.py {ENVIRONMENT}", clock)
    package = root / CLONE / ENVIRONMENT / "lib/python3/dist-packages/poesy"
    (package / "_dropped.py").write_text("", encoding="utf-8")
    with (root / CLONE / "engine/python/poesy/__init__.py").open("a", encoding="utf-8") as file:
        file.write("\nchanged = True\n")
    clock.begin(f"{command}, again")
    follow(root, command, clock)
    follow(root, f"{ENVIRONMENT}/bin/python -c 'import poesy; assert poesy.changed'", clock)
    if (package / "_dropped.py").exists():
        raise Fault("./quickstart python leaves a module that is not in the sources")


def summary(clock, done, output):
    for command, count in done.items():
        print(f"\n{command} in a bare root: {count} packages installed", end="")
    print()
    for name, seconds in clock.seconds():
        print(f"{seconds:8.1f} s  {name[:100]}")
    if "== The errors that matter most" in output:
        print(output.partition("== The errors that matter most\n")[2].partition("\n== ")[0])


def obey(wanted, command, suite, root, before, clock):
    """Runs the command and judges what comes of it; gives the number of packages in the root that it needs, and what it says."""
    clock.begin(command)
    output = follow(root, command, clock)
    if wanted != "test":  # in tests, GCC 14 has false warnings about null pointers in Eigen and GoogleTest
        check_warnings(output)
    after = installed(root)
    if wanted == "test":
        check_tests(output)
    elif wanted == "python":
        check_packages(before, after, suite, python=True)
        check_python(root, command, output, clock)
    else:
        check_packages(before, after, suite)
        check_program(root, output)
    return len(after - before), output


def keep_build(root):
    """Moves the build folder, with the times of its files, to this repository and its owner, unless there is one."""
    mine = REPOSITORY / BUILD
    uncommitted = subprocess.run(["git", "-c", "safe.directory=*", "-C", REPOSITORY, "status", "--porcelain"], check=True,
                                 stdout=subprocess.PIPE).stdout
    if mine.exists() or uncommitted:
        print(f"\nThe build of the root is dropped: {f'{mine} exists' if mine.exists() else 'there are uncommitted changes'}")
        return
    mine.parent.mkdir(exist_ok=True)
    run(["mv", root / CLONE / BUILD, mine])
    run(["chown", "--recursive", f"--reference={REPOSITORY}", mine.parent])


def try_out(words, suite, kept, work):
    root, clock, done, outputs = work / "root", Clock(), {}, ""
    readme = (REPOSITORY / "README.md").read_text(encoding="utf-8")
    commands_to_try = {command_of(readme, wanted): wanted for wanted in words}
    clock.begin("making the root")
    make_root(root, work, ["ca-certificates", "git"], suite)
    before = installed(root)
    clock.begin("cloning")
    clone(root, work)
    for command, wanted in commands_to_try.items():
        done[command], output = obey(wanted, command, suite, root, before, clock)
        outputs += output
    if kept:
        keep_build(root)
    summary(clock, done, outputs)


def in_work_folder(prefix, function):
    """Calls it with a folder that goes at the end, also when the program is asked to end; a fault ends the program."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    work = Path(tempfile.mkdtemp(prefix=f"poesy-{prefix.replace('_', '-')}-"))
    work.chmod(0o755)
    try:
        function(work)
    except (Fault, OSError) as fault:
        sys.exit(f"{prefix}: {fault}")
    finally:
        shutil.rmtree(work)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", choices=["program", "test", "python"], default="program", metavar="COMMAND")
    parser.add_argument("--suite", choices=["bookworm", "trixie"])
    parser.add_argument("--keep-build", action="store_true")
    asked = parser.parse_args()
    if REPOSITORY.parts[1] in ("dev", "proc", "sys"):  # there ENTER mounts what this machine has
        parser.error(f"a clone at {REPOSITORY} would be hidden in the root")
    suite = asked.suite or own_suite()
    if asked.keep_build and suite != own_suite():
        parser.error(f"--keep-build: the compiler of {suite} is not that of this machine")
    words = asked.words if isinstance(asked.words, list) else [asked.words]
    in_work_folder("bare_root", lambda work: try_out(["" if word == "program" else word for word in words],
                                                     suite, asked.keep_build, work))


if __name__ == "__main__":
    main()
