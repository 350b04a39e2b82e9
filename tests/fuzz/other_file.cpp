#include "tests/fuzz/other_file.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstring>

namespace poesy::fuzz {

OtherFile::OtherFile() : path_(folder_.write("other", "what no input may make poesy read")) {
  events_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (::inotify_add_watch(events_, path_.c_str(), IN_ACCESS) < 0) {
    std::fputs("files cannot be watched here: reading another file will not be noticed\n", stderr);
  }
}

OtherFile::~OtherFile() {
  if (events_ >= 0) ::close(events_);
}

bool OtherFile::was_read() const {
  constexpr std::size_t kRoom = 4096;
  std::array<std::byte, kRoom> events{};
  bool found = false;
  for (ssize_t bytes = 0; (bytes = ::read(events_, events.data(), events.size())) > 0;) {
    inotify_event event{};
    for (std::size_t at = 0; at + sizeof event <= static_cast<std::size_t>(bytes); at += sizeof event + event.len) {
      std::memcpy(&event, events.data() + at, sizeof event);
      found = found || (event.mask & IN_ACCESS) != 0;
    }
  }
  return found;
}

const OtherFile& other_file() {
  static const OtherFile only;
  return only;
}

}  // namespace poesy::fuzz
