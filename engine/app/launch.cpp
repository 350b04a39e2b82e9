#include "engine/app/launch.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace poesy::app {
namespace {

std::optional<std::size_t> number_in(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr) return std::nullopt;
  const std::string_view text = value;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<Launch> find_launch() {
  struct Variables {
    const char* rank;
    const char* size;
  };
  for (const auto& [rank_in, size_in] : {Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                         {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"},
                                         {"PMI_RANK", "PMI_SIZE"}}) {
    const auto rank = number_in(rank_in);
    const auto size = number_in(size_in);
    if (rank && size && *rank < *size) return Launch{*rank, *size};
  }
  return std::nullopt;
}

}  // namespace poesy::app
