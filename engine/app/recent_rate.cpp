#include "engine/app/recent_rate.h"

namespace poesy::app {
namespace {

constexpr std::chrono::seconds kWindow{15};
constexpr std::chrono::milliseconds kSpacing{500};

}  // namespace

void RecentRate::add(Clock::time_point now, std::uint64_t done) {
  latest_ = {now, done};
  if (now - marks_.back().time < kSpacing) return;
  marks_.push_back(latest_);
  while (marks_[1].time <= now - kWindow) marks_.pop_front();
}

double RecentRate::per_second() const {
  const double seconds = std::chrono::duration<double>(latest_.time - marks_.front().time).count();
  return seconds > 0.0 ? static_cast<double>(latest_.done - marks_.front().done) / seconds : 0.0;
}

}  // namespace poesy::app
