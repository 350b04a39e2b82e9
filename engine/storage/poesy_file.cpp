#include "engine/storage/poesy_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/base/address_space.h"
#include "engine/base/plain_file.h"
#include "engine/storage/checkpoint.h"

namespace poesy {
namespace {

constexpr const char* kOther = "give a result file written by poesy";
/// A child process gets one more second of processor time for each kBytesASecond bytes of a file, and one more second
/// of wall time for each kBytesAWaitedSecond bytes. This is enough for a slow disk, and ten times as long as hashing
/// takes.
/// @{
constexpr std::uintmax_t kBytesASecond = std::uintmax_t{16} << 20U;
constexpr std::uintmax_t kBytesAWaitedSecond = std::uintmax_t{4} << 20U;
/// @}

bool is_checkpoint(const std::string& path) {
  const PlainFile file(path);
  return file.is_open() && begins_as_checkpoint(file).value_or(false);
}

h5::File open_hdf5(const std::string& path) {
  try {
    return h5::File::open(path);
  } catch (const h5::Error& error) {
    if (is_checkpoint(path)) {
      throw FileError(path, "is a checkpoint of a run that has not ended, not a result",
                      "continue the run with poesy run --resume");
    }
    if (path.ends_with(".toml")) {
      throw FileError(path, "is not a result", "if it is a study, run it (poesy run) and give its result");
    }
    throw FileError(path, std::string("is not an intact HDF5 file: ") + error.what(), kOther);
  }
}

/// The value of the attribute `filetype` of the root; empty if there is none, so that poesy did not write the file.
std::string filetype_of(const h5::File& file) {
  try {
    return file.has_attribute("/", "filetype") ? text_attribute(file, "filetype") : "";
  } catch (const h5::Error&) {
    return "";  // the attribute is not a text
  }
}

void check_version(const std::string& path, const h5::File& file) {
  const auto version = file.attribute<std::int64_t>("/", "version");
  if (version.size() != 2) throw h5::Error("attribute 'version' is not two numbers");
  if (version[0] == kMajorVersion) return;
  const bool newer = version[0] > kMajorVersion;
  throw FileError(path,
                  fmt::format("is of format version {}.{}, {} than this program's {}.{}", version[0], version[1],
                              newer ? "newer" : "older", kMajorVersion, kMinorVersion),
                  fmt::format("use the poesy that wrote it ({}){}", printable(text_attribute(file, "poesy_version")),
                              newer ? " or a newer one" : ", or run the study again"));
}

/// A file descriptor that is closed with the object.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

rlim_t stored_bytes(const std::string& path) {
  const PlainFile file(path);
  return file.is_open() ? file.stored_bytes() : 0;
}

/// Messages of a child process to its parent: kEndedWell if it succeeded, kNoMemory if it had too little memory. Any
/// other message is the text of a FileError.
constexpr std::string_view kEndedWell = "+";
constexpr std::string_view kNoMemory = "-";

[[noreturn]] void fail_to_start(const std::string& path, int reason) {
  throw FileError(path, "cannot be read: no process to try it in (" + std::generic_category().message(reason) + ")",
                  "try again when fewer processes run");
}

/// Lowers the soft limit of this process to `most`, and the hard limit to one more: at the hard limit on processor
/// time, the system kills the process even if it blocks signals.
void limit(int resource, rlim_t most) {
  rlimit limits{};
  ::getrlimit(resource, &limits);
  limits.rlim_cur = std::min(most, limits.rlim_cur);
  limits.rlim_max = std::min(most + 1, limits.rlim_max);
  ::setrlimit(resource, &limits);
}

/// Isolates the child process: it runs no signal handler of the parent, shows no output, and has limits on processor
/// time and memory.
void confine(rlim_t file_bytes) {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kTrialSeconds + file_bytes / kBytesASecond);
  if (const rlim_t had = address_space(); had > 0) limit(RLIMIT_AS, had + kTrialBytes + 16 * file_bytes);
}

void send(const Descriptor& to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::write(to.number(), text.data(), text.size());
    if (sent < 0) return;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// Does the work of the child process. The process ends without destructors and exit handlers, because those are for
/// the parent.
[[noreturn]] void live_as_child(const Descriptor& to, rlim_t file_bytes, const std::function<void()>& read) {
  confine(file_bytes);
  try {
    read();
    send(to, kEndedWell);
  } catch (const FileError& error) {
    send(to, error.what());
  } catch (const std::bad_alloc&) {
    send(to, kNoMemory);
  } catch (...) {
    // Sends nothing, which the parent takes as a crash.
  }
  ::_exit(0);
}

/// Reads a pipe until the other end is closed. Returns none if that takes longer than `seconds`, not counting time in
/// which this process is stopped.
std::optional<std::string> receive(const Descriptor& from, std::uintmax_t seconds) {
  constexpr std::uintmax_t kInASecond = 10;
  constexpr int kMilliseconds = 1000 / static_cast<int>(kInASecond);
  std::string text;
  std::array<char, 4096> part{};
  for (std::uintmax_t waited = 0; waited < seconds * kInASecond;) {
    pollfd pipe{.fd = from.number(), .events = POLLIN, .revents = 0};
    const int ready = ::poll(&pipe, 1, kMilliseconds);
    if (ready == 0 || (ready < 0 && errno != EINTR)) ++waited;
    if (ready <= 0) continue;
    const ssize_t bytes = ::read(from.number(), part.data(), part.size());
    if (bytes > 0) text.append(part.data(), static_cast<std::size_t>(bytes));
    if (bytes == 0 || (bytes < 0 && errno != EINTR)) return text;
  }
  return std::nullopt;
}

/// Waits for a child process and returns its wait status; 0 if it cannot be determined.
int status_of(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return 0;
  }
  return status;
}

/// Throws FileError if the memory limit of this process is below the memory that reading an intact file may take. The
/// failure of the child process then does not show that the file is damaged, because HDF5 may crash without memory.
void refuse_for_little_memory(const std::string& path, rlim_t file_bytes) {
  constexpr rlim_t kMega = 1'000'000;
  const rlim_t most = address_space() + kTrialBytes + 16 * file_bytes;
  if (most_address_space() >= most) return;
  throw FileError(path,
                  fmt::format("cannot be read for want of memory: {} MB are enough, and this process may have {} MB",
                              most / kMega + 1, most_address_space() / kMega),
                  "raise the limit (ulimit -v)");
}

}  // namespace

void trial_read(const std::string& path, const std::function<void()>& read, unsigned long wait_seconds) {
  const rlim_t file_bytes = stored_bytes(path);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail_to_start(path, errno);
  const Descriptor from_child(pipe[0]);
  Descriptor to_parent(pipe[1]);
  const pid_t child = ::fork();
  if (child < 0) fail_to_start(path, errno);
  if (child == 0) live_as_child(to_parent, file_bytes, read);
  to_parent.close();
  const std::uintmax_t seconds = wait_seconds + file_bytes / kBytesAWaitedSecond;
  const std::optional<std::string> said = receive(from_child, seconds);
  if (!said) ::kill(child, SIGKILL);
  const int status = status_of(child);
  if (!said) {
    throw FileError(
        path, fmt::format("cannot be read within {} s: it is damaged, or the machine or its disk is busy", seconds),
        "try again, or take another copy");
  }
  if (*said == kEndedWell) return;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
    throw FileError(path, "cannot be read: the process that read it was killed, as a system without memory does",
                    "end other programs, and try again");
  }
  if (!said->empty() && *said != kNoMemory) throw FileError("", *said, "");
  const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (!slow) refuse_for_little_memory(path, file_bytes);
  if (*said == kNoMemory)
    throw FileError(path, "is damaged: reading it takes more memory than a result", kDamagedRemedy);
  throw FileError(path, slow ? "is damaged: reading it does not end" : "is damaged: reading it crashes",
                  kDamagedRemedy);
}

std::string text_attribute(const h5::File& file, const std::string& name) {
  const auto values = file.attribute<std::string>("/", name);
  if (values.size() != 1) throw h5::Error("attribute '" + name + "' is not one text");
  return values.front();
}

bool is_out_of_memory(const std::exception& error) {
  // These are the texts of H5E_NOSPACE, and of the messages of H5MM_malloc and its callers.
  const std::string_view text = error.what();
  return text.find("memory allocation failed") != std::string_view::npos ||
         text.find("unable to allocate memory") != std::string_view::npos ||
         text.find("No space available for allocation") != std::string_view::npos;
}

void check_readable(const std::string& path) {
  const PlainFile file(path);
  if (!file.other().empty()) throw FileError(path, "is " + std::string(file.other()), kOther);
  if (!file.is_open()) {
    throw FileError(path, "cannot be read (" + std::generic_category().message(file.error()) + ")", kOther);
  }
}

h5::File open_poesy_file(const std::string& path) {
  h5::File file = open_hdf5(path);
  const std::string filetype = filetype_of(file);
  if (filetype != kResultFile && filetype != kShardFile) {
    throw FileError(path, "is an HDF5 file, but not a result of poesy", kOther);
  }
  check_version(path, file);
  try {
    file.expect_plain_tree();
  } catch (const h5::StrangeFile& strange) {
    throw FileError(path, printable(strange.what(), 300) + ", and a result is one tree that reads nothing but itself",
                    "do not trust it; take another copy, or run the study again");
  }
  return file;
}

void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype) {
  if (filetype_of(file) == filetype) return;
  if (filetype == kResultFile) {
    throw FileError(path, "is a shard of a study, not a whole result", "put all shards together with poesy merge");
  }
  throw FileError(path, "is a whole result, not a shard of one", "give files that poesy run --shard wrote");
}

std::string mechanism_text(const h5::File& file) {
  return file.exists("/mechanism/text") ? file.read<std::string>("/mechanism/text").at(0) : std::string();
}

}  // namespace poesy
