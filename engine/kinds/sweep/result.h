#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/nan.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"

namespace poesy::axis {

using Design = Axis<"design">;      ///< Designs of a sweep; each is one study.
using SweptKey = Axis<"key">;       ///< Keys that differ between designs.
using Quantity = Axis<"quantity">;  ///< Figures of merit by which designs are compared.

}  // namespace poesy::axis

namespace poesy::sweep {

/// The result of a sweep: figures of merit of several designs of a study. Figures of merit are in display units, such
/// as mm.
struct Result {
  using Numbers = Array<double, axis::Quantity, axis::Design>;  ///< a number for each figure of merit and design

  std::string kind;                                        ///< kind of the studies
  std::string response;                                    ///< response that the figures of merit are about
  std::vector<std::string> keys;                           ///< full names of the keys that differ between designs
  Array<std::string, axis::Design, axis::SweptKey> value;  ///< value of each key, as the study states it
  /// Value as a number, in `unit`; NaN for a text, or if its unit differs from that of the first design.
  Array<double, axis::Design, axis::SweptKey> number;
  Array<std::string, axis::SweptKey> unit;          ///< unit of `number` for each key; empty if it has none
  Array<std::string, axis::Design> content_sha256;  ///< content hash of the result of a run of this design alone
  Array<std::string, axis::Design> verdict;         ///< verdict on the limits: "kept", "not kept",
                                                    ///< "undecided"; "none" without limits
  std::vector<SolveCounts> solves;                  ///< [designs] how the solves of the design ended
  /// Share of the workspace's poses that the design leaves out (left_out_share()); and 1 if the design has the poses of
  /// the first one, otherwise 0. Empty in files of version 0.2.
  /// @{
  Array<double, axis::Design> left_out;
  Array<std::uint8_t, axis::Design> has_first_poses;
  /// @}

  std::vector<std::string> quantities;  ///< names of the figures of merit, such as "yield"
  /// Unit of each figure of merit, such as "%" or "mm"; empty if it has none.
  Array<std::string, axis::Quantity> quantity_unit;
  Array<std::uint8_t, axis::Quantity> most_is_best;  ///< 1 if a larger value is better, otherwise 0
  /// 1 if all designs judge the same machines, so that intervals of changes are computed from pairs of verdicts on the
  /// same machine; otherwise 0.
  Array<std::uint8_t, axis::Quantity> is_paired;
  Numbers merit;        ///< figures of merit
  Numbers low;          ///< lower ends of the intervals of the figures of merit; NaN without an interval
  Numbers high;         ///< upper ends of the intervals of the figures of merit
  Numbers change;       ///< figure of merit minus that of the first design; NaN for the first design
  Numbers change_low;   ///< lower ends of the intervals of changes
  Numbers change_high;  ///< upper ends of the intervals of changes
  /// Figure of merit minus that of the best design (best_design()); NaN for the best design. Each interval of these
  /// changes has the confidence level on its own, and does not take into account that the best design was chosen by the
  /// same numbers.
  Numbers from_best;
  Numbers from_best_low;   ///< lower ends of the intervals of `from_best`
  Numbers from_best_high;  ///< upper ends of the intervals of `from_best`
  /// Number of machines that are good in this design and rejected in the first one; 0 if yields are not paired.
  /// `gained`, `lost` and `machines` are empty unless the first design has a yield of machines.
  Array<std::uint64_t, axis::Design> gained;
  Array<std::uint64_t, axis::Design> lost;      ///< number of machines that are rejected in this design and good in the
                                                ///< first one
  Array<std::uint64_t, axis::Design> machines;  ///< number of machines in each design
  double conf_level = kNaN;                     ///< confidence level of the intervals

  std::size_t designs() const { return solves.size(); }  ///< The number of designs.
};

/// The name of a design, from the last parts of the keys' names: "R = 260 mm, sigma = 0.02 mm".
std::string design_name(const Result& found, std::size_t design);

/// The last part of a key's name; the whole name if another key has the same last part.
std::string short_key(const Result& found, std::size_t key);

/// The design with the best value of a figure of merit; the first if several have this value. None if all values are
/// NaN.
std::optional<std::size_t> best_design(const Result& found, std::size_t quantity);

/// The sweep in a stored result. Precondition: the result is of kind `sweep`.
inline const Result& sweep_of(const StoredResult& result) { return found_of<Result>(result); }

}  // namespace poesy::sweep
