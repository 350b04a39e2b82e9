// Fuzzes mechanism files. An accepted mechanism is drawn. One of 16 is also followed through its workspace and
// described, and its model is built, which takes a hundred times as long.
#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include "engine/base/error.h"
#include "engine/report/mechanism_picture.h"
#include "engine/report/tables.h"
#include "models/file/mechanism.h"
#include "models/file/structure.h"
#include "models/registry.h"
#include "tests/fuzz/target.h"

namespace {

using namespace poesy;

/// The sketch without the user's names, which may contain "nan".
Sketch without_names(Sketch sketch) {
  for (auto& limb : sketch.limbs) {
    for (SketchedJoint& joint : limb) joint.name.clear();
  }
  return sketch;
}

void draw(const std::string& text) {
  const file::MechanismFile file = file::read_mechanism_file(text, "mechanism.toml");
  const file::Mechanism mechanism = file::mechanism(file, file::default_geometry(file));
  fuzz::expect(!file::structure_text(mechanism).empty(), "its joints are described");
  const Sketch sketch = file::sketch_of(mechanism);
  fuzz::expect(!mechanism_picture(sketch, file.title).empty(), "every title is drawn");
  fuzz::expect(mechanism_picture(without_names(sketch), "").find("nan") == std::string::npos,
               "every place in a picture is a number");
}

void build(const std::string& text) {
  const CatalogEntry entry = registry().from_text(text, "mechanism.toml");
  fuzz::expect(!model_text(entry).empty(), "what is accepted is described");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  const std::unique_ptr<Model> model = entry.build(geometry, 0);
  fuzz::expect(model->description().responses.size() == entry.description.responses.size(),
               "its model is as described");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::accepted<InputError>([&] {
    draw(text);
    if (std::accumulate(data, data + size, 0u) % 16 == 0) build(text);
  });
  return 0;
}
