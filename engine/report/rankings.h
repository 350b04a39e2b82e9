#pragma once

#include <string>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/report/table.h"

/// Results that put their errors in order, two beside each other.
namespace poesy {

/// A result, and the response by which its errors are ranked; it must have it.
struct RankedResult {
  const StoredResult& result;  ///< must outlive this
  std::string path;            ///< of the result
  std::string response;        ///< name
  SolveCounts solves;          ///< all of them
};

/// Two rankings of the same errors by their effects, at the sizes that each study gives them.
struct TwoRankings {
  Table table;  ///< of each error its rank and effect in A and in B, in an order of A
  double tau;   ///< Kendall's, of the effects; NaN where it is not known
  /// Sentences for people: the tau, how the metrics differ, what is left out.
  std::vector<std::string> remarks;
};

/// Throws InputError, at the path of B, where the results are of two kinds or mechanisms.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

/// Whether two results are by different metrics, as far as both say it; files of older versions do not.
bool differ_in_metric(const StoredResult& a, const StoredResult& b);

/// What a reader must know of one of them, on one line: "A: title (path); metric: ...; ranked by gap; 5 of 1 000 solves
/// did not converge".
std::string ranked_text(char letter, const RankedResult& ranked);

}  // namespace poesy
