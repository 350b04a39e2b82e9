#include "engine/app/progress.h"

#include <unistd.h>

#include <cstdio>

#include "engine/app/progress_line.h"
#include "engine/app/terminal.h"

namespace poesy::app {
namespace {

constexpr std::chrono::milliseconds kLive{100};
constexpr std::chrono::seconds kPlain{5};

/// Columns that a line may take. A line as wide as the terminal would wrap on some.
std::size_t room() {
  const std::size_t width = terminal_width(STDERR_FILENO);
  return (width != 0 ? width : kUsualWidth) - 1;
}

}  // namespace

ProgressPrinter::ProgressPrinter(bool quiet)
    : quiet_(quiet), live_(shows_live_lines(STDERR_FILENO)), next_(Clock::now() + interval()), rate_(Clock::now()) {}

ProgressPrinter::~ProgressPrinter() { finish(); }

ProgressPrinter::Clock::duration ProgressPrinter::interval() const {
  return live_ ? Clock::duration(kLive) : Clock::duration(kPlain);
}

void ProgressPrinter::finish() {
  if (line_open_) std::fputs("\r\033[K", stderr);
  line_open_ = false;
}

void ProgressPrinter::operator()(const Progress& progress) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const std::uint64_t done = progress.solves - progress.before;
  if (done < done_) {  // counted from the beginning again
    rate_ = RecentRate(now);
    ++stage_;
  }
  done_ = done;
  rate_.add(now, done);
  if (now < next_) return;
  next_ = now + interval();
  const ProgressFacts facts{progress, rate_.per_second(), stage_};
  std::fputs((live_ ? "\r" + live_line(facts, room()) + "\033[K" : plain_line(facts) + "\n").c_str(), stderr);
  std::fflush(stderr);
  line_open_ = live_;
}

}  // namespace poesy::app
