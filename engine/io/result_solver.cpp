#include <cmath>

#include "engine/io/result_parts.h"

namespace poesy {
namespace {

template <class T, class Get>
std::vector<T> each(const std::vector<SolveCounts>& solves, const Get& get) {
  std::vector<T> values;
  for (const SolveCounts& cell : solves) values.push_back(get(cell));
  return values;
}

}  // namespace

void add_sigma(ResultBuilder& result, const Study& study) {
  result.add("/factors/sigma", {"factor"}, standard_deviations(study),
             {"SI: factor unit, see /factors/unit", "Standard deviation of the error, as set in the study"});
  std::vector<std::string> shapes;
  for (const FactorIndex factor : study.analysis.factors) {
    shapes.emplace_back(name(study.errors.by_factor[factor.value].shape()));
  }
  result.add("/factors/distribution", {"factor"}, shapes, {"1", "Distribution of the error, as set in the study"});
}

void add_solver(ResultBuilder& result, const Axes& axes, const std::vector<SolveCounts>& solves) {
  result.add_axis("status", texts(kStatusNames, std::identity()), {"1", "How a solve ended"});
  result.file().make_group("/solver");
  Axes with_status{"status"};
  with_status.insert(with_status.end(), axes.begin(), axes.end());
  result.show_axes("/solver", with_status);
  result.add("/solver/not_converged", axes,
             each<std::uint64_t>(solves, [](auto& cell) { return cell.not_converged(); }),
             {"1", "Samples that did not reach their fixed point"});
  result.add(
      "/solver/iterations_mean", axes,
      each<double>(solves,
                   [](auto& cell) { return static_cast<double>(cell.iterations) / static_cast<double>(cell.total()); }),
      {"1", "Mean number of iterations of a sample"});
  result.add("/solver/iterations_max", axes,
             each<std::uint32_t>(solves, [](auto& cell) { return cell.most_iterations; }),
             {"1", "Most iterations of a sample"});
  std::vector<std::uint64_t> by_status;
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    for (const SolveCounts& cell : solves) by_status.push_back(cell.by_status[status]);
  }
  result.add("/solver/solves_by_status", with_status, by_status, {"1", "Samples that ended so"});
}

std::vector<SolveCounts> read_solver(const h5::File& file, std::size_t cells) {
  const auto by_status = read_exactly<std::uint64_t>(file, "/solver/solves_by_status", kStatusNames.size() * cells);
  const auto mean = read_exactly<double>(file, "/solver/iterations_mean", cells);
  const auto most = read_exactly<std::uint32_t>(file, "/solver/iterations_max", cells);
  std::vector<SolveCounts> solves(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    SolveCounts& counts = solves[cell];
    for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
      counts.by_status[status] = by_status[status * cells + cell];
    }
    // The mean is the sum over the total, so this gives back the sum exactly; without samples it is NaN.
    if (counts.total() > 0) {
      counts.iterations = static_cast<std::uint64_t>(std::llround(mean[cell] * static_cast<double>(counts.total())));
    }
    counts.most_iterations = most[cell];
  }
  return solves;
}

}  // namespace poesy
