#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "engine/report/html/page.h"
#include "engine/report/html/parts.h"

namespace poesy {

/// A quantity by which results are compared, for R options and P items, in the units shown.
struct ComparableQuantity {
  std::string label;                            ///< for people
  std::string array;                            ///< how its arrays are named
  std::vector<std::vector<std::string>> units;  ///< [R] of one for all items, or of P
  std::vector<double> value;                    ///< [R x P]
  std::vector<double> low = {};                 ///< [R x P] lower ends of intervals; empty where there are none
  std::vector<double> high = {};                ///< [R x P] upper ends, likewise
};

/// What a result offers to be compared with another one of its kind.
struct Comparable {
  std::string option_word;           ///< "response"
  std::vector<std::string> options;  ///< [R]
  std::string item_word;             ///< "error"
  std::vector<std::string> items;    ///< [P]
  /// Bars show all of them; the first gives ranks and the points against each other, the last the table.
  std::vector<ComparableQuantity> quantities = {};
  bool ranked = false;              ///< whether items have an order by size
  std::string total_label = {};     ///< what the totals are; empty: there are none
  std::vector<double> totals = {};  ///< [R] one number for all items together, in the units shown
};

/// A Comparable whose options are the responses, in the order of response_order, without quantities yet.
Comparable comparable_by_response(const StoredResult& result, std::string item_word, std::vector<std::string> items);

/// Adds a quantity in the unit shown of each response. value: SI, of (response, item).
void add_quantity(Comparable& to, const StoredResult& result, std::string label, std::string array,
                  const std::function<double(std::size_t, std::size_t)>& value);

/// What two results say of the same options and items, in the order of A.
struct Comparison {
  Comparable a;                     ///< of the first result
  Comparable b;                     ///< of the second
  std::vector<std::string> only_a;  ///< items of the first alone
  std::vector<std::string> only_b;  ///< items of the second alone
};

struct ReportKind;

/// What there is to compare of two results of this kind and one mechanism. Throws InputError where they have nothing in
/// common.
Comparison comparison(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b);

/// Adds figures and tables of a comparison to a page, as sections.
void add_comparison(const Comparison& compared, Page& page);

}  // namespace poesy
