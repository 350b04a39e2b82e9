#include "engine/app/facts.h"

#include <fmt/chrono.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>
#include <string>

namespace poesy::app {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string("unknown");
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves) {
  RunFacts facts;
  facts.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  facts.host = host_name();
  facts.cpu = cpu_name();
  facts.threads = threads;
  facts.wall_seconds = wall_seconds;
  facts.solves = solves;
  return facts;
}

}  // namespace poesy::app
