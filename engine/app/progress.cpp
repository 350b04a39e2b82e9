#include "engine/app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace poesy::app {
namespace {

constexpr std::chrono::milliseconds kLive{100};
constexpr std::chrono::seconds kPlain{5};

}  // namespace

ProgressPrinter::ProgressPrinter(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      next_(start_ + (terminal_ ? Clock::duration(kLive) : Clock::duration(kPlain))) {}

ProgressPrinter::~ProgressPrinter() { finish(); }

void ProgressPrinter::finish() {
  if (line_open_) std::fputs("\r\033[K", stderr);
  line_open_ = false;
}

void ProgressPrinter::operator()(const Progress& progress) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? Clock::duration(kLive) : Clock::duration(kPlain));
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const auto solves = static_cast<double>(progress.solves - progress.before);
  const auto left = static_cast<double>(progress.total - progress.solves);
  const std::string text =
      fmt::format("{:5.1f} % done, {:.3g} solves/s, {} not converged, {:.0f} s left",
                  100.0 * static_cast<double>(progress.solves) / static_cast<double>(progress.total), solves / seconds,
                  progress.not_converged, solves > 0.0 ? left * seconds / solves : 0.0);
  std::fputs((terminal_ ? "\r" + text + "\033[K" : text + "\n").c_str(), stderr);
  std::fflush(stderr);
  line_open_ = terminal_;
}

}  // namespace poesy::app
