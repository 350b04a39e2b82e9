#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/page.h"
#include "engine/report/html/report.h"
#include "engine/report/in_common.h"

namespace poesy {

/// The numbers of one result, [R x P] in the units shown; without intervals low and high are empty.
struct ComparedValues {
  std::vector<double> value;      ///< one for each thing that is compared
  std::vector<double> low = {};   ///< lower ends of their intervals; empty where there are none
  std::vector<double> high = {};  ///< upper ends, likewise
};

/// One quantity of both results.
struct ComparedQuantity {
  std::string label;                            ///< for people
  std::string array;                            ///< how its arrays are named
  std::vector<std::vector<std::string>> units;  ///< [R] of one for all items, or of P
  ComparedValues a;                             ///< of the first result
  ComparedValues b;                             ///< of the second
};

/// What two results say about the same R options and P items.
struct Comparison {
  std::string option_word;           ///< "response"
  std::string item_word;             ///< "error"
  std::vector<std::string> options;  ///< [R]
  std::vector<std::string> items;    ///< [P]
  std::vector<std::string> only_a;   ///< items of A alone
  std::vector<std::string> only_b;   ///< what the second alone has
  /// Bars show all of them; the first gives ranks and the points against each other, the last the table.
  std::vector<ComparedQuantity> quantities;
  bool ranked = true;                ///< whether items have an order by size
  std::string total_label = {};      ///< what the totals are; empty: there are none
  std::vector<double> total_a = {};  ///< [R] one number for all items together of the first result, in the units shown
  std::vector<double> total_b = {};  ///< of the second
};

/// What there is to compare of two results of one kind and mechanism. Throws InputError where they have nothing in
/// common.
Comparison comparison(const ReportedResult& a, const ReportedResult& b);

/// Adds figures and tables of a comparison to a page, as sections.
void add_comparison(const Comparison& compared, Page& page);

/// The page of two results. Throws InputError where they cannot be compared. Precondition: two results.
Page comparison_page(std::span<const ReportedResult> results);

}  // namespace poesy
