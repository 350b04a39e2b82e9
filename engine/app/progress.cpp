#include "engine/app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/run/run_options.h"

namespace poesy::app {
namespace {

/// A duration in two units: "2 h 10 min". The small unit is left out if its count is zero. count: duration in the small
/// unit. per_large: number of small units in a large one.
std::string two_parts(double count, double per_large, const char* large, const char* small) {
  const double whole = std::floor(count / per_large);
  const double rest = count - whole * per_large;
  return rest > 0.0 ? fmt::format("{:.0f} {} {:.0f} {}", whole, large, rest, small)
                    : fmt::format("{:.0f} {}", whole, large);
}

constexpr std::chrono::seconds kWindow{15};
constexpr std::chrono::milliseconds kSpacing{500};

constexpr std::size_t kShortestBar = 4;
constexpr std::size_t kLongestBar = 60;
constexpr std::size_t kRoomForLeft = std::string_view("1 min 20 s left").size();
constexpr std::string_view kGap = "  ";

double share_done(const Progress& progress) {
  if (progress.total == 0) return 0.0;
  return std::min(1.0, static_cast<double>(progress.solves) / static_cast<double>(progress.total));
}

/// The percentage of solves that are done, rounded down so that 100 % appears only at the end.
double percent_done(const Progress& progress) { return std::floor(1000.0 * share_done(progress)) / 10.0; }

/// A rate with its unit: "720 samples/s", "7.21 M samples/s".
std::string rate_text(double rate) {
  constexpr std::array kPrefixes{"", "k ", "M ", "G "};
  std::size_t prefix = 0;
  while (rate >= 999.5 && prefix + 1 < kPrefixes.size()) {
    rate /= 1000.0;
    ++prefix;
  }
  return fmt::format("{:.3g} {}samples/s", rate, kPrefixes[prefix]);
}

/// The rate followed by a comma; empty as long as the rate is not known.
std::string rate_part(const ProgressFacts& facts) {
  return facts.rate > 0.0 ? rate_text(facts.rate) + ", " : std::string();
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
  const std::uint64_t of_design = progress.total - std::min(progress.solves, progress.total);
  const auto left = static_cast<double>(of_design + (facts.designs - facts.design) * progress.total);
  return readable_duration(std::max(1.0, std::ceil(left / facts.rate))) + " left";
}

std::string stage_text(const ProgressFacts& facts) {
  const std::string stage = facts.stage > 1 ? fmt::format("stage {}", facts.stage) : std::string();
  if (facts.designs == 0) return stage.empty() ? stage : stage + ": ";
  return fmt::format("design {} of {}{}{}: ", facts.design, facts.designs, stage.empty() ? "" : ", ", stage);
}

std::string bar(double share, std::size_t length) {
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(length));
  return "[" + std::string(filled, '#') + std::string(length - filled, '.') + "]";
}

/// The line, or an empty text if the line has more than `width` characters.
std::string within(std::size_t width, std::string line) {
  return line.size() <= width ? std::move(line) : std::string();
}

/// A line with the percentage, a bar, `details` (rate and number of failed solves) and the time left. The bar takes the
/// free columns, at most kLongestBar. A few columns stay free, because the text of the time left may become longer.
/// Empty if there is too little room.
std::string with_bar(const ProgressFacts& facts, const std::string& details, std::size_t width) {
  const std::string begin = stage_text(facts) + fmt::format("{:5.1f} % ", percent_done(facts.progress));
  const std::string left = left_text(facts);
  const std::size_t taken = begin.size() + 2 + details.size() + kGap.size() + std::max(kRoomForLeft, left.size());
  if (taken + kShortestBar > width) return {};
  return begin + bar(share_done(facts.progress), std::min(width - taken, kLongestBar)) + details + std::string(kGap) +
         left;
}

constexpr std::chrono::milliseconds kLive{100};
constexpr std::chrono::seconds kPlain{5};

/// The number of columns that a line may have. Some terminals wrap a line that is as wide as they are.
std::size_t room() {
  const std::size_t width = terminal_width(STDERR_FILENO);
  return (width != 0 ? width : kUsualWidth) - 1;
}

}  // namespace

double parse_duration(const std::string& text, const std::string& option) {
  constexpr std::string_view kRemedy = "give a time greater than zero with s, min or h, such as \"10 min\"";
  try {
    const Quantity quantity = parse_quantity(text);
    if (quantity.dimension == Dimension::time && quantity.si > 0.0) return quantity.si;
  } catch (const QuantityError&) {
    // Every text that is not a duration gets the same message.
  }
  throw InputError({}, option + " is '" + printable(text) + "'", kRemedy);
}

std::string readable_duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  const double tens = std::round(seconds / 10.0) * 10.0;
  if (tens < 600.0) return two_parts(tens, 60.0, "min", "s");
  const double minutes = std::round(seconds / 60.0);
  if (minutes < 60.0) return fmt::format("{:.0f} min", minutes);
  if (minutes < 1440.0) return two_parts(minutes, 60.0, "h", "min");
  return two_parts(std::round(seconds / 3600.0), 24.0, "d", "h");
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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

std::string plain_line(const ProgressFacts& facts) {
  return fmt::format("{}{:.1f} % done, {}{}, {}", stage_text(facts), percent_done(facts.progress), rate_part(facts),
                     failures_text(facts.progress), left_text(facts));
}

std::string live_line(const ProgressFacts& facts, std::size_t width) {
  const std::string rate = facts.rate > 0.0 ? fmt::format("{}{:>15}", kGap, rate_text(facts.rate)) : std::string();
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

std::string search_line(const PoseSearch& search) {
  return fmt::format("looking for poses: {} of {} found, {} candidates", search.found, search.wanted,
                     search.candidates);
}

std::string validation_line(std::size_t done, std::size_t designs) {
  return fmt::format("validating designs: {} of {} done", done, designs);
}

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet), live_(shows_live_lines(STDERR_FILENO)), next_(Clock::now() + interval()) {}

ProgressLine::Clock::duration ProgressLine::interval() const {
  return live_ ? Clock::duration(kLive) : Clock::duration(kPlain);
}

void ProgressLine::finish() {
  if (open_) std::fputs("\r\033[K", stderr);
  open_ = false;
}

bool ProgressLine::is_due(Clock::time_point now) {
  if (quiet_ || now < next_) return false;
  next_ = now + interval();
  return true;
}

void ProgressLine::write(const std::function<std::string()>& plain,
                         const std::function<std::string(std::size_t)>& live) {
  std::fputs((live_ ? "\r" + live(room()) + "\033[K" : plain() + "\n").c_str(), stderr);
  std::fflush(stderr);
  open_ = live_;
}

void ProgressPrinter::begin_design(std::size_t design, std::size_t designs) {
  rate_ = RecentRate(RecentRate::Clock::now());
  done_ = 0;
  stage_ = 1;
  design_ = design;
  designs_ = designs;
}

void ProgressPrinter::operator()(const Progress& progress) {
  const RecentRate::Clock::time_point now = RecentRate::Clock::now();
  const std::uint64_t done = progress.solves - progress.before;
  if (done < done_) {  // a new stage of the study began (a call of fold()); solves of a stage are counted from 0
    rate_ = RecentRate(now);
    ++stage_;
  }
  done_ = done;
  rate_.add(now, done);
  if (!line_.is_due(now)) return;
  const ProgressFacts facts{progress, rate_.per_second(), stage_, design_, designs_};
  line_.write([&] { return plain_line(facts); }, [&](std::size_t width) { return live_line(facts, width); });
}

}  // namespace poesy::app
