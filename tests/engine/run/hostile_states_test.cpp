#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/kinds/study_run.h"
#include "engine/run/checkpoints.h"
#include "engine/run/run_options.h"
#include "tests/support/small_studies.h"

/// States that were changed after a run wrote them. A run must refuse them or continue from them; sanitizers and
/// contracts report any other error.
namespace poesy {
namespace {

using States = std::vector<Bytes>;

/// Whether the run continues from these states.
bool accepted(const test::SmallStudy& small, const States& states) {
  Checkpoints checkpoints([] { return false; }, [](std::span<const ByteSource>) {}, states);
  try {
    run_study(small.study, *small.model, small.poses, {.threads = 1, .checkpoints = &checkpoints});
    return true;
  } catch (const BytesError&) {
    return false;
  } catch (const InputError&) {
    return true;  // the run continued, but no tolerances keep the limits
  }
}

/// The state with the bytes of `value` written from position `at` on.
Bytes with_real(Bytes state, std::size_t at, double value) {
  std::memcpy(&state.at(at), &value, std::min(sizeof value, state.size() - at));
  return state;
}

class HostileStates : public testing::TestWithParam<std::size_t> {
 protected:
  const test::SmallStudy& small() const { return test::small_studies()[GetParam()]; }
};

TEST_P(HostileStates, TakenOrRefused) {
  constexpr std::size_t kPlaces = 40;
  const std::vector<States> all = test::states_of(small());
  for (const States& moment : {all[all.size() / 2], all.back()}) {
    ASSERT_TRUE(accepted(small(), moment));
    for (std::size_t stage = 0; stage < moment.size(); ++stage) {
      States changed = moment;
      const Bytes& sound = moment[stage];
      for (std::size_t at = 0; at < sound.size(); at += 1 + sound.size() / kPlaces) {
        for (const double value : {kNaN, -1.0, 1e300}) {
          changed[stage] = with_real(sound, at, value);
          static_cast<void>(accepted(small(), changed));
        }
        changed[stage] = sound;
        changed[stage][at] ^= std::byte{1};
        static_cast<void>(accepted(small(), changed));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Small, HostileStates, testing::Range(std::size_t{0}, test::small_studies().size()),
                         [](const auto& one) {
                           std::string name = test::small_studies()[one.param].name;
                           std::erase(name, '_');
                           return name;
                         });

/// The position of the first real number in the state of a job. Before it are the job's name, its sizes, the range of
/// its units and the counts of how solves ended; see mean_squares.cpp, machine_loads.cpp and variations.cpp.
std::size_t first_real(const Bytes& state) {
  ByteReader from(state);
  const std::string job = from.text();
  const std::size_t sizes = job == "mean squares" ? 4 : 3;
  for (std::size_t k = 0; k < sizes + 2; ++k) from.number();
  read_state<SolveCounts>(from);
  if (job == "variations") from.number();
  return state.size() - from.left();
}

TEST(HostileStatesOfToleranceSearches, HaveNoImpossibleNumbers) {
  const auto small = std::ranges::find(test::small_studies(), "allocation", &test::SmallStudy::name);
  const States sound = test::states_of(*small).back();
  ASSERT_TRUE(accepted(*small, sound));
  std::set<std::string> tried;
  for (std::size_t stage = 0; stage < sound.size(); ++stage) {
    const std::size_t at = first_real(sound[stage]);
    if (at == sound[stage].size()) continue;
    tried.insert(ByteReader(sound[stage]).text());
    for (const double value : {kNaN, -1.0}) {
      States changed = sound;
      changed[stage] = with_real(sound[stage], at, value);
      EXPECT_FALSE(accepted(*small, changed)) << "stage " << stage << ", " << value;
    }
  }
  EXPECT_EQ(tried, (std::set<std::string>{"machine loads", "mean squares", "variations"}));
}

}  // namespace
}  // namespace poesy
