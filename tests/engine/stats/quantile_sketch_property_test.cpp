#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/buckets.h"
#include "engine/stats/quantile_sketch.h"
#include "tests/engine/stats/plain_sort.h"

namespace poesy {
namespace {

using Engine = std::mt19937_64;

struct Shape {
  std::string name;
  std::function<double(Engine&)> draw;
};

double normal(Engine& engine) { return std::normal_distribution<double>()(engine); }
double uniform(Engine& engine) { return std::uniform_real_distribution<double>(0.0, 1.0)(engine); }

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{
      {"Normal", normal},
      {"FoldedSmall", [](Engine& e) { return std::abs(1e-12 * normal(e)); }},
      {"Negative", [](Engine& e) { return -1.0 - uniform(e); }},
      {"Lognormal", [](Engine& e) { return std::exp(20.0 * normal(e)); }},
      {"AllExponents",
       [](Engine& e) { return std::copysign(std::ldexp(1.0 + uniform(e), int(2044 * uniform(e)) - 1022), normal(e)); }},
      {"HalfZero", [](Engine& e) { return std::max(0.0, normal(e)); }},
      {"TwoPoints", [](Engine& e) { return uniform(e) < 0.3 ? -1e200 : 1e-200; }},
      {"WholeNumbers", [](Engine& e) { return std::floor(7.0 * normal(e)); }},
      {"JustNormal", [](Engine& e) { return std::numeric_limits<double>::min() * (1.0 + 3.0 * uniform(e)); }},
      {"FarFromZero", [](Engine& e) { return 1e6 + 1e-3 * normal(e); }},
      {"BelowZero", [](Engine& e) { return -3.0 + 1e-6 * normal(e); }},
      {"AcrossAPowerOfTwo", [](Engine& e) { return 1.0 + 1e-9 * normal(e); }},
      {"HeavyTails", [](Engine& e) { return 5.0 + 1e-3 * normal(e) / normal(e); }},
      {"FewFarAway", [](Engine& e) { return uniform(e) < 0.002 ? 1e3 * normal(e) : 1.0 + 1e-6 * normal(e); }}};
  return all;
}

std::vector<double> drawn(const Shape& shape, std::size_t count, Engine& engine) {
  std::vector<double> values(count);
  for (double& value : values) value = shape.draw(engine);
  return values;
}

QuantileSketch of(std::span<const double> values) {
  QuantileSketch sketch;
  sketch.add(values);
  return sketch;
}

Bytes written(const QuantileSketch& sketch) {
  return bytes_of([&](ByteWriter& to) { write_state(sketch, to); });
}

class SketchOf : public testing::TestWithParam<std::size_t> {};

TEST_P(SketchOf, AgreesWithASortAsStated) {
  Engine engine(11);
  for (const std::size_t count : {1u, 2u, 3u, 10u, 97u, 1000u, 4321u}) {
    const std::vector<double> values = drawn(shapes()[GetParam()], count, engine);
    const QuantileSketch sketch = of(values);
    ASSERT_EQ(sketch.count(), count);
    for (const double q : {0.0, 1e-9, 0.001, 0.05, 0.25, 0.5, 2.0 / 3.0, 0.95, 0.999, 1.0}) {
      const double truth = test::sorted_quantile(values, q);
      const double off = std::abs(sketch.quantile(q) - truth);
      EXPECT_LE(off, QuantileSketch::kRelativeError * std::abs(truth))
          << count << " numbers, q = " << q << ": " << sketch.quantile(q) << " for " << truth;
      EXPECT_LE(off, order_statistic_error(sketch.buckets(), quantile_rank(q, count))) << count << " " << q;
    }
    EXPECT_EQ(sketch.min(), test::sorted_quantile(values, 0.0));
    EXPECT_EQ(sketch.max(), test::sorted_quantile(values, 1.0));
  }
}

TEST_P(SketchOf, SameBitsWhenMerged) {
  Engine engine(12);
  std::vector<double> values = drawn(shapes()[GetParam()], 3000, engine);
  const QuantileSketch whole = of(values);
  for (int trial = 0; trial < 8; ++trial) {
    std::ranges::shuffle(values, engine);
    std::vector<QuantileSketch> parts;
    for (std::size_t begin = 0; begin < values.size();) {
      const std::size_t end = std::min(values.size(), begin + engine() % 700);  // some parts are empty
      parts.push_back(of(std::span(values).subspan(begin, end - begin)));
      begin = end;
    }
    while (parts.size() > 1) {  // merges any two parts in any order
      std::swap(parts[engine() % parts.size()], parts.back());
      const QuantileSketch last = parts.back();
      parts.pop_back();
      parts[engine() % parts.size()].merge(last);
    }
    EXPECT_EQ(written(parts.front()), written(whole));
  }
}

TEST_P(SketchOf, QuantilesAscend) {
  Engine engine(13);
  const QuantileSketch sketch = of(drawn(shapes()[GetParam()], 500, engine));
  for (int k = 1; k <= 1000; ++k) EXPECT_LE(sketch.quantile((k - 1) / 1000.0), sketch.quantile(k / 1000.0));
}

INSTANTIATE_TEST_SUITE_P(Shapes, SketchOf, testing::Range(std::size_t{0}, shapes().size()),
                         [](const auto& shape) { return shapes()[shape.param].name; });

}  // namespace
}  // namespace poesy
