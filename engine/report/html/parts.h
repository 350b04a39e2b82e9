#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/io/result_file.h"
#include "engine/report/display.h"
#include "engine/report/html/figures.h"
#include "engine/report/html/page.h"
#include "engine/report/table.h"

/// What the sections of all kinds of results share.
namespace poesy {

/// The names at these positions.
std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions);
/// The headline's responses, the one that ranks errors first (default_ranking).
std::vector<std::size_t> headline_order(const StoredResult& result);
/// The same, then all others.
std::vector<std::size_t> response_order(const StoredResult& result);

/// "mm/deg", for each of these responses and each of these errors.
std::vector<std::vector<std::string>> index_units(const StoredResult& result, std::span<const std::size_t> responses,
                                                  std::span<const std::size_t> factors);
/// "mm", for each of these responses.
std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses);
/// What a caption of bars says of the order of errors, whose units may be mixed.
std::string order_by_effect(bool mixed);
/// Whether not all have the same unit.
bool mixed_units(const std::vector<NamedUnit>& things);

/// Order statistics of a response over these samples (positions pose x samples + sample) that were solved, NaN of none.
std::vector<double> order_statistics(const EvaluationResult& found, std::size_t response, std::size_t first,
                                     std::size_t count, std::span<const double> levels);

/// The share of solves that did not converge; NaN where there is none.
double share_not_converged(const SolveCounts& solves);
/// The sum of these.
SolveCounts sum_of(std::span<const SolveCounts> solves);

/// Takes the tables of these names out of a list, in the order of the names.
std::vector<Table> take_tables(std::vector<Table>& tables, std::span<const std::string_view> names);

/// Which part of a result's cells goes into its figures, so that a report stays small.
struct ShownCells {
  /// Numbers of one figure: with more of them in all, responses that are not of the headline are left out, then poses.
  static constexpr std::size_t kMostWithAllResponses = 300'000;
  static constexpr std::size_t kMost = 600'000;         ///< Numbers that a page may hold.
  static constexpr std::size_t kMostInLayer = 400'000;  ///< Numbers that one layer may hold.

  std::vector<std::size_t> responses;  ///< positions
  std::vector<std::size_t> poses;      ///< ascending
  std::size_t all_responses = 0;       ///< of the result, shown or not
  std::size_t all_poses = 0;           ///< of the result, shown or not

  /// Of numbers at all poses, [rows x M], those at the poses that are shown.
  std::vector<double> at_poses(std::span<const double> values) const;
  /// Whether not every pose is shown.
  bool thinned() const { return poses.size() < all_poses; }
  /// What is left out, in a sentence; empty where nothing is.
  std::string note() const;
};

/// The part for all figures of a result.
ShownCells shown_cells(const StoredResult& result);

/// The poses' coordinates.
std::vector<Coordinate> pose_coordinates(const StoredResult& result, const ShownCells& shown, ArrayPool& pool);

/// By what the columns of a heat map may be ordered: the coordinates; on a trajectory the time.
std::vector<Coordinate> column_coordinates(const StoredResult& result, const ShownCells& shown, ArrayPool& pool);

/// The numbers of the poses where they are thinned; else none, for they count from 0.
ArrayName pose_numbers(const ShownCells& shown, ArrayPool& pool);

/// What curves over poses have as their x: the time on a trajectory, else the number of the pose.
Coordinate pose_axis(const StoredResult& result, const ShownCells& shown, ArrayPool& pool);

/// Adds a field of the shown poses, values: [M].
Field pose_field(const std::string& array, std::string label, std::string unit, std::span<const double> values,
                 const ShownCells& shown, ArrayPool& pool, double scale = 1.0);

/// The condition number of each pose, where the result has it.
std::vector<Field> condition_field(const StoredResult& result, const ShownCells& shown, ArrayPool& pool);

/// Adds a figure to a page and its place to a section.
void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption);

}  // namespace poesy
