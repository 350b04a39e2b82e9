#include "engine/files/trial_read.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/base/error.h"

namespace poesy {
namespace {

constexpr std::string_view kEndedWell = "+";  ///< all that such a child says; any other says what the FileError said

/// A file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() { close(); }

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

[[noreturn]] void fail_to_start(const std::string& path, int reason) {
  throw FileError(path, "cannot be read: no process to try it in (" + std::generic_category().message(reason) + ")",
                  "try again when fewer processes run");
}

/// A pipe from the child to its parent.
struct Pipe {
  explicit Pipe(const std::string& path) : Pipe(made(path)) {}

  Descriptor out;
  Descriptor in;

 private:
  explicit Pipe(std::array<int, 2> ends) : out(ends[0]), in(ends[1]) {}
  static std::array<int, 2> made(const std::string& path) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(path, errno);
    return ends;
  }
};

/// Lowers a limit of this process. Who passes it by one more is killed, whatever signals are blocked.
void limit(int resource, rlim_t most) {
  rlimit limits{};
  ::getrlimit(resource, &limits);
  limits.rlim_cur = std::min(most, limits.rlim_cur);
  limits.rlim_max = std::min(most + 1, limits.rlim_max);
  ::setrlimit(resource, &limits);
}

/// Bytes of address space that this process has, 0 where the system does not tell.
rlim_t address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// No handler of the parent runs in the child, nothing of it is seen, and it ends whatever happens.
void confine(rlim_t file_bytes) {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kTrialSeconds + file_bytes / (1U << 20U));
  if (const rlim_t had = address_space(); had > 0) limit(RLIMIT_AS, had + kTrialBytes + 16 * file_bytes);
}

void send(const Descriptor& to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::write(to.number(), text.data(), text.size());
    if (sent < 0) return;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// The child's whole life. It ends without destructors and without what is done at exit: both are the parent's.
[[noreturn]] void live_as_child(const Descriptor& to, rlim_t file_bytes, const std::function<void()>& read) {
  confine(file_bytes);
  try {
    read();
    send(to, kEndedWell);
  } catch (const FileError& error) {
    send(to, error.what());
  } catch (...) {
    // As good as a crash.
  }
  ::_exit(0);
}

/// What comes out of a pipe until its other end is closed.
std::string receive(const Descriptor& from) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t bytes = ::read(from.number(), part.data(), part.size());
    if (bytes > 0) text.append(part.data(), static_cast<std::size_t>(bytes));
    if (bytes == 0 || (bytes < 0 && errno != EINTR)) return text;
  }
}

/// The status of a child that ended; 0 where this process lets nobody know.
int status_of(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return 0;
  }
  return status;
}

}  // namespace

void trial_read(const std::string& path, const std::function<void()>& read) {
  std::error_code ignored;
  const auto file_bytes = static_cast<rlim_t>(std::filesystem::file_size(path, ignored));
  Pipe pipe(path);
  const pid_t child = ::fork();
  if (child < 0) fail_to_start(path, errno);
  if (child == 0) live_as_child(pipe.in, file_bytes, read);
  pipe.in.close();
  const std::string said = receive(pipe.out);
  const int status = status_of(child);
  if (said == kEndedWell) return;
  if (!said.empty()) throw FileError("", said, "");
  const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  throw FileError(path, slow ? "is damaged: reading it does not end" : "is damaged: reading it crashes",
                  kDamagedRemedy);
}

}  // namespace poesy
