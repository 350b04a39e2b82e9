#include "engine/app/progress_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "engine/app/duration.h"

namespace poesy::app {
namespace {

constexpr std::size_t kShortestBar = 4;
constexpr std::size_t kLongestBar = 60;
constexpr std::size_t kRoomForLeft = std::string_view("1 min 20 s left").size();
constexpr std::string_view kGap = "  ";

double share_done(const Progress& progress) {
  if (progress.total == 0) return 0.0;
  return std::min(1.0, static_cast<double>(progress.solves) / static_cast<double>(progress.total));
}

/// Never 100 % before the end.
double percent_done(const Progress& progress) { return std::floor(1000.0 * share_done(progress)) / 10.0; }

/// "720 solves/s", "7.21 M solves/s"
std::string rate_text(double rate) {
  constexpr std::array kPrefixes{"", "k ", "M ", "G "};
  std::size_t prefix = 0;
  while (rate >= 999.5 && prefix + 1 < kPrefixes.size()) {
    rate /= 1000.0;
    ++prefix;
  }
  return fmt::format("{:.3g} {}solves/s", rate, kPrefixes[prefix]);
}

std::string count_text(const Progress& progress) { return fmt::format("{} not converged", progress.not_converged); }

std::string failures_text(const Progress& progress) {
  if (progress.not_converged == 0) return count_text(progress);
  return count_text(progress) + fmt::format(" ({:.2g} %)", 100.0 * static_cast<double>(progress.not_converged) /
                                                               static_cast<double>(progress.solves));
}

std::string left_text(const ProgressFacts& facts) {
  const Progress& progress = facts.progress;
  if (!(facts.rate > 0.0)) return "time left unknown";
  const auto left = static_cast<double>(progress.total - std::min(progress.solves, progress.total));
  return readable_duration(std::max(1.0, std::ceil(left / facts.rate))) + " left";
}

std::string stage_text(const ProgressFacts& facts) {
  return facts.stage > 1 ? fmt::format("stage {}: ", facts.stage) : std::string();
}

std::string bar(double share, std::size_t length) {
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(length));
  return "[" + std::string(filled, '#') + std::string(length - filled, '.') + "]";
}

/// Empty where the line is too long.
std::string within(std::size_t width, std::string line) {
  return line.size() <= width ? std::move(line) : std::string();
}

/// The share done, these details and, behind them, the time left, with a bar in the room that this leaves, also when
/// that time takes a few columns more. Empty where that is too little.
std::string with_bar(const ProgressFacts& facts, const std::string& details, std::size_t width) {
  const std::string begin = stage_text(facts) + fmt::format("{:5.1f} % ", percent_done(facts.progress));
  const std::string left = left_text(facts);
  const std::size_t taken = begin.size() + 2 + details.size() + kGap.size() + std::max(kRoomForLeft, left.size());
  if (taken + kShortestBar > width) return {};
  return begin + bar(share_done(facts.progress), std::min(width - taken, kLongestBar)) + details + std::string(kGap) +
         left;
}

}  // namespace

std::string plain_line(const ProgressFacts& facts) {
  return fmt::format("{}{:.1f} % done, {}, {}, {}", stage_text(facts), percent_done(facts.progress),
                     rate_text(facts.rate), failures_text(facts.progress), left_text(facts));
}

std::string live_line(const ProgressFacts& facts, std::size_t width) {
  const std::string rate = fmt::format("{}{:>15}", kGap, rate_text(facts.rate));
  const std::string count = std::string(kGap) + count_text(facts.progress);
  const std::string failures = std::string(kGap) + failures_text(facts.progress);
  const std::string left = left_text(facts);
  const std::string share = stage_text(facts) + fmt::format("{:.1f} %", percent_done(facts.progress));
  const std::array from_most_to_least{with_bar(facts, rate + failures, width),
                                      within(width, plain_line(facts)),
                                      with_bar(facts, rate + count, width),
                                      with_bar(facts, rate, width),
                                      with_bar(facts, {}, width),
                                      within(width, share + ", " + left),
                                      within(width, share)};
  const auto fits = std::ranges::find_if(from_most_to_least, [](const std::string& line) { return !line.empty(); });
  return fits != from_most_to_least.end() ? *fits : std::string();
}

}  // namespace poesy::app
