#include "engine/report/not_converged.h"

#include <charconv>

#include "engine/report/failure_share.h"
#include "engine/report/html/study_facts.h"

namespace poesy {

double max_not_converged(const StoredResult& result) {
  const std::string text = study_setting(result.study_text, "solver", "max_not_converged");
  double share = 1.0;
  std::from_chars(text.data(), text.data() + text.size(), share);
  return share;
}

bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves) {
  return static_cast<double>(failed) >
         unremarkable_failure_share(max_not_converged(result)) * static_cast<double>(solves);
}

}  // namespace poesy
