#include "engine/random/normal_copula.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"
#include "engine/linalg/decompositions.h"

namespace poesy {
namespace {

std::size_t side(std::span<const double> matrix) {
  const auto size = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
  POESY_EXPECTS(size > 0 && size * size == matrix.size());
  return size;
}

POESY_EACH_INSTRUCTION_SET void scale(double factor, double* row, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) row[b] *= factor;
}

POESY_EACH_INSTRUCTION_SET void add_scaled(double factor, const double* other, double* row, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) row[b] += factor * other[b];
}

}  // namespace

double smallest_eigenvalue(std::span<const double> matrix) {
  const auto size = static_cast<Eigen::Index>(side(matrix));
  // Row-major or column-major does not matter, because the matrix is symmetric.
  return linalg::eigenvalues(Eigen::Map<const linalg::Matrix>(matrix.data(), size, size))[0];
}

std::vector<double> lower_triangle(std::span<const double> matrix) {
  const std::size_t size = side(matrix);
  std::vector<double> triangle(matrix.size(), 0.0);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = matrix[i * size + j];
      for (std::size_t k = 0; k < j; ++k) rest -= triangle[i * size + k] * triangle[j * size + k];
      POESY_EXPECTS(i != j || rest > 0.0);
      triangle[i * size + j] = i == j ? std::sqrt(rest) : rest / triangle[j * size + j];
    }
  }
  return triangle;
}

NormalCopula::NormalCopula(std::span<const double> correlation)
    : size_(side(correlation)),
      correlation_(correlation.begin(), correlation.end()),
      triangle_(lower_triangle(correlation)) {}

void NormalCopula::correlate(std::span<const std::span<double>> rows) const {
  POESY_EXPECTS(rows.size() == size_);
  // The number of columns that are processed together, so that these columns of all rows fit into the cache.
  constexpr std::size_t kColumns = 128;
  const std::size_t count = rows.front().size();
  for (std::size_t begin = 0; begin < count; begin += kColumns) {
    const std::size_t columns = std::min(kColumns, count - begin);
    // The loop goes from the last row to the first, because a row needs the unchanged rows before it.
    for (std::size_t i = size_; i-- > 0;) {
      scale(triangle_[i * size_ + i], rows[i].data() + begin, columns);
      for (std::size_t j = 0; j < i; ++j) {
        add_scaled(triangle_[i * size_ + j], rows[j].data() + begin, rows[i].data() + begin, columns);
      }
    }
  }
}

ConditionalScores::ConditionalScores(const NormalCopula& copula, std::span<const std::size_t> shared,
                                     std::span<const std::size_t> drawn)
    : slopes_(drawn.size() * shared.size()), triangle_(drawn.size() * drawn.size()) {
  const std::size_t size = copula.size();
  POESY_EXPECTS(shared.size() + drawn.size() == size);
  std::vector<std::size_t> order(shared.begin(), shared.end());
  order.insert(order.end(), drawn.begin(), drawn.end());
  std::vector<double> ordered;
  for (const std::size_t i : order) {
    for (const std::size_t j : order) ordered.push_back(copula.correlation()[i * size + j]);
  }
  const std::vector<double> all = lower_triangle(ordered);
  const std::size_t s = shared.size();
  for (std::size_t d = 0; d < drawn.size(); ++d) {
    const double* const row = all.data() + (s + d) * size;
    for (std::size_t j = s; j-- > 0;) {  // solves x L_ss = L_ds, from the last column to the first
      double rest = row[j];
      for (std::size_t k = j + 1; k < s; ++k) rest -= slopes_[d * s + k] * all[k * size + j];
      slopes_[d * s + j] = rest / all[j * size + j];
    }
    for (std::size_t k = 0; k <= d; ++k) triangle_[d * drawn.size() + k] = row[s + k];
  }
}

void ConditionalScores::fill(std::span<const std::span<const double>> shared,
                             std::span<const std::span<const double>> normals,
                             std::span<const std::span<double>> drawn) const {
  POESY_EXPECTS(drawn.size() == normals.size() && drawn.size() * shared.size() == slopes_.size());
  for (std::size_t d = 0; d < drawn.size(); ++d) {
    const std::size_t count = drawn[d].size();
    std::ranges::copy(normals[d], drawn[d].begin());
    scale(triangle_[d * drawn.size() + d], drawn[d].data(), count);
    for (std::size_t k = 0; k < d; ++k) {
      add_scaled(triangle_[d * drawn.size() + k], normals[k].data(), drawn[d].data(), count);
    }
    for (std::size_t j = 0; j < shared.size(); ++j) {
      add_scaled(slopes_[d * shared.size() + j], shared[j].data(), drawn[d].data(), count);
    }
  }
}

}  // namespace poesy
