#include "engine/base/address_space.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace poesy {

std::uintmax_t address_space() {
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uintmax_t>(::sysconf(_SC_PAGESIZE));
}

std::uintmax_t most_address_space() {
  rlimit limits{};
  ::getrlimit(RLIMIT_AS, &limits);
  return limits.rlim_cur;
}

bool has_address_space(std::size_t bytes) {
  void* const room = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  ::munmap(room, bytes);
  return true;
}

void save_address_space() {
#ifdef M_ARENA_MAX
  if (most_address_space() != RLIM_INFINITY) ::mallopt(M_ARENA_MAX, 1);
#endif
}

void return_large_lists() {
#ifdef M_MMAP_THRESHOLD
  constexpr int kLarge = 4 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace poesy
