#include "engine/result/headline.h"

#include <algorithm>
#include <utility>

#include "engine/model/leading_response.h"

namespace poesy {
namespace {

double missed_share(const LimitVerdict& one) {
  return one.tried == 0 ? 0.0 : 1.0 - static_cast<double>(one.within) / static_cast<double>(one.tried);
}

/// The responses with limits. Those whose limits are missed most often come first.
std::vector<std::size_t> limited_responses(const StoredResult& result) {
  std::vector<std::size_t> list;
  if (!result.verdicts) return list;
  std::vector<LimitVerdict> limits = result.verdicts->limits;
  std::ranges::stable_sort(limits, std::ranges::greater(), missed_share);
  std::ranges::transform(limits, std::back_inserter(list), &LimitVerdict::response);
  return list;
}

}  // namespace

void order_headline(StoredResult& result) {
  std::vector<std::size_t> order = limited_responses(result);
  const std::size_t limited = order.size();
  for (const std::size_t r : result.headline) {
    if (std::ranges::find(order, r) == order.end()) order.push_back(r);
  }
  std::ranges::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(limited), order.end(), {},
                           [&](std::size_t r) { return leading_rank(result.responses[r].name); });
  result.headline = std::move(order);
}

}  // namespace poesy
