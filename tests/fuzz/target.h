#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>

/// What a fuzz target is: a function that takes any bytes and never crashes, leaks or hangs. Linked with libFuzzer it
/// is a fuzzer, linked with replay.cpp a test over the files of corpus/ and crashes/.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace poesy::fuzz {

/// A file on a disk in memory, there as long as this object. (HDF5 wants a real path, which memfd_create gives not.)
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes) : descriptor_(::mkstemp(path_.data())) {
    if (descriptor_ < 0) throw std::runtime_error("no file in memory");
    for (auto rest = bytes; !rest.empty();) {
      const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
      if (written < 0) throw std::runtime_error("no room in memory");
      rest = rest.subspan(static_cast<std::size_t>(written));
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() {
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_ = "/dev/shm/poesy-fuzz-XXXXXX";
  int descriptor_;
};

/// Ends the program, which makes the input a finding, unless the condition holds.
inline void expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken expectation: %s\n", what);
  std::abort();
}

/// Number of accepted reads, over all inputs so far.
inline std::size_t accepted_reads = 0;

/// Whether read() gives something rather than an Error.
template <class Error, class Read>
bool accepted(const Read& read) {
  try {
    read();
    ++accepted_reads;
    return true;
  } catch (const Error& error) {
    expect(error.what()[0] != '\0', "an error says what is wrong");
    return false;
  }
}

}  // namespace poesy::fuzz
