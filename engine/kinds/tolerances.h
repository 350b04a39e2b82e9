#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/files/result_file.h"
#include "engine/model/catalog.h"

namespace poesy {

/// Which tolerances are asked for, as the command line says it.
struct TolerancesOptions {
  std::string result;                    ///< path of the result
  std::string response;                  ///< that they are for; empty: none was named
  std::optional<std::string> limit;      ///< on the root mean square of the response: "0.05 mm"
  std::optional<std::string> reference;  ///< the error from which equal effects are counted: "NAME" or "NAME=0.1 mm"
  std::string folder;                    ///< for what is written; empty: RESULT_tolerances
  bool extrapolate = false;              ///< although an index changes with size
};

/// How a kind of study sets tolerances: writes them with the studies that test them, and gives what `poesy tolerances`
/// prints, broken at `width`. Throws InputError, FileError.
using SetTolerances = std::string (*)(const StoredResult& result, const TolerancesOptions& options,
                                      const Catalog& catalog, std::size_t width);

/// The same for a result of any kind. Throws InputError also for a kind that has no tolerances.
std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width);

}  // namespace poesy
