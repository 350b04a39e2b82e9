#include "engine/kinds/sensitivity/cell_stats.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "engine/kinds/sensitivity/collector.h"
#include "tests/engine/kinds/study_kinds.h"

namespace poesy::sensitivity {
namespace {

using namespace test;

constexpr std::size_t kResponses = 2;
constexpr std::size_t kPoses = 3;
constexpr std::size_t kCells = 2 * kPoses;

/// The stored state of a cell's statistics, for comparisons bit by bit.
Bytes bits(UnitStats stats) {
  ByteWriter to;
  Archive archive(to);
  stats.state(archive, 0);
  return to.take();
}

/// A study of two errors at three poses, with all its units solved. Some samples fail.
struct Solved {
  explicit Solved(std::size_t samples) : prepared(study_of(&kStudy, samples)) {
    UnitEvaluator evaluate(plan(), *prepared.model);
    for (std::size_t u = 0; u < plan().units(); ++u) found.push_back(evaluate(plan().unit(u)));
  }

  const Plan& plan() const { return prepared.plan; }
  std::size_t cell_of(std::size_t u) const { return u / plan().units_per_cell(); }

  /// The units from first_unit to end_unit of a cell, merged one after the other.
  UnitStats one_by_one(std::size_t cell, std::size_t first_unit, std::size_t end_unit) const {
    UnitStats merged;
    merged.responses.resize(kResponses);
    for (std::size_t k = first_unit; k < end_unit; ++k) merged.merge(found[cell * plan().units_per_cell() + k]);
    return merged;
  }
  UnitStats one_by_one(std::size_t cell) const { return one_by_one(cell, 0, plan().units_per_cell()); }

  /// All cells, each with its units from first_unit to end_unit.
  CellStats cells(std::size_t first_unit, std::size_t end_unit) const {
    CellStats merged(kResponses, kCells);
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      for (std::size_t k = first_unit; k < end_unit; ++k) {
        merged.merge(cell, found[cell * plan().units_per_cell() + k]);
      }
    }
    return merged;
  }

  Collector collector(const Shard& shard = Shard()) const { return {plan(), kResponses, 0.95, shard}; }
  /// A collector that has all units of this shard.
  Collector collected(const Shard& shard = Shard()) const {
    Collector collect = collector(shard);
    for (std::size_t u = 0; u < plan().units(); ++u) {
      if (shard.of(kCells).holds(cell_of(u))) collect.add(plan().unit(u), found[u]);
    }
    return collect;
  }

  Prepared prepared;
  std::vector<CellUnit> found;  ///< [units] statistics of each unit
};

/// The stored state of a collector. samples: number of samples of the study.
Bytes state_of(Collector collect, std::size_t samples) {
  ByteWriter to;
  Archive archive(to);
  collect.state(archive, samples);
  return to.take();
}

/// Restores a collector from its stored states. samples: number of samples of the study.
void take_up(Collector& collect, const Bytes& states, std::size_t samples) {
  ByteReader from(states);
  Archive archive(from);
  while (archive.is_left()) collect.state(archive, samples);
}

void expect_units_one_by_one(const CellStats& cells, const Solved& solved) {
  ASSERT_EQ(cells.size(), kCells);
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    EXPECT_EQ(bits(cells.at(cell)), bits(solved.one_by_one(cell))) << cell;
  }
}

/// The message with which the collector refuses a stored state. Empty if it accepts the state.
std::string refusal(Collector collect, const Bytes& state, std::size_t samples) {
  try {
    take_up(collect, state, samples);
    return "";
  } catch (const BytesError& error) {
    return error.what();
  }
}

TEST(CellStats, BeginWithoutSamples) {
  EXPECT_EQ(CellStats().size(), 0U);
  const CellStats cells(kResponses, kCells);
  ASSERT_EQ(cells.size(), kCells);
  UnitStats none;
  none.responses.resize(kResponses);
  for (std::size_t cell = 0; cell < kCells; ++cell) EXPECT_EQ(bits(cells.at(cell)), bits(none));
}

TEST(CellStats, AreTheirUnitsMergedOneByOne) {
  const Solved solved(3300);
  const CellStats cells = solved.cells(0, 4);
  expect_units_one_by_one(cells, solved);
  EXPECT_FALSE(cells.at(0).failed.first().empty());  // the study has failed samples
}

TEST(CellStats, APartHasTheSameCells) {
  const CellStats cells = Solved(2300).cells(0, 3);
  for (const NumberRange range : {NumberRange{0, kCells}, {0, 1}, {2, 5}, {kCells - 1, kCells}, {3, 3}}) {
    const CellStats part = cells.part(range);
    ASSERT_EQ(part.size(), range.end - range.first);
    ASSERT_EQ(part.responses.size(), kResponses);
    for (std::size_t k = 0; k < part.size(); ++k) EXPECT_EQ(bits(part.at(k)), bits(cells.at(range.first + k)));
  }
}

TEST(CellStats, OfLaterSamplesAreMergedCellByCell) {
  const Solved solved(3300);
  for (std::size_t k = 0; k <= 4; ++k) {
    CellStats cells = solved.cells(0, k);
    cells.merge(solved.cells(k, 4));
    ASSERT_EQ(cells.size(), kCells);
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      UnitStats expected = solved.one_by_one(cell, 0, k);
      expected.merge(solved.one_by_one(cell, k, 4));
      EXPECT_EQ(bits(cells.at(cell)), bits(expected)) << k << " units of cell " << cell;
    }
    // If the merged part is a single unit, the result has the same bits as merging all units one after the other.
    if (k == 3) expect_units_one_by_one(cells, solved);
  }
}

/// Parameter: number of samples, so that a cell has whole units only, one smaller unit only, or both.
class Cells : public testing::TestWithParam<std::size_t> {};

TEST_P(Cells, HasTheUnitsOneByOne) {
  const Solved solved(GetParam());
  Collector collect = solved.collected();
  for (std::size_t slot = 0; slot < 2; ++slot) {
    const CellStats of_slot = collect.cells_of(slot);
    ASSERT_EQ(of_slot.size(), kPoses);
    for (std::size_t m = 0; m < kPoses; ++m) {
      EXPECT_EQ(bits(of_slot.at(m)), bits(solved.one_by_one(slot * kPoses + m)));
    }
  }
  expect_units_one_by_one(std::move(collect).cells(), solved);
}

TEST_P(Cells, GoesOnFromAStateAfterAnyUnit) {
  const Solved solved(GetParam());
  const Bytes end = state_of(solved.collected(), GetParam());
  Collector collect = solved.collector();
  for (std::size_t u = 0; u < solved.plan().units(); ++u) {
    collect.add(solved.plan().unit(u), solved.found[u]);
    const Bytes state = state_of(collect, GetParam());
    Collector resumed = solved.collector();
    take_up(resumed, state, GetParam());
    EXPECT_EQ(state_of(resumed, GetParam()), state) << u;
    for (std::size_t cell = 0; cell < kCells; ++cell) EXPECT_EQ(resumed.units_done(cell), collect.units_done(cell));
    EXPECT_EQ(resumed.total().total(), collect.total().total());
    for (std::size_t k = u + 1; k < solved.plan().units(); ++k) resumed.add(solved.plan().unit(k), solved.found[k]);
    EXPECT_EQ(state_of(resumed, GetParam()), end) << u;
    expect_units_one_by_one(std::move(resumed).cells(), solved);
  }
}

TEST_P(Cells, TakesUpTheStatesOfAllShards) {
  const Solved solved(GetParam());
  Bytes states;
  for (const std::size_t shard : {2UL, 0UL, 1UL}) {
    const Bytes state = state_of(solved.collected({shard, 3}), GetParam());
    states.insert(states.end(), state.begin(), state.end());
  }
  Collector whole = solved.collector();
  take_up(whole, states, GetParam());
  EXPECT_EQ(state_of(whole, GetParam()), state_of(solved.collected(), GetParam()));
  expect_units_one_by_one(std::move(whole).cells(), solved);
}

TEST_P(Cells, RefusesTheCellsOfAnotherShard) {
  const Solved solved(GetParam());
  for (std::size_t of = 0; of < 3; ++of) {
    for (std::size_t by = 0; by < 3; ++by) {
      EXPECT_EQ(refusal(solved.collector({by, 3}), state_of(solved.collected({of, 3}), GetParam()), GetParam()),
                of == by ? "" : "has a cell of another shard");
    }
  }
}

TEST_P(Cells, RefusesACellTwice) {
  const Solved solved(GetParam());
  Bytes state = state_of(solved.collected({1, 3}), GetParam());
  state.insert(state.end(), state.begin(), state.end());
  EXPECT_EQ(refusal(solved.collector(), state, GetParam()), "has a cell twice");
}

INSTANTIATE_TEST_SUITE_P(Samples, Cells, testing::Values(2 * Plan::kUnitSamples, 300, 2 * Plan::kUnitSamples + 300),
                         [](const auto& tested) { return "of_" + std::to_string(tested.param); });

TEST(SensitivityCollector, OfMoreSamplesLeavesTheSmallerUnitOut) {
  const Solved more(2 * Plan::kUnitSamples + 300);
  for (const std::size_t samples : {std::size_t{300}, Plan::kUnitSamples, Plan::kUnitSamples + 300}) {
    Collector collect = more.collector();
    take_up(collect, state_of(Solved(samples).collected(), samples), samples);
    const std::size_t whole = samples / Plan::kUnitSamples;
    for (std::size_t u = 0; u < more.plan().units(); ++u) {
      const std::size_t number = u % more.plan().units_per_cell();
      if (number == 0) {
        EXPECT_EQ(collect.units_done(more.cell_of(u)), whole);
      }
      if (number >= whole) collect.add(more.plan().unit(u), more.found[u]);
    }
    const std::size_t all = more.plan().samples();
    EXPECT_EQ(state_of(collect, all), state_of(more.collected(), all)) << samples;
  }
}

}  // namespace
}  // namespace poesy::sensitivity
