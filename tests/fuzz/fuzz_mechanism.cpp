// A mechanism's file. What is accepted is described and drawn, and its model built.
#include <vector>

#include "engine/base/error.h"
#include "engine/report/mechanism_picture.h"
#include "engine/report/tables.h"
#include "models/registry.h"
#include "tests/fuzz/target.h"

namespace {

using namespace poesy;

void read(const std::string& text) {
  const CatalogEntry entry = registry().from_text(text, "mechanism.toml");
  fuzz::expect(!model_text(entry).empty(), "what is accepted is described");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  const std::unique_ptr<Model> model = entry.build(geometry, 0);
  fuzz::expect(model->description().responses.size() == entry.description.responses.size(),
               "its model is as described");
  const std::string picture = mechanism_picture(model->sketch().value(), entry.description.title);
  fuzz::expect(picture.find("nan") == std::string::npos, "every place in a picture is a number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::accepted<InputError>([&] { read(text); });
  return 0;
}
