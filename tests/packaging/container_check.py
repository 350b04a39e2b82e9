#!/usr/bin/env python3
"""Follows engine/packaging/container/Containerfile without a container engine, and uses the result.

Each FROM becomes a root that mmdebstrap makes of the image's Debian release, without the documents that slim images
omit. RUN, COPY, WORKDIR, ENV and ENTRYPOINT are executed there as an engine would. The context is the commit that is
checked out here, with a developer's build folder, which .dockerignore must exclude. In the last root a user without
privileges starts the entry point with the arguments of README.md's `podman run`, in the folder that it mounts.

The script must be started as root and needs mmdebstrap. Only its own processes see what it mounts.
"""

import json
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

from bare_root import ENTER, REPOSITORY, Clock, Fault, clone, follow, in_work_folder, installed, make_root, run

CONTAINERFILE = "engine/packaging/container/Containerfile"
SUITES = {"docker.io/library/debian:12-slim": "bookworm", "docker.io/library/debian:13-slim": "trixie"}
# The dpkg settings of Debian's slim images, as set by debuerreotype, which makes these images.
SLIM = "".join(f"path-exclude /usr/share/{name}\n" for name in ("doc/*", "groff/*", "info/*", "lintian/overrides/*", "locale/*",
                                                                "man/*")) + "path-include /usr/share/doc/*/copyright\n"
USER = 12345  # a user id that no file in the root mentions
STUDY = """format = "poesy-study"
version = 1
mechanism = { model = "3-prs" }
poses = { count = 4 }
errors.linear = { distribution = "normal", sigma = "0.05 mm" }
errors.angular = { distribution = "normal", sigma = "0.02 deg" }
analysis = { kind = "sensitivity", samples = 200 }
"""
NOTICES = ("usr/share/doc/poesy/copyright", "usr/share/doc/poesy/notices/plot.txt", "usr/share/doc/poesy/notices/libeigen3-dev.txt")


@dataclass
class Stage:
    """One FROM with the steps below it."""

    suite: str
    name: str
    steps: list = field(default_factory=list)  # pairs (instruction, its text)


@dataclass
class Place:
    """Where a stage is: its root, the folder of its steps, its environment and its entry point."""

    root: Path
    folder: str = "/"
    environment: dict = field(default_factory=dict)
    entry: list = field(default_factory=list)

    def path(self, name):
        """A path of the stage as a path of this machine."""
        return self.root / str(Path(self.folder, name)).lstrip("/")


def stages(text):
    """The stages of a Containerfile."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    found = []
    for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines():
        instruction, _, rest = line.partition(" ")
        if instruction == "FROM":
            image, _, name = rest.partition(" AS ")
            if image not in SUITES:
                raise Fault(f"it is not known which Debian {image} is")
            found.append(Stage(SUITES[image], name))
        elif instruction not in ("RUN", "COPY", "WORKDIR", "ENV", "ENTRYPOINT"):
            raise Fault(f"the check does not know {instruction}")
        elif not found:
            raise Fault(f"{instruction} comes before FROM")
        else:
            found[-1].steps.append((instruction, rest.strip()))
    if not found or [name for name, _ in found[-1].steps].count("ENTRYPOINT") != 1:
        raise Fault("the last stage does not have one ENTRYPOINT")
    return found


def ignored(text):
    """Names in the context's top folder that .dockerignore leaves out."""
    names = {line.rstrip("/") for line in text.splitlines() if line and not line.startswith("#")}
    if any(not re.fullmatch(r"\.?\w[\w.-]*", name) for name in names):
        raise Fault("the check knows only plain names in .dockerignore")
    return names


def copy(text, place, context, places):
    """COPY: files, or what is in a folder, from the context or from a stage that is done."""
    words = shlex.split(text)
    options = [word for word in words if word.startswith("--")]
    *sources, target = [word for word in words if not word.startswith("--")]
    origin, left_out = context, ignored((context / ".dockerignore").read_text(encoding="utf-8"))
    for option in options:
        name = option.removeprefix("--from=")
        if name not in places:
            raise Fault(f"COPY {option} names no stage that is done")
        origin, left_out = places[name].root, set()
    for source in sources:
        files = sorted(origin.glob(source.lstrip("/"))) if source != "." else [origin]
        if not files:
            raise Fault(f"COPY {text}: there is no {source}")
        for file in files:
            copy_one(file, place.path(target), origin, left_out, target.endswith("/"))


def copy_one(file, target, origin, left_out, into_folder):
    if file.is_dir():
        shutil.copytree(file, target, symlinks=True, dirs_exist_ok=True,
                        ignore=lambda folder, names: left_out & set(names) if Path(folder) == origin else ())
        return
    if into_folder:
        target.mkdir(parents=True, exist_ok=True)
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(file, target)


def step(instruction, text, place, context, places, clock):
    if instruction == "RUN":
        values = "".join(f"export {name}={shlex.quote(value)}; " for name, value in place.environment.items())
        clock.begin(f"RUN {text}")
        follow(place.root, f"{values}{text}", clock, place.folder.lstrip("/"))
    elif instruction == "COPY":
        copy(text, place, context, places)
    elif instruction == "WORKDIR":
        place.folder = str(Path(place.folder, text))
        place.path(".").mkdir(parents=True, exist_ok=True)
    elif instruction == "ENV":
        place.environment |= dict(word.split("=", 1) for word in shlex.split(text))
    else:
        place.entry = entry_point(text)


def entry_point(text):
    try:
        words = json.loads(text)
    except ValueError:
        words = None
    if not isinstance(words, list) or not words or not all(isinstance(word, str) for word in words):
        raise Fault(f'ENTRYPOINT is not a list of words such as ["poesy"], but {text}')
    return words


def commands(readme, folder):
    """The arguments of README.md's `podman run`, whose words must be those of the Containerfile."""
    build = re.search(r"^podman build -t (\S+) -f (\S+) \.(?: .*)?$", readme, re.MULTILINE)
    start = re.search(r'^podman run --rm -v "\$PWD:(\S+)" (\S+) ([^#\n]*)', readme, re.MULTILINE)
    if not build or not start:
        raise Fault("README.md does not say how to build and run the image with podman")
    if build[2] != CONTAINERFILE:
        raise Fault(f"README.md builds {build[2]}, not {CONTAINERFILE}")
    if start[1] != folder or start[2] != build[1]:
        raise Fault(f"README.md starts {start[2]} in {start[1]}, not {build[1]} in {folder}")
    return start[3].split()


def build_all(text, context, work, clock):
    """Does all steps of all stages; gives the place of the last one."""
    places, place = {}, None
    for number, stage in enumerate(stages(text)):
        place = Place(work / f"stage{number}")
        base = work / stage.suite
        if not base.exists():
            clock.begin(f"making a root of {stage.suite}")
            make_root(base, work, ["ca-certificates"], stage.suite)
            (base / "etc/dpkg/dpkg.cfg.d/docker").write_text(SLIM, encoding="utf-8")
        run(["cp", "--archive", "--reflink=auto", base, place.root])
        for instruction, rest in stage.steps:
            print(f"== {instruction} {rest}", flush=True)
            step(instruction, rest, place, context, places, clock)
        places[stage.name] = place
    return place


def start(place, arguments):
    """What the entry point prints for a user without rights, who has nothing but the folder that is mounted."""
    words = [*place.entry, *arguments]
    done = subprocess.run(
        [*ENTER, place.root, "setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "--no-new-privs", "env", "-i",
         "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
         *(f"{name}={value}" for name, value in place.environment.items()),
         "sh", "-c", 'cd "$0" && exec "$@"', place.folder, *words], check=False, text=True, stdout=subprocess.PIPE)
    print(done.stdout, end="", flush=True)
    if done.returncode != 0:
        raise Fault(f"{' '.join(words)} ended with exit code {done.returncode}")
    return done.stdout


def check_version(printed, commit):
    if not re.match(rf"poesy \d+\.\d+\.\d+ \({commit}\)", printed):
        raise Fault(f"the image does not have poesy of commit {commit}, but: {printed.partition(chr(10))[0]}")


def check_image(root):
    """That the notices are there, and what only building needs is not."""
    for name in NOTICES:
        if not (root / name).is_file():
            raise Fault(f"/{name} is missing")
    for_building = sorted({"g++", "cmake", "git", "libeigen3-dev"} & installed(root))
    if for_building:
        raise Fault(f"what only building needs is in the image: {', '.join(for_building)}")


def use(place, arguments, clock):
    clock.begin("using the image")
    folder = place.path(".")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    for path in (folder, folder / "study.toml"):
        shutil.chown(path, USER, USER)
    commit = subprocess.run(["git", "-c", "safe.directory=*", "-C", REPOSITORY, "rev-parse", "HEAD"], check=True, text=True,
                            stdout=subprocess.PIPE).stdout.strip()
    check_version(start(place, ["--version"]), commit)
    start(place, arguments)
    result = folder / "study.h5"
    if not result.is_file() or result.stat().st_uid != USER:
        raise Fault("the study leaves no study.h5 that belongs to who ran it")
    start(place, ["verify", "study.h5"])
    check_image(place.root)


def try_out(work):
    clock = Clock()
    clock.begin("cloning")
    clone(work, work, "context")
    context = work / "context"
    (context / "build/release").mkdir(parents=True)
    (context / "build/release/CMakeCache.txt").write_text("# of another machine\n", encoding="utf-8")
    place = build_all((context / CONTAINERFILE).read_text(encoding="utf-8"), context, work, clock)
    use(place, commands((context / "README.md").read_text(encoding="utf-8"), place.folder), clock)
    size = subprocess.run(["du", "-sxm", place.root], check=True, text=True, stdout=subprocess.PIPE).stdout.split()[0]
    print(f"\n{CONTAINERFILE} in bare roots: {size} MB")
    for name, seconds in clock.seconds():
        print(f"{seconds:8.1f} s  {name[:100]}")


def main():
    if sys.argv[1:]:
        sys.exit(__doc__)
    in_work_folder("container_check", try_out)


if __name__ == "__main__":
    main()
