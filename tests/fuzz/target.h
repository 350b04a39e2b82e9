#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>

/// The fuzz target: a function that accepts any bytes and must never crash, leak or hang. Linked with libFuzzer it is a
/// fuzzer; linked with replay.cpp it is a test over the files in corpus/ and crashes/.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace poesy::fuzz {

/// A file in memory (/dev/shm) that exists as long as this object. (HDF5 needs a real path, which memfd_create does not
/// give.)
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

/// Aborts the program unless the condition holds, so that the fuzzer reports the input.
inline void expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken expectation: %s\n", what);
  std::abort();
}

/// Number of accepted reads over all inputs.
inline std::size_t accepted_reads = 0;

/// Whether read() returns without throwing an Error.
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
