"""A Slurm with one node on this machine for the duration of a test: munge, controller and node daemon with their own
key, ports and folder. It reads nothing of an installed configuration and starts no service.

    with Slurm() as slurm:
        job = slurm.submit("--array=1-3", "array.sbatch", "study.toml", cwd=folder)
        states = slurm.wait(job)        # {"1_1": ("COMPLETED", 0), ...}

Needs Debian's slurm-wlm and munge, and permission to create a process namespace: see enter_namespace.
"""

import collections
import os
import pathlib
import pwd
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

DAEMONS = ("munged", "slurmctld", "slurmd")
PATH = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin"])
ENTERED = "POESY_IN_PROCESS_NAMESPACE"
# When the first process of the namespace ends, the kernel ends all others, so no daemon or job outlives the test.
NAMESPACE = ["unshare", *(["--map-current-user"] if os.geteuid() != 0 else []), "--pid", "--fork", "--kill-child",
             "--mount-proc"]
CPUS = 2
CONFIGURATION = """\
ClusterName=poesy
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
# A job that goes back into the queue waits until its old credentials have expired.
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
# The node says that it has CPUS processors even where the machine has fewer.
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2,sched_min_interval=0,bf_interval=2
KillWait=5
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=test Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
ENDS = {"COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "DEADLINE", "BOOT_FAIL"}
Ended = collections.namedtuple("Ended", ["state", "exit_code"])


def why_not():
    """Why there can be no Slurm here; empty if there can."""
    missing = [name for name in (*DAEMONS, "sbatch") if shutil.which(name, path=PATH) is None]
    if missing:
        return f"{', '.join(missing)} not installed; on Debian: apt-get install slurm-wlm munge"
    entered = subprocess.run([*NAMESPACE, "true"], capture_output=True, text=True, check=False)
    return "" if entered.returncode == 0 else f"no namespace for processes: {entered.stderr.strip()}"


def enter_namespace():
    """Starts this program again as the first process of a namespace, and returns there. Precondition: not why_not()."""
    if ENTERED not in os.environ:
        os.environ[ENTERED] = "1"
        os.execvp(NAMESPACE[0], [*NAMESPACE, sys.executable, "-B", *sys.argv])


def free_ports(count):
    """That nobody listens on, all different."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()


class Slurm:
    """Context manager. Raises RuntimeError with the daemons' logs when the node does not come up."""

    def __enter__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm-"))
        self.folder.chmod(0o755)  # munged requires that everybody can reach its socket
        self.daemons = []
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": str(self.folder / "slurm.conf")}
        try:
            self._configure()
            self._start_munge()
            self._start("slurmctld", "-D", "-f", self.folder / "slurm.conf")
            self._start("slurmd", "-D", "-f", self.folder / "slurm.conf", "-N", self.host)
            self.wait_for(lambda: "idle" in self._output("sinfo", "--noheader", "--format=%T"), 60,
                          "the node is not idle")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(timeout=10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def submit(self, *arguments, cwd):
        """The job's number. arguments: those of sbatch, script included."""
        return int(self._checked("sbatch", "--parsable", *map(str, arguments), cwd=cwd).split(";")[0])

    def wait(self, job, seconds=600):
        """How the job, or each task of the array, ended: {"1" or "1_2": Ended}."""
        self.wait_for(lambda: all(ended.state in ENDS for ended in self.states(job).values()), seconds,
                      f"job {job} is not done")
        return self.states(job)

    def states(self, job):
        found = {}
        for line in self._show_job(job, "--oneliner").splitlines():
            facts = dict(re.findall(r"(\w+)=(\S+)", line))
            number = facts["JobId"] if "ArrayTaskId" not in facts else f"{facts['ArrayJobId']}_{facts['ArrayTaskId']}"
            found[number] = Ended(facts["JobState"], int(facts["ExitCode"].split(":")[0]))
        return found

    def cancel(self, job):
        self._checked("scancel", str(job))

    def restarts(self, job):
        """How often the job was put back into the queue."""
        return int(re.search(r"Restarts=(\d+)", self._show_job(job)).group(1))

    def _show_job(self, job, *options):
        """What scontrol says of a job. It dies of SIGPIPE where a busy controller hangs up on it; then it asks again."""
        for _ in range(4):
            try:
                return self._checked("scontrol", *options, "show", "job", str(job))
            except BrokenPipeError:
                time.sleep(1)
        return self._checked("scontrol", *options, "show", "job", str(job))

    def _configure(self):
        self.host = socket.gethostname().split(".")[0]
        controller_port, node_port = free_ports(2)
        configuration = CONFIGURATION.format(
            host=self.host, user=pwd.getpwuid(os.geteuid()).pw_name, controller_port=controller_port,
            node_port=node_port, folder=self.folder, cpus=CPUS)
        (self.folder / "slurm.conf").write_text(configuration, encoding="utf-8")
        for name in ("state", "spool"):
            (self.folder / name).mkdir()

    def _start_munge(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        files = [f"--{name}-file={self.folder}/munge.{name}" for name in ("key", "log", "pid", "seed")]
        self._start("munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket", *files)
        self.wait_for((self.folder / "munge.socket").exists, 20, "munged gives no socket")

    def _start(self, name, *arguments):
        with open(self.folder / f"{name}.log", "wb") as log:
            self.daemons.append(subprocess.Popen([name, *map(str, arguments)], env=self.environment, cwd=self.folder,
                                                 stdin=subprocess.DEVNULL, stdout=log, stderr=log))

    def _run(self, *command, cwd=None):
        return subprocess.run(command, env=self.environment, cwd=cwd, capture_output=True, text=True, timeout=60,
                              check=False)

    def _output(self, *command):
        return self._run(*command).stdout

    def _checked(self, *command, cwd=None):
        done = self._run(*command, cwd=cwd)
        if done.returncode == -signal.SIGPIPE:
            raise BrokenPipeError(" ".join(command))
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    def wait_for(self, condition, seconds, complaint):
        """Raises RuntimeError with the complaint and the logs when the time is over."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end or any(daemon.poll() is not None for daemon in self.daemons):
                raise RuntimeError(f"{complaint}\n{self._logs()}")
            time.sleep(0.2)

    def _logs(self):
        logs = [f"-- {path.name}\n{path.read_text(errors='replace')[-4000:]}" for path in self.folder.glob("*.log")]
        return "\n".join([*logs, self._output("sinfo", "--list-reasons"), self._output("squeue")])
